"""Rigs: a character teaches its skeleton, another mesh gets it.

Environment: FOCAL_CHARACTERS a folder of sample humanoids (focal_creatures --family humanoid --train 1 --test 1).
"""
import functools
import json
import math
import os
import pathlib
import struct
import unittest

import focal
from support import Case, mesh, numpy, rows, training_set

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


def joint_places(document):
    """Of the file's first skin by name, in the world."""
    nodes, places = document["nodes"], {}

    def rotated(q, v):
        x, y, z, w = q
        t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
        return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]]

    def visit(index, walk):
        node = nodes[index]
        walk = walk + [(node.get("rotation", [0, 0, 0, 1]), node.get("translation", [0, 0, 0]))]
        place = [0, 0, 0]
        for rotation, translation in reversed(walk):
            place = [a + b for a, b in zip(rotated(rotation, place), translation)]
        places[node.get("name")] = place
        for child in node.get("children", []):
            visit(child, walk)

    below = {child for node in nodes for child in node.get("children", [])}
    for index in range(len(nodes)):
        if index not in below:
            visit(index, [])
    return places


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

    def test_fixed_joints(self):
        name = rig_model().joint_names[5]
        free = found().rig().joints[5]
        place = tuple(x + 0.0625 for x in free.position)
        pinned = found().rig(fixed_joints={name: place}).joints
        self.assertEqual(pinned[5].position, tuple(struct.unpack("3f", struct.pack("3f", *place))))
        self.assertEqual(pinned[5].confidence, 1)
        self.assertNotEqual(pinned[free.parent].position, found().rig().joints[free.parent].position)
        with self.assertRaisesRegex(ValueError, "no_such_joint"):
            found().rig(fixed_joints={"no_such_joint": place})
        with self.assertRaisesRegex(ValueError, "3 numbers"):
            found().rig(fixed_joints={name: (0, 0)})

    def test_orientation(self):
        body = focal.Mesh.load(HUMANOIDS / "humanoid_01.glb")
        places, faces = [tuple(row) for row in body.vertices], [tuple(row) for row in body.faces]
        height = max(place[1] for place in places) - min(place[1] for place in places)
        upright = {joint.name: joint.position for joint in found().rig().joints}
        turns = {"back": (lambda p: (-p[0], p[1], -p[2]),) * 2, "head down": (lambda p: (p[0], -p[1], -p[2]),) * 2,
                 "lying": (lambda p: (p[0], -p[2], p[1]), lambda p: (p[0], p[2], -p[1]))}
        for name, (there, back) in turns.items():
            with self.subTest(name):
                turned = focal.Mesh([there(place) for place in places], faces)
                for joint in rig_model().detect(turned, orientation="any").rig().joints:
                    self.assertLess(math.dist(back(joint.position), upright[joint.name]), 0.02 * height, joint.name)
        with self.assertRaises(ValueError):
            rig_model().detect(body, orientation="sideways")

    def test_ground_root_and_vrm(self):
        folder = pathlib.Path(self.folder())
        skeleton = found().rig(names="mixamo", ground_root=True)
        first, second = skeleton.joints[:2]
        self.assertEqual((first.name, first.parent, second.parent), ("root", -1, 0))
        self.assertAlmostEqual(first.position[1], min(y for _, y, _ in rows(focal.Mesh.load(HUMANOIDS / "humanoid_01.glb").vertices)), 5)
        self.assertNotIn(0, {number for row, share in zip(rows(skeleton.weights[0]), rows(skeleton.weights[1]))
                             for number, weight in zip(row, share) if weight > 0})
        skeleton.write_vrm(folder / "avatar.vrm", {"name": "Ann", "authors": ["Bob"]})
        file = gltf(folder / "avatar.vrm")
        bones = file["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
        self.assertEqual(file["nodes"][bones["leftUpperArm"]["node"]]["name"], "mixamorig:LeftArm")
        self.assertEqual(file["nodes"][bones["hips"]["node"]]["name"], "mixamorig:Hips")
        self.refused(Status.INVALID_ARGUMENT, "name and a list of authors", skeleton.write_vrm, folder / "a.vrm", {})
        with self.assertRaises(TypeError):
            skeleton.write_vrm(folder / "a.vrm", "Ann")

    def test_bind(self):
        mesh = focal.Mesh.load(HUMANOIDS / "humanoid_00.rig.glb")
        skeleton = focal.Skeleton.bind(mesh)
        self.assertEqual({joint.name for joint in skeleton.joints}, set(rig_model().joint_names))
        target = pathlib.Path(self.folder()) / "kept.glb"
        skeleton.write(target)
        before, after = gltf(HUMANOIDS / "humanoid_00.rig.glb"), gltf(target)
        self.assertEqual((before["nodes"], before["skins"]), (after["nodes"], after["skins"]))

        joints = skeleton.joints
        again = focal.Skeleton.bind(focal.Mesh(mesh.vertices, mesh.faces), joints, max_influences=8)
        self.assertEqual([one.position for one in again.joints], [one.position for one in joints])
        self.assertEqual(len(rows(again.weights[0])[0]), 8)
        two = [{"name": "a", "parent": -1, "position": joints[0].position, "moves": False},
               {"name": "b", "parent": 0, "position": joints[1].position, "tip": joints[1].tip}]
        numbers, weights = focal.Skeleton.bind(mesh, two).weights
        self.assertEqual({number for row, share in zip(rows(numbers), rows(weights))
                          for number, weight in zip(row, share) if weight > 0}, {1})
        for wrong, message in (([{"name": "a"}], "lacks parent, position"), (["a"], "each joint must be a mapping")):
            with self.assertRaisesRegex((TypeError, ValueError), message):
                focal.Skeleton.bind(mesh, wrong)
        self.refused(Status.INVALID_ARGUMENT, "no skin", focal.Skeleton.bind,
                     focal.Mesh.load(HUMANOIDS / "humanoid_01.glb"))

    def test_stock_models(self):
        folder = pathlib.Path(self.folder())
        rig_model().save(folder / "tiny.focal")
        context = focal.Context(models_folder=folder)
        self.assertEqual(context.stock_models["tiny"], folder / "tiny.focal")
        self.assertEqual(focal.stock_models(context), context.stock_models)
        self.assertEqual(focal.Model.load_stock("tiny", context=context).joint_names, rig_model().joint_names)
        with self.assertRaises(focal.Error) as caught:
            focal.Model.load_stock("dragon", context=context)
        self.assertEqual(caught.exception.code, Status.FILE_NOT_FOUND)
        self.assertIn("tiny", caught.exception.hint)
        with self.assertRaises(TypeError):
            focal.Model.load_stock(3)

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

    def test_template_in_the_model(self):
        training = training_set()
        names = training.landmark_names
        template = {**TEMPLATE, "joints": [{"name": "first", "centre": names[:1]}, {"name": "second", "parent": "first", "surface": names[1:2]}]}
        self.refused(Status.INVALID_ARGUMENT, "nowhere", training.set_skeleton, {**TEMPLATE, "joints": [{"name": "a", "centre": ["nowhere"]}]})
        self.assertRaises(TypeError, training.set_skeleton, 3)
        training.set_skeleton(template)
        model = focal.Model.train(training, tree_count=10, learn_confidence=False)
        self.assertEqual(json.loads(model.skeleton_template), template)
        self.assertEqual(focal.Model.from_bytes(model.to_bytes()).joint_names, ["first", "second"])
        rigged = model.detect(mesh()).rig(joint_names={"second": "other"})
        self.assertEqual([joint.name for joint in rigged.joints], ["first", "other"])
        training.set_skeleton(None)
        self.assertIsNone(focal.Model.train(training, tree_count=10, learn_confidence=False).skeleton_template)

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

    def test_poses(self):
        folder = pathlib.Path(self.folder())
        for pose, below in (("t", 0), (focal.Pose.A, 45)):
            found().rig(names="vrm", rest_pose=pose).write(folder / "posed.glb")
            places = joint_places(gltf(folder / "posed.glb"))
            for side in ("left", "right"):
                for one, other in (("UpperArm", "LowerArm"), ("LowerArm", "Hand")):
                    way = [b - a for a, b in zip(places[side + one], places[side + other])]
                    self.assertAlmostEqual(math.degrees(math.asin(-way[1] / math.hypot(*way))), below, 2)
            for still in ("hips", "leftUpperArm", "leftFoot"):
                found().rig(names="vrm", rest_pose="teachers").write(folder / "rest.glb")
                self.assertLess(math.dist(places[still], joint_places(gltf(folder / "rest.glb"))[still]), 1e-5)
        for given, same in ((True, "teachers"), (False, "mesh"), (None, "mesh")):
            for name, pose in (("one", given), ("other", same)):
                found().rig(rest_pose=pose).write(folder / f"{name}.glb")
            self.assertEqual((folder / "one.glb").read_bytes(), (folder / "other.glb").read_bytes())
        with self.assertRaisesRegex(ValueError, "rest_pose is 'y', not one of"):
            found().rig(rest_pose="y")

    def test_symmetric(self):
        """The sample stands in a pose of its own: bones of both sides get the same lengths, and a warning says that it is no more."""
        skeleton = found().rig(symmetric=True)
        joints = {joint.name: joint for joint in skeleton.joints}

        def length(side):
            return math.dist(joints[side + "UpperArm"].position, joints[side + "LowerArm"].position)

        self.assertAlmostEqual(length("left"), length("right"), 5)
        self.assertTrue(any("is not symmetric" in warning for warning in skeleton.warnings))

    def test_helpers(self):
        names = rig_model().joint_names
        self.assertEqual([joint.name for joint in found().rig(drop_helpers=True).joints], names)  # it has none
        parts = ("rightUpperLeg", "leftUpperLeg", "leftLowerLeg", "leftFoot")
        marks = [next(mark.name for mark in found() if mark.name.startswith(f"{part} ")) for part in parts]
        template = {**TEMPLATE, "joints": [
            {"name": "hips", "centre": marks[:1]}, {"name": "thigh", "parent": "hips", "centre": marks[1:2]},
            {"name": "thigh_twist_01", "parent": "thigh", "centre": marks[2:3]}, {"name": "calf", "parent": "thigh_twist_01", "centre": marks[3:]}]}
        skeleton = found().rig(skeleton_template=template, drop_helpers=True, joint_names=["a", "b", "c", "d"])
        self.assertEqual([(joint.name, joint.parent) for joint in skeleton.joints], [("a", -1), ("b", 0), ("d", 1)])
        self.assertLess(max(max(int(j) for j in row) for row in skeleton.weights[0]), 3)
        for row in skeleton.weights[1]:
            self.assertAlmostEqual(sum(float(weight) for weight in row), 1, 5)

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
