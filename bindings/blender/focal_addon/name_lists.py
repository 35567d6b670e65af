"""Lists of landmark names to choose from, so that meshes of several people are marked alike. Knows nothing of Blender.

The bodies' names are those of the sample characters and of the skeleton templates; the face has the 68 points of the iBUG 300-W
annotation scheme, from the subject's right to the left.
"""


def _pairs(text):
    """Words of which those that end in * stand for a left and a right one."""
    return [name for word in text.split() for name in ([word[:-1] + ".L", word[:-1] + ".R"] if word.endswith("*") else [word])]


def _face():
    def row(name, numbers, side):
        return [f"{name}_{number}.{side}" for number in numbers]

    def eye(side, order):
        return [f"eye_{place}.{side}" for place in order.split()]

    lips = ("mouth_corner.R lip_top_side.R lip_top_peak.R lip_top_mid lip_top_peak.L lip_top_side.L mouth_corner.L "
            "lip_bottom_side.L lip_bottom_near.L lip_bottom_mid lip_bottom_near.R lip_bottom_side.R "
            "mouth_inner_corner.R lip_top_inner.R lip_top_inner_mid lip_top_inner.L mouth_inner_corner.L "
            "lip_bottom_inner.L lip_bottom_inner_mid lip_bottom_inner.R").split()
    return (row("jaw", range(1, 9), "R") + ["chin"] + row("jaw", range(8, 0, -1), "L")
            + row("brow", range(1, 6), "R") + row("brow", range(5, 0, -1), "L")
            + ["nose_bridge_1", "nose_bridge_2", "nose_bridge_3", "nose_tip", "nostril_outer.R", "nostril_inner.R",
               "nose_base", "nostril_inner.L", "nostril_outer.L"]
            + eye("R", "outer top_outer top_inner inner bottom_inner bottom_outer")
            + eye("L", "inner top_inner top_outer outer bottom_outer bottom_inner") + lips)


LISTS = {
    "HUMANOID": _pairs("crown nose chin chest navel upperBack lowerBack crotch shoulder* elbow* handTip* thumbTip* hip* knee* heel* "
                       "toeTip*"),
    "QUADRUPED": _pairs("nose crown withers croup chest belly tailTip earTip* shoulder* elbow* frontToe* knee* hock* hindToe*"),
    "HAND": _pairs("thumbTip thumbKnuckle indexTip indexKnuckle middleTip middleKnuckle ringTip ringKnuckle littleTip "
                   "littleKnuckle palm backOfHand wristFront wristBack wristThumbSide wristLittleSide"),
    "FACE_68": _face(),
}
