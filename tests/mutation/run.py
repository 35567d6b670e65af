#!/usr/bin/env python3
"""Would the tests notice if a check of foreign bytes or of an argument were wrong?

Every condition that guards a refusal (if (...) throw, fail, refuse, return false) in the readers and the C interface is
changed in every way below, one at a time, and the tests that concern the file are run. A mutant that no test fails on has
survived: a test is missing, or the change changes nothing; those are listed with their reason in equivalent.txt. A file is
compiled once with all its mutants in it, FOCAL_MUTANT in the environment switches one on, and it is linked in front of the
library. Needs a release build of the tests (tests/run.sh).

usage: run.py [--build BUILD] [--sample N] [--seed S] [--only TEXT] [--jobs N] [--least PERCENT]
"""
import argparse
import collections
import concurrent.futures
import fnmatch
import os
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
    ("src/gltf/*.cpp", ["*gltf/*"], ["mesh"]),
    ("src/base/archive.cpp", ["*base/archive*"], []),
    ("src/model/*_file.cpp", ["*model/*_file*"], []),
    ("src/base/utf8.cpp", ["*model/*_file*"], []),
    ("capi/*.cpp", [], None),
]
# Of the C interface: tests/capi/X_test for capi/X.cpp, and these, the likeliest and quickest first.
PROGRAMS = collections.defaultdict(list, {
    "arguments": ["mesh", "model"], "boundary": ["structs"], "context": ["structs", "host"], "correspondence": ["detection"],
    "detection": ["model", "analysis"], "detection_output": ["detection", "model"], "model": ["structs"], "status": ["structs"],
    "training_set": ["skeleton"]})

Mutant = collections.namedtuple("Mutant", "path line what start end new kind")  # new: what stands for text[start:end]


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

    def add(start, end, new, what, kind):
        found.append(Mutant(path, text.count("\n", 0, start) + 1, what, start, end, new, kind))

    for match in re.finditer(r"\bif \(", code):
        opening = match.end() - 1
        end = closing(code, opening)
        if end < 0 or not REFUSAL.match(code[end + 1:end + 120]):
            continue
        if re.match(r"(const )?[\w:*& ]+ = [^;]*$", code[opening + 1:end]):  # declares what it tests
            continue
        start = opening + 1 + re.sub(r"\{[^}]*\}", lambda m: " " * len(m.group()), code[opening + 1:end]).rfind(";") + 1
        shown = " ".join(text[opening + 1:end].split())
        add(start, end, "false", "if (" + shown + ")  ->  never", "bool")
        types = [m.span() for m in TYPE_ARGUMENT.finditer(code, start, end)]
        for operator in OPERATOR.finditer(code, start, end):
            if any(a <= operator.start() < b for a, b in types):
                continue
            new = SWAPS[operator.group()]
            add(start, end, text[start:operator.start()] + new + text[operator.end():end],
                f"{shown}  :  {operator.group()} at {operator.start() - opening} -> {new}", "bool")
    for match in RANGE.finditer(code):  # literal bounds of a number that is read
        end = closing(code, match.end() - 1)
        for bound in re.finditer(r"(?<=, )-?\d+(?=[,)])", code[match.start():end + 1]):
            at = match.start() + bound.start()
            for step in (-1, 1):
                add(at, at + len(bound.group()), str(int(bound.group()) + step),
                    " ".join(text[match.start():end + 1].split()) + f"  :  {bound.group()} -> {int(bound.group()) + step}",
                    "number")
    return found


def with_mutants(text, mutants):
    """The source with all these mutants in it, numbered from 0 in their order."""
    places = collections.defaultdict(list)  # outer places before those inside them
    for number, mutant in enumerate(mutants):
        places[mutant.start, -mutant.end, mutant.kind].append((number, mutant.new))
    ordered = sorted(places.items())

    def rendered(start, end, at):
        result = ""
        while at < len(ordered) and ordered[at][0][0] < end:
            (first, last, kind), choices = ordered[at]
            last = -last
            inside = at + 1
            while inside < len(ordered) and ordered[inside][0][0] < last:
                inside += 1
            cast = "bool" if kind == "bool" else ""
            result += text[start:first] + "(" + "".join(f"focal_mutant == {n} ? {cast}({new}) : " for n, new in choices) + \
                f"{cast}({rendered(first, last, at + 1)}))"
            start, at = last, inside
        return result + text[start:end]

    switch = ('#include <cstdlib>\nstatic const int focal_mutant = '
              'std::getenv("FOCAL_MUTANT") ? std::atoi(std::getenv("FOCAL_MUTANT")) : -1;\n')
    return switch + rendered(0, len(text), 0)


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
        self.programs = {p.name[len("capi_"):-len("_test")]: p for p in (folder / "tests/capi").glob("capi_*_test")}

    def programs_of(self, path):
        return [name for name in [path.stem, *PROGRAMS[path.stem]] if name in self.programs]

    def run(self, command):
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True)

    def object_of(self, path, text, folder):
        source = folder / path.name
        source.write_text(text)
        words = list(self.compile[path])
        for flag in ("-MF", "-MT"):
            del words[words.index(flag):words.index(flag) + 2]
        words[words.index("-c") + 1] = str(source)
        words[words.index("-o") + 1] = str(folder / "mutant.o")
        words = [w for w in words if w not in ("-MD", "-Werror")] + [f"-I{path.parent}", "-w"]
        return folder / "mutant.o" if self.run(words).returncode == 0 else None

    def linked(self, name, mutant_object, own_object, folder, leave_out=()):
        words = [w for w in self.link[name].split(" ") if w not in leave_out]
        words[words.index("-o") + 1] = str(folder / name)
        if own_object in words:
            words[words.index(own_object)] = str(mutant_object)
        else:
            words.insert(words.index("-o"), str(mutant_object))
        done = self.run(["sh", "-c", " ".join(words)])
        if done.returncode:
            sys.exit(f"cannot link {name}: {done.stderr[-2000:]}")
        return folder / name

    def other_tests(self, sources):
        """The objects of tests that are not wanted: they would only take time to link."""
        objects = [w for w in self.link["focal_tests"].split(" ") if w.endswith("_test.cpp.o")]
        return [o for o in objects if not any(fnmatch.fnmatch(o, source + "*") for source in sources)]


class Tests:
    """A file with its mutants, linked into the tests that concern it."""

    def __init__(self, build, path, mutants, sources, programs, folder):
        self.folder, self.commands = folder, []
        text = path.read_text()
        mutant_object = build.object_of(path, with_mutants(text, mutants), folder)
        self.compiles = mutant_object is not None
        if not self.compiles:
            return
        if sources:
            tests = build.linked("focal_tests", mutant_object, None, folder, build.other_tests(sources))
            self.commands.append(([tests, "--abort-after=1", "--source-file=" + ",".join(sources)], None))
        if programs:
            words = build.compile[path]
            own = words[words.index("-o") + 1] if "capi" in path.parts else None
            library = build.linked("libfocal", mutant_object, own, folder)
            self.commands += [([build.programs[p]], library) for p in programs]

    def fail_on(self, number):
        environment = dict(os.environ, FOCAL_MUTANT=str(number))
        environment.pop("FOCAL_EVALUATION_DATA", None)  # what the tests make themselves must do, and is quicker
        for command, library in self.commands:
            more = {"LD_PRELOAD": str(library)} if library else {}
            with tempfile.TemporaryDirectory() as folder:
                try:
                    if subprocess.run(command, cwd=folder, capture_output=True, timeout=120,
                                      env=environment | more).returncode:
                        return True
                except subprocess.TimeoutExpired:
                    return True
        return False


def results_of(build, path, mutants, sources, programs, jobs):
    """For each mutant: is it killed? None where it does not compile."""
    with tempfile.TemporaryDirectory() as name:
        tests = Tests(build, path, mutants, sources, programs, pathlib.Path(name))
        if tests.compiles:
            if tests.fail_on(-1):
                sys.exit(f"the tests of {path} fail without any mutant")
            with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
                yield from pool.map(tests.fail_on, range(len(mutants)))
            return
    if len(mutants) == 1:
        yield None
    else:  # one of them, perhaps
        for mutant in mutants:
            yield from results_of(build, path, [mutant], sources, programs, jobs)


def described(mutant):
    return f"{mutant.path.relative_to(ROOT)}: {mutant.what}"


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
    known, trials = [], []
    for pattern, sources, programs in SUBJECTS:
        for path in sorted(ROOT.glob(pattern)):
            if given.only in str(path):
                chosen = programs if programs is not None else build.programs_of(path)
                for mutant in mutants_of(path):
                    (known if described(mutant) in equivalent else trials).append((mutant, sources, chosen))
    if given.sample and given.sample < len(trials):
        trials = random.Random(given.seed).sample(trials, given.sample)
    files = collections.defaultdict(list)
    for mutant, sources, programs in trials:
        files[mutant.path, tuple(sources), tuple(programs)].append(mutant)
    killed, stillborn, survivors = 0, 0, []
    for (path, sources, programs), mutants in files.items():
        for mutant, result in zip(mutants, results_of(build, path, mutants, sources, programs, given.jobs)):
            stillborn += result is None
            killed += result is True
            if result is False:
                survivors.append(mutant)
                print(f"survived: {described(mutant)}   (line {mutant.line})", flush=True)
    tried = killed + len(survivors)
    if not tried:
        sys.exit("no mutant was tried")
    share = 100 * killed / tried
    print(f"{tried} mutants, {killed} killed ({share:.1f} %), {len(survivors)} survived; {stillborn} did not compile, "
          f"{len(known)} change nothing (equivalent.txt)")
    sys.exit(share < given.least)


if __name__ == "__main__":
    main()
