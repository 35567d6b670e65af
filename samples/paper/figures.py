"""A function for each table and figure: it returns the body of a section and the values that the docstring, which is its words, has in braces."""
import time

import focal
import numpy as np

from damage import resampled, surface_of, with_holes, with_noise, without
from drawing import AMBER, BLUE, GREEN, GREY, HUES, RED, chart, fixed, picture, row, table
from experiment import PRESETS, Shape, learn, vote_picture
from printed import BONES, ERRORS, SECONDS


def performance(studies):
    """Table 1: seconds
    On {threads} threads; as printed: on a 3.4 GHz Core i7 and a GeForce GTX 780, for meshes of 5K to 12.5K vertices. Unlike the paper, forests and geodesics
    are those of all landmarks of a set; with preset paper the geodesics of a detection count towards the voting."""
    rows = []
    for study in studies:
        count, lines = len(study.train), {}
        for preset in PRESETS:
            train, test = study.clocks[preset].seconds, study.found[preset][0].seconds
            lines[preset] = [train["analysis"] / count, train["distances"] / count, train["forest"], test["spectrum"] + test["descriptors"],
                             test["geodesics"], test["forest"], test["vote"] + test["constellation"] + test["refine"], test["total"]]
        if study.name in SECONDS:
            lines["as printed"] = [*SECONDS[study.name], sum(SECONDS[study.name][3:])]
        rows += [[study.title, study.test.mesh.vertex_count, count, who, *map(fixed, line)] for who, line in lines.items()]
    return table(["set", "vertices", "shapes", "preset", "training: descriptors, per shape", "geodesics, per shape", "forests",
                  "detection: descriptors", "geodesics", "forest", "voting", "in all"], *rows), {"threads": focal.Context().thread_count}


def errors(studies):
    """Table 2: errors by kind of point
    In mean edge lengths of the test mesh. Kind 1: tips; kind 3: flat places; kind 2: what lies between. Unlike the paper, the points are the marked ones
    nearest to the paper's, on remeshed shapes of the same sources, and both ways in which a symmetry plane can point vote. The points: {names}"""
    rows, names = [], ""
    for study in studies:
        for preset in PRESETS:
            means = [fixed(study.mean_error(preset, kind)) for kind in (*study.kinds, study.landmarks)]
            rows.append([study.title, preset, *(f"{mean} ({len(kind)})" for kind, mean in zip(study.kinds, means)), means[3]])
        if study.name in ERRORS:
            rows.append([study.title, "as printed", *map(fixed, ERRORS[study.name])])
        names += f"<br>{study.name}: " + "; ".join(f"{i} {', '.join(kind) or 'none'}" for i, kind in enumerate(study.kinds, 1))
    return table(["set", "preset", "error 1 (points)", "error 2", "error 3", "mean"], *rows), {"names": names}


def pipeline(study, counts=(3, 10, 30, 100, 1250)):
    """Figs. 1 and 6: from marks to a found point, and how votes add up
    Landmark {last} is marked on the training shapes; the distances to it are learned; the points of a new shape vote for its place. Below, so many points
    vote for {first}, each along the circle at the distance that the forest regresses from its descriptor; with preset default all distances in the
    leaves vote, so few points leave wide bands."""
    first, last, shape = study.examples[0], study.examples[-1], study.train[0]
    distances = shape.mesh.distances(shape.marks[last])
    pictures = [picture(one.mesh, caption, one.view(last), paint, [(one.places[last], RED)]) for one, caption, paint in
                [(one, "marked", None) for one in study.train[:2]] + [(shape, "distances learned", 1 - distances / distances.max())]]
    pictures += [vote_picture(study.found[preset][0], study.test, last, f"{preset}, votes") for preset in PRESETS]
    adding = [vote_picture(model.detect(study.test.mesh, sampling_rate=1, max_samples=count), study.test, first, f"{preset}, {count}")
              for preset, model in study.models.items() for count in counts]
    return row(pictures) + row(adding, len(counts)), {"first": first, "last": last}


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
        apart, _ = sides(test.mesh, [test.places[name] for name in pair])
        aware = [line[::-1] if side < 0 else line for line, side in zip(values, apart)]
        charts += "".join(chart(title, "component", list(zip(pair, (RED, BLUE), lines)))
                          for title, lines in (("SI-HKS", values), ("symmetry-aware", aware)))
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


def timed(call, *given, **parameters):
    start = time.perf_counter()
    return call(*given, **parameters), time.perf_counter() - start


def curves(study, preset, what, x, places, lines, seconds):
    """lines: a number for each example at each place."""
    curves_of = [(name, colour, line, places[-len(lines):]) for name, colour, line in zip(study.examples, (RED, GREEN, BLUE), zip(*lines))]
    return f"<div>{chart(f'{preset}, {what}', x, curves_of)}{chart(f'{preset}, seconds', x, [('', GREY, seconds, places)])}</div>"


def by_training(study):
    """Fig. 7 a, b: how much of each training shape is sampled, and how many shapes are trained on
    Mean square error of the distances that a model regresses for the sample points of the test shape. {forests} The mean of the distributions of preset
    default, shown here, is no better for more samples: of a landmark with a mirror image it lies between two distances (see Fig. 5)."""
    rates, counts = (0.1, 0.5, 1) if study.quick else (0.1, 0.2, 0.3, 0.5, 0.7, 1), range(2, len(study.train) + 1, 1 if study.quick else 2)
    parts, charts = {"sampling rate in training": [(rate, None, {"sampling_rate": rate}) for rate in rates],
                     "training shapes": [(count, count, {}) for count in counts]}, ""
    for x, preset in [(x, preset) for x in parts for preset in PRESETS]:
        lines, seconds = [], []
        for _, count, parameters in parts[x]:
            model, took = timed(learn, study.train[:count], study.examples, preset=preset, **study.trees, **parameters)
            seconds.append(took)
            analysis = model.analyse(study.test.mesh)
            pairs = [model.regress(analysis, name, study.test.marks[name]) for name in study.examples]
            lines.append([np.mean((truth - regressed)**2) for regressed, truth in pairs])
        charts += curves(study, preset, "mean square error", x, [place for place, *_ in parts[x]], lines, seconds)
    return charts, {"forests": "Forests of 10 trees." if study.trees else ""}


def by_votes(study, rates=(0.02, 0.05, 0.1, 0.15, 0.2, 0.3)):
    """Fig. 7 c: how much of the test shape is sampled
    The norm of the difference of two successive distributions of votes, over that of the later one. Both presets sample their share of what they
    analyse: preset default a proxy of 3,500 vertices. Unlike the paper, preset paper votes on the processor, so its time grows with the rate."""
    charts, count = "", study.test.mesh.vertex_count
    for preset, model in study.models.items():
        found = [timed(model.detect, study.test.mesh, sampling_rate=1, max_samples=max(1, int(rate * count))) for rate in rates]
        votes = [[line / line.sum() for line in map(one.votes, study.examples)] for one, _ in found]
        lines = [[np.linalg.norm(b - a) / np.linalg.norm(b) for a, b in zip(*pair)] for pair in zip(votes, votes[1:])]
        charts += curves(study, preset, "change of the votes", "sampling rate in detection", rates, lines, [took for _, took in found])
    return charts, {}


def extraction(study):
    """Figs. 8 and 9: {name}
    The votes of all {count} points at once, squared, those below 0.2 left out, and a point of each kind. The caption has the mean error."""
    pictures = []
    for shape, preset, found in [(shape, preset, study.found[preset][i]) for i, shape in enumerate(study.tests[:2]) for preset in PRESETS]:
        votes = np.max([found.votes(name)**2 for name in study.landmarks], axis=0)
        marks = [(one.position, BLUE) for one in found if one.position and one.name in shape.marks]
        mean = np.mean(shape.errors(found, study.landmarks))
        pictures.append(picture(shape.mesh, f"{preset}, all: {mean:.1f}", shape.view(), np.where(votes < 0.2, 0, votes), marks))
    singly = [vote_picture(study.found[preset][0], study.test, name, f"{preset}, {name}") for preset in PRESETS for name in study.examples]
    return row(pictures) + row(singly), {"name": study.name, "count": len(study.landmarks)}


def few_marks(study, near=5):
    """Beside Schelling points: how many marks it takes, {name}
    The share of all points found within 5 mean edges of their marks on the test shapes; each point is marked once on every training shape. Schelling
    points (Chen et al. 2012) take tens to hundreds of marks a shape, and predict where people click, not which point is which."""
    counts, shares = range(2, len(study.train) + 1, 2 if study.quick else 1), {preset: [] for preset in PRESETS}
    for preset, count in [(preset, count) for preset in PRESETS for count in counts]:
        is_known = count == len(study.train)
        model = study.models[preset] if is_known else learn(study.train[:count], study.landmarks, preset=preset, **study.trees)
        away = [one for shape in study.tests for one in shape.errors(model.detect(shape.mesh), study.landmarks)]
        shares[preset].append(np.mean(np.less(away, near)))
    rows = [[count, *(f"{100 * shares[preset][i]:.0f} %" for preset in PRESETS)] for i, count in enumerate(counts)]
    lines = [(preset, colour, shares[preset], counts) for preset, colour in zip(PRESETS, (AMBER, BLUE))]
    return (chart("share found", "training shapes, one mark each", lines) +
            table(["marks of each point", "paper: found", "default: found"], *rows), {"name": study.name})


def changed(study, models, landmark, changes, limits=()):
    """A row for each model: what it finds on each changed shape, {name: arguments of Shape.changed}. limits: the most vertices it is tried on."""
    view, shapes, pictures = study.test.view(landmark), {name: study.test.changed(*change) for name, change in changes.items()}, []
    for label, model, name, shape in [(label, model, name, shape) for label, model in models.items() for name, shape in shapes.items()]:
        if shape.mesh.vertex_count > dict(limits).get(label, 1e9):
            pictures.append(picture(shape.mesh, f"{label}, {name}: not tried", view))
        else:
            pictures.append(vote_picture(model.detect(shape.mesh), shape, landmark, f"{label}, {name}", view))
    return row(pictures, len(changes)), {"landmark": landmark}


def damage(study):
    """Fig. 10: noise, holes, scale
    Landmark {landmark}: three rows of preset paper by descriptor, one of preset default. Noise of 0.3 mean edges, 60 holes of one vertex, a hundred times
    the size. Unlike the paper, spin images and shape contexts weigh points by area, on the connected surface nearby."""
    landmark, clean = study.examples[-1], surface_of(study.test.mesh)
    models = {name: learn(study.train, [landmark], preset="paper", descriptor=name, **study.trees)
              for name in ("si-hks", "spin-image", "unique-shape-context")}
    return changed(study, {**models, "default": study.models["default"]}, landmark, {
        "clean": clean, "noise": with_noise(*clean), "holes": with_holes(*clean), "100 x": (100 * clean[0], clean[1], (100, 100, 100))})


def resolution(study):
    """Fig. 11: resolution
    Landmark {landmark}, the test shape with so many vertices; errors in mean edges of the shape as it was. Preset paper takes distances from every vertex,
    which was not tried above 14,000; preset default analyses a proxy of 3,500 vertices whatever the size."""
    clean, own = surface_of(study.test.mesh), study.test.mesh.vertex_count
    counts = (own // 4, own // 2, own, 4 * own) if study.quick else (12500, 62500, 125000, 500000)
    return changed(study, study.models, study.examples[-1], {f"{count / 1000:.1f}K": resampled(*clean, count) for count in counts}, {"paper": 14000})


def applications(study):
    """Figs. 12 and 13: segmentation, correspondence and coarse skeletons
    k-means of position and SI-HKS that starts at the points found, and at points drawn at random. Below, points of one colour correspond; lines are the
    skeleton that is defined once over the points."""
    mesh, starts, shapes, pictures = study.test.mesh, {f"{preset}, from the points": study.found[preset][0] for preset in PRESETS}, study.tests[:3], []
    for seed in (1, 2):  # k-means starts where the landmarks are held
        vertices = np.random.default_rng(seed).choice(np.unique(mesh.faces), len(study.landmarks))
        starts[f"from anywhere, {seed}"] = study.models["default"].detect(mesh, fixed=dict(zip(study.landmarks, vertices)))
    parts = [picture(mesh, caption, study.test.view(), found.segment("k_means")) for caption, found in starts.items()]
    for preset, number in [(preset, number) for preset in PRESETS for number in range(len(shapes))]:
        found = [one for one in study.found[preset][number] if one.position]
        names, marks = [one.name for one in found], [(one.position, HUES(study.landmarks.index(one.name) % 20)) for one in found]
        bones = [(names.index(a), names.index(b)) for a, b in BONES.get(study.name, []) if a in names and b in names]
        pictures.append(picture(shapes[number].mesh, f"{preset}, shape {number + 1}", shapes[number].view(), marks=marks, bones=bones))
    return row(parts) + row(pictures, len(shapes)), {}


def missing_parts(study):
    """Fig. 14: missing parts and a shape that is not isometric
    Landmark {landmark} without the head, without the arms, and 1.6 times as wide and deep: the paper's method works for the first only. Preset default
    divides distances by sqrt(area), which a missing part hardly changes, and learns from copies with parts cut off."""
    if study.name not in ("scape", "human07", "humanoid"):
        return "", {}
    test, clean, changes = study.test, surface_of(study.test.mesh), {}
    for name, words, share in (("no head", ("crown", "head"), 0.15), ("no arms", ("hand", "finger"), 0.27)):
        ends = [tip for tip in study.kinds[0] if tip in test.marks and any(word in tip for word in words)]
        distances = np.array([test.mesh.distances(test.marks[end]) for end in ends])
        changes[name] = without(*clean, distances.min(axis=0) < share * distances.max())
    changes["wider"] = clean[0] * (1.6, 1, 1.6), clean[1], (1.6, 1, 1.6)
    return changed(study, study.models, study.kinds[2][0], changes)
