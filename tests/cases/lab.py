"""What the cases share: the command, models of sample characters that are trained once, and a list of what was measured."""
import json
import os
import subprocess

from scene import Scene

RIGHT, KNOWN, WRONG = "right", "known miss", "WRONG"


class Lab:
    def __init__(self, focal, quick_model, cases, characters, data, out, models):
        self.command, self.quick_model, self.cases, self.characters = focal, quick_model, cases, characters
        self.data, self.out = data, out
        self.model_folder = models or self.result("models", "")
        self.results = []  # (case, what, figure, state)
        self.written = []  # (file, input, how): for tests/viewers/check.mjs
        self.rigs = {}

    def input(self, *names):
        return os.path.join(self.cases, *names)

    def character(self, number, kind=".glb"):
        return os.path.join(self.characters, "humanoid", f"humanoid_{number:02}{kind}")

    def result(self, *names):
        path = os.path.join(self.out, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def focal(self, *arguments):
        """Of a run: status, output, what it says of errors and warnings."""
        run = subprocess.run([self.command, *map(str, arguments)], capture_output=True, text=True)
        return run.returncode, run.stdout, run.stderr

    def report(self, *arguments):
        """The JSON of a run that must be done. A rig whose verdict is failed ends with 1, and is judged here by its joints."""
        status, out, err = self.focal(*arguments, "--json", "--quiet")
        if status > (1 if "--keep-failed" in arguments else 0) or not out:
            raise RuntimeError(f"focal {' '.join(map(str, arguments))} ended with {status}: {err}")
        return json.loads(out)

    # --- models ---

    def model(self, name, *characters):
        """Of rigged characters, as the command makes it."""
        return self.trained(name, lambda path: self.report("train", "--rigs", *characters, "-o", path))

    def quick(self, name, *characters):
        """The same in a second; no more is asked of it than that it knows the skeleton."""
        return self.trained(name, lambda path: subprocess.run([self.quick_model, path, *characters], check=True))

    def trained(self, name, train):
        path = os.path.join(self.model_folder, name + ".focal")
        if not os.path.exists(path):
            train(path)
        return path

    def taught(self):
        """RIGS.focal of the cases: the first five sample humanoids."""
        return self.model("RIGS", *[self.character(number, ".rig.glb") for number in range(5)])

    def marks(self):
        """MARKS.focal of the cases."""
        options = ("--limit", 4, "--trees", 6, "--eigenpairs", 60, "--proxy", 1000)
        return self.trained("MARKS", lambda path: self.report("train", os.path.join(self.characters, "humanoid"), "-o", path, *options))

    def rig(self, model, mesh, *options, kind=".glb"):
        """The rigged file and the command's report; the same rig is made once."""
        key = (model, mesh, options)
        if key not in self.rigs:
            path = self.result("rigs", f"{len(self.rigs):02}{kind}")
            report = self.report("rig", model, mesh, "-o", path, "--keep-failed", *options)
            with open(path + ".json", "w") as file:
                json.dump(report, file)
            self.written.append((path, mesh, " ".join(["rig", *options])))
            self.rigs[key] = (path, report)
        path, report = self.rigs[key]
        return (Scene(path) if kind == ".glb" else path), report

    # --- figures ---

    def add(self, case, what, figure, state):
        self.results.append((case, what, figure, state))

    def is_so(self, case, what, so, figure=""):
        self.add(case, what, str(figure), RIGHT if so else WRONG)

    def at_most(self, case, what, value, bound, known=None):
        """known: bound of a miss that is known, above the right answer's."""
        state = RIGHT if value <= bound else KNOWN if known is not None and value <= known else WRONG
        self.add(case, what, f"{value:.4g} (at most {bound:g}{'' if known is None else f'; known to miss, {known:g}'})", state)


class Case:
    """One folder of the cases, as its function sees it."""

    def __init__(self, lab, name):
        self.lab, self.name = lab, name

    def file(self, *names):
        return self.lab.input(self.name, *names)

    def result(self, *names):
        return self.lab.result(self.name, *names)

    def is_so(self, what, so, figure=""):
        self.lab.is_so(self.name, what, bool(so), figure)

    def at_most(self, what, value, bound, known=None):
        self.lab.at_most(self.name, what, float(value), bound, known)
