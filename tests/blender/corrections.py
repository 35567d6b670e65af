"""Landmarks set by hand, and the others after them."""
import sys
import time

import bpy
import numpy

from common import MODULE, activate, check, refused, size, step, truth, world


def errors_of(obj):
    """{landmark: how far from the truth, as a share of the size}"""
    right = truth(obj.name)
    return {m.name: numpy.linalg.norm(world(obj, m) - right[m.name]) / size(obj)
            for m in obj.focal.landmarks if m.placed}


def mean(errors):
    return sum(errors.values()) / len(errors)


def unsure(obj):
    return sum(m.status == "UNCERTAIN" for m in obj.focal.landmarks)


def put(obj, name, place):
    """As the artist does: by the 3D cursor."""
    obj.focal.active = obj.focal.landmarks.find(name)
    x, y, z = place
    bpy.context.scene.cursor.location = (x, -z, y)
    check(bpy.ops.focal.landmark_cursor() == {"FINISHED"}, f"{name} is put")


def analysis():
    """What is kept of the mesh that was looked at last."""
    detections = sys.modules[MODULE + ".detection"]._detections
    return detections[next(reversed(detections))].analysis


def test(obj):
    activate(obj)
    test_put_right(obj)
    test_what_stays(obj)
    test_changed_mesh(obj)


def test_put_right(obj):
    """A landmark that was spoiled and put right stays, and the others are chosen to suit it."""
    settings, mark = bpy.context.scene.focal, obj.focal.landmarks["handTip.L"]
    check("Set or accept a landmark first" in refused(bpy.ops.focal.resolve), "nothing is fixed yet")
    before, unsure_before = errors_of(obj), unsure(obj)
    settings.resolve = False
    put(obj, mark.name, truth(obj.name)["heel.L"])
    spoiled = errors_of(obj)
    check({n for n in spoiled if spoiled[n] != before[n]} == {mark.name}, "without the setting no other moves")
    check(bpy.ops.focal.resolve() == {"FINISHED"}, "solved with a wrong place")
    wrong, kept = errors_of(obj), analysis()
    check(mark.status == "MARKED" and wrong[mark.name] == spoiled[mark.name] > 0.3, "what was set by hand stays")
    settings.resolve = True
    began = time.perf_counter()
    put(obj, mark.name, truth(obj.name)[mark.name])
    took = time.perf_counter() - began
    after = errors_of(obj)
    check(analysis() is kept, "the mesh is analysed once")
    check(mark.status == "MARKED" and after[mark.name] < 0.01, "it stays where it was put")
    check(max(abs(after[n] - wrong[n]) for n in after if n != mark.name) > 1e-4, "the correction moved others")
    check(mean(after) < mean(before) + 1e-3 and max(after.values()) < 0.06, "all are close to the truth")
    check(unsure(obj) <= unsure_before, f"{unsure_before} were uncertain, now {unsure(obj)}")
    step(f"corrected, the others within {1000 * took:.0f} ms: uncertain {unsure_before} then {unsure(obj)}, mean error "
         f"{100 * mean(before):.2f} % then {100 * mean(after):.2f} %")


def test_what_stays(obj):
    """Accepted ones and those told absent; a cleared one is found again."""
    marks = obj.focal.landmarks
    obj.focal.active = marks.find("nose")
    place = world(obj, marks["nose"])
    check(bpy.ops.focal.landmark_accept() == {"FINISHED"}, "accepted")
    obj.focal.active = marks.find("knee.L")
    bpy.ops.focal.landmark_unplace(absent=True)
    bpy.ops.focal.resolve()
    check(numpy.allclose(world(obj, marks["nose"]), place) and marks["nose"].confidence == 1, "the accepted one stays")
    check(marks["knee.L"].status == "ABSENT", "what is absent stays absent")
    bpy.ops.focal.landmark_unplace()
    bpy.ops.focal.resolve()
    check(marks["knee.L"].placed, "what was cleared is found again")
    step("accepted, told absent, cleared")


def test_changed_mesh(obj):
    """Another shape is analysed anew; rigs and parts start from the corrections too."""
    kept = analysis()
    for vertex in obj.data.vertices:
        vertex.co.x *= 1.01
    obj.data.update()
    bpy.ops.focal.resolve()
    check(analysis() is not kept, "analysed anew")
    for vertex in obj.data.vertices:
        vertex.co.x /= 1.01
    obj.data.update()
    target = sys.modules[MODULE + ".detection"].Target(bpy.context, obj)
    check(set(target.fixed) == {"handTip.L", "nose"}, "whatever starts from a detection knows the corrections")
    bpy.ops.focal.detect(keep_marked=False)
    check(all(m.status != "MARKED" for m in obj.focal.landmarks), "they can be forgotten")
    step("the mesh changed")
