#include "model.h"

#include <limits>
#include <string>
#include <utility>

#include "arguments.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "blob.h"
#include "boundary.h"
#include "descriptors/descriptor.h"
#include "geodesics/distance.h"
#include "landmarks/train.h"
#include "model/landmark_model.h"
#include "model/model_file.h"
#include "skeleton/detail_training.h"
#include "skeleton_template.h"
#include "structs.h"
#include "task.h"
#include "training_set.h"

namespace focal {
namespace {

focal_train_params to_abi(const TrainParams& params) {
  focal_train_params result{};
  result.preset = static_cast<focal_preset>(params.preset);
  result.eigenpair_count = params.eigenpair_count;
  result.tree_count = params.tree_count;
  result.min_leaf_samples = params.min_leaf_samples;
  result.components_per_split = params.components_per_split;
  result.sampling_rate = params.sampling_rate;
  result.max_samples_per_shape = params.max_samples_per_shape;
  result.proxy_vertices = params.proxy_vertices;
  result.seed = params.seed;
  result.learn_confidence = params.learns_confidence;
  result.rigged_shapes = RiggedShapesParams{}.shapes;
  result.descriptor = params.descriptor;
  result.distance = params.distance;
  return result;
}

Preset checked_preset(focal_preset preset) {
  check_range("focal_train_params.preset", preset, FOCAL_PRESET_DEFAULT, FOCAL_PRESET_PAPER);
  return static_cast<Preset>(preset);
}

// What does not stand in the parameters: the shapes learned of rigged characters.
focal_train_params abi_params_of(const ModelObject& object) {
  focal_train_params result = to_abi(object.info.params);
  if (object.learned_skeleton()) result.rigged_shapes = object.info.shape_count;
  return result;
}

}  // namespace

uint64_t ModelObject::file_bytes() const {
  return file_bytes_.get([&] { return serialise(*model).size(); });
}

template <>
struct StructTraits<focal_train_params> {
  static constexpr const char* name = "focal_train_params";
  static constexpr size_t first_size = 48;
  static focal_train_params defaults() { return to_abi(TrainParams::from_preset(Preset::default_preset)); }
};
static_assert(sizeof(focal_train_params) == 64 && offsetof(focal_train_params, distance) == 60);

template <>
struct StructTraits<focal_model_info> {
  static constexpr const char* name = "focal_model_info";
  static constexpr size_t first_size = 48;
  static focal_model_info defaults() { return {}; }
};
static_assert(sizeof(focal_model_info) == 48 && offsetof(focal_model_info, file_bytes) == 40);

namespace {

TrainParams checked(const focal_train_params* given) {
  const focal_train_params params = read_struct(given);
  constexpr double most = std::numeric_limits<int32_t>::max();
  TrainParams result = TrainParams::from_preset(checked_preset(params.preset));
  check_range("focal_train_params.eigenpair_count", params.eigenpair_count, 8, 2000);
  check_range("focal_train_params.tree_count", params.tree_count, 1, 10000);
  check_range("focal_train_params.min_leaf_samples", params.min_leaf_samples, 1, most);
  check_range("focal_train_params.components_per_split", params.components_per_split, 1, most);
  check_range("focal_train_params.sampling_rate", params.sampling_rate, 1e-6, 1);
  check_range("focal_train_params.max_samples_per_shape", params.max_samples_per_shape, 1, most);
  check_range("focal_train_params.proxy_vertices", params.proxy_vertices, 0, most);
  check_flag("focal_train_params.learn_confidence", params.learn_confidence);
  check_range("focal_train_params.rigged_shapes", params.rigged_shapes, 2, 10000);
  check_range("focal_train_params.descriptor", params.descriptor, 0,
              static_cast<double>(descriptor_kinds().size() - 1));
  check_range("focal_train_params.distance", params.distance, 0,
              static_cast<double>(distance_kinds().size() - 1));
  result.eigenpair_count = params.eigenpair_count;
  result.tree_count = params.tree_count;
  result.min_leaf_samples = params.min_leaf_samples;
  result.components_per_split = params.components_per_split;
  result.sampling_rate = params.sampling_rate;
  result.max_samples_per_shape = params.max_samples_per_shape;
  result.proxy_vertices = params.proxy_vertices;
  result.seed = params.seed;
  result.learns_confidence = params.learn_confidence != 0;
  result.descriptor = params.descriptor;
  result.distance = params.distance;
  return result;
}

}  // namespace

namespace {

// A damaged file can hold one that is none.
SkeletonTemplate checked_template(const std::string& text, const std::vector<std::string>& landmarks) {
  try {
    const SkeletonTemplate result = parse_skeleton_template(text.c_str());
    check_template(result, landmarks);
    return result;
  } catch (const Error& error) {
    throw Error(Status::invalid_file, std::string("section TMPL: ") + error.what(), "train the model again");
  }
}

}  // namespace

focal_model* publish_model(std::shared_ptr<const ContextObject> context, LandmarkModel model) {
  const auto object = std::make_shared<ModelObject>();
  object->context = std::move(context);
  object->info = info_of(model);
  if (!model.skeleton_template.empty()) {
    object->by_template = checked_template(model.skeleton_template, model.landmark_names);
    for (const TemplateJoint& joint : object->by_template->joints)
      object->info.joint_names.push_back(joint.name);
  }
  object->model = std::make_shared<const LandmarkModel>(std::move(model));
  return publish(object);
}

}  // namespace focal

using namespace focal;

focal_status focal_train_params_init(focal_train_params* params, size_t struct_size) {
  return guarded([&] { init_struct(params, struct_size); });
}

focal_status focal_train_params_set_preset(focal_train_params* params, focal_preset preset) {
  return guarded([&] { write_result(params, to_abi(TrainParams::from_preset(checked_preset(preset)))); });
}

focal_status focal_model_train(const focal_training_set* set, const focal_train_params* params,
                               focal_task* task, focal_model** out_model) {
  return guarded([&] {
    require(out_model, "out_model");
    const auto object = resolve<TrainingSetObject>(set);
    const TrainParams how = checked(params);
    const TaskLease lease(task);
    const Execution execution = object->context->execution_with(lease.task());
    execution.check_cancelled();
    const bool rigged = !object->characters.empty();
    std::vector<std::string> odd;
    const TrainingSet made =
        rigged ? training_set_of(object->characters,
                                 {.shapes = read_struct(params).rigged_shapes, .seed = how.seed}, execution,
                                 &odd)
               : TrainingSet{};
    object->context->report_warnings(odd);
    LandmarkModel model = train(rigged ? made : object->set, how, execution);
    if (rigged && how.preset == Preset::default_preset)
      model.details = learn_details(object->characters, model.skeleton, how.seed, execution);
    *out_model = publish_model(object->context, std::move(model));
  });
}

focal_status focal_model_load(const focal_context* context, const char* path, focal_model** out_model) {
  return guarded([&] {
    require(out_model, "out_model");
    auto running = resolve<ContextObject>(context);
    const auto file = path_of(path);
    naming_file(file, [&] { *out_model = publish_model(std::move(running), parse_model(read_file(file))); });
  });
}

focal_status focal_model_load_memory(const focal_context* context, const void* data, uint64_t size,
                                     focal_model** out_model) {
  return guarded([&] {
    require(out_model, "out_model");
    auto running = resolve<ContextObject>(context);
    *out_model = publish_model(std::move(running), parse_model(bytes_of(data, size)));
  });
}

focal_status focal_model_save(const focal_model* model, const char* path) {
  return guarded([&] {
    const auto object = resolve<ModelObject>(model);
    write_file_atomically(path_of(path), serialise(*object->model));
  });
}

focal_status focal_model_save_memory(const focal_model* model, focal_blob** out_blob) {
  return guarded([&] {
    require(out_blob, "out_blob");
    const auto object = resolve<ModelObject>(model);
    const auto blob = std::make_shared<BlobObject>();
    blob->bytes = serialise(*object->model);
    *out_blob = publish(blob);
  });
}

focal_status focal_model_destroy(focal_model* model) { return remove_handle(model, HandleType::model); }

focal_status focal_model_info_init(focal_model_info* info, size_t struct_size) {
  return guarded([&] { init_struct(info, struct_size); });
}

focal_status focal_model_get_info(const focal_model* model, focal_model_info* out_info) {
  return guarded([&] {
    const auto object = resolve<ModelObject>(model);
    const ModelInfo& from = object->info;
    focal_model_info info{};
    info.preset = static_cast<focal_preset>(from.params.preset);
    info.landmark_count = static_cast<uint32_t>(from.landmark_names.size());
    info.shape_count = static_cast<uint32_t>(from.shape_count);
    info.mean_vertex_count = static_cast<uint64_t>(from.mean_vertex_count);
    info.sample_count = static_cast<uint64_t>(from.sample_count);
    info.tree_node_count = static_cast<uint64_t>(from.tree_node_count);
    info.file_bytes = object->file_bytes();
    write_result(out_info, info);
  });
}

focal_status focal_model_get_train_params(const focal_model* model, focal_train_params* out_params) {
  return guarded([&] { write_result(out_params, abi_params_of(*resolve<ModelObject>(model))); });
}

const char* focal_model_landmark_name(const focal_model* model, uint32_t index) {
  return guarded_value<const char*>(nullptr, [&] {
    return text_at(resolve<ModelObject>(model)->info.landmark_names, index, "the model", "landmarks");
  });
}

const char* focal_model_skeleton_template(const focal_model* model) {
  return guarded_value<const char*>(nullptr, [&] {
    const auto object = resolve<ModelObject>(model);
    return object->by_template ? object->model->skeleton_template.c_str() : nullptr;
  });
}
