"""Blender loads every glTF file that focal wrote: as many bones as the joints of the rig, meshes that an armature moves, clips.

    blender --background --factory-startup --python-exit-code 3 --python in_blender.py -- LIST

LIST: as check.mjs has it. A file that Blender refuses is a fault where Blender takes its input; where Blender refuses both, the last line
counts it. An importer that fails by itself, or takes hardly any file, proves nothing: that is a fault too.
"""
import json
import sys

import bpy
import numpy

if not hasattr(numpy, "bool"):  # Debian 12: the importer of Blender 3.4 needs it, NumPy 1.24 does not have it
    numpy.bool = bool


def loaded(path):
    """What Blender makes of a file, or the error that it ends with."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        bpy.ops.import_scene.gltf(filepath=path)
    except RuntimeError as error:
        if "AttributeError" in str(error):
            raise  # the importer does not work here
        return str(error).strip().splitlines()[-1]
    bones = [bone.name for armature in bpy.data.armatures for bone in armature.bones]
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    moved = sum(any(modifier.type == "ARMATURE" for modifier in obj.modifiers) for obj in meshes)
    return {"bones": bones, "vertices": sum(len(obj.data.vertices) for obj in meshes), "moved": moved, "actions": len(bpy.data.actions)}


def faults_of(written, source, how):
    """Of one file; None: Blender refuses its input as well."""
    after = loaded(written)
    if isinstance(after, str):
        return None if isinstance(loaded(source), str) else [f"is not loaded: {after}"]
    faults = []
    if after["vertices"] == 0:
        faults.append("has no vertices")
    if how.startswith("rig"):
        with open(written + ".json", encoding="utf-8") as file:
            joints = len(json.load(file)["joints"])
        if len(after["bones"]) < joints:
            faults.append(f"has {len(after['bones'])} bones, the rig has {joints} joints")
        if after["moved"] == 0:
            faults.append("no armature moves a mesh")
    return faults


def main(listed):
    with open(listed, encoding="utf-8") as file:
        rows = [line.rstrip("\n").split("\t") for line in file]
    faulty = refused = 0
    for written, source, how in rows:
        faults = faults_of(written, source, how)
        if faults is None:
            refused += 1
            print(f"\nblender: {source} is refused, as written and as it was", flush=True)
        for fault in faults or []:
            faulty += 1
            print(f"\nblender: {written} ({how}): {fault}", flush=True)
    print(f"\nblender {bpy.app.version_string}: {len(rows)} files, {faulty} faults, {refused} refused with their inputs", flush=True)
    if refused > len(rows) // 4:
        print("\nblender: too few files were loaded to say anything", flush=True)
        return 1
    return faulty


if main(sys.argv[sys.argv.index("--") + 1]):
    sys.exit(1)
