#!/usr/bin/env python3
"""Compares focal's numerical stages with an independent NumPy reference and with exact geodesics, on real meshes.

Environment: FOCAL_REFERENCE, the reference script; FOCAL_EVALUATION_DATA, a folder of sets. Without them, or without
NumPy and SciPy, it says so and exits with 77 (skipped). Prints one line a figure; exits with 1 if one is over its limit.
"""
import argparse, importlib.util, json, os, subprocess, sys, tempfile

SETS = ["faust5k", "lion", "hand"]
EIGENPAIRS = 50          # compared; the signatures use all 200
SOURCES = 8              # of heat distances; the first two, at far ends of the shape, of exact distances too


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def load_reference():
    path, data = os.environ.get("FOCAL_REFERENCE"), os.environ.get("FOCAL_EVALUATION_DATA")
    if not path or not os.path.exists(path):
        skip("FOCAL_REFERENCE names no reference script")
    if not data or not os.path.isdir(data):
        skip("FOCAL_EVALUATION_DATA names no folder of sets")
    try:
        spec = importlib.util.spec_from_file_location("focal_reference", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError as error:
        skip(f"the reference does not load: {error}")
    return module, data


class Report:
    def __init__(self):
        self.failures = 0

    def add(self, mesh, what, value, limit):
        """A figure with a limit, or with None: only reported."""
        ok = limit is None or value <= limit
        self.failures += not ok
        verdict = "reported only" if limit is None else f"limit {limit:.0e}" + ("" if ok else "  FAILED")
        print(f"{mesh:12s} {what:58s} {value:9.2e}  {verdict}", flush=True)


def spread_sources(surface):
    """The vertex farthest from the centre, the one farthest from it, and some between."""
    import numpy as np
    far = lambda point: int(np.linalg.norm(surface.V - point, axis=1).argmax())
    end = far(surface.V.mean(0))
    n = len(surface.V)
    return [end, far(surface.V[end])] + [i * n // SOURCES for i in range(SOURCES - 2)]


def compare(report, reference, folder, name, programs, work):
    import numpy as np
    path = os.path.join(folder, name + ".glb")
    surface = reference.Surface(*reference.read_glb(path), name)
    n = len(surface.V)
    sources = spread_sources(surface)
    subprocess.run([programs.stages, path, work, *map(str, sources)], check=True)
    read = lambda file, *shape: np.fromfile(os.path.join(work, file)).reshape(*shape)

    values, vectors = surface.eigenpairs(cache=work)
    for method in ["chebyshev", "spectra"]:
        mine = read("eigenvalues_" + method, -1)
        error = np.abs(mine / np.where(values > 0, values, 1) - 1)[1:EIGENPAIRS].max()
        report.add(name, f"eigenvalues 2 to {EIGENPAIRS}, {method}: relative", error, 1e-6)
        report.add(name, f"first eigenvalue over the second, {method}", mine[0] / mine[1], 1e-8)

    theirs = reference.si_hks(surface, values, vectors)
    error = np.abs(read("si_hks", n, -1) - theirs) / np.abs(theirs)
    report.add(name, "SI-HKS: relative, 95th percentile", np.quantile(error, 0.95), 1e-4)

    heat, theirs = read("heat", SOURCES, n), surface.heat(sources)
    report.add(name, "heat distances over sqrt(area), largest", np.abs(heat - theirs).max() / surface.root_area, 1e-4)

    if programs.exact:
        subprocess.run([programs.exact, path, os.path.join(work, "exact"), *map(str, sources[:2])], check=True)
        exact = read("exact", 2, n)
        report.add(name, "exact distances over the diameter, largest",
                   np.abs(read("own_exact", 2, n) - exact).max() / exact.max(), 1e-6)
        mean_error = lambda distances: np.abs(distances[:2] - exact).mean() / exact.max()
        # Where the reference, which discretises alike, is off itself, the mesh needs repair before any heat method.
        own = mean_error(theirs)
        report.add(name, "heat against exact distances over the diameter, mean", mean_error(heat),
                   1e-2 if own <= 1e-2 else None)
        report.add(name, "  the reference's heat against the same", own, None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--stages", required=True, help="the program focal_stages")
    parser.add_argument("--exact", help="the program exact_geodesics; without it exact distances are not compared")
    programs = parser.parse_args()
    reference, data = load_reference()
    report = Report()
    if not programs.exact:
        print("skipped: exact geodesics (built without CGAL)")
    for folder in SETS:
        folder = os.path.join(data, folder)
        with open(os.path.join(folder, "set.json")) as file:
            name = json.load(file)["test"][0]
        with tempfile.TemporaryDirectory() as work:
            compare(report, reference, folder, name, programs, work)
    sys.exit(1 if report.failures else 0)


if __name__ == "__main__":
    main()
