"""The add-on without a window: from the zip to a rigged character that comes back from a glTF file."""
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import corrections  # noqa: E402
import detecting  # noqa: E402
import installation  # noqa: E402
import learning  # noqa: E402
import marks  # noqa: E402
import rigging  # noqa: E402
import skeletons  # noqa: E402
from common import OTHERS, OUT  # noqa: E402


def offer_stock_model():
    """Looked up once: the file is there before, what it holds comes later."""
    os.makedirs(os.path.join(OUT, "models"))
    with open(os.path.join(OUT, "models", "mine.focal"), "w", encoding="ascii") as file:
        file.write("not yet")
    os.environ["FOCAL_MODELS"] = os.path.join(OUT, "models")


def main():
    offer_stock_model()
    installation.test_library_missing()
    marks.test_marks()
    marks.test_list()
    marks.test_name_lists()
    marks.test_million()
    learning.test_training()
    learning.test_unsaved()
    learning.test_measure()
    detecting.test_refusals()
    detecting.test_detection()
    detecting.test_extras()
    corrections.test(bpy.data.objects[OTHERS[0]])
    detecting.test_votes_and_parts()
    skeletons.test(bpy.data.objects[OTHERS[0]])
    rigging.test_rig()
    rigging.test_collection()
    learning.test_parts()
    learning.test_rigs()
    rigging.test_character()
    installation.test_undo_and_file()
    installation.test_off_and_on()
    print("all passed")


main()
