"""The declarations of focal.h for ctypes. Made by generate_abi.py: change the header, run it again."""
from ctypes import (
        CFUNCTYPE, Structure, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p)
from ctypes import POINTER as P
from enum import IntEnum

FOCAL_VERSION_MAJOR = 0
FOCAL_VERSION_MINOR = 1
FOCAL_VERSION_PATCH = 0
FOCAL_NO_VERTEX = 0xffffffff
FOCAL_NO_TRIANGLE = 0xffffffff


class Status(IntEnum):
    """focal_status"""
    OK = 0
    INVALID_ARGUMENT = 1
    INVALID_MESH = 2
    INVALID_FILE = 3
    IO = 4
    OUT_OF_MEMORY = 5
    UNSUPPORTED = 6
    NOT_CONVERGED = 7
    CANCELLED = 8
    INTERNAL = 9
    INVALID_HANDLE = 10
    MESH_TOO_SMALL = 11
    FILE_NOT_FOUND = 12
    UNSUPPORTED_VERSION = 13
    INVALID_LANDMARK = 14
    TOO_FEW_SHAPES = 15


class Backend(IntEnum):
    """focal_backend"""
    AUTO = 0
    CPU = 1
    CUDA = 2


class LogLevel(IntEnum):
    """focal_log_level"""
    INFO = 0
    WARNING = 1
    ERROR = 2


class Surface(IntEnum):
    """focal_surface"""
    AUTO = 0
    AS_IS = 1
    WRAPPED = 2


class Scenery(IntEnum):
    """focal_scenery"""
    HIDDEN = 0
    SHEET = 1
    ENCLOSURE = 2
    APART = 3


class Descriptor(IntEnum):
    """focal_descriptor"""
    SI_HKS = 0
    HKS = 1
    WKS = 2
    SPIN_IMAGE = 3
    UNIQUE_SHAPE_CONTEXT = 4


class Distance(IntEnum):
    """focal_distance"""
    HEAT = 0
    EXACT = 1
    BIHARMONIC = 2
    COMMUTE_TIME = 3


class Preset(IntEnum):
    """focal_preset"""
    DEFAULT = 0
    PAPER = 1


class Quality(IntEnum):
    """focal_quality"""
    BEST = 0
    INTERACTIVE = 1


class Orientation(IntEnum):
    """focal_orientation"""
    UPRIGHT = 0
    ANY = 1


class LandmarkStatus(IntEnum):
    """focal_landmark_status"""
    FOUND = 0
    UNCERTAIN = 1
    ABSENT = 2


class Segmentation(IntEnum):
    """focal_segmentation"""
    AUTO = 0
    GEODESIC = 1
    K_MEANS = 2
    SKELETON = 3


class BoneNames(IntEnum):
    """focal_bone_names"""
    AS_TRAINED = 0
    VRM = 1
    MIXAMO = 2
    UNREAL = 3
    RIGIFY = 4
    UNITY = 5
    RIGIFY_METARIG = 6


class Pose(IntEnum):
    """focal_pose"""
    OF_MESH = 0
    OF_TEACHERS = 1
    T = 2
    A = 3


class Verdict(IntEnum):
    """focal_verdict"""
    GOOD = 0
    CHECK = 1
    FAILED = 2


# Handles: tags to hand back, never followed.
focal_context = type("focal_context", (Structure,), {})
focal_mesh = type("focal_mesh", (Structure,), {})
focal_training_set = type("focal_training_set", (Structure,), {})
focal_model = type("focal_model", (Structure,), {})
focal_detection = type("focal_detection", (Structure,), {})
focal_analysis = type("focal_analysis", (Structure,), {})
focal_correspondence = type("focal_correspondence", (Structure,), {})
focal_skeleton = type("focal_skeleton", (Structure,), {})
focal_task = type("focal_task", (Structure,), {})
focal_blob = type("focal_blob", (Structure,), {})

# Callbacks.
focal_log_fn = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
focal_parallel_body_fn = CFUNCTYPE(None, c_void_p, c_int64)
focal_parallel_for_fn = CFUNCTYPE(None, c_void_p, c_int64, focal_parallel_body_fn, c_void_p)


class focal_context_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("backend", c_int32),
        ("device_index", c_int32),
        ("thread_count", c_int32),
        ("log", focal_log_fn),
        ("log_user_data", c_void_p),
        ("parallel_for", focal_parallel_for_fn),
        ("parallel_for_user_data", c_void_p),
        ("memory_budget_bytes", c_uint64),
        ("models_folder", c_char_p),
    ]


class focal_surface_point(Structure):
    _fields_ = [
        ("triangle", c_uint32),
        ("barycentric", c_float * 3),
    ]


class focal_mesh_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("weld", c_int32),
        ("drop_degenerate", c_int32),
        ("surface", c_int32),
        ("allow_external_files", c_int32),
        ("keep_source_file", c_int32),
        ("max_vertices", c_uint64),
        ("max_triangles", c_uint64),
        ("max_nodes", c_uint64),
        ("max_json_bytes", c_uint64),
        ("max_file_bytes", c_uint64),
        ("pose_animation", c_char_p),
        ("pose_time", c_double),
        ("lenient", c_int32),
        ("keep_scenery", c_int32),
        ("task", P(focal_task)),
    ]


class focal_mesh_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("position_stride", c_uint32),
        ("positions", P(c_float)),
        ("vertex_count", c_uint64),
        ("indices", P(c_uint32)),
        ("index_count", c_uint64),
    ]


class focal_mesh_part(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("first_vertex", c_uint64),
        ("vertex_count", c_uint64),
        ("first_triangle", c_uint64),
        ("triangle_count", c_uint64),
    ]


class focal_mesh_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("warning_count", c_uint32),
        ("vertex_count", c_uint64),
        ("triangle_count", c_uint64),
        ("surface_vertex_count", c_uint64),
        ("surface_triangle_count", c_uint64),
        ("mean_edge_length", c_double),
        ("surface_area", c_double),
        ("load_seconds", c_double),
        ("repair_seconds", c_double),
        ("invalid_triangles", c_uint64),
        ("degenerate_triangles", c_uint64),
        ("flipped_triangles", c_uint64),
        ("nonmanifold_edges", c_uint64),
        ("nonmanifold_vertices", c_uint64),
        ("boundary_loops", c_uint64),
        ("component_count", c_uint64),
        ("is_oriented", c_int32),
        ("is_wrapped", c_int32),
        ("left_out_triangles", c_uint64),
        ("left_out_count", c_uint32),
        ("reserved", c_uint32),
    ]


class focal_left_out(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reason", c_int32),
        ("name", c_char_p),
        ("triangle_count", c_uint64),
        ("is_whole_node", c_int32),
        ("reserved", c_uint32),
    ]


class focal_symmetry_plane(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("normal", c_float * 3),
        ("offset", c_double),
        ("support", c_double),
    ]


class focal_train_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("preset", c_int32),
        ("eigenpair_count", c_int32),
        ("tree_count", c_int32),
        ("min_leaf_samples", c_int32),
        ("components_per_split", c_int32),
        ("sampling_rate", c_double),
        ("max_samples_per_shape", c_int32),
        ("proxy_vertices", c_int32),
        ("seed", c_uint64),
        ("learn_confidence", c_int32),
        ("rigged_shapes", c_int32),
        ("descriptor", c_int32),
        ("distance", c_int32),
    ]


class focal_model_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("preset", c_int32),
        ("landmark_count", c_uint32),
        ("shape_count", c_uint32),
        ("mean_vertex_count", c_uint64),
        ("sample_count", c_uint64),
        ("tree_node_count", c_uint64),
        ("file_bytes", c_uint64),
    ]


class focal_detect_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("quality", c_int32),
        ("sampling_rate", c_double),
        ("max_samples", c_int32),
        ("peaks_per_landmark", c_int32),
        ("found_confidence", c_double),
        ("absent_confidence", c_double),
        ("keep_votes", c_int32),
        ("orientation", c_int32),
        ("seed", c_uint64),
        ("fixed_points", P(focal_surface_point)),
        ("fixed_point_count", c_uint64),
    ]


class focal_landmark(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("status", c_int32),
        ("name", c_char_p),
        ("confidence", c_double),
        ("expected_error", c_double),
        ("runner_up_confidence", c_double),
        ("point", focal_surface_point),
        ("position", c_float * 3),
        ("vertex", c_uint32),
        ("runner_up_point", focal_surface_point),
        ("runner_up_position", c_float * 3),
        ("runner_up_vertex", c_uint32),
        ("has_runner_up", c_int32),
        ("reserved", c_uint32),
    ]


class focal_detection_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("landmark_count", c_uint32),
        ("warning_count", c_uint32),
        ("has_votes", c_int32),
        ("vertex_count", c_uint64),
        ("triangle_count", c_uint64),
        ("category_fit", c_double),
        ("backend", c_int32),
        ("reserved", c_uint32),
    ]


class focal_stage_seconds(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("load", c_double),
        ("repair", c_double),
        ("proxy", c_double),
        ("spectrum", c_double),
        ("descriptors", c_double),
        ("geodesics", c_double),
        ("forest", c_double),
        ("vote", c_double),
        ("constellation", c_double),
        ("refine", c_double),
        ("total", c_double),
    ]


class focal_skeleton_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("names", c_int32),
        ("joint_names", P(c_char_p)),
        ("joint_name_count", c_uint64),
        ("animations", P(focal_mesh)),
        ("rest_pose", c_int32),
        ("symmetric", c_int32),
        ("skeleton_template", c_char_p),
        ("max_influences", c_int32),
        ("drop_helpers", c_int32),
        ("fixed_joints", P(c_float)),
        ("fixed_joint_count", c_uint64),
        ("ground_root", c_int32),
        ("reserved_2", c_int32),
    ]


class focal_bind_params(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("max_influences", c_int32),
        ("joint_names", P(c_char_p)),
        ("joint_count", c_uint64),
        ("joint_parents", P(c_int32)),
        ("joint_positions", P(c_float)),
        ("joint_rotations", P(c_float)),
        ("joint_tips", P(c_float)),
        ("joint_moves", P(c_int32)),
    ]


class focal_skeleton_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("joint_count", c_uint32),
        ("warning_count", c_uint32),
        ("max_influences", c_uint32),
        ("vertex_count", c_uint64),
        ("unweighted_vertices", c_uint64),
        ("quality", c_double),
        ("verdict", c_int32),
        ("guessed_joints", c_uint32),
        ("influences_per_vertex", c_uint32),
        ("reserved", c_uint32),
    ]


class focal_joint(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("parent", c_int32),
        ("name", c_char_p),
        ("confidence", c_double),
        ("position", c_float * 3),
        ("rotation", c_float * 4),
        ("tip", c_float * 3),
    ]


# name: (result, arguments)
FUNCTIONS = {
    "focal_version": (c_uint32, []),
    "focal_version_string": (c_char_p, []),
    "focal_status_name": (c_char_p, [c_int32]),
    "focal_last_error": (c_char_p, []),
    "focal_peak_memory_bytes": (c_uint64, []),
    "focal_context_params_init": (c_int32, [P(focal_context_params), c_size_t]),
    "focal_context_create": (c_int32, [P(focal_context_params), P(P(focal_context))]),
    "focal_context_destroy": (c_int32, [P(focal_context)]),
    "focal_context_backend": (c_int32, [P(focal_context)]),
    "focal_context_backend_reason": (c_char_p, [P(focal_context)]),
    "focal_context_thread_count": (c_int32, [P(focal_context)]),
    "focal_context_memory_held": (c_uint64, [P(focal_context)]),
    "focal_task_create": (c_int32, [P(P(focal_task))]),
    "focal_task_destroy": (c_int32, [P(focal_task)]),
    "focal_task_cancel": (c_int32, [P(focal_task)]),
    "focal_task_reset": (c_int32, [P(focal_task)]),
    "focal_task_progress": (c_double, [P(focal_task)]),
    "focal_task_stage": (c_char_p, [P(focal_task)]),
    "focal_task_is_cancelled": (c_int32, [P(focal_task)]),
    "focal_blob_data": (c_void_p, [P(focal_blob)]),
    "focal_blob_size": (c_uint64, [P(focal_blob)]),
    "focal_blob_destroy": (c_int32, [P(focal_blob)]),
    "focal_mesh_params_init": (c_int32, [P(focal_mesh_params), c_size_t]),
    "focal_mesh_desc_init": (c_int32, [P(focal_mesh_desc), c_size_t]),
    "focal_mesh_create": (c_int32, [P(focal_context), P(focal_mesh_desc), P(focal_mesh_params), P(P(focal_mesh))]),
    "focal_mesh_load_gltf": (c_int32, [P(focal_context), c_char_p, P(focal_mesh_params), P(P(focal_mesh))]),
    "focal_mesh_load_gltf_memory": (c_int32, [
        P(focal_context), c_void_p, c_uint64, P(focal_mesh_params), P(P(focal_mesh))]),
    "focal_mesh_destroy": (c_int32, [P(focal_mesh)]),
    "focal_mesh_create_parts": (c_int32, [
        P(focal_context), P(P(focal_mesh_desc)), c_uint64, P(focal_mesh_params), P(P(focal_mesh))]),
    "focal_mesh_part_init": (c_int32, [P(focal_mesh_part), c_size_t]),
    "focal_mesh_part_count": (c_uint32, [P(focal_mesh)]),
    "focal_mesh_get_part": (c_int32, [P(focal_mesh), c_uint32, P(focal_mesh_part)]),
    "focal_mesh_info_init": (c_int32, [P(focal_mesh_info), c_size_t]),
    "focal_mesh_get_info": (c_int32, [P(focal_mesh), P(focal_mesh_info)]),
    "focal_mesh_positions": (P(c_float), [P(focal_mesh)]),
    "focal_mesh_triangles": (P(c_uint32), [P(focal_mesh)]),
    "focal_mesh_warning": (c_char_p, [P(focal_mesh), c_uint32]),
    "focal_left_out_init": (c_int32, [P(focal_left_out), c_size_t]),
    "focal_mesh_get_left_out": (c_int32, [P(focal_mesh), c_uint32, P(focal_left_out)]),
    "focal_mesh_write_wrap_gltf": (c_int32, [P(focal_mesh), c_char_p]),
    "focal_mesh_position_of": (c_int32, [P(focal_mesh), P(focal_surface_point), P(c_float)]),
    "focal_mesh_point_at_vertex": (c_int32, [P(focal_mesh), c_uint32, P(focal_surface_point)]),
    "focal_mesh_closest_point": (c_int32, [P(focal_mesh), P(c_float), P(focal_surface_point)]),
    "focal_descriptor_count": (c_uint32, []),
    "focal_descriptor_name": (c_char_p, [c_int32]),
    "focal_descriptor_dimension": (c_uint32, [c_int32]),
    "focal_distance_count": (c_uint32, []),
    "focal_distance_name": (c_char_p, [c_int32]),
    "focal_mesh_describe": (c_int32, [
        P(focal_context), P(focal_mesh), c_int32, P(c_uint32), c_uint64, P(focal_task), P(c_float)]),
    "focal_mesh_distances": (c_int32, [
        P(focal_context), P(focal_mesh), c_int32, P(focal_surface_point), P(focal_task), c_uint64, P(c_float)]),
    "focal_symmetry_plane_init": (c_int32, [P(focal_symmetry_plane), c_size_t]),
    "focal_mesh_symmetry_plane": (c_int32, [
        P(focal_context), P(focal_mesh), c_uint64, P(focal_task), P(focal_symmetry_plane)]),
    "focal_training_set_create": (c_int32, [P(focal_context), P(c_char_p), c_uint64, P(P(focal_training_set))]),
    "focal_training_set_destroy": (c_int32, [P(focal_training_set)]),
    "focal_training_set_add": (c_int32, [P(focal_training_set), P(focal_mesh), P(focal_surface_point), c_uint64]),
    "focal_training_set_add_vertices": (c_int32, [P(focal_training_set), P(focal_mesh), P(c_uint32), c_uint64]),
    "focal_training_set_add_rig": (c_int32, [P(focal_training_set), P(focal_mesh)]),
    "focal_training_set_set_skeleton": (c_int32, [P(focal_training_set), c_char_p]),
    "focal_training_set_check": (c_int32, [P(focal_training_set)]),
    "focal_training_set_warning_count": (c_uint32, [P(focal_training_set)]),
    "focal_training_set_warning": (c_char_p, [P(focal_training_set), c_uint32]),
    "focal_training_set_landmark_count": (c_uint64, [P(focal_training_set)]),
    "focal_training_set_mesh_count": (c_uint64, [P(focal_training_set)]),
    "focal_train_params_init": (c_int32, [P(focal_train_params), c_size_t]),
    "focal_train_params_set_preset": (c_int32, [P(focal_train_params), c_int32]),
    "focal_model_train": (c_int32, [P(focal_training_set), P(focal_train_params), P(focal_task), P(P(focal_model))]),
    "focal_model_load": (c_int32, [P(focal_context), c_char_p, P(P(focal_model))]),
    "focal_model_load_memory": (c_int32, [P(focal_context), c_void_p, c_uint64, P(P(focal_model))]),
    "focal_model_save": (c_int32, [P(focal_model), c_char_p]),
    "focal_model_save_memory": (c_int32, [P(focal_model), P(P(focal_blob))]),
    "focal_model_destroy": (c_int32, [P(focal_model)]),
    "focal_context_stock_count": (c_uint32, [P(focal_context)]),
    "focal_context_stock_name": (c_char_p, [P(focal_context), c_uint32]),
    "focal_context_stock_path": (c_char_p, [P(focal_context), c_uint32]),
    "focal_model_load_stock": (c_int32, [P(focal_context), c_char_p, P(P(focal_model))]),
    "focal_model_info_init": (c_int32, [P(focal_model_info), c_size_t]),
    "focal_model_get_info": (c_int32, [P(focal_model), P(focal_model_info)]),
    "focal_model_get_train_params": (c_int32, [P(focal_model), P(focal_train_params)]),
    "focal_model_landmark_name": (c_char_p, [P(focal_model), c_uint32]),
    "focal_detect_params_init": (c_int32, [P(focal_detect_params), c_size_t]),
    "focal_model_detect": (c_int32, [
        P(focal_model), P(focal_mesh), P(focal_detect_params), P(focal_task), P(P(focal_detection))]),
    "focal_detection_destroy": (c_int32, [P(focal_detection)]),
    "focal_model_detect_many": (c_int32, [
        P(focal_model), P(P(focal_mesh)), c_uint64, P(focal_detect_params), P(focal_task), P(P(focal_detection))]),
    "focal_model_analyse": (c_int32, [
        P(focal_model), P(focal_mesh), P(focal_detect_params), P(focal_task), P(P(focal_analysis))]),
    "focal_analysis_destroy": (c_int32, [P(focal_analysis)]),
    "focal_model_detect_analysis": (c_int32, [
        P(focal_model), P(focal_analysis), P(focal_detect_params), P(focal_task), P(P(focal_detection))]),
    "focal_analysis_save": (c_int32, [P(focal_analysis), c_char_p]),
    "focal_analysis_load": (c_int32, [P(focal_context), P(focal_mesh), c_char_p, P(P(focal_analysis))]),
    "focal_analysis_sample_count": (c_uint64, [P(focal_analysis)]),
    "focal_model_regress": (c_int32, [
        P(focal_model), P(focal_analysis), c_uint32, P(focal_surface_point), P(focal_task), c_uint64, P(c_float),
        P(c_float)]),
    "focal_landmark_init": (c_int32, [P(focal_landmark), c_size_t]),
    "focal_detection_landmark_count": (c_uint32, [P(focal_detection)]),
    "focal_detection_get_landmark": (c_int32, [P(focal_detection), c_uint32, P(focal_landmark)]),
    "focal_detection_info_init": (c_int32, [P(focal_detection_info), c_size_t]),
    "focal_detection_get_info": (c_int32, [P(focal_detection), P(focal_detection_info)]),
    "focal_stage_seconds_init": (c_int32, [P(focal_stage_seconds), c_size_t]),
    "focal_detection_get_seconds": (c_int32, [P(focal_detection), P(focal_stage_seconds)]),
    "focal_detection_warning": (c_char_p, [P(focal_detection), c_uint32]),
    "focal_detection_votes": (c_int32, [P(focal_detection), c_uint32, c_uint64, P(c_float)]),
    "focal_detection_distances": (c_int32, [P(focal_detection), c_uint32, c_uint64, P(c_float)]),
    "focal_detection_region": (c_int32, [P(focal_detection), c_uint32, c_double, c_uint64, P(c_float)]),
    "focal_detection_write_gltf": (c_int32, [P(focal_detection), c_char_p]),
    "focal_detection_write_votes_gltf": (c_int32, [P(focal_detection), c_char_p]),
    "focal_correspondence_create": (c_int32, [
        P(focal_detection), P(focal_detection), P(focal_task), P(P(focal_correspondence))]),
    "focal_correspondence_destroy": (c_int32, [P(focal_correspondence)]),
    "focal_correspondence_points": (c_int32, [P(focal_correspondence), c_uint64, P(focal_surface_point)]),
    "focal_correspondence_carry": (c_int32, [P(focal_correspondence), c_uint64, P(c_float), c_uint64, P(c_float)]),
    "focal_detection_segment": (c_int32, [P(focal_detection), c_int32, P(focal_task), c_uint64, P(c_int32)]),
    "focal_detection_write_segments_gltf": (c_int32, [P(focal_detection), c_int32, c_char_p]),
    "focal_skeleton_params_init": (c_int32, [P(focal_skeleton_params), c_size_t]),
    "focal_model_joint_count": (c_uint32, [P(focal_model)]),
    "focal_model_joint_name": (c_char_p, [P(focal_model), c_uint32]),
    "focal_model_skeleton_template": (c_char_p, [P(focal_model)]),
    "focal_skeleton_create": (c_int32, [
        P(focal_detection), P(focal_skeleton_params), P(focal_task), P(P(focal_skeleton))]),
    "focal_skeleton_destroy": (c_int32, [P(focal_skeleton)]),
    "focal_bind_params_init": (c_int32, [P(focal_bind_params), c_size_t]),
    "focal_skeleton_bind": (c_int32, [
        P(focal_context), P(focal_mesh), P(focal_bind_params), P(focal_task), P(P(focal_skeleton))]),
    "focal_skeleton_info_init": (c_int32, [P(focal_skeleton_info), c_size_t]),
    "focal_skeleton_get_info": (c_int32, [P(focal_skeleton), P(focal_skeleton_info)]),
    "focal_joint_init": (c_int32, [P(focal_joint), c_size_t]),
    "focal_skeleton_get_joint": (c_int32, [P(focal_skeleton), c_uint32, P(focal_joint)]),
    "focal_skeleton_weights": (c_int32, [P(focal_skeleton), c_uint64, P(c_uint32), P(c_float)]),
    "focal_skeleton_warning": (c_char_p, [P(focal_skeleton), c_uint32]),
    "focal_skeleton_write_gltf": (c_int32, [P(focal_skeleton), c_char_p]),
    "focal_skeleton_write_vrm": (c_int32, [P(focal_skeleton), c_char_p, c_char_p]),
}
