#!/usr/bin/env python3
"""Would the tests notice if a check of foreign bytes or of an argument were wrong?

Every condition that guards a refusal (if (...) throw, fail, refuse, return false) in the readers and the C interface is
changed in every way below, one at a time; the file is compiled anew, linked in front of the library, and the tests that
concern it are run. A mutant that no test fails on has survived: a test is missing, or the change changes nothing; those
are listed with their reason in equivalent.txt. Needs a release build of the tests (tests/run.sh).

usage: run.py [--build BUILD] [--sample N] [--seed S] [--only TEXT] [--jobs N] [--least PERCENT]
"""
import argparse
import concurrent.futures
import pathlib
import random
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
REFUSAL = re.compile(r"^\s*\{?\s*(throw\b|fail\w*\(|refuse\w*\(|\w+\.fail\(|return (false|std::nullopt|\{\}|nullptr|no_\w+)|"
                     r"return FOCAL_ERROR)")
SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "||": "&&", "&&": "||"}
OPERATOR = re.compile(r"(?<![<>=!\-])(<=|>=|==|!=|\|\||&&|<|>)(?![<>=])")
TYPE_ARGUMENT = re.compile(r"\w+(::\w+)*<[\w:\s,*&]*>\s*[({:&*]")  # static_cast<T>(, std::vector<T>{
RANGE = re.compile(r"\b(integer|i32|u32|f32|f32s|count|check_range|number)\(")

# What is mutated, and the tests that should notice: doctest sources, then programs over the shared library.
SUBJECTS = [
    ("src/gltf/*.cpp", ["*gltf/*"], ["capi_mesh_test"]),
    ("src/base/archive.cpp", ["*base/archive*", "*landmarks/*_file*"], []),
    ("src/landmarks/*_file.cpp", ["*landmarks/*_file*"], ["capi_analysis_test", "capi_model_test"]),
    ("capi/*.cpp", [], "all"),
]


def closing(text, start):
    depth = 0
    for i in range(start, len(text)):
        depth += text[i] in "([{"
        depth -= text[i] in ")]}"
        if depth == 0:
            return i
    return -1


def blanked(text):
    """Comments and strings replaced by spaces of the same length."""
    return re.sub(r"//[^\n]*|\"(\\.|[^\"\\\n])*\"|'(\\.|[^'\\\n])'",
                  lambda m: " " * len(m.group()), text)


def mutants_of(path):
    text = path.read_text()
    code = blanked(text)
    found = []

    def add(start, end, new, what):
        found.append({"path": path, "line": text.count("\n", 0, start) + 1, "what": what,
                      "text": text[:start] + new + text[end:]})

    for match in re.finditer(r"\bif \(", code):
        start = match.end() - 1
        end = closing(code, start)
        if end < 0 or not REFUSAL.match(code[end + 1:end + 120]):
            continue
        condition = code[start + 1:end]
        if re.match(r"(const )?[\w:*& ]+ = [^;]*$", condition):  # a declaration: only as a whole
            continue
        add(start + 1, end, "false", "if (" + " ".join(text[start + 1:end].split()) + ")  ->  never")
        types = [m.span() for m in TYPE_ARGUMENT.finditer(code, start, end)]
        for operator in OPERATOR.finditer(code, start + 1, end):
            if any(a <= operator.start() < b for a, b in types):
                continue
            new = SWAPS[operator.group()]
            add(operator.start(), operator.end(), new,
                " ".join(text[start + 1:end].split()) + f"  :  {operator.group()} at {operator.start() - start} -> {new}")
    for match in RANGE.finditer(code):  # literal bounds of a number that is read
        end = closing(code, match.end() - 1)
        for bound in re.finditer(r"(?<=, )-?\d+(?=[,)])", code[match.start():end + 1]):
            at = match.start() + bound.start()
            for step in (-1, 1):
                add(at, at + len(bound.group()), str(int(bound.group()) + step),
                    " ".join(text[match.start():end + 1].split()) + f"  :  {bound.group()} -> {int(bound.group()) + step}")
    return found


def ninja(build, *arguments):
    return subprocess.run(["ninja", "-C", build, *arguments], check=True, capture_output=True, text=True).stdout


class Build:
    def __init__(self, folder):
        self.folder = folder
        commands = ninja(folder, "-t", "commands", "tests/focal_tests", "capi/libfocal.so").splitlines()
        self.compile, self.link = {}, {}
        for command in commands:
            words = shlex.split(command)
            if "-c" in words:
                source = (folder / words[words.index("-c") + 1]).resolve()
                self.compile[source] = words
            elif "-o" in words:
                self.link[pathlib.Path(words[words.index("-o") + 1]).name.split(".so")[0]] = command
        capi_tests = sorted(p for p in (folder / "tests/capi").glob("capi_*_test") if p.is_file())
        self.programs = {p.name: p for p in capi_tests}

    def run(self, command, **more):
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, **more)

    def object_of(self, mutant, folder):
        source = folder / mutant["path"].name
        source.write_text(mutant["text"])
        words = list(self.compile[mutant["path"]])
        for flag in ("-MF", "-MT"):
            del words[words.index(flag):words.index(flag) + 2]
        words[words.index("-c") + 1] = str(source)
        words[words.index("-o") + 1] = str(folder / "mutant.o")
        words = [w for w in words if w not in ("-MD", "-Werror")] + [f"-I{mutant['path'].parent}", "-w"]
        return folder / "mutant.o" if self.run(words).returncode == 0 else None

    def linked(self, name, mutant_object, own_object, folder):
        command = self.link[name]
        output = re.search(r"-o (\S+)", command).group(1)
        command = command.replace(f"-o {output}", f"-o {folder / name}", 1)
        if own_object and own_object in command:
            command = command.replace(own_object, str(mutant_object), 1)
        else:
            command = command.replace(f"-o {folder / name}", f"-o {folder / name} {mutant_object}", 1)
        done = self.run(["sh", "-c", command])
        if done.returncode:
            sys.exit(f"cannot link {name}: {done.stderr[-2000:]}")
        return folder / name


def fails(command, environment=None):
    try:
        with tempfile.TemporaryDirectory() as folder:
            return subprocess.run(command, cwd=folder, capture_output=True, timeout=120, env=environment).returncode != 0
    except subprocess.TimeoutExpired:
        return True


def is_killed(build, mutant, sources, programs):
    """None: does not compile."""
    import os
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mutant_object = build.object_of(mutant, folder)
        if not mutant_object:
            return None
        if sources:
            tests = build.linked("focal_tests", mutant_object, None, folder)
            if fails([tests, "--abort-after=1", "--source-file=" + ",".join(sources)]):
                return True
        names = list(build.programs) if programs == "all" else programs
        if names:
            words = build.compile[mutant["path"]]
            own = words[words.index("-o") + 1] if "capi" in mutant["path"].parts else None
            library = build.linked("libfocal", mutant_object, own, folder)
            environment = dict(os.environ, LD_PRELOAD=str(library))
            return any(fails([build.programs[n]], environment) for n in names)
    return False


def described(mutant):
    return f"{mutant['path'].relative_to(ROOT)}: {mutant['what']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--sample", type=int, help="only so many, drawn at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="only files whose path holds this")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=float, default=95, help="percent of the mutants that must be killed")
    given = parser.parse_args()
    build = Build(given.build.resolve())
    equivalent = {line.split("  #")[0].strip() for line in (HERE / "equivalent.txt").read_text().splitlines()
                  if line.strip() and not line.startswith("#")}
    trials = []
    for pattern, sources, programs in SUBJECTS:
        for path in sorted(ROOT.glob(pattern)):
            if given.only in str(path):
                trials += [(mutant, sources, programs) for mutant in mutants_of(path)]
    known = [t for t in trials if described(t[0]) in equivalent]
    trials = [t for t in trials if described(t[0]) not in equivalent]
    if given.sample and given.sample < len(trials):
        trials = random.Random(given.seed).sample(trials, given.sample)
    killed, stillborn, survivors = 0, 0, []
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for trial, result in zip(trials, pool.map(lambda t: is_killed(build, *t), trials)):
            stillborn += result is None
            killed += result is True
            if result is False:
                survivors.append(trial[0])
                print(f"survived: {described(trial[0])}   (line {trial[0]['line']})", flush=True)
    tried = killed + len(survivors)
    if not tried:
        sys.exit("no mutant was tried")
    share = 100 * killed / tried
    print(f"{tried} mutants, {killed} killed ({share:.1f} %), {len(survivors)} survived; {stillborn} did not compile, "
          f"{len(known)} change nothing (equivalent.txt)")
    sys.exit(share < given.least)


if __name__ == "__main__":
    main()
