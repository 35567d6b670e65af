"""focal: rigs characters, and finds landmarks on meshes after training on about ten marked ones.

    import focal
    model = focal.Model.load("animal.focal")
    for landmark in model.detect(focal.Mesh.load("cat.glb")):
        print(landmark.name, landmark.position, landmark.confidence)

The package calls focal's shared library through ctypes and needs nothing else; with NumPy, blocks of numbers
come as arrays. Positions and lengths are in the units of your mesh; vertex and triangle numbers are those of your mesh,
from 0. All objects but TrainingSet may be used by any number of threads at once; calls let other Python threads run.
"""
from ._abi import Backend, BoneNames, Descriptor, Distance, LandmarkStatus, LogLevel, Orientation, Pose, Preset, Quality, Scenery, Segmentation, Status, Surface, Verdict
from ._context import Context, stock_models
from ._correspondence import Correspondence
from ._detection import Detection, Landmark, Place
from ._errors import Cancelled, Error, LibraryError
from ._library import VERSION, descriptors, distances, load_library, peak_memory_bytes, version
from ._landmark_files import read_landmarks, write_landmarks
from ._marked_set import Evaluation, MarkedSet, MarkError
from ._mesh import NO_TRIANGLE, LeftOut, Mesh, Part, SymmetryPlane
from ._model import Analysis, Model
from ._skeleton import Joint, Skeleton
from ._task import Task
from ._training_set import TrainingSet
from ._values import SurfacePoint

__version__ = ".".join(map(str, VERSION))

__all__ = [
    "Analysis", "Backend", "BoneNames", "Cancelled", "Context", "Correspondence", "Descriptor", "Detection", "Distance",
    "Error", "Evaluation", "Joint", "Landmark", "LandmarkStatus", "LeftOut", "LibraryError", "LogLevel", "MarkError", "MarkedSet", "Mesh", "Model", "NO_TRIANGLE", "Orientation", "Part", "Place", "Pose",
    "Preset", "Quality", "Scenery", "Segmentation", "Skeleton", "Status", "Surface", "SurfacePoint", "SymmetryPlane", "Task", "TrainingSet",
    "Verdict", "descriptors", "distances", "load_library", "peak_memory_bytes", "read_landmarks", "stock_models", "version", "write_landmarks",
]

for _name in __all__:  # shown, and pickled, by the name that users know
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "focal"
del _name
