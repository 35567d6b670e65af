// Any sequence of calls of the C interface on tiny meshes, with handles that are good, NULL, destroyed or of another type, and
// arguments of any value. A call succeeds or says why not, and nothing is our own mistake.
#include <focal/focal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "calls_world.h"

using namespace fuzz;

namespace {

void make_mesh(World& world) {
  focal_mesh* mesh = nullptr;
  focal_mesh_params params;
  const focal_mesh_params* given = params_of(world, params, focal_mesh_params_init);
  if (given && world.choose.below(4) == 0) {
    params.weld = static_cast<int32_t>(world.choose.below(3)),
    params.drop_degenerate = static_cast<int32_t>(world.choose.below(3));
    params.max_vertices = world.choose.byte(), params.pose_time = world.choose.number();
    params.pose_animation = world.choose.below(2) ? "walk" : nullptr;
  }
  const auto* context = world.pick<focal_context>(contexts);
  switch (world.choose.below(4)) {
    case 0: {  // corners and places of any kind
      std::vector<float> positions(3 * (4 + world.choose.below(60)));
      for (float& x : positions)
        x = static_cast<float>(world.choose.below(8) ? world.choose.byte() / 16.0 : world.choose.number());
      std::vector<uint32_t> indices(world.choose.below(200));
      for (uint32_t& i : indices) i = world.choose.below(64);
      focal_mesh_desc desc;
      answered(focal_mesh_desc_init(&desc, sizeof desc));
      desc.positions = positions.data(), desc.vertex_count = positions.size() / 3;
      desc.indices = world.choose.below(16) ? indices.data() : nullptr, desc.index_count = indices.size();
      answered(focal_mesh_create(context, world.choose.below(16) ? &desc : nullptr, given, &mesh));
      break;
    }
    case 1: {  // a file with a few bytes changed
      auto file = glb();
      for (uint32_t n = world.choose.below(3); n > 0; --n)
        file[(world.choose.byte() * 256 + world.choose.byte()) % file.size()] =
            static_cast<unsigned char>(world.choose.byte());
      answered(focal_mesh_load_gltf_memory(context, file.data(), file.size() - world.choose.below(3), given,
                                           &mesh));
      break;
    }
    default: {  // a good one
      shape body = shape_create(6, static_cast<float>(world.choose.byte()) / 1000);
      const focal_mesh_desc desc = shape_desc(&body);
      answered(focal_mesh_create(context, &desc, given, &mesh));
      shape_destroy(&body);
    }
  }
  world.keep(meshes, mesh);
}

void look_at_mesh(World& world) {
  const auto* mesh = world.pick<focal_mesh>(meshes);
  focal_mesh_info info;
  focal_surface_point point{world.choose.byte(), {static_cast<float>(world.choose.number()), 0.5F, 0.25F}};
  float position[3];
  if (answered(focal_mesh_info_init(&info, sizeof info)) == FOCAL_OK &&
      answered(focal_mesh_get_info(mesh, &info)) == FOCAL_OK) {
    fuzz::insist(std::isfinite(info.surface_area) && info.surface_area > 0, "a mesh has an area");
    fuzz::insist(focal_mesh_positions(mesh) && focal_mesh_triangles(mesh), "a mesh has its arrays");
    for (uint32_t i = 0; i < info.warning_count; ++i)
      fuzz::insist(focal_mesh_warning(mesh, i) != nullptr, "warnings exist");
  }
  answered(focal_mesh_position_of(mesh, world.choose.below(8) ? &point : nullptr, position));
  if (answered(focal_mesh_point_at_vertex(mesh, world.choose.byte(), &point)) == FOCAL_OK)
    fuzz::insist(answered(focal_mesh_position_of(mesh, &point, position)) == FOCAL_OK,
                 "a vertex has a place");
}

const char* some_template(World& world) {
  return world.choose.below(4) == 0
             ? "{\"format\": 3}"
             : "{\"format\":\"focal-skeleton-template\",\"version\":1,\"joints\":[{\"name\":\"a\","
               "\"surface\":[\"nose\"]},{\"name\":\"b\",\"parent\":\"a\",\"centre\":[\"hand.L\"]}]}";
}

void fill_set(World& world) {
  focal_training_set* set = world.pick<focal_training_set>(sets);
  const auto* mesh = world.pick<focal_mesh>(meshes);
  uint32_t vertices[4];
  focal_surface_point points[4];
  for (int i = 0; i < 4; ++i) {
    vertices[i] = world.choose.below(8) ? world.choose.below(70) : FOCAL_NO_VERTEX;
    points[i] = {
        world.choose.byte(),
        {static_cast<float>(world.choose.number()), static_cast<float>(world.choose.number()), 0.5F}};
  }
  const uint64_t count = world.choose.below(8) ? uint32_t{SHAPE_MARKS} : world.choose.below(5);
  switch (world.choose.below(5)) {
    case 4:
      answered(focal_training_set_set_skeleton(set, some_template(world)));
      break;
    case 0:
      answered(focal_training_set_add(set, mesh, points, count));
      break;
    case 1:
      answered(focal_training_set_add_rig(set, mesh));
      break;
    default:
      answered(focal_training_set_add_vertices(set, mesh, vertices, count));
  }
  focal_training_set_landmark_count(set), focal_training_set_mesh_count(set);
}

void train(World& world) {
  if (world.trainings++ || world.choose.below(4)) return;  // the slow one
  focal_model* model = nullptr;
  focal_train_params params;
  answered(focal_train_params_init(&params, sizeof params));
  if (world.choose.below(16) == 0)
    answered(focal_train_params_set_preset(&params, static_cast<focal_preset>(world.choose.below(3))));
  params.learn_confidence = world.choose.below(8) == 0,
  params.tree_count = static_cast<int32_t>(world.choose.below(4));
  params.eigenpair_count =
      static_cast<int32_t>(world.choose.below(8) ? 8 + world.choose.below(16) : world.choose.byte() * 10);
  params.max_samples_per_shape = static_cast<int32_t>(world.choose.below(60));
  params.sampling_rate = world.choose.below(8) ? 1 : world.choose.number();
  answered(focal_model_train(world.pick<focal_training_set>(sets), &params, world.pick<focal_task>(tasks),
                             &model));
  world.keep(models, model);
}

void load_or_save(World& world) {
  focal_model* model = nullptr;
  focal_blob* blob = nullptr;
  focal_model_info info;
  if (world.choose.below(3) == 0) {
    if (answered(focal_model_save_memory(world.pick<focal_model>(models), &blob)) != FOCAL_OK) return;
    world.keep(blobs, blob);
    answered(focal_model_load_memory(world.pick<focal_context>(contexts), focal_blob_data(blob),
                                     focal_blob_size(blob), &model));
  } else {
    auto file = model_bytes();
    if (world.choose.below(4) == 0)
      file[world.choose.byte() % file.size()] ^= static_cast<unsigned char>(world.choose.byte());
    answered(focal_model_load_memory(world.pick<focal_context>(contexts), file.data(),
                                     file.size() - world.choose.below(2), &model));
  }
  world.keep(models, model);
  answered(focal_model_info_init(&info, sizeof info));
  if (focal_model_get_info(world.pick<focal_model>(models), &info) == FOCAL_OK)
    fuzz::insist(info.landmark_count > 0, "a model has landmarks");
  focal_model_landmark_name(world.pick<focal_model>(models), world.choose.byte());
  focal_model_joint_name(world.pick<focal_model>(models), world.choose.byte());
  focal_model_skeleton_template(world.pick<focal_model>(models));
}

void detect(World& world) {
  if (world.detections_made++ > 1) return;
  focal_detection* detection = nullptr;
  focal_analysis* analysis = nullptr;
  focal_detect_params params;
  const focal_detect_params* given = params_of(world, params, focal_detect_params_init);
  focal_surface_point fixed[SHAPE_MARKS] = {
      {world.choose.byte(), {1, 0, 0}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}};
  if (given && world.choose.below(2)) {
    params.quality = static_cast<focal_quality>(world.choose.below(3)),
    params.sampling_rate = world.choose.number();
    params.max_samples = static_cast<int32_t>(world.choose.byte()),
    params.peaks_per_landmark = static_cast<int32_t>(world.choose.below(70));
    params.keep_votes = static_cast<int32_t>(world.choose.below(3)),
    params.found_confidence = world.choose.number();
    if (world.choose.below(2))
      params.fixed_points = fixed,
      params.fixed_point_count = world.choose.below(8) ? uint32_t{SHAPE_MARKS} : 1;
  }
  const auto* model = world.pick<focal_model>(models);
  const auto* mesh = world.pick<focal_mesh>(meshes);
  focal_task* task = world.pick<focal_task>(tasks);
  if (world.choose.below(3)) {
    answered(focal_model_detect(model, mesh, given, task, &detection));
  } else {
    answered(focal_model_analyse(model, mesh, given, task, &analysis));
    world.keep(analyses, analysis);
    answered(
        focal_model_detect_analysis(model, world.pick<focal_analysis>(analyses), given, task, &detection));
  }
  world.keep(detections, detection);
}

void look_at_detection(World& world) {
  const auto* detection = world.pick<focal_detection>(detections);
  focal_landmark landmark;
  focal_detection_info info;
  answered(focal_landmark_init(&landmark, sizeof landmark)),
      answered(focal_detection_info_init(&info, sizeof info));
  if (answered(focal_detection_get_info(detection, &info)) != FOCAL_OK) return;
  for (uint32_t i = 0; i < info.landmark_count; ++i) {
    fuzz::insist(answered(focal_detection_get_landmark(detection, i, &landmark)) == FOCAL_OK,
                 "landmarks exist");
    fuzz::insist(landmark.confidence >= 0 && landmark.confidence <= 1, "confidence is a probability");
    if (landmark.point.triangle == FOCAL_NO_TRIANGLE) continue;
    fuzz::insist(landmark.point.triangle < info.triangle_count && landmark.vertex < info.vertex_count,
                 "places exist");
    for (const float x : landmark.position) fuzz::insist(std::isfinite(x), "positions are finite");
  }
  answered(focal_detection_get_landmark(detection, world.choose.byte(), &landmark));
  const uint64_t count = world.choose.below(8) ? info.vertex_count : world.choose.byte();
  std::vector<float> values(std::max<uint64_t>(count, 1));
  std::vector<int32_t> labels(info.triangle_count);
  const uint32_t call = world.choose.below(4), which = world.choose.below(5);
  if (call == 0) answered(focal_detection_votes(detection, which, count, values.data()));
  if (call == 1) answered(focal_detection_distances(detection, which, count, values.data()));
  if (call == 2)
    answered(focal_detection_region(detection, which, world.choose.number(), count, values.data()));
  if (call == 3)
    answered(focal_detection_segment(detection, static_cast<focal_segmentation>(which),
                                     world.pick<focal_task>(tasks), info.triangle_count, labels.data()));
}

void use_detection(World& world) {
  if (world.choose.below(2)) {
    focal_correspondence* map = nullptr;
    answered(focal_correspondence_create(world.pick<focal_detection>(detections),
                                         world.pick<focal_detection>(detections),
                                         world.pick<focal_task>(tasks), &map));
    world.keep(maps, map);
    std::vector<focal_surface_point> points(200);
    answered(focal_correspondence_points(map, world.choose.below(2) ? 74 : world.choose.below(200),
                                         points.data()));
    return;
  }
  focal_skeleton* skeleton = nullptr;
  focal_skeleton_params params;
  const focal_skeleton_params* given = params_of(world, params, focal_skeleton_params_init);
  if (given) {
    params.names = static_cast<focal_bone_names>(world.choose.below(7)),
    params.symmetric = static_cast<int32_t>(world.choose.below(3));
    params.rest_pose = static_cast<int32_t>(world.choose.below(5));
    params.drop_helpers = static_cast<int32_t>(world.choose.below(3));
    params.max_influences = static_cast<int32_t>(world.choose.below(10));
    params.skeleton_template = some_template(world);
  }
  answered(focal_skeleton_create(world.pick<focal_detection>(detections), given,
                                 world.pick<focal_task>(tasks), &skeleton));
  world.keep(skeletons, skeleton);
  focal_joint joint;
  answered(focal_joint_init(&joint, sizeof joint));
  answered(focal_skeleton_get_joint(world.pick<focal_skeleton>(skeletons), world.choose.below(4), &joint));
}

void handle_tasks(World& world) {
  focal_task* made = nullptr;
  const uint32_t call = world.choose.below(4);
  if (call == 0) return answered(focal_task_create(&made)), world.keep(tasks, made);
  auto* task = world.pick<focal_task>(tasks);
  if (call == 1) answered(focal_task_cancel(task));
  if (call == 2) answered(focal_task_reset(task));
  if (call == 3) focal_task_progress(task), focal_task_stage(task);
}

void make_set(World& world) {
  focal_training_set* set = nullptr;
  const char* names[SHAPE_MARKS] = {"nose", "hand.L", world.choose.below(8) ? "tail" : "nose"};
  answered(
      focal_training_set_create(world.pick<focal_context>(contexts), world.choose.below(8) ? names : nullptr,
                                world.choose.below(8) ? uint32_t{SHAPE_MARKS} : world.choose.below(4), &set));
  world.keep(sets, set);
}

void destroy_one(World& world) {
  const auto kind = static_cast<Kind>(world.choose.below(kinds));
  if (!world.handles[kind].empty())  // it stays in the list: a stale handle
    world.destroy(kind, world.handles[kind][world.choose.byte() % world.handles[kind].size()]);
}

void start(World& world) {
  focal_context* context = nullptr;
  focal_context_params params;
  answered(focal_context_params_init(&params, sizeof params));
  params.thread_count = 1;
  fuzz::insist(answered(focal_context_create(&params, &context)) == FOCAL_OK, "a context is made");
  world.keep(contexts, context);
  focal_model* model = nullptr;
  answered(focal_model_load_memory(context, model_bytes().data(), model_bytes().size(), &model));
  world.keep(models, model), world.keep(meshes, shape_mesh(context, 6, 0.02F));
  world.keep(sets, shape_training_set(context, 6, 2));
}

}  // namespace

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr void (*calls[])(World&) = {make_mesh,    look_at_mesh, fill_set,          train,
                                       load_or_save, detect,       look_at_detection, use_detection,
                                       handle_tasks, make_set,     destroy_one};
  model_bytes();
  World world{{data, size}, {}};
  start(world);
  for (int call = 0; call < 40 && !world.choose.ended(); ++call)
    calls[world.choose.below(std::size(calls))](world);
  return 0;
}
