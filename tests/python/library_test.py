"""The library is found where it may lie, and what is wrong with it is said.

Environment: FOCAL_CC a C compiler, for libraries of other versions.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import focal
from support import Case

PACKAGE = pathlib.Path(focal.__file__).resolve().parent
LIBRARY = pathlib.Path(focal.load_library()).name
TELL = "import focal; print(focal.load_library()); print(focal.version())"


class Loading(Case):
    """Each in a process of its own: a process loads one library, once."""

    def copied(self, with_library=True):
        """A copy of the package in a folder of its own."""
        folder = pathlib.Path(self.folder())
        shutil.copytree(PACKAGE, folder / "focal", ignore=None if with_library else shutil.ignore_patterns("lib"))
        return folder

    def python(self, folder, code=TELL, **environment):
        return subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=False,
                              env=dict(os.environ, PYTHONPATH=str(folder), **environment))

    def loads(self, folder, path, **environment):
        done = self.python(folder, **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.split()[0], str(path))

    def fails(self, folder, text, code=TELL, **environment):
        done = self.python(folder, code, **environment)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("LibraryError: ", done.stderr)
        self.assertRegex(done.stderr, text)
        return done.stderr


class Found(Loading):
    def test_the_package_stands_by_itself(self):
        folder = self.copied()
        self.loads(folder, folder / "focal" / "lib" / LIBRARY)

    def test_order_of_the_search(self):
        folder = self.copied()
        inside, beside, named = folder / "focal", folder, folder / "elsewhere"
        for other in (inside, beside, named):
            other.mkdir(exist_ok=True)
            for library in (PACKAGE / "lib").iterdir():
                shutil.copy(library, other)
        self.loads(folder, named / LIBRARY, FOCAL_LIBRARY=str(named / LIBRARY))
        self.loads(folder, inside / "lib" / LIBRARY)
        shutil.rmtree(inside / "lib")
        self.loads(folder, inside / LIBRARY)
        (inside / LIBRARY).unlink()
        self.loads(folder, beside / LIBRARY)

    def test_missing(self):
        folder = self.copied(with_library=False)
        text = self.fails(folder, "was not found")
        for place in (folder / "focal" / "lib", folder / "focal", folder, "FOCAL_LIBRARY", "focal_python_package"):
            self.assertIn(str(place), text)
        self.fails(folder, "was not found", "import focal; focal.Mesh([(0, 0, 0)], [(0, 0, 0)])")
        self.assertEqual(self.python(folder, "import focal; print(focal.__version__)").returncode, 0)
        self.fails(folder, "FOCAL_LIBRARY names .*which is not a file", FOCAL_LIBRARY=str(folder / "none.so"))

    def test_a_path_of_the_hosts_own(self):
        folder = self.copied(with_library=False)
        done = self.python(folder, f"import focal; print(focal.load_library({str(PACKAGE / 'lib' / LIBRARY)!r}))\n"
                                   "print(focal.Context().thread_count)")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.fails(folder, "cannot be loaded", "import focal; focal.load_library('none.so')")

    def test_no_library_at_all(self):
        folder = self.copied()
        (folder / "text.so").write_text("this is no library")
        self.fails(folder, "cannot be loaded: .*\n.*processor", FOCAL_LIBRARY=str(folder / "text.so"))

    def test_one_library_a_process(self):
        self.assertEqual(focal.load_library(), focal.load_library(focal.load_library()))
        with self.assertRaisesRegex(focal.LibraryError, "loaded already"):
            focal.load_library("/other/libfocal.so.0")


@unittest.skipUnless(os.environ.get("FOCAL_CC"), "FOCAL_CC names no C compiler")
class Versions(Loading):
    def made(self, code):
        """A shared library of these few lines of C."""
        folder = pathlib.Path(self.folder())
        (folder / "other.c").write_text(code)
        subprocess.run([os.environ["FOCAL_CC"], "-shared", "-fPIC", folder / "other.c", "-o", folder / "other.so"],
                       check=True)
        return str(folder / "other.so")

    def test_versions(self):
        folder, (major, minor, patch) = self.copied(), focal.VERSION
        own = ".".join(map(str, focal.VERSION))
        for other in ((major, minor + 1, 0), (major + 1, minor, patch)):
            library = self.made(f"unsigned focal_version(void) {{ return {other[0]}u << 16 | {other[1]}u << 8; }}")
            self.fails(folder, f"is focal {other[0]}.{other[1]}.*, this package is for {own}", FOCAL_LIBRARY=library)
        self.fails(folder, "it has no focal_version", FOCAL_LIBRARY=self.made("int focal_other(void) { return 0; }"))
        same = self.made(f"unsigned focal_version(void) {{ return {major}u << 16 | {minor}u << 8 | {patch + 1}u; }}")
        self.fails(folder, "has no focal_version_string: it is older than this package", FOCAL_LIBRARY=same)


if __name__ == "__main__":
    unittest.main()
