"""Figs. 1 to 6: the parts of the method. Each function returns the body of a section and the values in its docstring."""
import focal
import numpy as np

from damage import resampled, surface_of, with_holes, with_noise
from drawing import AMBER, BLUE, RED, chart, fixed, picture, row, table
from experiment import PRESETS, Shape, learn, vote_picture


def pipeline(study):
    """Fig. 1: from marks to a found point
    Landmark {landmark} is marked on the training shapes; the distances to it are learned; the points of a new shape vote for its place."""
    landmark, first = study.examples[-1], study.train[0]
    distances = first.mesh.distances(first.marks[landmark])
    pictures = [picture(shape.mesh, caption, shape.view(landmark), heat, [(shape.places[landmark], RED)]) for shape, caption, heat in
                [(shape, "marked", None) for shape in study.train[:2]] + [(first, "distances learned", 1 - distances / distances.max())]]
    pictures += [vote_picture(study.found[preset][0], study.test, landmark, f"{preset}, votes") for preset in PRESETS]
    return row(pictures), {"landmark": landmark}


def adding(study, counts=(3, 10, 30, 100, 1250)):
    """Fig. 6: votes add up
    Landmark {landmark}: so many points vote, each along the circle at the distance that the forest regresses from its descriptor; with preset default
    all distances in the leaves vote, so few points leave wide bands."""
    landmark = study.examples[0]
    return row([vote_picture(study.models[preset].detect(study.test.mesh, sampling_rate=1, max_samples=count), study.test, landmark,
                             f"{preset}, {count}") for preset in PRESETS for count in counts], len(counts)), {"landmark": landmark}


def descriptors(study):
    """Fig. 2: descriptors of one point on a damaged shape
    Noise of 0.3 mean edges, and 60 holes of one vertex. The table has the mean change of 200 points, relative to how far two points of the clean shape
    differ: at 1 nothing is left. Unlike the paper, spin images and shape contexts count area within 0.2 sqrt(area), not vertices."""
    clean = surface_of(study.test.mesh)
    surfaces = {"clean": clean, "noise": with_noise(*clean), "holes": with_holes(*clean)}
    common = np.unique(surfaces["holes"][1])  # vertices that all of them use
    vertices, charts, rows = common[np.arange(200) * len(common) // 200], "", []
    meshes = [focal.Mesh(*surface) for surface in surfaces.values()]
    for descriptor in focal.descriptors():
        values = [mesh.describe(vertices, descriptor) for mesh in meshes]
        apart = np.linalg.norm(values[0] - np.roll(values[0], 100, axis=0), axis=1).sum()
        charts += chart(descriptor, "component", [(name, colour, line[100]) for name, colour, line in zip(surfaces, (BLUE, AMBER, RED), values)])
        rows.append([descriptor, *(fixed(np.linalg.norm(values[0] - line, axis=1).sum() / apart) for line in values[1:])])
    return charts + table(["descriptor", "noise", "holes"], *rows), {}


def sides(mesh, points):
    """How far points lie from the symmetry plane, on the side of its normal, and the plane's support."""
    plane = mesh.symmetry_plane()
    return np.asarray(points) @ plane.normal - plane.offset, plane.support


def symmetry(study):
    """Fig. 3 a: symmetry-aware descriptors
    A point and its mirror image have one SI-HKS; on the side that the symmetry plane's normal does not point to, the components are reversed."""
    test, charts = study.test, ""
    images = [(name, other) for name in study.landmarks for other in sorted(study.mirror) if study.mirror[other] == name != other]
    for pair in [pair for pair in images if test.marks.keys() >= set(pair)][:2]:
        values = test.mesh.describe([test.mesh.faces[test.marks[name].triangle][np.argmax(test.marks[name].barycentric)] for name in pair])
        aware = [line[::-1] if side < 0 else line for line, side in zip(values, sides(test.mesh, [test.places[name] for name in pair])[0])]
        for title, lines in (("SI-HKS", values), ("symmetry-aware", aware)):
            charts += chart(title, "component", list(zip(pair, (RED, BLUE), lines)))
    return charts, {}


def planes(studies):
    """Fig. 3 b: symmetry planes
    Where the plane cuts the shape (red) and its two sides; the percentage is the share of the surface that is mirrored onto itself. Unlike the paper,
    focal finds the plane itself after Mitra, Guibas and Pauly 2006, by moments of balls instead of principal curvatures."""
    pictures = []
    for study, shape in [(study, shape) for study in studies for shape in (study.test, study.train[0])]:
        apart, support = sides(shape.mesh, shape.mesh.vertices)
        heat = np.where(abs(apart) < 1.2 * shape.edge, 0.85, np.where(apart > 0, 0.25, 0))
        pictures.append(picture(shape.mesh, f"{study.name}, {100 * support:.0f} %", shape.view(), heat))
    return row(pictures, min(5, len(pictures))), {}


def metrics(study):
    """Fig. 4: distances
    From landmark {landmark} in bands of even width, and the votes of preset paper by each distance, on meshes of {count} vertices, learned from {shapes}
    shapes. Where bands are uneven, a small error in distance is a long way on the surface. Preset default takes geodesic distances only."""
    landmark, bands, votes = study.examples[0], [], []
    count = min(1000 if study.quick else 1500, study.test.mesh.vertex_count)

    def coarser(shape):
        mesh = focal.Mesh(*resampled(*surface_of(shape.mesh), count))
        return Shape(mesh, {landmark: int(np.linalg.norm(mesh.vertices - shape.places[landmark], axis=1).argmin())})

    train, test = [coarser(shape) for shape in study.train[:3 if study.quick else 5] if landmark in shape.marks], coarser(study.test)
    for distance in focal.distances():
        share = study.test.mesh.distances(study.test.marks[landmark], distance)
        share /= share.max()
        bands.append(picture(study.test.mesh, distance, test.view(), np.where(8 * share % 1 < 0.5, 1 - 0.8 * share, 0)))
        found = learn(train, [landmark], preset="paper", distance=distance).detect(test.mesh)
        votes.append(vote_picture(found, test, landmark, distance))
    return row(bands + votes, len(bands)), {"landmark": landmark, "count": count, "shapes": len(train)}


def regression(study):
    """Fig. 5: regressed distances
    What the forests regress for the sample points of the test shape, and the truth: shares of each point's largest distance with preset paper, lengths
    over sqrt(area) with preset default. Shown is the mean of the leaves; far from a landmark with a mirror image they hold two distances."""
    charts, rows = "", {name: [name] for name in study.examples}
    for preset, model in study.models.items():
        analysis = model.analyse(study.test.mesh)
        for name in study.examples:
            regressed, truth = model.regress(analysis, name, study.test.marks[name])
            order = np.argsort(truth)
            charts += chart(f"{preset}, {name}", "sample points in the order of distance",
                            [("regressed", BLUE, regressed[order], None, "o"), ("true", RED, truth[order])])
            rows[name].append(fixed(np.mean((truth - regressed)**2), 4))
    return charts + table(["landmark", "paper: mean square error", "default"], *rows.values()), {}
