"""A wheel of the package: built without a network, installed elsewhere, with its library inside. Skips where pip cannot build one."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import unittest
import zipfile

import focal
from support import Case

PACKAGE = pathlib.Path(focal.__file__).resolve().parent


def can_build():
    return all(importlib.util.find_spec(name) for name in ("pip", "setuptools")) and (
        importlib.util.find_spec("wheel") or importlib.util.find_spec("setuptools.command.bdist_wheel"))


class Wheel(Case):
    def pip(self, *arguments):
        done = subprocess.run([sys.executable, "-m", "pip", "--disable-pip-version-check", *arguments], capture_output=True, text=True,
                              env={**os.environ, "PIP_NO_INDEX": "1", "PYTHONPATH": ""})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_built_and_used(self):
        folder = pathlib.Path(self.folder())
        source = folder / "source"
        source.mkdir()
        shutil.copytree(PACKAGE, source / "focal", ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("pyproject.toml", "setup.py"):
            shutil.copy(PACKAGE.parent / name, source)
        self.pip("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), str(source))
        wheel, = folder.glob("focal-*.whl")
        self.assertRegex(wheel.name, rf"^focal-{focal.__version__}-py3-none-\w+\.whl$")
        names = zipfile.ZipFile(wheel).namelist()
        for wanted in ("focal/__init__.py", "focal/py.typed", "focal/LICENSE", "focal/THIRD_PARTY.md"):
            self.assertIn(wanted, names)
        self.assertTrue(any(name.startswith("focal/lib/") for name in names))
        self.pip("install", "--no-deps", "--target", str(folder / "site"), str(wheel))
        said = subprocess.run([sys.executable, "-c", "import focal; print(focal.load_library(), focal.version())"], check=True,
                              cwd=folder, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(folder / "site")})
        self.assertIn(str(folder / "site" / "focal" / "lib"), said.stdout)
        self.assertIn(focal.version(), said.stdout)


if __name__ == "__main__":
    if not can_build():
        print("skipped: this Python has no pip, setuptools and wheel (on Debian: python3-pip, python3-wheel)")
        sys.exit(77)
    unittest.main()
