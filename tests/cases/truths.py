"""What is compared: joints with true ones, clips with clips."""
import json

import numpy as np


def true_joints(path, key="position"):
    with open(path) as file:
        return {joint["name"]: np.array(joint[key]) for joint in json.load(file)["joints"]}


def places(report):
    return {joint["name"]: np.array(joint["position"]) for joint in report["joints"]}


def distances(found, true):
    """Per true joint; one that was not found is infinitely far."""
    return np.array([np.linalg.norm(found[name] - place) if name in found else np.inf for name, place in true.items()])


def all_points(scene):
    return np.vstack([points for _, _, points, _ in scene.shown(weights=False)])


def height(scene):
    return np.ptp(all_points(scene)[:, 1])


def clip_difference(one, clip_of_one, other, clip_of_other, frames=9):
    """The largest distance of a joint over the frames of a clip."""
    worst, end = 0, one.end(clip_of_one)
    for time in np.linspace(0, end, frames):
        first, second = one.pose(clip_of_one, time).places(), other.pose(clip_of_other, time).places()
        worst = max(worst, distances(second, first).max())
    return worst


def turns(scene, clip, bone, times):
    """Degrees from the local rotation at the first time."""
    node = scene.bones()[bone]
    rotations = [scene.pose(clip, time).local_rotation(node).copy() for time in times]
    return [float(np.degrees(2 * np.arccos(min(abs(rotation @ rotations[0]), 1)))) for rotation in rotations]


def share(weights, bone):
    """Mean weight of the bone; weights: by joint name."""
    return float(weights[bone].mean()) if bone in weights else 0.0
