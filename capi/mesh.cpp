// The caller's triangles, or those of a glTF file, made ready to be analysed.
#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "arguments.h"
#include "base/stopwatch.h"
#include "boundary.h"
#include "mesh/closest_point.h"
#include "objects.h"
#include "structs.h"

using namespace focal;

namespace {

focal_mesh_params default_mesh_params() {
  const PrepareParams prepare;
  const GltfReadParams read;
  focal_mesh_params params{};
  params.weld = prepare.weld;
  params.drop_degenerate = prepare.drop_degenerate;
  params.surface = static_cast<focal_surface>(prepare.analysed);
  params.lenient = prepare.lenient;
  params.allow_external_files = read.allow_external_files;
  params.keep_source_file = 1;
  params.max_vertices = static_cast<uint64_t>(read.limits.vertices);
  params.max_triangles = static_cast<uint64_t>(read.limits.triangles);
  params.max_nodes = static_cast<uint64_t>(read.limits.nodes);
  params.max_json_bytes = static_cast<uint64_t>(read.limits.json_bytes);
  params.max_file_bytes = static_cast<uint64_t>(read.limits.file_bytes);
  return params;
}

}  // namespace

FOCAL_STRUCT(focal_mesh_desc, sizeof(focal_mesh_desc));
FOCAL_STRUCT_WITH_DEFAULTS(focal_mesh_params, 64, default_mesh_params);
static_assert(sizeof(void*) != 8 ||
              (sizeof(focal_mesh_params) == 96 && offsetof(focal_mesh_params, max_vertices) == 24 &&
               offsetof(focal_mesh_params, pose_time) == 72 && offsetof(focal_mesh_params, lenient) == 80 &&
               offsetof(focal_mesh_params, task) == 88));

namespace {

focal_mesh_params checked(const focal_mesh_params* given) {
  const focal_mesh_params params = read_struct(given);
  check_flag("focal_mesh_params.weld", params.weld);
  check_flag("focal_mesh_params.drop_degenerate", params.drop_degenerate);
  check_range("focal_mesh_params.surface", params.surface, FOCAL_SURFACE_AUTO, FOCAL_SURFACE_WRAPPED);
  check_flag("focal_mesh_params.allow_external_files", params.allow_external_files);
  check_flag("focal_mesh_params.keep_source_file", params.keep_source_file);
  // Vertices and triangles are counted in 32 bits inside.
  constexpr double most = std::numeric_limits<int32_t>::max();
  check_range("focal_mesh_params.max_vertices", static_cast<double>(params.max_vertices), 1, most);
  check_range("focal_mesh_params.max_triangles", static_cast<double>(params.max_triangles), 1, most);
  check_range("focal_mesh_params.max_nodes", static_cast<double>(params.max_nodes), 1, most);
  check_range("focal_mesh_params.max_json_bytes", static_cast<double>(params.max_json_bytes), 1, 0x1p40);
  check_range("focal_mesh_params.max_file_bytes", static_cast<double>(params.max_file_bytes), 1, 0x1p40);
  check_range("focal_mesh_params.pose_time", params.pose_time, 0, 1e9);
  check_flag("focal_mesh_params.lenient", params.lenient);
  check_flag("focal_mesh_params.keep_scenery", params.keep_scenery);
  return params;
}

GltfReadParams read_params(const focal_mesh_params& params) {
  GltfReadParams read;
  read.limits.vertices = static_cast<int64_t>(params.max_vertices);
  read.limits.triangles = static_cast<int64_t>(params.max_triangles);
  read.limits.nodes = static_cast<int64_t>(params.max_nodes);
  read.limits.json_bytes = static_cast<int64_t>(params.max_json_bytes);
  read.limits.file_bytes = static_cast<int64_t>(params.max_file_bytes);
  read.allow_external_files = params.allow_external_files != 0;
  read.lenient = params.lenient != 0;
  read.hidden_too = params.keep_scenery != 0;
  return read;
}

void check_desc(const focal_mesh_desc& desc) {
  require(desc.positions, "focal_mesh_desc.positions");
  require(desc.indices, "focal_mesh_desc.indices");
  if (desc.position_stride != 0 && (desc.position_stride < 12 || desc.position_stride % 4 != 0))
    throw Error(
        Status::invalid_argument,
        "focal_mesh_desc.position_stride is " + std::to_string(desc.position_stride),
        "give the bytes from one vertex to the next, a multiple of 4 from 12 up, or 0 for packed positions");
  if (desc.index_count % 3 != 0)
    throw Error(Status::invalid_argument, "focal_mesh_desc.index_count is not a multiple of 3",
                "give three indices for each triangle");
}

void check_size(std::span<const MeshPart> ranges, const focal_mesh_params& params) {
  const auto is_too_large = [&](const MeshPart& one) {  // each number first: their sum must not wrap round
    return one.vertex_count > params.max_vertices || one.triangle_count > params.max_triangles ||
           one.first_vertex + one.vertex_count > params.max_vertices ||
           one.first_triangle + one.triangle_count > params.max_triangles;
  };
  if (std::any_of(ranges.begin(), ranges.end(), is_too_large))
    throw Error(Status::unsupported, "the mesh has more vertices or triangles than allowed",
                "raise focal_mesh_params.max_vertices and max_triangles");
}

// Appends a part. lenient: an index out of range becomes -1, which prepare leaves out.
void add_part(const focal_mesh_desc& desc, const MeshPart& part, bool lenient, TriangleMesh& mesh) {
  const size_t stride = desc.position_stride ? desc.position_stride / sizeof(float) : 3;
  for (uint64_t v = 0; v < desc.vertex_count; ++v)
    for (int i = 0; i < 3; ++i)
      mesh.positions(static_cast<Eigen::Index>(part.first_vertex + v), i) =
          desc.positions[static_cast<size_t>(v) * stride + i];
  for (uint64_t i = 0; i < desc.index_count; ++i) {
    const bool exists = desc.indices[i] < desc.vertex_count;
    if (!exists && !lenient)
      throw Error(Status::invalid_mesh,
                  "triangle " + std::to_string(i / 3) + " names vertex " + std::to_string(desc.indices[i]) +
                      ", the mesh has " + std::to_string(desc.vertex_count),
                  "indices run from 0 to vertex_count - 1");
    mesh.triangles.data()[3 * part.first_triangle + i] =
        exists ? static_cast<int32_t>(part.first_vertex + desc.indices[i]) : -1;
  }
}

std::vector<MeshPart> ranges_of(std::span<const focal_mesh_desc> parts) {
  std::vector<MeshPart> ranges;
  MeshPart next;
  for (const focal_mesh_desc& desc : parts) {
    next.vertex_count = desc.vertex_count, next.triangle_count = desc.index_count / 3;
    ranges.push_back(next);
    next.first_vertex += next.vertex_count, next.first_triangle += next.triangle_count;
  }
  return ranges;
}

TriangleMesh mesh_of(std::span<const focal_mesh_desc> parts, std::span<const MeshPart> ranges, bool lenient) {
  const MeshPart& last = ranges.back();
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(last.first_vertex + last.vertex_count), 3);
  mesh.triangles.resize(static_cast<Eigen::Index>(last.first_triangle + last.triangle_count), 3);
  for (size_t i = 0; i < parts.size(); ++i) add_part(parts[i], ranges[i], lenient, mesh);
  return mesh;
}

// As scenery is judged and named.
std::vector<MeshPiece> pieces_of(std::span<const MeshPart> ranges) {
  std::vector<MeshPiece> pieces;
  if (ranges.size() < 2) return pieces;
  for (const MeshPart& range : ranges)
    pieces.push_back({"part " + std::to_string(pieces.size()), static_cast<int32_t>(range.first_triangle),
                      static_cast<int32_t>(range.triangle_count)});
  return pieces;
}

// What prepare leaves out, as the getters and the writers need it.
void note_scenery(const PreparedMesh& mesh, std::span<const MeshPiece> pieces,
                  std::span<GltfPrimitive> primitives, MeshObject& object) {
  for (const Scenery& one : mesh.scenery) {
    object.left_out.push_back({static_cast<int32_t>(one.kind),
                               pieces.empty() ? "the mesh" : pieces[one.piece].name, one.triangle_count,
                               one.whole_piece});
    if (pieces.empty() || !one.whole_piece) continue;
    const MeshPiece& piece = pieces[one.piece];
    for (GltfPrimitive& primitive : primitives) {
      const int32_t from_first = primitive.first_triangle - piece.first_triangle;
      primitive.is_scenery |= from_first >= 0 && from_first < piece.triangle_count;
    }
  }
}

// Prepares the surface and fills what the getters answer with.
void finish(MeshObject& object, TriangleMesh source, std::vector<MeshPiece> pieces,
            std::span<GltfPrimitive> primitives, const focal_mesh_params& params,
            const Execution& execution) {
  Stopwatch watch;
  PrepareParams prepare_params;
  prepare_params.weld = params.weld != 0;
  prepare_params.drop_degenerate = params.drop_degenerate != 0;
  prepare_params.analysed = static_cast<AnalysedSurface>(params.surface);
  prepare_params.lenient = params.lenient != 0;
  prepare_params.leave_out_scenery = params.keep_scenery == 0;
  prepare_params.pieces = std::move(pieces);
  execution.begin_stage("repair", 0.5, 1);
  auto mesh = std::make_shared<const PreparedMesh>(prepare(std::move(source), prepare_params, execution));
  const MatrixX3& positions = mesh->source.positions;
  object.positions.assign(positions.data(), positions.data() + positions.size());
  object.mean_edge_length = mesh->scale * mean_edge_length(mesh->surface);
  object.surface_area = mesh->scale * mesh->scale * surface_area(mesh->surface);
  object.warnings.insert(object.warnings.end(), mesh->warnings.begin(), mesh->warnings.end());
  note_scenery(*mesh, prepare_params.pieces, primitives, object);
  object.mesh = std::move(mesh);
  object.repair_seconds = watch.lap();
}

focal_mesh* made_of(const focal_context* context, std::span<const focal_mesh_desc* const> given,
                    const focal_mesh_params* params) {
  const auto running = resolve<ContextObject>(context);
  std::vector<focal_mesh_desc> parts;
  for (const focal_mesh_desc* one : given) require_struct(one), parts.push_back(read_struct(one));
  const focal_mesh_params how = checked(params);
  for (const focal_mesh_desc& one : parts) check_desc(one);
  const std::vector<MeshPart> ranges = ranges_of(parts);
  check_size(ranges, how);
  const TaskLease lease(how.task);
  const auto object = std::make_shared<MeshObject>();
  object->parts = ranges;
  finish(*object, mesh_of(parts, ranges, how.lenient != 0), pieces_of(ranges), {}, how,
         running->execution_with(lease.task()));
  running->report_warnings(object->warnings);
  return publish(object, *running);
}

// open(how) gives a GltfDocument.
template <class Open>
focal_mesh* load(const focal_context* context, const focal_mesh_params* given, std::string name,
                 Open&& open) {
  const auto running = resolve<ContextObject>(context);
  const focal_mesh_params params = checked(given);
  const GltfReadParams how = read_params(params);
  const TaskLease lease(params.task);
  const Execution execution = running->execution_with(lease.task());
  const auto object = std::make_shared<MeshObject>();
  Stopwatch watch;
  execution.begin_stage("reading", 0, 0.5);
  const GltfDocument document = open(how);
  GltfMesh gltf = document.mesh();
  execution.check_cancelled();
  if (params.pose_animation) pose(document, params.pose_animation, params.pose_time, gltf);
  object->load_seconds = watch.lap();
  object->name = std::move(name);
  for (const GltfPrimitive& one : gltf.primitives)
    object->parts.push_back({static_cast<uint64_t>(one.first_vertex), static_cast<uint64_t>(one.vertex_count),
                             static_cast<uint64_t>(one.first_triangle),
                             static_cast<uint64_t>(one.triangle_count)});
  object->warnings = std::move(gltf.warnings);
  for (std::string& hidden : gltf.hidden)
    object->left_out.push_back({FOCAL_SCENERY_HIDDEN, std::move(hidden)});
  finish(*object, std::move(gltf.mesh), std::move(gltf.pieces), gltf.primitives, params, execution);
  if (params.keep_source_file != 0 && !params.pose_animation)
    object->file = std::make_shared<const SourceFile>(SourceFile{document, std::move(gltf.primitives)});
  running->report_warnings(object->warnings);
  return publish(object, *running);
}

}  // namespace

const SourceFile& focal::file_of(const MeshObject& mesh, const char* missing, const std::string& way_out) {
  if (mesh.file) return *mesh.file;
  throw Error(Status::invalid_argument, missing,
              way_out + "load it with focal_mesh_load_gltf and focal_mesh_params.keep_source_file 1");
}

focal_status focal_mesh_create(const focal_context* context, const focal_mesh_desc* desc,
                               const focal_mesh_params* params, focal_mesh** out_mesh) {
  return guarded([&] {
    require(out_mesh, "out_mesh");
    *out_mesh = made_of(context, std::span(&desc, 1), params);
  });
}

focal_status focal_mesh_create_parts(const focal_context* context, const focal_mesh_desc* const* parts,
                                     uint64_t part_count, const focal_mesh_params* params,
                                     focal_mesh** out_mesh) {
  return guarded([&] {
    require(out_mesh, "out_mesh");
    require(parts, "parts");
    check_range("part_count", static_cast<double>(part_count), 1, 65536);
    *out_mesh = made_of(context, std::span(parts, part_count), params);
  });
}

focal_status focal_mesh_load_gltf(const focal_context* context, const char* path,
                                  const focal_mesh_params* params, focal_mesh** out_mesh) {
  return guarded([&] {
    require(out_mesh, "out_mesh");
    const auto file = path_of(path);
    naming_file(file, [&] {
      *out_mesh = load(context, params, text_of(file.filename()),
                       [&](const GltfReadParams& how) { return GltfDocument::open(file, how); });
    });
  });
}

focal_status focal_mesh_load_gltf_memory(const focal_context* context, const void* data, uint64_t size,
                                         const focal_mesh_params* params, focal_mesh** out_mesh) {
  return guarded([&] {
    require(out_mesh, "out_mesh");
    const auto bytes = bytes_of(data, size);
    *out_mesh = load(context, params, "", [&](const GltfReadParams& how) {
      return GltfDocument({bytes.begin(), bytes.end()}, how);
    });
  });
}

focal_status focal_mesh_destroy(focal_mesh* mesh) { return remove_handle(mesh, HandleType::mesh); }

const float* focal_mesh_positions(const focal_mesh* mesh) {
  return guarded_value<const float*>([&] { return resolve<MeshObject>(mesh)->positions.data(); });
}

const uint32_t* focal_mesh_triangles(const focal_mesh* mesh) {
  // Every index is >= 0, and the signed and unsigned type of one size may stand for each other.
  return guarded_value<const uint32_t*>([&] {
    return reinterpret_cast<const uint32_t*>(resolve<MeshObject>(mesh)->mesh->source.triangles.data());
  });
}

focal_status focal_mesh_position_of(const focal_mesh* mesh, const focal_surface_point* point,
                                    float* out_position) {
  return guarded([&] {
    require(point, "point");
    require(out_position, "out_position");
    const auto prepared = resolve<MeshObject>(mesh)->mesh;
    const SurfacePoint on_surface = point_in(*prepared, *point, "the point");
    position_out(position_of(prepared->source, to_source(*prepared, on_surface)), out_position);
  });
}

focal_status focal_mesh_point_at_vertex(const focal_mesh* mesh, uint32_t vertex,
                                        focal_surface_point* out_point) {
  return guarded([&] {
    require(out_point, "out_point");
    const auto prepared = resolve<MeshObject>(mesh)->mesh;
    *out_point = point_out(to_source(*prepared, vertex_in(*prepared, vertex, "the point")));
  });
}

focal_status focal_mesh_closest_point(const focal_mesh* mesh, const float* position,
                                      focal_surface_point* out_point) {
  return guarded([&] {
    require(position, "position");
    require(out_point, "out_point");
    const auto prepared = resolve<MeshObject>(mesh)->mesh;
    const Vector3 place(position[0], position[1], position[2]);
    if (!place.allFinite())
      throw Error(Status::invalid_argument, "the position is not finite", "give three finite numbers");
    const SurfaceQuery query{(place - prepared->centre) / prepared->scale, Vector3::Zero()};
    const double radius = 0.1;  // surfaces have area 1
    *out_point = point_out(to_source(*prepared, closest_points(prepared->surface, {&query, 1}, radius)[0]));
  });
}

focal_status focal_mesh_write_wrap_gltf(const focal_mesh* mesh, const char* path) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    const auto file = path_of(path);
    check_suffix(file, true);
    const PreparedMesh& prepared = *object->mesh;
    const TriangleMesh shell = in_source_coordinates(wrapped(prepared).source, prepared);
    write_file_atomically(file, write_glb(shell, {}, "wrap"));
  });
}
