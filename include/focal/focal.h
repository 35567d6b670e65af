/* focal.h - mark a few points on about ten meshes, train a model on them, find the points on new meshes.
 *
 * Rules that hold for every function below
 *
 *   Errors     Functions that can fail return focal_status. The out_ argument comes last and is written only
 *              on FOCAL_OK. After a failure focal_last_error() returns a message that names the object and
 *              ends with a hint; it is per thread. Getters that return a value or a pointer return 0 or NULL
 *              for a bad handle or index, and set focal_last_error() too.
 *   Ownership  focal_X_create/load/train/detect return one handle; focal_X_destroy releases it (NULL is
 *              allowed). Handles may be destroyed in any order: a result keeps alive what it needs. A stale,
 *              foreign or twice destroyed handle yields FOCAL_ERROR_INVALID_HANDLE, never a crash.
 *              A handle is an opaque tag, not an address. No *_destroy changes focal_last_error().
 *   Lifetime   Returned pointers are borrowed from the handle and valid until it is destroyed. Arguments are
 *              copied before the call returns.
 *   Threads    Handles are immutable once created, so any number of threads may use one at the same time.
 *              Exceptions: focal_training_set [builder: one thread at a time] and focal_task [any thread,
 *              at any time]. No thread of focal is running between calls.
 *   Strings    UTF-8, NUL-terminated, paths included, on every platform.
 *   Versions   Structs begin with struct_size. Parameters: initialise them with *_init(&params,
 *              sizeof params), then change fields; NULL means the defaults. A struct with non-zero fields
 *              that this library does not know fails with FOCAL_ERROR_UNSUPPORTED. Results: call *_init the
 *              same way; the getter then fills the fields that fit. Reserved fields stay 0.
 *   Units      Positions, lengths and areas are in the units of the caller's mesh. Vertex and triangle
 *              numbers are those of the caller's mesh, 0-based. Flags are int32_t, 0 or 1. Probabilities
 *              are in 0..1.
 *   Never      The library never installs signal handlers, prints, exits, throws exceptions across this
 *              interface or uses the locale. It saves and restores the caller's floating-point environment.
 *              It writes files completely or not at all.
 */
#ifndef FOCAL_H
#define FOCAL_H

#include <stddef.h>
#include <stdint.h>

/* Define FOCAL_STATIC if the library is linked statically. */
#ifndef FOCAL_API
#if defined(FOCAL_STATIC)
#define FOCAL_API
#elif defined(_WIN32) && defined(FOCAL_BUILD)
#define FOCAL_API __declspec(dllexport)
#elif defined(_WIN32)
#define FOCAL_API __declspec(dllimport)
#elif defined(__GNUC__)
#define FOCAL_API __attribute__((visibility("default")))
#else
#define FOCAL_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version, status, errors ---- */

#define FOCAL_VERSION_MAJOR 0
#define FOCAL_VERSION_MINOR 1
#define FOCAL_VERSION_PATCH 0

/* The library's version at run time: major << 16 | minor << 8 | patch, and as text ("0.1.0"). */
FOCAL_API uint32_t focal_version(void);
FOCAL_API const char* focal_version_string(void);

typedef int32_t focal_status;
/* Values are never reused. */
enum {
  FOCAL_OK = 0,
  FOCAL_ERROR_INVALID_ARGUMENT = 1, /* NULL, out of range, wrong struct_size */
  FOCAL_ERROR_INVALID_MESH = 2,     /* no triangles, index out of range, NaN or infinite position */
  FOCAL_ERROR_INVALID_FILE = 3,     /* corrupt, truncated or not of the expected format */
  FOCAL_ERROR_IO = 4,               /* reading or writing failed */
  FOCAL_ERROR_OUT_OF_MEMORY = 5,
  FOCAL_ERROR_UNSUPPORTED = 6,     /* valid, but not supported by this library */
  FOCAL_ERROR_NOT_CONVERGED = 7,   /* a numerical method did not converge on this mesh */
  FOCAL_ERROR_CANCELLED = 8,       /* focal_task_cancel was called */
  FOCAL_ERROR_INTERNAL = 9,        /* a bug in focal: please report it */
  FOCAL_ERROR_INVALID_HANDLE = 10, /* NULL, stale, foreign, of another type, or destroyed twice */
  FOCAL_ERROR_MESH_TOO_SMALL = 11, /* too few vertices to analyse */
  FOCAL_ERROR_FILE_NOT_FOUND = 12,
  FOCAL_ERROR_UNSUPPORTED_VERSION = 13, /* a file of another format version */
  FOCAL_ERROR_INVALID_LANDMARK = 14,    /* a landmark on a vertex or triangle that does not exist */
  FOCAL_ERROR_TOO_FEW_SHAPES = 15       /* a landmark marked on fewer than two training meshes */
};

/* "FOCAL_OK", "FOCAL_ERROR_IO", ...; "FOCAL_ERROR_UNKNOWN" for other numbers. Never NULL. */
FOCAL_API const char* focal_status_name(focal_status status);

/* The last failure of this thread: "message\nhint: ...", or "" when there was none. Never NULL; valid until
 * the next failing call of the same thread. Successful calls do not change it. */
FOCAL_API const char* focal_last_error(void);

/* The peak resident memory of this process so far, in bytes; 0 where the system does not report it. */
FOCAL_API uint64_t focal_peak_memory_bytes(void);

/* ---- Handles ---- */

typedef struct focal_context focal_context;               /* how calls run: backend, threads, log */
typedef struct focal_mesh focal_mesh;                     /* a surface, ready to be analysed */
typedef struct focal_training_set focal_training_set;     /* marked meshes [builder] */
typedef struct focal_model focal_model;                   /* the result of training */
typedef struct focal_detection focal_detection;           /* landmarks found on one mesh */
typedef struct focal_analysis focal_analysis;             /* the part of a detection that models can share */
typedef struct focal_correspondence focal_correspondence; /* a map between two detected meshes */
typedef struct focal_skeleton focal_skeleton;             /* joints and skin weights for one mesh */
typedef struct focal_task focal_task;                     /* progress and cancellation [any thread] */
typedef struct focal_blob focal_blob;                     /* a block of bytes */

/* ---- Context ---- */

typedef int32_t focal_backend;
enum { FOCAL_BACKEND_AUTO = 0, FOCAL_BACKEND_CPU = 1, FOCAL_BACKEND_CUDA = 2 };

typedef int32_t focal_log_level;
enum { FOCAL_LOG_INFO = 0, FOCAL_LOG_WARNING = 1, FOCAL_LOG_ERROR = 2 };

/* Called from inside a focal call, on the calling thread. message is one line, valid during the call. */
typedef void (*focal_log_fn)(void* user_data, focal_log_level level, const char* message);

/* A parallel loop that the host provides, used instead of focal's threads. It must call body(body_data, i)
 * once for every i in [0, count), in any order and on any threads, and return when all calls have returned.
 * body never throws; focal may call the loop again from inside it. Results do not depend on the order or the
 * threads, bit for bit. */
typedef void (*focal_parallel_body_fn)(void* body_data, int64_t index);
typedef void (*focal_parallel_for_fn)(void* user_data, int64_t count, focal_parallel_body_fn body,
                                      void* body_data);

typedef struct focal_context_params {
  uint32_t struct_size;
  /* Default FOCAL_BACKEND_AUTO: the fastest backend that works. Where CUDA is requested and does not work, the
     CPU is used, and focal_context_backend_reason says why. */
  focal_backend backend;
  int32_t device_index; /* GPU number, from 0 */
  int32_t thread_count; /* 0: one per core; at most 1024 */
  focal_log_fn log;     /* may be NULL */
  void* log_user_data;
  focal_parallel_for_fn parallel_for; /* may be NULL: focal starts and joins threads inside each call */
  void* parallel_for_user_data;
  /* Calls on this context, and on handles created with it, fail with OUT_OF_MEMORY rather than let the library
     hold more than this in the process, for all contexts together. 0: no budget. Not counted: thread stacks,
     GPU memory, and the library's own code (a few MB). docs/performance.md lists the memory per detection. */
  uint64_t memory_budget_bytes;
  const char* models_folder; /* a folder of stock models, see focal_context_stock_count; NULL: none */
} focal_context_params;

FOCAL_API focal_status focal_context_params_init(focal_context_params* params, size_t struct_size);

/* Creates a context; params may be NULL. Errors: INVALID_ARGUMENT, UNSUPPORTED. */
FOCAL_API focal_status focal_context_create(const focal_context_params* params, focal_context** out_context);
FOCAL_API focal_status focal_context_destroy(focal_context* context);

/* The backend in use (never AUTO), one sentence on why it was chosen, and the maximum number of threads per
 * call. */
FOCAL_API focal_backend focal_context_backend(const focal_context* context);
FOCAL_API const char* focal_context_backend_reason(const focal_context* context);
FOCAL_API int32_t focal_context_thread_count(const focal_context* context);
/* Bytes that the library now holds in the process, for all contexts together: meshes, models, analyses, and
 * the working memory of calls in other threads. */
FOCAL_API uint64_t focal_context_memory_held(const focal_context* context);

/* ---- Task [any thread] ---- */

/* Reports progress of a long call and cancels it. Pass one task to one call; poll or cancel it from any
 * thread. Passing it to a second call while the first runs is INVALID_ARGUMENT. A cancelled task stays
 * cancelled, so a cancellation just before the call starts is not lost; focal_task_reset clears it. A task may
 * be destroyed while the call runs. */
FOCAL_API focal_status focal_task_create(focal_task** out_task);
FOCAL_API focal_status focal_task_destroy(focal_task* task);

/* The call that uses the task returns FOCAL_ERROR_CANCELLED within about 100 ms. */
FOCAL_API focal_status focal_task_cancel(focal_task* task);

/* Resets the task to progress 0, not cancelled. INVALID_ARGUMENT while a call uses it. */
FOCAL_API focal_status focal_task_reset(focal_task* task);

/* Progress in 0..1; never decreases; 1 after a successful call. */
FOCAL_API double focal_task_progress(const focal_task* task);
/* Name of the current stage ("spectrum", ...), "" before the first; valid for ever. */
FOCAL_API const char* focal_task_stage(const focal_task* task);
/* 1 after focal_task_cancel, else 0. */
FOCAL_API int32_t focal_task_is_cancelled(const focal_task* task);

/* ---- Blob ---- */

/* The bytes, 16-byte aligned, valid until the blob is destroyed. */
FOCAL_API const void* focal_blob_data(const focal_blob* blob);
/* Size in bytes. */
FOCAL_API uint64_t focal_blob_size(const focal_blob* blob);
FOCAL_API focal_status focal_blob_destroy(focal_blob* blob);

/* ---- Mesh ---- */

#define FOCAL_NO_VERTEX UINT32_C(0xFFFFFFFF)
#define FOCAL_NO_TRIANGLE UINT32_C(0xFFFFFFFF)

/* A point of the surface: a triangle and the weights (>= 0, sum 1) of its three corners. */
typedef struct focal_surface_point {
  uint32_t triangle; /* FOCAL_NO_TRIANGLE: no point */
  float barycentric[3];
} focal_surface_point;

/* Which surface is analysed. Landmarks, joints and weights always refer to the caller's own mesh. */
typedef int32_t focal_surface;
enum {
  /* WRAPPED for several parts, or many edges shared by more than two triangles; else AS_IS. */
  FOCAL_SURFACE_AUTO = 0,
  /* The mesh's own triangles; separate parts are linked at their nearest vertices. */
  FOCAL_SURFACE_AS_IS = 1,
  /* One closed surface around everything that is visible from outside; preset default only. */
  FOCAL_SURFACE_WRAPPED = 2
};

typedef struct focal_mesh_params {
  uint32_t struct_size;
  /* 1: merge vertices at equal positions (UV and normal splits), and open borders within 2e-4 of the mesh's
     size of each other. Default 1. */
  int32_t weld;
  int32_t drop_degenerate; /* drop triangles with a repeated corner, and duplicate triangles. Default 1 */
  focal_surface surface;   /* default FOCAL_SURFACE_AUTO */
  /* 1: also read .bin files beside a .gltf, inside its folder only. Default 0. Fields from here to pose_time
     apply to glTF files only. */
  int32_t allow_external_files;
  int32_t keep_source_file; /* 1: keep the file's bytes, so that results can be written into it. Default 1 */
  uint64_t max_vertices;    /* 1 or more. Default 5,000,000 */
  uint64_t max_triangles;   /* 1 or more. Default 10,000,000 */
  uint64_t max_nodes;       /* 1 or more. Default 1,000,000 */
  uint64_t max_json_bytes;  /* 1 or more. Default 64 MiB */
  uint64_t max_file_bytes;  /* 1 or more, also for each external file. Default 2 GiB */
  /* Name of an animation of the file: skinned meshes are loaded in its pose at pose_time instead of the bind
     pose. Such a mesh keeps no file: results are written as a plain .glb. NULL: none. */
  const char* pose_animation;
  /* Seconds, 0 or more; a time past the end means the end. */
  double pose_time;
  /* 1: triangles with a NaN or infinite corner, or an index out of range, are skipped with a warning instead
     of rejecting the mesh (INVALID_MESH); for files too. Numbering does not change: focal_mesh_triangles
     returns 0 0 0 for such a triangle, focal_mesh_positions 0 0 0 for a vertex without a finite position.
     Default 0. */
  int32_t lenient;
  /* 1: analyse the whole mesh. Default 0: leave out what focal_mesh_get_left_out lists, with a warning each:
     nodes of a file that KHR_node_visibility hides, and separate parts that are clearly not the character. A
     mesh of a single part, and parts that have a skin or are children of a joint, are always kept. Formerly
     reserved. */
  int32_t keep_scenery;
  struct focal_task* task; /* cancels loading a large mesh; NULL: none */
} focal_mesh_params;

FOCAL_API focal_status focal_mesh_params_init(focal_mesh_params* params, size_t struct_size);

/* A mesh in the caller's memory: triangles counter-clockwise seen from outside. */
typedef struct focal_mesh_desc {
  uint32_t struct_size;
  /* Bytes from one vertex to the next: a multiple of 4, at least 12; 0 means 12. */
  uint32_t position_stride;
  const float* positions; /* x, y, z of each vertex */
  uint64_t vertex_count;
  const uint32_t* indices; /* three per triangle */
  uint64_t index_count;    /* a multiple of 3 */
} focal_mesh_desc;

FOCAL_API focal_status focal_mesh_desc_init(focal_mesh_desc* desc, size_t struct_size);

/* Creates a mesh from arrays, a glTF file (.gltf or .glb) or a glTF file in memory, and prepares its surface
 * for the analysis (weld, clean, scale); about 0.1 s for 100,000 triangles. Triangles oriented against their
 * neighbours, and closed parts that are inside out, are flipped for the analysis; surface points always refer
 * to the corners in the caller's order. Edges of more than two triangles are allowed.
 * A glTF scene becomes one mesh: all triangle primitives in node order, node transforms applied, skins in
 * bind pose; vertices and triangles are numbered consecutively in that order. From memory, external files are
 * refused. Hidden nodes are not part of the mesh. Other scenery is, but its triangles are not analysed: no
 * landmark is placed there, and its vertices get no weights.
 * params may be NULL. Errors: INVALID_MESH, MESH_TOO_SMALL; from files also FILE_NOT_FOUND, IO, INVALID_FILE,
 * UNSUPPORTED. */
FOCAL_API focal_status focal_mesh_create(const focal_context* context, const focal_mesh_desc* desc,
                                         const focal_mesh_params* params, focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_load_gltf(const focal_context* context, const char* path,
                                            const focal_mesh_params* params, focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_load_gltf_memory(const focal_context* context, const void* data,
                                                   uint64_t size, const focal_mesh_params* params,
                                                   focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_destroy(focal_mesh* mesh);

/* Creates one mesh from the parts of a character (body, eyes, clothes) in the caller's memory. All results
 * number vertices and triangles consecutively, part after part. Rules and errors as focal_mesh_create;
 * INVALID_ARGUMENT also for a part_count of 0 or more than 65,536. */
FOCAL_API focal_status focal_mesh_create_parts(const focal_context* context,
                                               const focal_mesh_desc* const* parts, uint64_t part_count,
                                               const focal_mesh_params* params, focal_mesh** out_mesh);

/* The range of a part's vertices and triangles in the mesh: number in the mesh = number in the part +
 * first_vertex or first_triangle. */
typedef struct focal_mesh_part {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t first_vertex, vertex_count;
  uint64_t first_triangle, triangle_count;
} focal_mesh_part;

FOCAL_API focal_status focal_mesh_part_init(focal_mesh_part* part, size_t struct_size);

/* Parts in the order in which they were given; for a file its triangle primitives, in node order; for
 * focal_mesh_create one. Errors: INVALID_ARGUMENT (no such part). */
FOCAL_API uint32_t focal_mesh_part_count(const focal_mesh* mesh);
FOCAL_API focal_status focal_mesh_get_part(const focal_mesh* mesh, uint32_t index, focal_mesh_part* out_part);

typedef struct focal_mesh_info {
  uint32_t struct_size;
  uint32_t warning_count;        /* see focal_mesh_warning */
  uint64_t vertex_count;         /* of the caller's mesh */
  uint64_t triangle_count;       /* of the caller's mesh */
  uint64_t surface_vertex_count; /* of the analysed surface: welded and cleaned */
  uint64_t surface_triangle_count;
  double mean_edge_length; /* of the surface, over its undirected edges */
  double surface_area;     /* of the surface */
  double load_seconds;     /* reading and decoding */
  double repair_seconds;   /* weld, clean, scale, check the topology */
  /* Defects found and repaired. On a sound closed mesh component_count and is_oriented are 1, all others 0. */
  uint64_t invalid_triangles;    /* skipped because of focal_mesh_params.lenient */
  uint64_t degenerate_triangles; /* dropped: a repeated corner, or a duplicate (drop_degenerate) */
  uint64_t flipped_triangles;    /* flipped for the analysis */
  uint64_t nonmanifold_edges;    /* of the surface: shared by more than two triangles */
  uint64_t nonmanifold_vertices; /* of the surface: parts of it meet only in this point */
  uint64_t boundary_loops;       /* of the surface: connected curves of boundary edges (holes, open ends) */
  uint64_t component_count;      /* of the surface: its connected components */
  /* 0: so much of the surface is one-sided (like a Moebius strip) that its triangles have no consistent
     orientation; detection then distinguishes left from right by distances alone. */
  int32_t is_oriented;
  /* 1: one closed surface around the mesh is analysed, see focal_surface. Formerly reserved. */
  int32_t is_wrapped;
  uint64_t left_out_triangles; /* scenery that is not analysed, without hidden nodes */
  uint32_t left_out_count;     /* see focal_mesh_get_left_out */
  uint32_t reserved;
} focal_mesh_info;

FOCAL_API focal_status focal_mesh_info_init(focal_mesh_info* info, size_t struct_size);
FOCAL_API focal_status focal_mesh_get_info(const focal_mesh* mesh, focal_mesh_info* out_info);

/* The caller's mesh, row-major: vertex_count x 3 positions, triangle_count x 3 vertex numbers. */
FOCAL_API const float* focal_mesh_positions(const focal_mesh* mesh);
FOCAL_API const uint32_t* focal_mesh_triangles(const focal_mesh* mesh);

/* One sentence on a defect or a repair; index in 0..warning_count-1. */
FOCAL_API const char* focal_mesh_warning(const focal_mesh* mesh, uint32_t index);

/* Why a part of a scene is not analysed (unless focal_mesh_params.keep_scenery is 1). */
typedef int32_t focal_scenery;
enum {
  /* KHR_node_visibility hides the node or one above it. */
  FOCAL_SCENERY_HIDDEN = 0,
  /* Flat and larger than the character on all sides: a ground, a backdrop. */
  FOCAL_SCENERY_SHEET = 1,
  /* A convex shape that contains most of the character: a dome, a collider. */
  FOCAL_SCENERY_ENCLOSURE = 2,
  /* Farther from the character than the character's size; or a single convex object beside it. */
  FOCAL_SCENERY_APART = 3
};

typedef struct focal_left_out {
  uint32_t struct_size;
  focal_scenery reason;
  const char* name;        /* "node 'Ground'", "node 3", "the mesh"; valid as long as the mesh */
  uint64_t triangle_count; /* that are left out; 0 for FOCAL_SCENERY_HIDDEN */
  /* 1: the whole node is left out; written files keep this node and its mesh unchanged, without a skin. 0: the
     rest of the node is analysed, and in a written file the first joint moves the part that is left out. */
  int32_t is_whole_node;
  uint32_t reserved;
} focal_left_out;

FOCAL_API focal_status focal_left_out_init(focal_left_out* left_out, size_t struct_size);

/* index in 0..focal_mesh_info.left_out_count-1; hidden nodes come first. Errors: INVALID_ARGUMENT. */
FOCAL_API focal_status focal_mesh_get_left_out(const focal_mesh* mesh, uint32_t index,
                                               focal_left_out* out_left_out);

/* Writes the closed surface around the mesh as a .glb for inspection: the surface analysed when is_wrapped is
 * 1, and otherwise the one that FOCAL_SURFACE_WRAPPED would analyse. Position and units are those of the mesh.
 * Runs on one thread. Errors: INVALID_ARGUMENT (a path that ends in .gltf), INVALID_MESH, IO, FILE_NOT_FOUND
 * (no such folder). */
FOCAL_API focal_status focal_mesh_write_wrap_gltf(const focal_mesh* mesh, const char* path);

/* The position of a surface point (out_position: 3 floats), and the surface point at a vertex. Errors:
 * INVALID_LANDMARK when the triangle or vertex does not exist, or no triangle uses the vertex. */
FOCAL_API focal_status focal_mesh_position_of(const focal_mesh* mesh, const focal_surface_point* point,
                                              float* out_position);
FOCAL_API focal_status focal_mesh_point_at_vertex(const focal_mesh* mesh, uint32_t vertex,
                                                  focal_surface_point* out_point);

/* The point of the surface nearest to a position (3 floats, in the mesh's coordinates); parts that are left
 * out are ignored. Takes milliseconds for a million triangles. Errors: INVALID_ARGUMENT (a position that is
 * not finite). */
FOCAL_API focal_status focal_mesh_closest_point(const focal_mesh* mesh, const float* position,
                                                focal_surface_point* out_point);

/* ---- Measures: the quantities that training uses, for inspection ---- */

/* Descriptors of the neighbourhood of a point, and kinds of distance. More may be added, see
 * focal_descriptor_count and focal_distance_count. Values are never reused. */
typedef int32_t focal_descriptor;
enum {
  FOCAL_DESCRIPTOR_SI_HKS = 0, /* scale-invariant heat kernel signature */
  FOCAL_DESCRIPTOR_HKS = 1,    /* heat kernel signature */
  FOCAL_DESCRIPTOR_WKS = 2,    /* wave kernel signature */
  /* Like the next, of the neighbourhood in space: it changes with the pose. */
  FOCAL_DESCRIPTOR_SPIN_IMAGE = 3,
  /* Distinguishes left from right. */
  FOCAL_DESCRIPTOR_UNIQUE_SHAPE_CONTEXT = 4
};

typedef int32_t focal_distance;
enum {
  FOCAL_DISTANCE_HEAT = 0,        /* geodesic, by the heat method */
  FOCAL_DISTANCE_EXACT = 1,       /* geodesic, exact on the triangles; much slower */
  FOCAL_DISTANCE_BIHARMONIC = 2,  /* like the next not geodesic: preset paper only */
  FOCAL_DISTANCE_COMMUTE_TIME = 3 /* without a unit */
};

/* The descriptors and distances of this library: how many there are (numbered from 0), their names ("si-hks",
 * "heat"), and the number of values of a descriptor. NULL or 0 for a number that is not in use. */
FOCAL_API uint32_t focal_descriptor_count(void);
FOCAL_API const char* focal_descriptor_name(focal_descriptor descriptor);
FOCAL_API uint32_t focal_descriptor_dimension(focal_descriptor descriptor);
FOCAL_API uint32_t focal_distance_count(void);
FOCAL_API const char* focal_distance_name(focal_distance distance);

/* Computes the descriptor of each given vertex on the original surface, as preset paper does, from 200
 * eigenpairs. out_values: vertex_count x focal_descriptor_dimension, row-major. task may be NULL. Errors:
 * INVALID_ARGUMENT (no such descriptor), INVALID_LANDMARK (no such vertex, or no triangle uses it),
 * NOT_CONVERGED, CANCELLED. */
FOCAL_API focal_status focal_mesh_describe(const focal_context* context, const focal_mesh* mesh,
                                           focal_descriptor descriptor, const uint32_t* vertices,
                                           uint64_t vertex_count, focal_task* task, float* out_values);

/* Computes the distance from one point to each of the caller's vertices on the original surface, in the mesh's
 * units (commute time: without a unit); INFINITY where no triangle uses the vertex. vertex_count must be the
 * mesh's. task may be NULL. Errors: INVALID_ARGUMENT (no such distance), INVALID_LANDMARK, CANCELLED. */
FOCAL_API focal_status focal_mesh_distances(const focal_context* context, const focal_mesh* mesh,
                                            focal_distance distance, const focal_surface_point* source,
                                            focal_task* task, uint64_t vertex_count, float* out_distances);

/* The plane {x : normal . x = offset}; the sign of the normal has no meaning. */
typedef struct focal_symmetry_plane {
  uint32_t struct_size;
  float normal[3]; /* unit length */
  double offset;   /* in the mesh's units */
  double support;  /* 0..1: share of the surface's points whose mirror images are on the surface */
} focal_symmetry_plane;

FOCAL_API focal_status focal_symmetry_plane_init(focal_symmetry_plane* plane, size_t struct_size);
/* Finds the plane that mirrors the largest part of the surface onto itself, by votes of pairs of points with
 * similar neighbourhoods (Mitra, Guibas, Pauly 2006). seed: the same seed gives the same bits. out_plane must
 * have been initialised with focal_symmetry_plane_init. task may be NULL. Errors: CANCELLED. */
FOCAL_API focal_status focal_mesh_symmetry_plane(const focal_context* context, const focal_mesh* mesh,
                                                 uint64_t seed, focal_task* task,
                                                 focal_symmetry_plane* out_plane);

/* ---- Training set [builder] ---- */

/* Creates an empty training set. landmark_names: landmark_count (1..4096) distinct, non-empty names; the
 * landmarks of every mesh are then given in this order. NULL and 0: a set of rigged characters, see
 * focal_training_set_add_rig. */
FOCAL_API focal_status focal_training_set_create(const focal_context* context,
                                                 const char* const* landmark_names, uint64_t landmark_count,
                                                 focal_training_set** out_set);
FOCAL_API focal_status focal_training_set_destroy(focal_training_set* set);

/* Adds a mesh with its landmark_count landmarks, as surface points (triangle FOCAL_NO_TRIANGLE: absent on this
 * mesh) or as vertices (FOCAL_NO_VERTEX: absent). Weights are normalised to sum 1; a landmark in a triangle
 * that was dropped as degenerate moves to the corner of largest weight. On error the set is unchanged:
 * INVALID_LANDMARK (no such triangle or vertex, weights that are negative or all zero, a vertex that no
 * triangle uses), INVALID_ARGUMENT (a landmark_count other than the set's). */
FOCAL_API focal_status focal_training_set_add(focal_training_set* set, const focal_mesh* mesh,
                                              const focal_surface_point* landmarks, uint64_t landmark_count);
FOCAL_API focal_status focal_training_set_add_vertices(focal_training_set* set, const focal_mesh* mesh,
                                                       const uint32_t* vertices, uint64_t landmark_count);

/* Adds a rigged character, loaded with focal_mesh_load_gltf, to a set created without landmark names. Its
 * skeleton defines the landmarks: no point has to be marked. One character is enough, because training also
 * generates other poses and proportions of it. Several characters should share one skeleton: joints are
 * matched by name, and those that at least half of the characters have are learned. Errors: INVALID_ARGUMENT
 * (a set with landmark names; no file kept; no skin; no vertex that a joint moves), INVALID_FILE. */
FOCAL_API focal_status focal_training_set_add_rig(focal_training_set* set, const focal_mesh* mesh);

/* Sets the skeleton template over the marked landmarks, as JSON text (docs/rigs.md describes it), of a set with
 * landmark names. A model trained from the set contains it, and focal_skeleton_create uses it unless another
 * template is given. NULL removes it. On error the set is unchanged: INVALID_ARGUMENT (the template uses a
 * landmark that the set does not have; a set of rigged characters), INVALID_FILE (not valid JSON), UNSUPPORTED
 * (another version of the format, more than 1 MiB). */
FOCAL_API focal_status focal_training_set_set_skeleton(focal_training_set* set,
                                                       const char* skeleton_template);

/* Checks a set of rigged characters and lists its irregularities as warnings: joints that some characters lack,
 * name prefixes that were ignored, weights that are not finite, joints all in one position. Warnings are plain
 * sentences that number the characters from 1, in the order in which they were added; each call of
 * focal_training_set_check replaces them. focal_model_train runs the same check and logs the warnings. Errors
 * of the check: INVALID_ARGUMENT (no character; characters that share fewer than half of their joints; a
 * character that nothing can be learned from). A set with landmark names has no warnings. */
FOCAL_API focal_status focal_training_set_check(focal_training_set* set);
/* Number of warnings of the last check. */
FOCAL_API uint32_t focal_training_set_warning_count(const focal_training_set* set);
FOCAL_API const char* focal_training_set_warning(const focal_training_set* set, uint32_t index);

FOCAL_API uint64_t focal_training_set_landmark_count(const focal_training_set* set);
FOCAL_API uint64_t focal_training_set_mesh_count(const focal_training_set* set);

/* ---- Model ---- */

typedef int32_t focal_preset;
enum {
  FOCAL_PRESET_DEFAULT = 0, /* the most accurate method measured */
  FOCAL_PRESET_PAPER = 1    /* Xia et al. 2016, exactly */
};

typedef struct focal_train_params {
  uint32_t struct_size;
  focal_preset preset; /* the method; stored in the model, used in detection too */
  /* Eigenpairs of the Laplacian, 8..2000; fewer on tiny meshes. Default 128; preset paper: 200. */
  int32_t eigenpair_count;
  int32_t tree_count;            /* trees per forest, 1..10000. Default 30 */
  int32_t min_leaf_samples;      /* 1 or more. Default 5 */
  int32_t components_per_split;  /* random descriptor components tried at each split, 1 or more. Default 5 */
  double sampling_rate;          /* share of the analysed vertices, in (0, 1]. Default 1; preset paper: 0.5 */
  int32_t max_samples_per_shape; /* 1 or more. Default 6250 */
  /* Meshes with more vertices are decimated to about this many for the analysis, in training and detection;
     0: never. Default 3500; preset paper: 0. */
  int32_t proxy_vertices;
  uint64_t seed; /* the same seed gives the same bits. Default 0 */
  /* 1: learn confidences by leaving out one shape at a time; takes about three quarters of the training time.
     0: every confidence is about a half, and no landmark is reported as absent. Default 1. Preset paper has no
     confidences. */
  int32_t learn_confidence;
  /* Total number of shapes learned from rigged characters, copies in other poses included, 2..10000; at least
     one and a half times the number of characters. Default 16. */
  int32_t rigged_shapes;
  /* Stored in the model, used in detection too. Default FOCAL_DESCRIPTOR_SI_HKS. */
  focal_descriptor descriptor;
  /* The same. UNSUPPORTED in preset default unless it is geodesic. Default FOCAL_DISTANCE_HEAT. */
  focal_distance distance;
} focal_train_params;

/* init sets the default preset; set_preset sets every field to the values of one preset. */
FOCAL_API focal_status focal_train_params_init(focal_train_params* params, size_t struct_size);
FOCAL_API focal_status focal_train_params_set_preset(focal_train_params* params, focal_preset preset);

/* Trains a model; takes seconds to minutes. The model contains geometry of its training meshes. params and task
 * may be NULL. Errors: TOO_FEW_SHAPES (a landmark is marked on fewer than two meshes), CANCELLED,
 * NOT_CONVERGED. */
FOCAL_API focal_status focal_model_train(const focal_training_set* set, const focal_train_params* params,
                                         focal_task* task, focal_model** out_model);

/* Loads and saves a model, as a file or in memory. Errors: FILE_NOT_FOUND, IO, INVALID_FILE (the message names
 * the corrupt section), UNSUPPORTED_VERSION. */
FOCAL_API focal_status focal_model_load(const focal_context* context, const char* path,
                                        focal_model** out_model);
FOCAL_API focal_status focal_model_load_memory(const focal_context* context, const void* data, uint64_t size,
                                               focal_model** out_model);
FOCAL_API focal_status focal_model_save(const focal_model* model, const char* path);
FOCAL_API focal_status focal_model_save_memory(const focal_model* model, focal_blob** out_blob);
FOCAL_API focal_status focal_model_destroy(focal_model* model);

/* Stock models are files NAME.focal in these folders; the first folder that has a name takes precedence:
 * focal_context_params.models_folder; those that the environment variable FOCAL_MODELS lists (separated by ":",
 * on Windows ";"); then, relative to the library, models, ../models, ../share/focal/models and
 * ../../share/focal/models. They are listed once per context, at the first of these calls, and sorted by name;
 * names and paths are valid as long as the context. */
FOCAL_API uint32_t focal_context_stock_count(const focal_context* context);
FOCAL_API const char* focal_context_stock_name(const focal_context* context, uint32_t index);
FOCAL_API const char* focal_context_stock_path(const focal_context* context, uint32_t index);

/* Loads a stock model by name. Errors: FILE_NOT_FOUND (no stock model of this name; the message lists the
 * existing ones), and those of focal_model_load. */
FOCAL_API focal_status focal_model_load_stock(const focal_context* context, const char* name,
                                              focal_model** out_model);

typedef struct focal_model_info {
  uint32_t struct_size;
  focal_preset preset;
  uint32_t landmark_count;
  uint32_t shape_count;       /* training meshes */
  uint64_t mean_vertex_count; /* of the training surfaces */
  uint64_t sample_count;      /* training samples of all meshes */
  uint64_t tree_node_count;   /* of all trees */
  uint64_t file_bytes;        /* size of the model's file */
} focal_model_info;

FOCAL_API focal_status focal_model_info_init(focal_model_info* info, size_t struct_size);
FOCAL_API focal_status focal_model_get_info(const focal_model* model, focal_model_info* out_info);

/* The parameters of the training. out_params must have been initialised with focal_train_params_init. */
FOCAL_API focal_status focal_model_get_train_params(const focal_model* model, focal_train_params* out_params);

/* index in 0..landmark_count-1. */
FOCAL_API const char* focal_model_landmark_name(const focal_model* model, uint32_t index);

/* ---- Detection ---- */

typedef int32_t focal_quality;
enum {
  FOCAL_QUALITY_BEST = 0,       /* with the slower refinements */
  FOCAL_QUALITY_INTERACTIVE = 1 /* for a viewport */
};

/* How a mesh may be turned relative to the training shapes, for models of rigs. */
typedef int32_t focal_orientation;
enum {
  /* As the training shapes, +Y up and +Z to the front in glTF: other headings and up axes are tried, at a cost. */
  FOCAL_ORIENTATION_UPRIGHT = 0,
  /* All headings and up axes are equally likely: for meshes that face away or are not upright. Slower. */
  FOCAL_ORIENTATION_ANY = 1
};

typedef struct focal_detect_params {
  uint32_t struct_size;
  focal_quality quality; /* default FOCAL_QUALITY_BEST */
  /* Share of the analysed vertices, 0..1. Default 0: chosen for model and quality. */
  double sampling_rate;
  int32_t max_samples;        /* 1 or more. Default 1250 */
  int32_t peaks_per_landmark; /* candidates among which the constellation chooses, 1..64. Default 8 */
  double found_confidence;    /* below it: FOCAL_LANDMARK_UNCERTAIN. 0..1, default 0.5 */
  /* Below it: FOCAL_LANDMARK_ABSENT. A landmark that the model has learned to recognise as missing is ABSENT
     whatever its confidence. 0..found_confidence, default 0.05. */
  double absent_confidence;
  int32_t keep_votes;            /* 1: keep the vote maps in the detection. Default 1 */
  focal_orientation orientation; /* default FOCAL_ORIENTATION_UPRIGHT */
  uint64_t seed;                 /* the same seed gives the same bits. Default 1 */
  /* Known landmarks, for example corrected by hand: one point for each landmark of the model, in its order,
     FOCAL_NO_TRIANGLE for a landmark to be detected. Known landmarks stay in place, FOUND with confidence 1,
     and constrain the others. NULL and 0: none. Preset default only. */
  const focal_surface_point* fixed_points;
  uint64_t fixed_point_count;
} focal_detect_params;

FOCAL_API focal_status focal_detect_params_init(focal_detect_params* params, size_t struct_size);

/* Finds the model's landmarks on a mesh; runs in the model's context. Holes with a border of up to
 * 1.5 sqrt(area) are closed for the analysis (preset default only; a warning gives their number); landmarks are
 * always on the caller's triangles. The detection keeps mesh and model alive, and a few MB that skeletons and
 * correspondences need. params and task may be NULL. Errors: CANCELLED, NOT_CONVERGED. */
FOCAL_API focal_status focal_model_detect(const focal_model* model, const focal_mesh* mesh,
                                          const focal_detect_params* params, focal_task* task,
                                          focal_detection** out_detection);
FOCAL_API focal_status focal_detection_destroy(focal_detection* detection);

/* Detects on many meshes: one thread per mesh, and one stream per mesh on a GPU, for a higher throughput than
 * one call after another. out_detections: mesh_count handles, in the order of the meshes, with the same bits as
 * from focal_model_detect on the CPU. When one mesh fails, no handle is returned, and the message gives the
 * mesh's number. Errors: as above; INVALID_ARGUMENT also for fixed_points, which belong to one mesh. */
FOCAL_API focal_status focal_model_detect_many(const focal_model* model, const focal_mesh* const* meshes,
                                               uint64_t mesh_count, const focal_detect_params* params,
                                               focal_task* task, focal_detection** out_detections);

/* ---- Analysis: one mesh, many models ---- */

/* Runs the part of a detection that models can share: nearly all of its time. The result works with every model
 * of the same eigenpair_count, proxy_vertices and preset, so normally with all models of the default preset.
 * params may be NULL; of its fields quality, sampling_rate, max_samples and seed are used. task may be NULL.
 * The analysis keeps the mesh alive. Errors: CANCELLED, NOT_CONVERGED. */
FOCAL_API focal_status focal_model_analyse(const focal_model* model, const focal_mesh* mesh,
                                           const focal_detect_params* params, focal_task* task,
                                           focal_analysis** out_analysis);
FOCAL_API focal_status focal_analysis_destroy(focal_analysis* analysis);

/* Like focal_model_detect, on an analysed mesh: about 0.1 s. INVALID_ARGUMENT when the parameters of the
 * analysis differ from the model's. */
FOCAL_API focal_status focal_model_detect_analysis(const focal_model* model, const focal_analysis* analysis,
                                                   const focal_detect_params* params, focal_task* task,
                                                   focal_detection** out_detection);

/* Saves an analysis to a file of a few MB, and loads it again for the same mesh. The file contains geometry of
 * the mesh. Errors: IO, FILE_NOT_FOUND, INVALID_FILE (corrupt, or of another mesh), UNSUPPORTED_VERSION. */
FOCAL_API focal_status focal_analysis_save(const focal_analysis* analysis, const char* path);
FOCAL_API focal_status focal_analysis_load(const focal_context* context, const focal_mesh* mesh,
                                           const char* path, focal_analysis** out_analysis);

/* Compares the model's regressed distances with the true ones: for each sample point of the analysis,
 * out_regressed is the distance to landmark `index` predicted from its descriptor, out_true the distance to
 * `truth`, a point of the mesh. Both have sample_count values, which must be the analysis's. Preset default: in
 * units of sqrt(surface_area), the mean over the leaves. Preset paper: relative to the sample's own largest
 * distance; of the two sides of the symmetry plane, the one that fits the truth better. task may be NULL.
 * Errors: INVALID_ARGUMENT, INVALID_LANDMARK, CANCELLED. */
FOCAL_API uint64_t focal_analysis_sample_count(const focal_analysis* analysis);
FOCAL_API focal_status focal_model_regress(const focal_model* model, const focal_analysis* analysis,
                                           uint32_t index, const focal_surface_point* truth, focal_task* task,
                                           uint64_t sample_count, float* out_regressed, float* out_true);

typedef int32_t focal_landmark_status;
enum { FOCAL_LANDMARK_FOUND = 0, FOCAL_LANDMARK_UNCERTAIN = 1, FOCAL_LANDMARK_ABSENT = 2 };

typedef struct focal_landmark {
  uint32_t struct_size;
  focal_landmark_status status;
  const char* name;            /* valid as long as the detection */
  double confidence;           /* probability that the error is below 4 % of sqrt(surface area) */
  double expected_error;       /* a length, in the mesh's units */
  double runner_up_confidence; /* the runner_up fields hold the second-best place, if has_runner_up is 1 */
  focal_surface_point point;   /* FOCAL_NO_TRIANGLE: no place; then position and vertex are not set */
  float position[3];
  uint32_t vertex; /* the caller's vertex nearest to the point */
  focal_surface_point runner_up_point;
  float runner_up_position[3];
  uint32_t runner_up_vertex;
  int32_t has_runner_up;
  uint32_t reserved;
} focal_landmark;

FOCAL_API focal_status focal_landmark_init(focal_landmark* landmark, size_t struct_size);

/* Landmarks are in the order of the model's names; INVALID_ARGUMENT for an index past the last. */
FOCAL_API uint32_t focal_detection_landmark_count(const focal_detection* detection);
FOCAL_API focal_status focal_detection_get_landmark(const focal_detection* detection, uint32_t index,
                                                    focal_landmark* out_landmark);

typedef struct focal_detection_info {
  uint32_t struct_size;
  uint32_t landmark_count;
  uint32_t warning_count; /* see focal_detection_warning; the mesh's own warnings come first */
  int32_t has_votes;
  uint64_t vertex_count;   /* of the caller's mesh */
  uint64_t triangle_count; /* of the caller's mesh */
  double category_fit;     /* 0..1: how well the mesh fits the model's category */
  focal_backend backend;   /* the backend that was used */
  uint32_t reserved;
} focal_detection_info;

FOCAL_API focal_status focal_detection_info_init(focal_detection_info* info, size_t struct_size);
FOCAL_API focal_status focal_detection_get_info(const focal_detection* detection,
                                                focal_detection_info* out_info);

/* Wall time of each stage in seconds; load and repair are those of the mesh. total: all stages and the time
 * between them. */
typedef struct focal_stage_seconds {
  uint32_t struct_size;
  uint32_t reserved;
  double load;
  double repair;
  double proxy;
  double spectrum;
  double descriptors;
  double geodesics;
  double forest;
  double vote;
  double constellation;
  double refine;
  double total;
} focal_stage_seconds;

FOCAL_API focal_status focal_stage_seconds_init(focal_stage_seconds* seconds, size_t struct_size);
FOCAL_API focal_status focal_detection_get_seconds(const focal_detection* detection,
                                                   focal_stage_seconds* out_seconds);

/* index in 0..focal_detection_info.warning_count-1. */
FOCAL_API const char* focal_detection_warning(const focal_detection* detection, uint32_t index);

/* The vote map of one landmark: a value in 0..1 for each of the caller's vertices (0 where no triangle uses the
 * vertex), scaled so that the largest is 1. vertex_count must be the mesh's. UNSUPPORTED when votes were not
 * kept. */
FOCAL_API focal_status focal_detection_votes(const focal_detection* detection, uint32_t index,
                                             uint64_t vertex_count, float* out_votes);

/* Geodesic distance along the surface from one landmark's place, whatever its status, to each of the caller's
 * vertices, in the mesh's units; INFINITY where no triangle uses the vertex. The first call takes about 50 ms,
 * each further one 10 ms. vertex_count must be the mesh's. INVALID_LANDMARK when the landmark has no place. */
FOCAL_API focal_status focal_detection_distances(const focal_detection* detection, uint32_t index,
                                                 uint64_t vertex_count, float* out_distances);

/* Membership of the region within `radius` of one landmark, for each of the caller's vertices: 1 inside, 0
 * outside, between 0 and 1 within half a mean edge of the border. radius is relative to
 * sqrt(focal_mesh_info.surface_area), so one number selects the same region on every mesh of a category,
 * whatever its size; a radius r in mesh units is r / sqrt(surface_area). Errors as above; INVALID_ARGUMENT for
 * a negative radius. */
FOCAL_API focal_status focal_detection_region(const focal_detection* detection, uint32_t index, double radius,
                                              uint64_t vertex_count, float* out_membership);

/* Writes the caller's own glTF, without loss, plus a node for each landmark that is not absent and
 * mesh.extras.focal. The file type stays that of the source: a path with the other type's suffix is
 * INVALID_ARGUMENT. References to files beside a .gltf are unchanged. A mesh from arrays, or without a kept
 * file (focal_mesh_params.keep_source_file), is written as a plain .glb. Errors: IO, FILE_NOT_FOUND (no such
 * folder). */
FOCAL_API focal_status focal_detection_write_gltf(const focal_detection* detection, const char* path);

/* Writes the surface as a .glb with the vote maps as vertex colours, for inspection: each vertex has the hue of
 * the landmark with the strongest vote there. UNSUPPORTED when votes were not kept. */
FOCAL_API focal_status focal_detection_write_votes_gltf(const focal_detection* detection, const char* path);

/* ---- Correspondence ---- */

/* Maps every vertex of the source to a point of the target; both must be detected with the same model (preset
 * default). Takes about a second. Landmarks correspond by their number. The correspondence keeps both meshes
 * alive. task may be NULL. Errors: INVALID_ARGUMENT (different models; fewer than three landmarks found on
 * both), CANCELLED. */
FOCAL_API focal_status focal_correspondence_create(const focal_detection* source,
                                                   const focal_detection* target, focal_task* task,
                                                   focal_correspondence** out_correspondence);
FOCAL_API focal_status focal_correspondence_destroy(focal_correspondence* correspondence);

/* Points of the target, one for each vertex of the source (FOCAL_NO_TRIANGLE where no triangle uses the
 * vertex). vertex_count must be the source's. */
FOCAL_API focal_status focal_correspondence_points(const focal_correspondence* correspondence,
                                                   uint64_t vertex_count, focal_surface_point* out_points);

/* Transfers one value per vertex of the target (a region, a weight, a colour channel) to the vertices of the
 * source; 0 where no triangle uses a vertex. The counts must be those of the meshes. */
FOCAL_API focal_status focal_correspondence_carry(const focal_correspondence* correspondence,
                                                  uint64_t target_vertex_count, const float* target_values,
                                                  uint64_t vertex_count, float* out_values);

/* ---- Segmentation ---- */

typedef int32_t focal_segmentation;
enum {
  /* SKELETON where the model has one, else GEODESIC. */
  FOCAL_SEGMENTATION_AUTO = 0,
  /* The landmark nearest along the surface; labels are landmark numbers. */
  FOCAL_SEGMENTATION_GEODESIC = 1,
  /* Xia et al. 2016: clusters of position and SI-HKS, started at the landmarks. */
  FOCAL_SEGMENTATION_K_MEANS = 2,
  /* The joint of largest weight; labels are joint numbers (focal_model_joint_name). */
  FOCAL_SEGMENTATION_SKELETON = 3
};

/* A label for each of the caller's triangles, -1 for no label. triangle_count must be the mesh's. task may be
 * NULL. Errors: INVALID_ARGUMENT (SKELETON with a model without a skeleton), CANCELLED. */
FOCAL_API focal_status focal_detection_segment(const focal_detection* detection, focal_segmentation method,
                                               focal_task* task, uint64_t triangle_count,
                                               int32_t* out_labels);

/* Writes the mesh as a .glb with its segments as vertex colours, for inspection. */
FOCAL_API focal_status focal_detection_write_segments_gltf(const focal_detection* detection,
                                                           focal_segmentation method, const char* path);

/* ---- Skeleton ---- */

typedef int32_t focal_bone_names;
enum {
  FOCAL_BONE_NAMES_AS_TRAINED = 0,
  FOCAL_BONE_NAMES_VRM = 1,           /* VRM 1.0: hips, leftUpperArm */
  FOCAL_BONE_NAMES_MIXAMO = 2,        /* mixamorig:Hips, mixamorig:LeftArm */
  FOCAL_BONE_NAMES_UNREAL = 3,        /* pelvis, upperarm_l */
  FOCAL_BONE_NAMES_RIGIFY = 4,        /* DEF-spine, DEF-upper_arm.L */
  FOCAL_BONE_NAMES_UNITY = 5,         /* Hips, LeftUpperArm; also used by Godot */
  FOCAL_BONE_NAMES_RIGIFY_METARIG = 6 /* spine, upper_arm.L, thigh.L: input of Rigify's rig generator */
};

/* The pose in which a file shows the rigged mesh. The joints are posed; the vertices are unchanged. */
typedef int32_t focal_pose;
enum {
  /* The pose of the mesh. */
  FOCAL_POSE_OF_MESH = 0,
  /* The rest pose of the model's first training character, or of the template. */
  FOCAL_POSE_OF_TEACHERS = 1,
  /* The same with the arms stretched out horizontally to the sides. */
  FOCAL_POSE_T = 2,
  /* The same with the stretched arms 45 degrees below horizontal. */
  FOCAL_POSE_A = 3
};

typedef struct focal_skeleton_params {
  uint32_t struct_size;
  /* Default AS_TRAINED. Bones are renamed by their roles, which are recognised from the words in their names and
     from the hierarchy, not from one spelling. Bones without a role in the convention (a tail, a skirt) keep
     their names. */
  focal_bone_names names;
  /* Custom names, one for each joint in the model's order (see focal_model_joint_name). NULL, or NULL for one
     joint: the name that `names` gives. */
  const char* const* joint_names;
  uint64_t joint_name_count; /* the model's joint_count, or 0 */
  /* A rigged character, loaded with focal_mesh_load_gltf, whose animations focal_skeleton_write_gltf adds to
     the file. Its joints should have the names of the training characters' joints. NULL: none. */
  const focal_mesh* animations;
  /* Default FOCAL_POSE_OF_MESH. T and A need two arms, recognised by the joints' roles; else INVALID_ARGUMENT. */
  focal_pose rest_pose;
  /* 1: make the skeleton exactly symmetric: left and right joints, recognised by their names, become mirror
     images of each other, as do the weights of vertices that are mirror images. A mesh that is not symmetric
     (posed, or fewer than half of its vertices have a mirror image) gets bones of equal lengths instead, and a
     warning. A template may request it too. Default 0. */
  int32_t symmetric;
  /* Your own skeleton template over the model's landmarks, as JSON text (docs/rigs.md describes it); weights are
     then computed from its bones by heat diffusion. NULL: the skeleton of the training characters, or the
     template stored in the model. With a template, animations is not allowed, and rest_pose only when the
     template has one. */
  const char* skeleton_template;
  /* Maximum number of joints that move one vertex: 1 to 8, default 4. Above 4 the file also has JOINTS_1 and
     WEIGHTS_1. */
  int32_t max_influences;
  /* 1: remove the training characters' twist and helper bones, recognised by the words in their names (twist,
     roll, helper, corrective, share); their weights go to the joints above them. The skeleton then has fewer
     joints than the model. Default 0. */
  int32_t drop_helpers;
  /* Known joint positions, for example corrected by hand: joint_count of the model or template x 3, NaN for a
     joint to be computed. Known joints get exactly these positions, to the bit; the others follow, less the
     farther away along the bones, and the weights are computed accordingly. NULL: none. */
  const float* fixed_joints;
  uint64_t fixed_joint_count; /* joint_count, or 0 with NULL */
  /* 1: add a joint "root" ("Root" where names are capitalised) on the ground below the first root, as the parent
     of all roots; it moves no vertex. It comes first, so every other joint number is one higher than in the
     model. Y is up. Default 0. */
  int32_t ground_root;
  int32_t reserved_2;
} focal_skeleton_params;

FOCAL_API focal_status focal_skeleton_params_init(focal_skeleton_params* params, size_t struct_size);

/* The skeleton that a model has learned from rigged characters, or that it contains as a template
 * (focal_training_set_set_skeleton): number of joints (0: no skeleton) and their names, in order. */
FOCAL_API uint32_t focal_model_joint_count(const focal_model* model);
FOCAL_API const char* focal_model_joint_name(const focal_model* model, uint32_t index);
/* The template that the model contains, unchanged; NULL: none. Valid as long as the model. */
FOCAL_API const char* focal_model_skeleton_template(const focal_model* model);

/* Computes joints and skin weights for the mesh of a detection, in the mesh's pose; takes about a second. The
 * skeleton keeps the detection alive. params and task may be NULL. Errors: INVALID_ARGUMENT (no template, and the
 * model was not trained on rigged characters; fewer than three landmarks found; a template that uses unknown
 * names), INVALID_FILE (the template is not valid JSON), CANCELLED. */
FOCAL_API focal_status focal_skeleton_create(const focal_detection* detection,
                                             const focal_skeleton_params* params, focal_task* task,
                                             focal_skeleton** out_skeleton);
FOCAL_API focal_status focal_skeleton_destroy(focal_skeleton* skeleton);

/* An existing skeleton that is to be kept: joint_count joints, parents before children. */
typedef struct focal_bind_params {
  uint32_t struct_size;
  int32_t max_influences; /* maximum number of joints that move one vertex: 1 to 8, default 4 */
  /* Non-empty names. NULL with joint_count 0: use the joints of the skins of the mesh's own file; then the fields
     below are NULL too, and a joint that is not the main joint of any vertex in that file (a pole, a target) moves no vertex
     here either, unless this holds for all joints. */
  const char* const* joint_names;
  uint64_t joint_count;         /* at most 65,536 */
  const int32_t* joint_parents; /* number of a joint before it; -1: a root */
  const float* joint_positions; /* joint_count x 3 */
  const float* joint_rotations; /* joint_count x 4, x y z w, as focal_joint.rotation; NULL: no rotation */
  /* joint_count x 3: the far end of each joint's bone; NaN or NULL: computed from the body. */
  const float* joint_tips;
  const int32_t* joint_moves; /* 0: the joint moves no vertex; NULL: all joints move vertices */
} focal_bind_params;

FOCAL_API focal_status focal_bind_params_init(focal_bind_params* params, size_t struct_size);

/* Computes skin weights for an existing skeleton from the body alone, by heat diffusion from the bones along the
 * surface; small separate parts attached to a bone are rigid. Needs no model; takes a fraction of a second. Joints
 * are unchanged, to the bit: with those of the file, focal_skeleton_write_gltf replaces JOINTS_n and WEIGHTS_n of
 * its skinned meshes and changes nothing else. The result is not judged: verdict GOOD, quality and confidences 1;
 * a warning names joints outside the body. The skeleton keeps the mesh alive. params may be NULL (the joints of
 * the mesh's own file), task too. Errors: INVALID_ARGUMENT (no file, or one without a skin; a joint after its
 * child; no joint that moves vertices), INVALID_FILE, CANCELLED. */
FOCAL_API focal_status focal_skeleton_bind(const focal_context* context, const focal_mesh* mesh,
                                           const focal_bind_params* params, focal_task* task,
                                           focal_skeleton** out_skeleton);

/* Whether the skeleton can be used as it is. The warnings of a skeleton that is not GOOD give the reasons. */
typedef int32_t focal_verdict;
enum {
  FOCAL_VERDICT_GOOD = 0,
  FOCAL_VERDICT_CHECK = 1, /* inspect it: some joints may be wrong */
  FOCAL_VERDICT_FAILED = 2 /* do not use it: the mesh is of another category, or the skeleton is collapsed */
};

typedef struct focal_skeleton_info {
  uint32_t struct_size;
  uint32_t joint_count;
  uint32_t warning_count;       /* see focal_skeleton_warning */
  uint32_t max_influences;      /* of one vertex; at most focal_skeleton_params.max_influences */
  uint64_t vertex_count;        /* of the caller's mesh */
  uint64_t unweighted_vertices; /* vertices that no triangle uses */
  double quality;               /* 0..1: the basis of the verdict */
  focal_verdict verdict;
  uint32_t guessed_joints; /* joints whose landmarks were not found: placed by the rest of the body */
  /* Of focal_skeleton_weights: 4, or 8 where max_influences above 4 was set. */
  uint32_t influences_per_vertex;
  uint32_t reserved;
} focal_skeleton_info;

FOCAL_API focal_status focal_skeleton_info_init(focal_skeleton_info* info, size_t struct_size);
FOCAL_API focal_status focal_skeleton_get_info(const focal_skeleton* skeleton, focal_skeleton_info* out_info);

typedef struct focal_joint {
  uint32_t struct_size;
  int32_t parent;   /* index of a joint before it; -1: a root */
  const char* name; /* valid as long as the skeleton */
  /* Probability that the error is below 5 % of the longest side of the body's bounding box; 1 where the position
     was given. */
  double confidence;
  float position[3];
  /* Quaternion x, y, z, w: from the joint's own axes, those of the training characters, to the mesh's. */
  float rotation[4];
  float tip[3]; /* the far end of its part of the surface */
} focal_joint;

FOCAL_API focal_status focal_joint_init(focal_joint* joint, size_t struct_size);
FOCAL_API focal_status focal_skeleton_get_joint(const focal_skeleton* skeleton, uint32_t index,
                                                focal_joint* out_joint);

/* Influences of each of the caller's vertices, largest weight first: joint numbers and weights, both
 * vertex_count x focal_skeleton_info.influences_per_vertex, row-major. Weights sum to 1; all are 0 where no
 * triangle uses the vertex. vertex_count must be the mesh's. */
FOCAL_API focal_status focal_skeleton_weights(const focal_skeleton* skeleton, uint64_t vertex_count,
                                              uint32_t* out_joints, float* out_weights);

/* index in 0..focal_skeleton_info.warning_count-1. */
FOCAL_API const char* focal_skeleton_warning(const focal_skeleton* skeleton, uint32_t index);

/* Writes the caller's own glTF, without loss, with the skeleton, a skin for every visible mesh (see
 * focal_left_out), and the landmarks as focal_detection_write_gltf writes them. Same rules for the path, same
 * errors. */
FOCAL_API focal_status focal_skeleton_write_gltf(const focal_skeleton* skeleton, const char* path);

/* Writes a VRM 1.0 avatar (.vrm or .glb): the output of focal_skeleton_write_gltf with the extension VRMC_vrm,
 * which has the humanoid bones by the joints' roles, and `meta`, a JSON object of VRM's meta data with at least
 * "name" and "authors" (a list); "licenseUrl" and other required fields get VRM's defaults. VRM requires a
 * T-pose: set focal_skeleton_params.rest_pose to FOCAL_POSE_T. Errors: those of
 * focal_skeleton_write_gltf; INVALID_ARGUMENT (the skeleton lacks one of the 15 joints that VRM requires, which
 * the message names; the source file is a .gltf; meta without a name or authors), INVALID_FILE (meta is not a
 * JSON object). */
FOCAL_API focal_status focal_skeleton_write_vrm(const focal_skeleton* skeleton, const char* meta,
                                                const char* path);

#ifdef __cplusplus
}
#endif
#endif /* FOCAL_H */
