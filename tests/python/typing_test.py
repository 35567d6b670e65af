"""The package is clean by `mypy --strict`, and callers see the types of arrays. Skips where there is no mypy."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import focal

CALLER = '''
import focal
import numpy
from numpy.typing import NDArray

mesh = focal.Mesh.load("cat.glb")
vertices: NDArray[numpy.float32] = mesh.vertices
faces: NDArray[numpy.uint32] = mesh.faces
model = focal.Model.load("animal.focal")
with model.detect(mesh) as found:
    votes: NDArray[numpy.float32] = found.votes("nose")
    labels: NDArray[numpy.int32] = found.segment()
    place: tuple[float, float, float] | None = found["nose"].position
    joints, weights = found.rig(names="mixamo").weights
    reveal_type(joints)
    reveal_type(weights)
wrong: str = mesh.vertices
'''


def mypy(*arguments):
    with tempfile.TemporaryDirectory() as cache:
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-color-output", "--cache-dir", cache, *arguments],
                              capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(pathlib.Path(focal.__file__).parents[1])})


class Types(unittest.TestCase):
    def test_the_package_is_strict(self):
        said = mypy("-p", "focal")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_what_callers_see(self):
        with tempfile.TemporaryDirectory() as folder:
            caller = pathlib.Path(folder) / "caller.py"
            caller.write_text(CALLER)
            said = mypy(str(caller)).stdout
        self.assertEqual(said.count("error:"), 1, said)
        self.assertIn('has type "ndarray[Any, dtype[floating[_32Bit]]]", variable has type "str"', said)
        self.assertRegex(said, r"Revealed type is .*unsignedinteger")
        self.assertRegex(said, r"Revealed type is .*floating")


if __name__ == "__main__":
    if not importlib.util.find_spec("mypy"):
        print("skipped: there is no mypy for this Python (on Debian: python3-mypy)")
        sys.exit(77)
    unittest.main()
