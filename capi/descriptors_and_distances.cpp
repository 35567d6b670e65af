// What training learns from, to look at: descriptors, distances, symmetry planes, regressed distances.
#include <algorithm>
#include <string>
#include <vector>

#include "arguments.h"
#include "boundary.h"
#include "descriptors/descriptor.h"
#include "geodesics/distance.h"
#include "landmarks/regress.h"
#include "objects.h"
#include "paper/symmetry_plane.h"
#include "structs.h"

using namespace focal;

FOCAL_STRUCT(focal_symmetry_plane, 32);
static_assert(sizeof(focal_symmetry_plane) == 32 && offsetof(focal_symmetry_plane, support) == 24);
static_assert(FOCAL_DESCRIPTOR_UNIQUE_SHAPE_CONTEXT == 4 && FOCAL_DISTANCE_COMMUTE_TIME == 3);

namespace {

template <class Kind>
const Kind& kind_at(std::span<const Kind> kinds, int32_t number, const char* things) {
  check_index(number < 0 ? kinds.size() : static_cast<uint64_t>(number), kinds.size(), "the library", things);
  return kinds[number];
}
const DescriptorKind& descriptor_at(int32_t number) {
  return kind_at(descriptor_kinds(), number, "descriptors");
}
const DistanceKind& distance_at(int32_t number) { return kind_at(distance_kinds(), number, "distances"); }

}  // namespace

uint32_t focal_descriptor_count(void) { return static_cast<uint32_t>(descriptor_kinds().size()); }

uint32_t focal_distance_count(void) { return static_cast<uint32_t>(distance_kinds().size()); }

const char* focal_descriptor_name(focal_descriptor descriptor) {
  return guarded_value<const char*>([&] { return descriptor_at(descriptor).name.data(); });
}

const char* focal_distance_name(focal_distance distance) {
  return guarded_value<const char*>([&] { return distance_at(distance).name.data(); });
}

uint32_t focal_descriptor_dimension(focal_descriptor descriptor) {
  return guarded_value<uint32_t>([&] { return descriptor_at(descriptor).dimension; });
}

focal_status focal_mesh_describe(const focal_context* context, const focal_mesh* mesh,
                                 focal_descriptor descriptor, const uint32_t* vertices, uint64_t vertex_count,
                                 focal_task* task, float* out_values) {
  return guarded([&] {
    require(out_values, "out_values");
    require(vertices, "vertices");
    const auto running = resolve<ContextObject>(context);
    const auto object = resolve<MeshObject>(mesh);
    const DescriptorKind& kind = descriptor_at(descriptor);
    std::vector<int32_t> rows;
    for (uint64_t i = 0; i < vertex_count; ++i) {
      vertex_in(*object->mesh, vertices[i], "vertex " + std::to_string(vertices[i]));
      rows.push_back(object->mesh->surface_vertex[vertices[i]]);
    }
    const TaskLease lease(task);
    const RowMatrixf values =
        describe(*object->mesh, kind, rows, running->execution_with(lease.task())).cast<float>();
    std::copy_n(values.data(), values.size(), out_values);
  });
}

focal_status focal_mesh_distances(const focal_context* context, const focal_mesh* mesh,
                                  focal_distance distance, const focal_surface_point* source,
                                  focal_task* task, uint64_t vertex_count, float* out_distances) {
  return guarded([&] {
    require(out_distances, "out_distances");
    require(source, "source");
    const auto running = resolve<ContextObject>(context);
    const auto object = resolve<MeshObject>(mesh);
    const DistanceKind& kind = distance_at(distance);
    check_count("vertex_count", vertex_count, object->mesh->surface_vertex.size(), "the mesh", "vertices");
    const SurfacePoint place = point_in(*object->mesh, *source, "the source");
    const TaskLease lease(task);
    const auto distances = distances_on(*object->mesh, kind, place, running->execution_with(lease.task()));
    std::copy(distances.begin(), distances.end(), out_distances);
  });
}

focal_status focal_mesh_symmetry_plane(const focal_context* context, const focal_mesh* mesh, uint64_t seed,
                                       focal_task* task, focal_symmetry_plane* out_plane) {
  return guarded([&] {
    check_result(out_plane);
    const auto running = resolve<ContextObject>(context);
    const PreparedMesh& prepared = *resolve<MeshObject>(mesh)->mesh;
    const TaskLease lease(task);
    const Execution execution = running->execution_with(lease.task());
    execution.begin_stage("symmetry", 0, 1);
    const SymmetryPlane plane = symmetry_plane(prepared.surface, seed, execution);
    focal_symmetry_plane result{};
    position_out(plane.normal, result.normal);
    result.offset = prepared.scale * plane.offset + plane.normal.dot(prepared.centre);
    result.support = plane.support;
    write_result(out_plane, result);
  });
}

uint64_t focal_analysis_sample_count(const focal_analysis* analysis) {
  return guarded_value<uint64_t>([&] { return resolve<AnalysisObject>(analysis)->analysis.samples.size(); });
}

focal_status focal_model_regress(const focal_model* model, const focal_analysis* analysis, uint32_t index,
                                 const focal_surface_point* truth, focal_task* task, uint64_t sample_count,
                                 float* out_regressed, float* out_true) {
  return guarded([&] {
    require(out_regressed, "out_regressed");
    require(out_true, "out_true");
    require(truth, "truth");
    const auto object = resolve<ModelObject>(model);
    const auto analysed = resolve<AnalysisObject>(analysis);
    check_index(index, object->info.landmark_names.size(), "the model", "landmarks");
    check_count("sample_count", sample_count, analysed->analysis.samples.size(), "the analysis", "samples");
    const SurfacePoint place = point_in(*analysed->mesh->mesh, *truth, "the truth");
    const TaskLease lease(task);
    const Execution execution = object->context->execution_with(lease.task());
    execution.begin_stage("regression", 0, 1);
    const Regression result =
        regress(*object->model, analysed->analysis, static_cast<int32_t>(index), place, execution);
    std::copy_n(result.regressed.data(), result.regressed.size(), out_regressed);
    std::copy_n(result.truth.data(), result.truth.size(), out_true);
  });
}
