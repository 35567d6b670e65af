"""What the paper prints, and which landmarks of each known set stand for its points and bones."""


def both(*names):
    return [f"{name}.{side}" for name in names for side in "LR"]


def chains(text):
    """Bones from chains such as "nose-withers-belly"; a * stands for the left side, then for the right."""
    sided = [chain.replace("*", side) for chain in text.split() for side in "LR"[:1 + ("*" in chain)]]
    return [bone for names in (chain.split("-") for chain in sided) for bone in zip(names, names[1:])]


# The three kinds of point of Table 2: tips of the shape, what lies between, and flat places. Of another set every landmark lies between.
FINGERS = ["thumb", "index", "middle", "ring", "little"]
HUMAN = ["head_top", *both("middle_finger", "toe")], both("elbow_outer", "knee_front", "shoulder"), ["navel", "lower_back"]
KINDS = {
    "scape": HUMAN,
    "human07": HUMAN,
    "lion": ([*both("front_paw_outer", "back_paw_outer"), "tail_tip", "nose_top"], ["tail_base_top"], ["belly"]),
    "teddy": (both("arm_tip", "leg_tip"), both("ear_tip"), ["belly", "back"]),
    "ant": ([*both("leg1_tip", "leg2_tip", "leg3_tip", "leg4_tip"), "head", "tail"], [], ["neck_top", "body_top", *both("leg4_base")]),
    "hand": ([f"{name}_tip" for name in FINGERS], [f"{name}_base" for name in FINGERS] +
             ["valley_index_thumb", "valley_middle_index", "valley_ring_middle", "valley_little_ring"], []),
    "humanoid": (["crown", *both("handTip", "toeTip")], both("elbow", "knee", "shoulder"), ["navel", "chest"]),
    "quadruped": ([*both("frontToe", "hindToe"), "tailTip", "nose"], both("elbow"), ["belly", "withers"]),
    "sample hand": ([f"{name}Tip" for name in FINGERS], [f"{name}Knuckle" for name in FINGERS], ["palm", "backOfHand"]),
    "insect": ([*both("frontTip", "middleTip", "hindTip"), "abdomenTip"], both("frontKnee", "hindKnee"), ["thorax", "sternum"]),
}

# Table 1: descriptors, geodesics (both of one shape) and forests of training; descriptors, geodesics, forest and voting of detection.
SECONDS = {"scape": (9.56, 8.31, 66.12, 3.82, 3.09, 0.03, 1.33), "lion": (3.70, 0.85, 13.45, 1.51, 0.34, 0.03, 0.48),
           "teddy": (9.49, 10.63, 68.10, 3.81, 4.34, 0.03, 1.19), "ant": (6.42, 3.32, 26.63, 2.52, 1.27, 0.02, 0.74),
           "hand": (6.71, 3.69, 21.59, 2.64, 1.49, 0.02, 0.86)}
# Table 2: errors of tips, points between, flat places, and all points.
ERRORS = {"scape": (2.46, 2.57, 2.14, 2.46), "lion": (2.85, 3.09, 4.16, 3.04), "teddy": (3.79, 4.67, 4.21, 4.12),
          "ant": (4.01, float("nan"), 4.92, 4.27), "hand": (3.24, 4.82, float("nan"), 3.87)}

# Fig. 13: a coarse skeleton over the points of each set.
HUMAN_BONES = chains("head_top-navel navel-shoulder.*-elbow_outer.*-middle_finger.* navel-knee_front.*-toe.*")
BONES = {
    "scape": HUMAN_BONES,
    "human07": HUMAN_BONES,
    "humanoid": chains("crown-chest-navel chest-shoulder.*-elbow.*-handTip.* navel-knee.*-toeTip.*"),
    "quadruped": chains("nose-withers-belly-tailTip withers-elbow.*-frontToe.* belly-hindToe.*"),
    "lion": chains("nose_top-belly-tail_base_top-tail_tip belly-front_paw_outer.* tail_base_top-back_paw_outer.*"),
    "teddy": chains("belly-arm_tip.* belly-leg_tip.* belly-ear_tip.*"),
}
