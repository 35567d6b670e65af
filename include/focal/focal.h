/* focal.h - mark a few points on about ten meshes, learn them, find them on new meshes.
 *
 * Rules that hold for every function below
 *
 *   Errors     Fallible functions return focal_status. The out_ argument comes last and is written only on
 *              FOCAL_OK. After a failure focal_last_error() says what went wrong, names the object and ends
 *              with a hint; it is per thread. Getters that return a value or a pointer return 0 or NULL for
 *              a bad handle or index, and set focal_last_error() too.
 *   Ownership  focal_X_create/load/train/detect give one handle, focal_X_destroy takes it back (NULL is
 *              fine). Handles may be destroyed in any order: a result keeps what it needs. A stale, foreign
 *              or twice destroyed handle is answered with FOCAL_ERROR_INVALID_HANDLE, never with a crash.
 *              A handle is an opaque tag, not an address. No *_destroy touches focal_last_error().
 *   Lifetime   Returned pointers are borrowed from the handle and live as long as it does. What is passed
 *              in is copied before the call returns.
 *   Threads    Handles are immutable once made, so any number of threads may use one at once. Exceptions:
 *              focal_training_set [builder: one thread at a time] and focal_task [any thread, at any time].
 *              No thread of focal is alive between calls.
 *   Strings    UTF-8, NUL-terminated, paths included, on every platform.
 *   Versions   Structs begin with struct_size. Parameters: fill them with *_init(&params, sizeof params),
 *              then change fields; NULL stands for the defaults. A non-zero tail that this library does not
 *              know is FOCAL_ERROR_UNSUPPORTED. Results: call *_init the same way, then the getter fills
 *              what fits. Reserved fields stay 0.
 *   Units      Positions, lengths and areas are in the units of the caller's mesh. Vertex and triangle
 *              numbers are those of the caller's mesh, 0-based. Flags are int32_t, 0 or 1. Probabilities
 *              lie in 0..1.
 *   Never      Signal handlers, prints, exit, exceptions across this border, use of the locale. The caller's
 *              floating-point environment is saved and restored. Files are written whole or not at all.
 */
#ifndef FOCAL_H
#define FOCAL_H

#include <stddef.h>
#include <stdint.h>

#ifndef FOCAL_API
#if defined(_WIN32) && defined(FOCAL_BUILD)
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

/* The library's version at run time, major << 16 | minor << 8 | patch, and as text ("0.1.0"). */
FOCAL_API uint32_t focal_version(void);
FOCAL_API const char* focal_version_string(void);

typedef int32_t focal_status;
enum { /* values are never reused */
       FOCAL_OK = 0,
       FOCAL_ERROR_INVALID_ARGUMENT = 1, /* NULL, out of range, wrong struct_size */
       FOCAL_ERROR_INVALID_MESH = 2,     /* no triangles, index out of range, NaN or infinite position */
       FOCAL_ERROR_INVALID_FILE = 3,     /* damaged, truncated or not what it says */
       FOCAL_ERROR_IO = 4,               /* reading or writing failed */
       FOCAL_ERROR_OUT_OF_MEMORY = 5,
       FOCAL_ERROR_UNSUPPORTED = 6,     /* valid, but this library does not do it */
       FOCAL_ERROR_NOT_CONVERGED = 7,   /* numerics found no answer on this mesh */
       FOCAL_ERROR_CANCELLED = 8,       /* focal_task_cancel was called */
       FOCAL_ERROR_INTERNAL = 9,        /* a mistake of focal: please report */
       FOCAL_ERROR_INVALID_HANDLE = 10, /* NULL, stale, foreign, of another type, or destroyed twice */
       FOCAL_ERROR_MESH_TOO_SMALL = 11, /* too few vertices to analyse */
       FOCAL_ERROR_FILE_NOT_FOUND = 12,
       FOCAL_ERROR_UNSUPPORTED_VERSION = 13, /* a model file of another version */
       FOCAL_ERROR_INVALID_LANDMARK = 14,    /* a landmark on a vertex or triangle that does not exist */
       FOCAL_ERROR_TOO_FEW_SHAPES = 15       /* a landmark marked on fewer than two training meshes */
};

/* "FOCAL_OK", "FOCAL_ERROR_IO", ...; "FOCAL_ERROR_UNKNOWN" for other numbers. Never NULL. */
FOCAL_API const char* focal_status_name(focal_status status);

/* The last failure of this thread: "message\nhint: ...", or "" when there was none. Never NULL; valid until
 * the next failing call of the same thread. Successful calls leave it as it is. */
FOCAL_API const char* focal_last_error(void);

/* The largest resident memory of this process so far, in bytes; 0 where the system does not report it. */
FOCAL_API uint64_t focal_peak_memory_bytes(void);

/* ---- Handles ---- */

typedef struct focal_context focal_context;           /* how calls are run: backend, threads, log */
typedef struct focal_mesh focal_mesh;                 /* a surface, ready to be analysed */
typedef struct focal_training_set focal_training_set; /* marked meshes [builder] */
typedef struct focal_model focal_model;               /* what training makes */
typedef struct focal_detection focal_detection;       /* landmarks found on one mesh */
typedef struct focal_analysis focal_analysis; /* what is computed of a mesh before any model is asked */
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

/* The host's own parallel loop: call body(body_data, i) once for every i in [0, count), in any order, on any
 * threads, and return when all have ended. Used instead of focal's threads. body never throws; from inside
 * it, focal may call the loop again. Results are the same bits whatever it does. */
typedef void (*focal_parallel_body_fn)(void* body_data, int64_t index);
typedef void (*focal_parallel_for_fn)(void* user_data, int64_t count, focal_parallel_body_fn body,
                                      void* body_data);

typedef struct focal_context_params {
  uint32_t struct_size;
  focal_backend
      backend; /* FOCAL_BACKEND_AUTO: the fastest that works. CUDA that does not work: CPU and a reason */
  int32_t device_index; /* of the GPU, from 0 */
  int32_t thread_count; /* 0: one a core; at most 1024 */
  focal_log_fn log;     /* may be NULL */
  void* log_user_data;
  focal_parallel_for_fn parallel_for; /* may be NULL: focal starts and joins threads inside each call */
  void* parallel_for_user_data;
  /* 0: no budget. Calls on this context, and on what was made with it, fail with OUT_OF_MEMORY rather than let
   * the library hold more than this in the process, for all its contexts together. Not counted: threads' stacks, a GPU's
   * memory, and what the library's own code takes (a few MB). docs/performance.md lists what detections take. */
  uint64_t memory_budget_bytes;
  const char* models_folder; /* stock models of the host's own, see focal_context_stock_count. NULL: none */
} focal_context_params;

FOCAL_API focal_status focal_context_params_init(focal_context_params* params, size_t struct_size);

/* Errors: INVALID_ARGUMENT, UNSUPPORTED. */
FOCAL_API focal_status focal_context_create(const focal_context_params* params, focal_context** out_context);
FOCAL_API focal_status focal_context_destroy(focal_context* context);

/* The backend in use (never AUTO), why it was chosen in one sentence, and the number of threads a call may
 * use. */
FOCAL_API focal_backend focal_context_backend(const focal_context* context);
FOCAL_API const char* focal_context_backend_reason(const focal_context* context);
FOCAL_API int32_t focal_context_thread_count(const focal_context* context);
/* Bytes that the library holds in the process now, for all contexts together: meshes, models, analyses, and what calls in
 * other threads are at work on. */
FOCAL_API uint64_t focal_context_memory_held(const focal_context* context);

/* ---- Task [any thread] ---- */

/* One for each long call: hand it in, poll or cancel it from any thread. Handing it to a second call while
 * the first runs is INVALID_ARGUMENT. A cancelled task stays cancelled, so a cancel just before the call
 * starts is not lost; focal_task_reset makes it fresh again. It may be destroyed while the call runs. */
FOCAL_API focal_status focal_task_create(focal_task** out_task);
FOCAL_API focal_status focal_task_destroy(focal_task* task);

/* The call that runs with it returns FOCAL_ERROR_CANCELLED within about 100 ms. */
FOCAL_API focal_status focal_task_cancel(focal_task* task);

/* Back to progress 0, not cancelled. INVALID_ARGUMENT while a call runs with it. */
FOCAL_API focal_status focal_task_reset(focal_task* task);

FOCAL_API double focal_task_progress(
    const focal_task* task); /* 0..1, never falls; 1 after a call that went well */
FOCAL_API const char* focal_task_stage(
    const focal_task* task); /* "spectrum", ..., "" before; lives for ever */
FOCAL_API int32_t focal_task_is_cancelled(const focal_task* task); /* 0 or 1 */

/* ---- Blob ---- */

FOCAL_API const void* focal_blob_data(const focal_blob* blob); /* 16-byte aligned; live until destroyed */
FOCAL_API uint64_t focal_blob_size(const focal_blob* blob);    /* bytes */
FOCAL_API focal_status focal_blob_destroy(focal_blob* blob);

/* ---- Mesh ---- */

#define FOCAL_NO_VERTEX UINT32_C(0xFFFFFFFF)
#define FOCAL_NO_TRIANGLE UINT32_C(0xFFFFFFFF)

/* A point of the surface: weights (>= 0, sum 1) of the three corners of a triangle. */
typedef struct focal_surface_point {
  uint32_t triangle; /* FOCAL_NO_TRIANGLE: no point */
  float barycentric[3];
} focal_surface_point;

/* What is analysed of a mesh. Landmarks, joints and weights always come back on the caller's own triangles. */
typedef int32_t focal_surface;
enum {
  FOCAL_SURFACE_AUTO = 0,   /* WRAPPED for several parts, or many edges of more than two triangles */
  FOCAL_SURFACE_AS_IS = 1,  /* its own triangles; separate parts are linked at their nearest vertices */
  FOCAL_SURFACE_WRAPPED = 2 /* one closed surface round all that shows from outside; preset default only */
};

typedef struct focal_mesh_params {
  uint32_t struct_size;
  int32_t weld;            /* merge vertices of equal position (UV and normal splits), and open
                              borders that meet within 2e-4 of the size. Default 1 */
  int32_t drop_degenerate; /* drop triangles with a repeated corner and repeated triangles. Default 1 */
  focal_surface surface;   /* Default AUTO */
  /* The rest concerns glTF files only. */
  int32_t allow_external_files; /* also read .bin files beside a .gltf, inside its folder only. Default 0 */
  int32_t keep_source_file;     /* keep the file's bytes, so that results can be written into it. Default 1 */
  uint64_t max_vertices;        /* 1 or more. Default 5,000,000 */
  uint64_t max_triangles;       /* 1 or more. Default 10,000,000 */
  uint64_t max_nodes;           /* 1 or more. Default 1,000,000 */
  uint64_t max_json_bytes;      /* 1 or more. Default 64 MiB */
  uint64_t max_file_bytes;      /* 1 or more, also for each external file. Default 2 GiB */
  /* Name of an animation of the file: skinned meshes come in the pose that it gives them at pose_time
     (seconds, 0 or more; past its end as at its end) instead of the bind pose. Such a mesh keeps no file:
     results are written as a plain .glb. NULL: none. */
  const char* pose_animation;
  double pose_time;
  /* 1: triangles with a NaN or infinite corner, or an index out of range, are left out with a warning
     instead of refusing the mesh (INVALID_MESH); for files too. Their numbers stay taken:
     focal_mesh_triangles gives 0 0 0 there, focal_mesh_positions 0 0 0 for a vertex at no place. Default 0 */
  int32_t lenient;
  /* 1: all of the mesh is analysed. Default 0: what focal_mesh_get_left_out lists is not: nodes of a file that
     KHR_node_visibility hides, and separate parts that are plainly not the character, with a warning each. A mesh
     of a single part, and what has a skin or hangs on a joint, is always kept. Was reserved */
  int32_t keep_scenery;
  struct focal_task* task; /* cancels loading a large mesh; NULL: none */
} focal_mesh_params;

FOCAL_API focal_status focal_mesh_params_init(focal_mesh_params* params, size_t struct_size);

/* A mesh in the caller's memory: triangles counter-clockwise seen from outside. */
typedef struct focal_mesh_desc {
  uint32_t struct_size;
  uint32_t
      position_stride; /* bytes from one vertex to the next; 0 stands for 12; else >= 12, a multiple of 4 */
  const float* positions; /* x, y, z of each vertex */
  uint64_t vertex_count;
  const uint32_t* indices; /* three a triangle */
  uint64_t index_count;    /* a multiple of 3 */
} focal_mesh_desc;

FOCAL_API focal_status focal_mesh_desc_init(focal_mesh_desc* desc, size_t struct_size);

/* Each makes a mesh and prepares its surface (welded, cleaned, scaled), about 0.1 s for 100,000 triangles.
 * Triangles that face the other way than their neighbours, and closed parts that are inside out, are turned
 * over for the analysis; surface points always refer to the corners in the caller's order. Edges of more than
 * two triangles are allowed.
 * params may be NULL. Errors: INVALID_MESH, MESH_TOO_SMALL; from files also FILE_NOT_FOUND, IO, INVALID_FILE,
 * UNSUPPORTED. A glTF scene (.gltf or .glb) becomes one mesh: all triangle primitives in node order, node
 * transforms applied, skins at bind pose; vertices and triangles are numbered through in that order. From
 * memory, external files are refused. Hidden nodes are not part of the mesh; other scenery is, but counts as what no
 * triangle uses: no landmark lies there, and it gets no weights. */
FOCAL_API focal_status focal_mesh_create(const focal_context* context, const focal_mesh_desc* desc,
                                         const focal_mesh_params* params, focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_load_gltf(const focal_context* context, const char* path,
                                            const focal_mesh_params* params, focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_load_gltf_memory(const focal_context* context, const void* data,
                                                   uint64_t size, const focal_mesh_params* params,
                                                   focal_mesh** out_mesh);
FOCAL_API focal_status focal_mesh_destroy(focal_mesh* mesh);

/* A character of several parts (body, eyes, clothes) in the caller's memory as one mesh: vertices and triangles are numbered through, part after
 * part, in all results. Rules and errors as focal_mesh_create; INVALID_ARGUMENT also for part_count 0, or more than 65,536. */
FOCAL_API focal_status focal_mesh_create_parts(const focal_context* context,
                                               const focal_mesh_desc* const* parts, uint64_t part_count,
                                               const focal_mesh_params* params, focal_mesh** out_mesh);

/* Where a part's vertices and triangles are among those of the mesh: the part's own number plus first_vertex or first_triangle. */
typedef struct focal_mesh_part {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t first_vertex, vertex_count;
  uint64_t first_triangle, triangle_count;
} focal_mesh_part;

FOCAL_API focal_status focal_mesh_part_init(focal_mesh_part* part, size_t struct_size);

/* Parts in the order in which they were given; of a file its triangle primitives, in node order; of focal_mesh_create one. Errors:
 * INVALID_ARGUMENT (no such part). */
FOCAL_API uint32_t focal_mesh_part_count(const focal_mesh* mesh);
FOCAL_API focal_status focal_mesh_get_part(const focal_mesh* mesh, uint32_t index, focal_mesh_part* out_part);

typedef struct focal_mesh_info {
  uint32_t struct_size;
  uint32_t warning_count;        /* focal_mesh_warning */
  uint64_t vertex_count;         /* the caller's */
  uint64_t triangle_count;       /* the caller's */
  uint64_t surface_vertex_count; /* of the surface that is analysed: welded and cleaned */
  uint64_t surface_triangle_count;
  double mean_edge_length; /* of the surface, over its undirected edges */
  double surface_area;     /* of the surface */
  double load_seconds;     /* reading and decoding */
  double repair_seconds;   /* weld, clean, scale, look at the topology */
  /* What was found and done, all 0 on a sound closed mesh but component_count and is_oriented, which are 1 */
  uint64_t invalid_triangles;    /* left out by focal_mesh_params.lenient */
  uint64_t degenerate_triangles; /* with a repeated corner or repeated: left out (drop_degenerate) */
  uint64_t flipped_triangles;    /* turned over for the analysis */
  uint64_t nonmanifold_edges;    /* of the surface: shared by more than two triangles */
  uint64_t nonmanifold_vertices; /* of the surface: where parts of it meet in nothing but a point */
  uint64_t boundary_loops;  /* of the surface: connected curves of edges of one triangle: holes, open ends */
  uint64_t component_count; /* of the surface: its separate parts */
  /* 0: so much of the surface has only one side (as a Moebius strip) that its triangles cannot be turned to
     face one way; detection then distinguishes left from right by distances alone */
  int32_t is_oriented;
  int32_t is_wrapped; /* 1: one closed surface round the mesh is analysed, see focal_surface. Was reserved */
  uint64_t left_out_triangles; /* scenery that is not analysed; of HIDDEN, none */
  uint32_t left_out_count;     /* focal_mesh_get_left_out */
  uint32_t reserved;
} focal_mesh_info;

FOCAL_API focal_status focal_mesh_info_init(focal_mesh_info* info, size_t struct_size);
FOCAL_API focal_status focal_mesh_get_info(const focal_mesh* mesh, focal_mesh_info* out_info);

FOCAL_API const float* focal_mesh_positions(const focal_mesh* mesh);    /* vertex_count x 3, row-major */
FOCAL_API const uint32_t* focal_mesh_triangles(const focal_mesh* mesh); /* triangle_count x 3, row-major */

/* A plain sentence on what was found and done; index below warning_count. */
FOCAL_API const char* focal_mesh_warning(const focal_mesh* mesh, uint32_t index);

/* What of a scene is not analysed unless focal_mesh_params.keep_scenery is 1, and why. */
typedef int32_t focal_scenery;
enum {
  FOCAL_SCENERY_HIDDEN = 0, /* KHR_node_visibility hides the node or one above it */
  FOCAL_SCENERY_SHEET = 1,  /* flat, and it reaches beyond the character on all sides: a ground, a backdrop */
  FOCAL_SCENERY_ENCLOSURE = 2, /* a convex shape that contains most of the character: a dome, a collider */
  FOCAL_SCENERY_APART = 3 /* farther from the character than that is large; or one convex thing beside it */
};

typedef struct focal_left_out {
  uint32_t struct_size;
  focal_scenery reason;
  const char* name;        /* "node 'Ground'", "node 3", "the mesh"; lives as long as the mesh */
  uint64_t triangle_count; /* that are left out; 0 where it is HIDDEN */
  /* 1: all of the node; files are written with this node and its mesh as they were, without a skin. 0: the
     rest of the node is analysed, and in a written file the first joint moves what is left out */
  int32_t is_whole_node;
  uint32_t reserved;
} focal_left_out;

FOCAL_API focal_status focal_left_out_init(focal_left_out* left_out, size_t struct_size);

/* index below focal_mesh_info.left_out_count; hidden nodes come first. Errors: INVALID_ARGUMENT. */
FOCAL_API focal_status focal_mesh_get_left_out(const focal_mesh* mesh, uint32_t index,
                                               focal_left_out* out_left_out);

/* Writes a .glb of the closed surface round the mesh, to look at: what is analysed of a mesh that is_wrapped, and what
 * FOCAL_SURFACE_WRAPPED would analyse of another. It lies where the mesh lies, in its units. Runs on one thread. Errors:
 * INVALID_ARGUMENT (a path that ends in .gltf), INVALID_MESH, IO, FILE_NOT_FOUND (no such folder). */
FOCAL_API focal_status focal_mesh_write_wrap_gltf(const focal_mesh* mesh, const char* path);

/* Where a surface point lies (out_position: 3 floats), and the surface point at a vertex. Errors:
 * INVALID_LANDMARK when the triangle or vertex does not exist, or no triangle uses the vertex. */
FOCAL_API focal_status focal_mesh_position_of(const focal_mesh* mesh, const focal_surface_point* point,
                                              float* out_position);
FOCAL_API focal_status focal_mesh_point_at_vertex(const focal_mesh* mesh, uint32_t vertex,
                                                  focal_surface_point* out_point);

/* The point of the surface nearest to a position (3 floats, in the mesh's coordinates); parts that are left out do not
 * count. Milliseconds for a million triangles. Errors: INVALID_ARGUMENT (a position that is not finite). */
FOCAL_API focal_status focal_mesh_closest_point(const focal_mesh* mesh, const float* position,
                                                focal_surface_point* out_point);

/* ---- Measures: what training learns from, to look at ---- */

/* What describes the surroundings of a point, and what distances are; more may come, see focal_descriptor_count
 * and focal_distance_count. Values are never reused. */
typedef int32_t focal_descriptor;
enum {
  FOCAL_DESCRIPTOR_SI_HKS = 0,     /* scale-invariant heat kernel signature */
  FOCAL_DESCRIPTOR_HKS = 1,        /* heat kernel signature */
  FOCAL_DESCRIPTOR_WKS = 2,        /* wave kernel signature */
  FOCAL_DESCRIPTOR_SPIN_IMAGE = 3, /* of the neighbourhood in space, like the next: poses change it */
  FOCAL_DESCRIPTOR_UNIQUE_SHAPE_CONTEXT = 4 /* distinguishes left from right */
};

typedef int32_t focal_distance;
enum {
  FOCAL_DISTANCE_HEAT = 0,        /* geodesic, by the heat method */
  FOCAL_DISTANCE_EXACT = 1,       /* geodesic, exact on the triangles; much slower */
  FOCAL_DISTANCE_BIHARMONIC = 2,  /* not geodesic, like the next: preset paper only */
  FOCAL_DISTANCE_COMMUTE_TIME = 3 /* has no unit */
};

/* Those that this library has, numbered from 0, with their names ("si-hks", "heat") and the number of values of
 * a descriptor. NULL or 0 for a number that is none. */
FOCAL_API uint32_t focal_descriptor_count(void);
FOCAL_API const char* focal_descriptor_name(focal_descriptor descriptor);
FOCAL_API uint32_t focal_descriptor_dimension(focal_descriptor descriptor);
FOCAL_API uint32_t focal_distance_count(void);
FOCAL_API const char* focal_distance_name(focal_distance distance);

/* Describes vertices of the surface as it is, as preset paper does, by 200 eigenpairs. out_values: vertex_count
 * x the descriptor's dimension. task may be NULL. Errors: INVALID_ARGUMENT (no such descriptor), INVALID_LANDMARK (no such vertex, or no triangle uses it), NOT_CONVERGED, CANCELLED. */
FOCAL_API focal_status focal_mesh_describe(const focal_context* context, const focal_mesh* mesh,
                                           focal_descriptor descriptor, const uint32_t* vertices,
                                           uint64_t vertex_count, focal_task* task, float* out_values);

/* Distances from one point to each of the caller's vertices, on the surface as it is, in the mesh's units
 * (commute time: without a unit); INFINITY where no triangle uses the vertex. vertex_count must be the mesh's.
 * task may be NULL. Errors: INVALID_ARGUMENT (no such distance), INVALID_LANDMARK, CANCELLED. */
FOCAL_API focal_status focal_mesh_distances(const focal_context* context, const focal_mesh* mesh,
                                            focal_distance distance, const focal_surface_point* source,
                                            focal_task* task, uint64_t vertex_count, float* out_distances);

/* {x : normal . x = offset}; the sign of the normal carries no meaning. */
typedef struct focal_symmetry_plane {
  uint32_t struct_size;
  float normal[3]; /* of length 1 */
  double offset;   /* in the mesh's units */
  double support;  /* 0..1: share of the surface's points whose mirror images lie on it */
} focal_symmetry_plane;

FOCAL_API focal_status focal_symmetry_plane_init(focal_symmetry_plane* plane, size_t struct_size);
/* The plane that mirrors most of the surface onto itself, by votes of pairs of points that look alike (Mitra,
 * Guibas, Pauly 2006). seed: same seed, same bits. out_plane must have been through focal_symmetry_plane_init.
 * task may be NULL. Errors: CANCELLED. */
FOCAL_API focal_status focal_mesh_symmetry_plane(const focal_context* context, const focal_mesh* mesh,
                                                 uint64_t seed, focal_task* task,
                                                 focal_symmetry_plane* out_plane);

/* ---- Training set [builder] ---- */

/* landmark_names: landmark_count (1..4096) different, non-empty names; every mesh is then marked in this
 * order. Or NULL and 0: a set of rigged characters, see focal_training_set_add_rig. */
FOCAL_API focal_status focal_training_set_create(const focal_context* context,
                                                 const char* const* landmark_names, uint64_t landmark_count,
                                                 focal_training_set** out_set);
FOCAL_API focal_status focal_training_set_destroy(focal_training_set* set);

/* Adds a mesh with its marks, landmark_count of them, as surface points (triangle FOCAL_NO_TRIANGLE: absent
 * on this mesh) or as vertices (FOCAL_NO_VERTEX: absent). Weights are scaled to sum 1; a mark in a triangle
 * that was dropped as degenerate moves to its heaviest corner. The set stays as it was on error:
 * INVALID_LANDMARK (no such triangle or vertex, weights that are negative or all zero, a vertex that no
 * triangle uses), INVALID_ARGUMENT (another landmark_count than the set's). */
FOCAL_API focal_status focal_training_set_add(focal_training_set* set, const focal_mesh* mesh,
                                              const focal_surface_point* landmarks, uint64_t landmark_count);
FOCAL_API focal_status focal_training_set_add_vertices(focal_training_set* set, const focal_mesh* mesh,
                                                       const uint32_t* vertices, uint64_t landmark_count);

/* Adds a rigged character, loaded with focal_mesh_load_gltf, to a set made without landmark names.
 * Landmarks are placed by its skeleton: no point has to be marked. One character is enough: it is learned
 * in other poses and proportions too. Several should share one skeleton: joints are matched by name, and
 * those of at least half of the characters are learned. Errors: INVALID_ARGUMENT (a set with landmark
 * names; no file kept; no skin; no vertex that a joint moves), INVALID_FILE. */
FOCAL_API focal_status focal_training_set_add_rig(focal_training_set* set, const focal_mesh* mesh);

/* A skeleton over the marked landmarks, as JSON text (docs/rigs.md describes it), for a set with landmark names. A model trained from
 * the set carries it, and focal_skeleton_create uses it where no other template is given. NULL: none, as at first. The set stays as it was
 * on error: INVALID_ARGUMENT (a template that names what the set has not; a set of rigged characters), INVALID_FILE (no JSON),
 * UNSUPPORTED (another version of the format, more than 1 MiB). */
FOCAL_API focal_status focal_training_set_set_skeleton(focal_training_set* set,
                                                       const char* skeleton_template);

/* What is odd about the set of rigged characters, looked at anew with each call of focal_training_set_check: joints that
 * some of them lack, prefixes of names that were put aside, weights that are no numbers, joints all in one place. Plain
 * sentences that number the characters from 1, in the order in which they were added. focal_model_train checks too, and gives
 * the sentences to the context's log. Errors of the check: INVALID_ARGUMENT (no character; characters that share fewer than half of
 * their joints; a character that nothing can be learned from). For a set with landmark names there is nothing to say. */
FOCAL_API focal_status focal_training_set_check(focal_training_set* set);
FOCAL_API uint32_t focal_training_set_warning_count(const focal_training_set* set); /* of the last check */
FOCAL_API const char* focal_training_set_warning(const focal_training_set* set, uint32_t index);

FOCAL_API uint64_t focal_training_set_landmark_count(const focal_training_set* set);
FOCAL_API uint64_t focal_training_set_mesh_count(const focal_training_set* set);

/* ---- Model ---- */

typedef int32_t focal_preset;
enum {
  FOCAL_PRESET_DEFAULT = 0, /* what measures best */
  FOCAL_PRESET_PAPER = 1    /* Xia et al. 2016 to the letter */
};

typedef struct focal_train_params {
  uint32_t struct_size;
  focal_preset preset; /* which method; kept in the model, detection follows it */
  /* Eigenpairs of the Laplacian, 8..2000; fewer on tiny meshes. Default 128; preset paper: 200 */
  int32_t eigenpair_count;
  int32_t tree_count;            /* a forest, 1..10000. Default 30 */
  int32_t min_leaf_samples;      /* 1 or more. Default 5 */
  int32_t components_per_split;  /* random descriptor components tried at each split, 1 or more. Default 5 */
  double sampling_rate;          /* of the vertices analysed, above 0 to 1. Default 1; preset paper: 0.5 */
  int32_t max_samples_per_shape; /* 1 or more. Default 6250 */
  /* Meshes with more vertices are analysed on a decimated copy of about so many, here and in detection;
     0: as they are. Default 3500; preset paper: 0 */
  int32_t proxy_vertices;
  uint64_t seed; /* same seed, same bits. Default 0 */
  /* By leaving shapes out in turn, about three quarters of the time. Default 1; without it every confidence is
     about a half, and no landmark is called absent. Preset paper has none */
  int32_t learn_confidence;
  /* Shapes learned of rigged characters in all, copies in other poses included, 2..10000; at least half as
     many again as there are characters. Default 16 */
  int32_t rigged_shapes;
  focal_descriptor descriptor; /* kept in the model, detection follows it, as with the next. Default SI_HKS */
  focal_distance distance;     /* UNSUPPORTED in preset default when it is not geodesic. Default HEAT */
} focal_train_params;

/* init fills the default preset; set_preset refills every field with the values of one preset. */
FOCAL_API focal_status focal_train_params_init(focal_train_params* params, size_t struct_size);
FOCAL_API focal_status focal_train_params_set_preset(focal_train_params* params, focal_preset preset);

/* Learns a model; seconds to minutes. params and task may be NULL. Errors: TOO_FEW_SHAPES (a landmark is
 * marked on fewer than two meshes), CANCELLED, NOT_CONVERGED. A model contains geometry of its training
 * meshes. */
FOCAL_API focal_status focal_model_train(const focal_training_set* set, const focal_train_params* params,
                                         focal_task* task, focal_model** out_model);

/* Errors: FILE_NOT_FOUND, IO, INVALID_FILE (with the section that is damaged), UNSUPPORTED_VERSION. */
FOCAL_API focal_status focal_model_load(const focal_context* context, const char* path,
                                        focal_model** out_model);
FOCAL_API focal_status focal_model_load_memory(const focal_context* context, const void* data, uint64_t size,
                                               focal_model** out_model);
FOCAL_API focal_status focal_model_save(const focal_model* model, const char* path);
FOCAL_API focal_status focal_model_save_memory(const focal_model* model, focal_blob** out_blob);
FOCAL_API focal_status focal_model_destroy(focal_model* model);

/* Stock models come with focal: files NAME.focal. Folders, the first that has a name counts: focal_context_params.models_folder,
 * those that the environment variable FOCAL_MODELS lists (separated by ":", on Windows ";"), and beside the library models,
 * ../models, ../share/focal/models and ../../share/focal/models. They are looked up once a context, at the first of these calls, and
 * sorted by name; names and paths live as long as the context. */
FOCAL_API uint32_t focal_context_stock_count(const focal_context* context);
FOCAL_API const char* focal_context_stock_name(const focal_context* context, uint32_t index);
FOCAL_API const char* focal_context_stock_path(const focal_context* context, uint32_t index);

/* Errors: FILE_NOT_FOUND (there is no stock model of this name; the message lists those there are), and those of
 * focal_model_load. */
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

/* The parameters it was trained with. out_params must have been through focal_train_params_init. */
FOCAL_API focal_status focal_model_get_train_params(const focal_model* model, focal_train_params* out_params);

/* index below landmark_count. */
FOCAL_API const char* focal_model_landmark_name(const focal_model* model, uint32_t index);

/* ---- Detection ---- */

typedef int32_t focal_quality;
enum {
  FOCAL_QUALITY_BEST = 0,       /* with the slower refinements */
  FOCAL_QUALITY_INTERACTIVE = 1 /* for a viewport */
};

typedef struct focal_detect_params {
  uint32_t struct_size;
  focal_quality quality; /* default FOCAL_QUALITY_BEST */
  double sampling_rate;  /* of the vertices analysed, 0 to 1; 0, the default: as suits model and quality */
  int32_t max_samples;   /* 1 or more. Default 1250 */
  int32_t peaks_per_landmark; /* candidates among which the constellation chooses, 1..64. Default 8 */
  double found_confidence;    /* below it: FOCAL_LANDMARK_UNCERTAIN. 0..1, default 0.5 */
  /* Below it: FOCAL_LANDMARK_ABSENT; so is a landmark that the model has learned to call missing, whatever
     its confidence. 0..found_confidence, default 0.05 */
  double absent_confidence;
  int32_t keep_votes; /* keep the vote maps in the detection. Default 1 */
  int32_t reserved;
  uint64_t seed; /* same seed, same bits. Default 1 */
  /* Places that are known, as after a correction by hand: one for each landmark of the model, in its order,
     FOCAL_NO_TRIANGLE where it is to be found. They stay where they are, FOUND with confidence 1, and the
     others are chosen to suit them. NULL and 0: none. Preset default only. */
  const focal_surface_point* fixed_points;
  uint64_t fixed_point_count;
} focal_detect_params;

FOCAL_API focal_status focal_detect_params_init(focal_detect_params* params, size_t struct_size);

/* Finds the model's landmarks on a mesh. params and task may be NULL; runs in the model's context. Errors:
 * CANCELLED, NOT_CONVERGED. The detection keeps mesh and model alive, and a few MB that skeletons and maps
 * start from. Holes with a border of up to 1.5 sqrt(area) are closed for the analysis (preset default
 * only; a warning says how many); landmarks still lie on the caller's triangles. */
FOCAL_API focal_status focal_model_detect(const focal_model* model, const focal_mesh* mesh,
                                          const focal_detect_params* params, focal_task* task,
                                          focal_detection** out_detection);
FOCAL_API focal_status focal_detection_destroy(focal_detection* detection);

/* The same on many meshes: each on a thread of its own, and on a stream of its own where a GPU is used, which gives
 * more of them a second than one call after another. out_detections: mesh_count handles, in the order of the
 * meshes, with the same bits as from focal_model_detect on the CPU; all of them or, when one fails, none: the message
 * gives its number. Errors: as above; INVALID_ARGUMENT also for fixed_points, which belong to one mesh. */
FOCAL_API focal_status focal_model_detect_many(const focal_model* model, const focal_mesh* const* meshes,
                                               uint64_t mesh_count, const focal_detect_params* params,
                                               focal_task* task, focal_detection** out_detections);

/* ---- Analysis: one mesh, many models ---- */

/* Analyses the mesh as this model needs it; nearly all the work of a detection. The result serves every
 * model with the same eigenpair_count, proxy_vertices and preset, so all of the default preset. params may
 * be NULL; of them count quality, sampling_rate, max_samples and seed. Errors: CANCELLED, NOT_CONVERGED.
 * It keeps the mesh alive. */
FOCAL_API focal_status focal_model_analyse(const focal_model* model, const focal_mesh* mesh,
                                           const focal_detect_params* params, focal_task* task,
                                           focal_analysis** out_analysis);
FOCAL_API focal_status focal_analysis_destroy(focal_analysis* analysis);

/* Like focal_model_detect, on an analysed mesh: about 0.1 s. INVALID_ARGUMENT when the analysis
 * was made with other parameters than the model's. */
FOCAL_API focal_status focal_model_detect_analysis(const focal_model* model, const focal_analysis* analysis,
                                                   const focal_detect_params* params, focal_task* task,
                                                   focal_detection** out_detection);

/* An analysis in a file, a few MB, and back for the same mesh. Errors: IO, FILE_NOT_FOUND, INVALID_FILE
 * (damaged, or of another mesh), UNSUPPORTED_VERSION. It contains geometry of the mesh. */
FOCAL_API focal_status focal_analysis_save(const focal_analysis* analysis, const char* path);
FOCAL_API focal_status focal_analysis_load(const focal_context* context, const focal_mesh* mesh,
                                           const char* path, focal_analysis** out_analysis);

/* What the model's regression makes of an analysis: for each of its sample points the distance to landmark
 * `index` that follows from its descriptor, and the true one to `truth`, a point of the mesh. Preset default: in
 * units of sqrt(surface_area), the mean of what the leaves hold. Preset paper: shares of the sample's own
 * largest distance; of the two sides of the symmetry plane those that fit the truth better. sample_count must
 * be the analysis's. task may be NULL. Errors: INVALID_ARGUMENT, INVALID_LANDMARK, CANCELLED. */
FOCAL_API uint64_t focal_analysis_sample_count(const focal_analysis* analysis);
FOCAL_API focal_status focal_model_regress(const focal_model* model, const focal_analysis* analysis,
                                           uint32_t index, const focal_surface_point* truth, focal_task* task,
                                           uint64_t sample_count, float* out_regressed, float* out_true);

typedef int32_t focal_landmark_status;
enum { FOCAL_LANDMARK_FOUND = 0, FOCAL_LANDMARK_UNCERTAIN = 1, FOCAL_LANDMARK_ABSENT = 2 };

typedef struct focal_landmark {
  uint32_t struct_size;
  focal_landmark_status status;
  const char* name;            /* lives as long as the detection */
  double confidence;           /* probability of lying within 4 % of sqrt(area) of the truth */
  double expected_error;       /* a length, in the mesh's units */
  double runner_up_confidence; /* the runner_up fields hold the second-best place, when there is one */
  focal_surface_point point;   /* FOCAL_NO_TRIANGLE: no place at all; then position and vertex hold nothing */
  float position[3];
  uint32_t vertex; /* the caller's vertex nearest to it */
  focal_surface_point runner_up_point;
  float runner_up_position[3];
  uint32_t runner_up_vertex;
  int32_t has_runner_up;
  uint32_t reserved;
} focal_landmark;

FOCAL_API focal_status focal_landmark_init(focal_landmark* landmark, size_t struct_size);

/* Landmarks come in the order of the model's names; INVALID_ARGUMENT for an index past the last. */
FOCAL_API uint32_t focal_detection_landmark_count(const focal_detection* detection);
FOCAL_API focal_status focal_detection_get_landmark(const focal_detection* detection, uint32_t index,
                                                    focal_landmark* out_landmark);

typedef struct focal_detection_info {
  uint32_t struct_size;
  uint32_t landmark_count;
  uint32_t warning_count; /* focal_detection_warning; the mesh's own warnings come first */
  int32_t has_votes;
  uint64_t vertex_count;   /* of the caller's mesh */
  uint64_t triangle_count; /* of the caller's mesh */
  double category_fit;     /* 0..1: does this mesh belong to the model's category at all */
  focal_backend backend;   /* that did the work */
  uint32_t reserved;
} focal_detection_info;

FOCAL_API focal_status focal_detection_info_init(focal_detection_info* info, size_t struct_size);
FOCAL_API focal_status focal_detection_get_info(const focal_detection* detection,
                                                focal_detection_info* out_info);

/* Wall time of each stage in seconds; load and repair are the mesh's. total: all of
 * them and what lies between. */
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

FOCAL_API const char* focal_detection_warning(const focal_detection* detection, uint32_t index);

/* The vote map of one landmark, a value in 0..1 for each of the caller's vertices (0 where no triangle uses
 * the vertex); the largest is 1. vertex_count must be the mesh's. UNSUPPORTED when votes were not kept. */
FOCAL_API focal_status focal_detection_votes(const focal_detection* detection, uint32_t index,
                                             uint64_t vertex_count, float* out_votes);

/* Geodesic distances along the surface from one landmark's place, absent or not, to each of the caller's
 * vertices, in the mesh's units: INFINITY where no triangle uses the vertex. The
 * first call takes about 50 ms, each further one 10 ms. vertex_count must be the mesh's. INVALID_LANDMARK
 * when the landmark has no place at all. */
FOCAL_API focal_status focal_detection_distances(const focal_detection* detection, uint32_t index,
                                                 uint64_t vertex_count, float* out_distances);

/* The region within `radius` of one landmark, as a value for each of the caller's vertices: 1 inside, 0
 * outside, in between within half a mean edge of its border. radius is a share of
 * sqrt(focal_mesh_info.surface_area), so one number means the same region on every mesh of a category,
 * whatever its size: a radius r in the units of a mesh is r / sqrt(surface_area). Errors as above;
 * INVALID_ARGUMENT for a radius below 0. */
FOCAL_API focal_status focal_detection_region(const focal_detection* detection, uint32_t index, double radius,
                                              uint64_t vertex_count, float* out_membership);

/* Writes the caller's own glTF, nothing lost, plus a node for each landmark that is not absent and
 * mesh.extras.focal. It is the kind of file that was loaded: a path that ends in the other kind's suffix is
 * INVALID_ARGUMENT; files beside a .gltf are referred to as before. A mesh from arrays, or whose file was not
 * kept (focal_mesh_params.keep_source_file), is written as a plain .glb. Errors: IO, FILE_NOT_FOUND (no such
 * folder). */
FOCAL_API focal_status focal_detection_write_gltf(const focal_detection* detection, const char* path);

/* Writes a .glb of the surface with the vote maps as vertex colours, to look at: each vertex in
 * the hue of the landmark with the strongest vote there. UNSUPPORTED when votes were not kept. */
FOCAL_API focal_status focal_detection_write_votes_gltf(const focal_detection* detection, const char* path);

/* ---- Correspondence ---- */

/* A point of the target for every vertex of the source, both detected with the same model (preset
 * default); about a second. Landmarks correspond by their number. task may be NULL. Errors:
 * INVALID_ARGUMENT (different models; fewer than three landmarks found on both), CANCELLED. It keeps both
 * meshes alive. */
FOCAL_API focal_status focal_correspondence_create(const focal_detection* source,
                                                   const focal_detection* target, focal_task* task,
                                                   focal_correspondence** out_correspondence);
FOCAL_API focal_status focal_correspondence_destroy(focal_correspondence* correspondence);

/* Points of the target, one for each vertex of the source (FOCAL_NO_TRIANGLE where no triangle uses the
 * vertex). vertex_count must be the source's. */
FOCAL_API focal_status focal_correspondence_points(const focal_correspondence* correspondence,
                                                   uint64_t vertex_count, focal_surface_point* out_points);

/* Carries a value for each vertex of the target (a region, a weight, a colour channel) over to the source;
 * 0 where no triangle uses a vertex. The counts must be those of the meshes. */
FOCAL_API focal_status focal_correspondence_carry(const focal_correspondence* correspondence,
                                                  uint64_t target_vertex_count, const float* target_values,
                                                  uint64_t vertex_count, float* out_values);

/* ---- Segmentation ---- */

typedef int32_t focal_segmentation;
enum {
  FOCAL_SEGMENTATION_AUTO = 0,     /* SKELETON where the model has one, else GEODESIC */
  FOCAL_SEGMENTATION_GEODESIC = 1, /* the landmark nearest along the surface; labels are landmark numbers */
  FOCAL_SEGMENTATION_K_MEANS =
      2, /* Xia et al. 2016: clusters of position and SI-HKS that start at the landmarks */
  FOCAL_SEGMENTATION_SKELETON =
      3 /* the joint that moves it most; labels are joint numbers (focal_model_joint_name) */
};

/* A label for each of the caller's triangles, -1 where there is none. task may be NULL. triangle_count
 * must be the mesh's. Errors: INVALID_ARGUMENT (SKELETON with a model that has none), CANCELLED. */
FOCAL_API focal_status focal_detection_segment(const focal_detection* detection, focal_segmentation method,
                                               focal_task* task, uint64_t triangle_count,
                                               int32_t* out_labels);

/* Writes a .glb of the mesh with its parts as vertex colours, to look at. */
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
  FOCAL_BONE_NAMES_UNITY = 5,         /* Hips, LeftUpperArm; Godot's too */
  FOCAL_BONE_NAMES_RIGIFY_METARIG = 6 /* spine, upper_arm.L, thigh.L: what Rigify generates controls from */
};

/* In which pose a file shows the rigged mesh: its joints take it there, its vertices stay as they were. */
typedef int32_t focal_pose;
enum {
  FOCAL_POSE_OF_MESH = 0, /* as the mesh stands */
  FOCAL_POSE_OF_TEACHERS =
      1,            /* the rest pose of the first character that taught the model, or of the template */
  FOCAL_POSE_T = 2, /* the same with level arms, stretched out to the sides */
  FOCAL_POSE_A = 3  /* the same with such arms 45 degrees below the level */
};

typedef struct focal_skeleton_params {
  uint32_t struct_size;
  /* Default AS_TRAINED. Bones are renamed by their roles, which follow from the words of their names and from where they hang, not
     from one spelling; those without a role in the convention (a tail, a skirt) keep their names */
  focal_bone_names names;
  /* Names of your own, one for each joint in the model's order (see focal_model_joint_name); NULL, or NULL
     for one of them: as above. joint_name_count: the model's joint_count, or 0. */
  const char* const* joint_names;
  uint64_t joint_name_count;
  /* A rigged character, loaded with focal_mesh_load_gltf, whose animations focal_skeleton_write_gltf puts
     in; NULL: none. Its joints should be named as those of the characters that taught the model. */
  const focal_mesh* animations;
  /* Default FOCAL_POSE_OF_MESH. T and A need a skeleton with two arms, which the joints' roles name; INVALID_ARGUMENT without. */
  focal_pose rest_pose;
  /* 1: what is alike on both sides becomes exactly so: joints of the left and right side, which their names identify, are mirror images
     of each other, and so are the weights of vertices that are. A mesh that does not stand alike on both sides (posed, or fewer than half
     of its vertices have a mirror image) gets bones of the same lengths, and a warning. Default 0. A template may ask for it too. */
  int32_t symmetric;
  /* A skeleton of your own over the model's landmarks, as JSON text (docs/rigs.md describes it); weights
     then follow from its bones by heat. NULL: the skeleton of the characters that taught the model, or the
     template that it carries. With a template, animations is not allowed, and rest_pose only when the template gives one. */
  const char* skeleton_template;
  /* Joints that move one vertex, at most: 1 to 8, default 4. Above 4 the file has JOINTS_1 and WEIGHTS_1 too. */
  int32_t max_influences;
  /* 1: without the teachers' twist bones and helpers, recognised by the words of their names (twist, roll, helper, corrective, share); the
     joints above them get what they moved. The skeleton then has fewer joints than the model. Default 0 */
  int32_t drop_helpers;
  /* Joints that are known, as after a correction by hand: joint_count of the model or template x 3 positions, with NaN for a joint that
     is to follow. They lie there to the bit; the others move with them, less the farther along the bones, and weights suit
     them. fixed_joint_count: the joint_count, or 0 with NULL: none. */
  const float* fixed_joints;
  uint64_t fixed_joint_count;
  /* 1: one more joint, "root" ("Root" where names are capital), on the ground below the first root and above all roots; it moves no vertex. It comes first:
     other joints have one number more than in the model. Y is up. Default 0. */
  int32_t ground_root;
  int32_t reserved_2;
} focal_skeleton_params;

FOCAL_API focal_status focal_skeleton_params_init(focal_skeleton_params* params, size_t struct_size);

/* The skeleton that a model of rigged characters has learned, or that a model of marked landmarks carries
 * (focal_training_set_set_skeleton): number of joints (0: none) and their names, in order. */
FOCAL_API uint32_t focal_model_joint_count(const focal_model* model);
FOCAL_API const char* focal_model_joint_name(const focal_model* model, uint32_t index);
/* The template that the model carries, as it was given; NULL: none. Valid as long as the model. */
FOCAL_API const char* focal_model_skeleton_template(const focal_model* model);

/* Joints and skin weights for the mesh of a detection, in the pose that it has; about a second. params and
 * task may be NULL. Errors: INVALID_ARGUMENT (no template, and the model was not learned from rigged
 * characters; fewer than three landmarks found; a template that names what is not there), INVALID_FILE
 * (the template is no JSON), CANCELLED. It keeps the detection alive. */
FOCAL_API focal_status focal_skeleton_create(const focal_detection* detection,
                                             const focal_skeleton_params* params, focal_task* task,
                                             focal_skeleton** out_skeleton);
FOCAL_API focal_status focal_skeleton_destroy(focal_skeleton* skeleton);

/* A skeleton that is there already, and is to stay: joint_count joints, parents first. */
typedef struct focal_bind_params {
  uint32_t struct_size;
  int32_t max_influences; /* joints that move one vertex, at most: 1 to 8, default 4 */
  /* NULL and 0: the joints of the skins of the mesh's own file; then the fields below are NULL too. A joint that is no
     vertex's main one there (a pole, a target) moves none here, unless none is. Otherwise names, each non-empty */
  const char* const* joint_names;
  uint64_t joint_count;         /* at most 65,536 */
  const int32_t* joint_parents; /* number of a joint before it; -1: a root */
  const float* joint_positions; /* joint_count x 3 */
  const float* joint_rotations; /* joint_count x 4, x y z w, as focal_joint.rotation; NULL: none is turned */
  const float*
      joint_tips; /* joint_count x 3: where the bone of a joint ends; NaN, or NULL: that follows from the body */
  const int32_t* joint_moves; /* 0: the joint moves no vertex; NULL: all of them do */
} focal_bind_params;

FOCAL_API focal_status focal_bind_params_init(focal_bind_params* params, size_t struct_size);

/* Weights for a skeleton that is there, from the body alone: heat of the bones, spread along the surface; small separate parts that
 * ride on a bone are rigid. No model is needed; a part of a second. Joints stay as they are, to the bit: with those of the file
 * focal_skeleton_write_gltf replaces JOINTS_n and WEIGHTS_n of its skinned meshes and changes nothing else. Nothing is judged: verdict
 * GOOD, quality and confidences 1; a warning names joints that lie outside the body. params may be NULL (the joints of
 * the mesh's own file), task too. Errors: INVALID_ARGUMENT (no file, or one without a skin; a joint after its child; no joint that moves
 * anything), INVALID_FILE, CANCELLED. It keeps the mesh alive. */
FOCAL_API focal_status focal_skeleton_bind(const focal_context* context, const focal_mesh* mesh,
                                           const focal_bind_params* params, focal_task* task,
                                           focal_skeleton** out_skeleton);

/* Whether the skeleton can be used as it is. Warnings of a skeleton that is not GOOD say what speaks against it. */
typedef int32_t focal_verdict;
enum {
  FOCAL_VERDICT_GOOD = 0,
  FOCAL_VERDICT_CHECK = 1, /* to be looked at: some of its joints may lie wrong */
  FOCAL_VERDICT_FAILED = 2 /* not to be used: the mesh is of another kind, or the skeleton is crumpled */
};

typedef struct focal_skeleton_info {
  uint32_t struct_size;
  uint32_t joint_count;
  uint32_t warning_count;       /* focal_skeleton_warning */
  uint32_t max_influences;      /* of one vertex; at most focal_skeleton_params.max_influences */
  uint64_t vertex_count;        /* of the caller's mesh */
  uint64_t unweighted_vertices; /* those that no triangle uses */
  double quality;               /* 0..1: what the verdict follows from */
  focal_verdict verdict;
  uint32_t guessed_joints; /* those without a landmark that was found: the rest of the body places them */
  uint32_t influences_per_vertex; /* of focal_skeleton_weights: 4, or 8 where more than 4 were asked for */
  uint32_t reserved;
} focal_skeleton_info;

FOCAL_API focal_status focal_skeleton_info_init(focal_skeleton_info* info, size_t struct_size);
FOCAL_API focal_status focal_skeleton_get_info(const focal_skeleton* skeleton, focal_skeleton_info* out_info);

typedef struct focal_joint {
  uint32_t struct_size;
  int32_t parent;   /* index of a joint before it; -1: a root */
  const char* name; /* lives as long as the skeleton */
  /* Probability of lying within 5 % of the longest side of the body's box of its place; 1 where it was given. */
  double confidence;
  float position[3];
  /* Quaternion x, y, z, w: from the joint's own axes, those of the training characters, to the mesh's */
  float rotation[4];
  float tip[3]; /* the far end of its part of the surface */
} focal_joint;

FOCAL_API focal_status focal_joint_init(focal_joint* joint, size_t struct_size);
FOCAL_API focal_status focal_skeleton_get_joint(const focal_skeleton* skeleton, uint32_t index,
                                                focal_joint* out_joint);

/* Influences of each of the caller's vertices, heaviest first: joint numbers and weights,
 * vertex_count x focal_skeleton_info.influences_per_vertex, which is 4 unless more were asked for. Weights sum to 1; all 0 where no triangle uses the vertex. vertex_count must be the
 * mesh's. */
FOCAL_API focal_status focal_skeleton_weights(const focal_skeleton* skeleton, uint64_t vertex_count,
                                              uint32_t* out_joints, float* out_weights);

FOCAL_API const char* focal_skeleton_warning(const focal_skeleton* skeleton, uint32_t index);

/* Writes the caller's own glTF, nothing lost, with the skeleton, a skin for every mesh it shows (see
 * focal_left_out), and the landmarks as focal_detection_write_gltf does. Same rules for the path, same errors. */
FOCAL_API focal_status focal_skeleton_write_gltf(const focal_skeleton* skeleton, const char* path);

/* Writes a VRM 1.0 avatar (.vrm or .glb): what focal_skeleton_write_gltf writes, with VRMC_vrm: the humanoid map by the joints' roles, and
 * `meta`, a JSON object of VRM's meta data with at least "name" and "authors" (a list); "licenseUrl" and what else is required are
 * filled in with VRM's defaults. VRM wants a T-pose: focal_skeleton_params.rest_pose with a model of such characters. Errors: those of
 * focal_skeleton_write_gltf; INVALID_ARGUMENT (the skeleton lacks one of the 15 joints that VRM requires, which the message names; the file came as
 * .gltf; meta without a name or authors), INVALID_FILE (meta is no JSON object). */
FOCAL_API focal_status focal_skeleton_write_vrm(const focal_skeleton* skeleton, const char* meta,
                                                const char* path);

#ifdef __cplusplus
}
#endif
#endif /* FOCAL_H */
