"""Rigs: a character teaches its skeleton, another mesh gets it.

Environment: FOCAL_CHARACTERS a folder of sample humanoids (focal_creatures --family humanoid --train 1 --test 1).
"""
import functools
import json
import os
import pathlib
import struct
import unittest

import focal
from support import Case, numpy, rows

Status = focal.Status
HUMANOIDS = pathlib.Path(os.environ.get("FOCAL_CHARACTERS", "")) / "humanoid"
TEMPLATE = {"format": "focal-skeleton-template", "version": 1, "joints": []}


@functools.lru_cache(maxsize=None)
def rig_model():
    marked = focal.TrainingSet()
    marked.add_rig(focal.Mesh.load(HUMANOIDS / "humanoid_00.rig.glb"))
    return focal.Model.train(marked, proxy_vertices=1500, tree_count=10, rigged_shapes=8, learn_confidence=False)


@functools.lru_cache(maxsize=None)
def found():
    return rig_model().detect(focal.Mesh.load(HUMANOIDS / "humanoid_01.glb"))


def gltf(path):
    data = path.read_bytes()
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


@unittest.skipUnless(HUMANOIDS.is_dir(), "FOCAL_CHARACTERS holds no humanoids")
class Rigs(Case):
    def test_skeleton(self):
        skeleton, names = found().rig(), rig_model().joint_names
        joints = skeleton.joints
        self.assertEqual([joint.name for joint in joints], names)
        self.assertEqual(skeleton.info["joint_count"], len(joints))
        for number, joint in enumerate(joints):
            self.assertTrue(-1 <= joint.parent < number, joint)
            self.assertTrue(0 <= joint.confidence <= 1)
            self.assertAlmostEqual(sum(x * x for x in joint.rotation), 1, 4)
            self.assertEqual((len(joint.position), len(joint.tip)), (3, 3))
        self.assertEqual(len(skeleton.warnings), skeleton.info["warning_count"])

    def test_verdict(self):
        skeleton = found().rig()
        self.assertIsInstance(skeleton.verdict, focal.Verdict)
        self.assertEqual((skeleton.verdict, skeleton.quality), (skeleton.info["verdict"], skeleton.info["quality"]))
        self.assertTrue(0 <= skeleton.quality <= 1)
        self.assertTrue(0 <= skeleton.info["guessed_joints"] <= skeleton.info["joint_count"])
        self.assertNotEqual(skeleton.verdict, focal.Verdict.FAILED)
        said = any(warning.startswith("the rig ") for warning in skeleton.warnings)
        self.assertEqual(said, skeleton.verdict != focal.Verdict.GOOD)

    def test_check(self):
        marked, folder = focal.TrainingSet(), pathlib.Path(self.folder())
        self.refused(Status.INVALID_ARGUMENT, "no rigged character", marked.check)
        marked.add_rig(focal.Mesh.load(HUMANOIDS / "humanoid_00.rig.glb"))
        self.assertEqual(marked.check(), [])
        data = (HUMANOIDS / "humanoid_00.rig.glb").read_bytes()
        (folder / "other.glb").write_bytes(data.replace(b'"left', b'"qrst').replace(b'"right', b'"uvwxy'))
        marked.add_rig(focal.Mesh.load(folder / "other.glb"))
        self.refused(Status.INVALID_ARGUMENT, "2 (other.glb) share", marked.check)
        self.assertEqual(focal.TrainingSet(["nose"]).check(), [])

    def test_weights(self):
        numbers, weights = found().rig().weights
        self.assertEqual((len(numbers), len(weights)), (found().info["vertex_count"],) * 2)
        joints = len(rig_model().joint_names)
        for of_vertex, weight in zip(rows(numbers), rows(weights)):
            self.assertAlmostEqual(sum(weight), 1, 4)
            self.assertEqual(weight, sorted(weight, reverse=True))
            self.assertTrue(all(0 <= joint < joints for joint in of_vertex))
        if numpy is not None:
            self.assertEqual((numbers.dtype, weights.dtype, weights.shape[1]), (numpy.uint32, numpy.float32, 4))

    def test_names(self):
        own = rig_model().joint_names
        for names in ("mixamo", focal.BoneNames.MIXAMO):
            self.assertIn("mixamorig:Hips", [joint.name for joint in found().rig(names=names).joints])
        mapped = found().rig(joint_names={own[1]: "Wirbel"})
        self.assertEqual([joint.name for joint in mapped.joints], [own[0], "Wirbel", *own[2:]])
        listed = found().rig(names="vrm", joint_names=["Wurzel", *[None] * (len(own) - 1)])
        self.assertEqual(listed.joints[0].name, "Wurzel")
        for kind, wrong in ((ValueError, {"no joint": "a"}), (TypeError, "hips"), (TypeError, [1]), (TypeError, 3)):
            self.assertRaises(kind, found().rig, joint_names=wrong)
        self.refused(Status.INVALID_ARGUMENT, "joint_name_count", found().rig, joint_names=["a"])
        with self.assertRaisesRegex(ValueError, "names is 'maya', not one of: as_trained, vrm, mixamo"):
            found().rig(names="maya")

    def test_template(self):
        names = [landmark.name for landmark in found()]
        joints = [{"name": "first", "centre": [names[0]]},
                  {"name": "second", "parent": "first", "centre": [names[1]], "tip": names[2]}]
        template = {**TEMPLATE, "joints": joints}
        for given in (template, json.dumps(template)):
            made = found().rig(skeleton_template=given)
            self.assertEqual([joint.name for joint in made.joints], ["first", "second"])
        self.refused(Status.INVALID_FILE, "", found().rig, skeleton_template="{")
        self.refused(Status.INVALID_ARGUMENT, "", found().rig, skeleton_template=TEMPLATE)
        self.assertRaises(TypeError, found().rig, skeleton_template=3)

    def test_parts_by_joints(self):
        labels = [int(label) for label in found().segment()]
        self.assertEqual(labels, [int(label) for label in found().segment("skeleton")])
        self.assertLessEqual(set(labels), set(range(-1, len(rig_model().joint_names))))

    def test_files(self):
        folder = pathlib.Path(self.folder())
        told = []
        skeleton = found().rig(names="mixamo", rest_pose=True, symmetric=True,
                               on_progress=lambda progress, stage: told.append(progress))
        skeleton.write(folder / "rigged.glb")
        written = gltf(folder / "rigged.glb")
        self.assertEqual(len(written["skins"]), 1)
        self.assertIn("mixamorig:Head", [node.get("name") for node in written["nodes"]])
        self.assertEqual(told[-1], 1)
        focal.TrainingSet().add_rig(focal.Mesh.load(folder / "rigged.glb"))  # it is a rigged character now
        self.refused(Status.FILE_NOT_FOUND, "", skeleton.write, folder / "none" / "rigged.glb")

    def test_animations(self):
        folder, character = pathlib.Path(self.folder()), HUMANOIDS / "humanoid_00.rig.glb"
        names = [animation["name"] for animation in gltf(character)["animations"]]
        found().rig(animations=focal.Mesh.load(character)).write(folder / "dancing.glb")
        self.assertEqual([one["name"] for one in gltf(folder / "dancing.glb")["animations"]], names)
        posed = focal.Mesh.load(folder / "dancing.glb", pose_animation=names[0], pose_time=0.5)
        self.assertEqual(posed.triangle_count, found().info["triangle_count"])
        self.assertNotEqual(rows(posed.vertices), rows(focal.Mesh.load(HUMANOIDS / "humanoid_01.glb").vertices))
        found().rig().write(folder / "still.glb")
        still = found().rig(animations=focal.Mesh.load(folder / "still.glb"))
        self.assertIn("the character has no animations", still.warnings)
        self.refused(Status.INVALID_ARGUMENT, "no skin", found().rig,
                     animations=focal.Mesh.load(HUMANOIDS / "humanoid_00.glb"))
        with self.assertRaisesRegex(TypeError, "animations must be a focal.Mesh"):
            found().rig(animations="dance.glb")


if __name__ == "__main__":
    unittest.main()
