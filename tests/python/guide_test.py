"""What README and docs/python.md show is run as it stands, in a folder with the files it names.

Environment: FOCAL_SOURCE the project's folder; FOCAL_CHARACTERS a folder of sample humanoids, for the part on rigs.
"""
import contextlib
import io
import os
import pathlib
import re
import shutil
import unittest
from unittest import mock

import focal
import rig_test
from support import Case, glb, model, shape

SOURCE = pathlib.Path(os.environ.get("FOCAL_SOURCE") or pathlib.Path(__file__).resolve().parents[2])


class Guide(Case):
    def setUp(self):
        folder = pathlib.Path(self.folder())
        for name, variation in (("cat1", 0), ("cat2", 0.05), ("cat3", 0.1), ("cat4", 0.15), ("cat", 0.12)):
            for place in (folder, folder / "cats"):
                place.mkdir(exist_ok=True)
                (place / f"{name}.glb").write_bytes(glb(*shape(16, variation)[:2]))
        model().save(folder / "animal.focal")
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(folder)

    def said(self, code, names):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(code, names)
        return out.getvalue()

    @unittest.skipUnless(rig_test.HUMANOIDS.is_dir(), "FOCAL_CHARACTERS holds no sample humanoids")
    def test_readme(self):
        text = (SOURCE / "README.md").read_text(encoding="utf-8")
        block = re.search(r"^(    import focal\n(?:    .*\n)*)", text, re.M)[1]
        lines = [line[4:] for line in block.rstrip().split("\n")]
        self.assertLess(len(lines), 15)
        shutil.copy(rig_test.HUMANOIDS / "humanoid_01.glb", "statue.glb")
        rig_test.rig_model().save("humanoid.focal")
        with mock.patch.dict(os.environ, FOCAL_MODELS=os.getcwd()):
            self.said("\n".join(lines), {})
        self.assertGreater(focal.Mesh.load("rigged.glb").vertex_count, 1000)

    def test_docs(self):
        if rig_test.HUMANOIDS.is_dir():
            shutil.copy(rig_test.HUMANOIDS / "humanoid_01.glb", "statue.glb")
            rig_test.rig_model().save("rig.focal")
        text = (SOURCE / "docs" / "python.md").read_text(encoding="utf-8")
        blocks, names, said = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S), {}, []
        self.assertGreater(len(blocks), 6)
        for block in blocks:
            if "rig.focal" not in block or rig_test.HUMANOIDS.is_dir():
                said.append(self.said(block, names))
        self.assertEqual([line.split()[0] for line in said[0].splitlines()], ["nose", "paw", "tail"])
        self.assertIn("FILE_NOT_FOUND | ", said[-1])
        self.assertIn("100%", "".join(said))
        self.assertEqual(pathlib.Path("rigged.glb").exists(), rig_test.HUMANOIDS.is_dir())


if __name__ == "__main__":
    unittest.main()
