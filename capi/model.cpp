// What training makes and detection uses: trained, loaded, saved, looked at; and the models that come with focal.
#include <limits>
#include <string>
#include <utility>

#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "descriptors/descriptor.h"
#include "geodesics/distance.h"
#include "landmarks/train.h"
#include "model/model_file.h"
#include "objects.h"
#include "skeleton/detail_training.h"
#include "skeleton/template_file.h"
#include "structs.h"

using namespace focal;

namespace {

// The fields that both sides call alike, either way.
template <class To, class From>
void copy_train_fields(const From& from, To& to) {
  to.eigenpair_count = from.eigenpair_count;
  to.tree_count = from.tree_count;
  to.min_leaf_samples = from.min_leaf_samples;
  to.components_per_split = from.components_per_split;
  to.sampling_rate = from.sampling_rate;
  to.max_samples_per_shape = from.max_samples_per_shape;
  to.proxy_vertices = from.proxy_vertices;
  to.seed = from.seed;
  to.descriptor = from.descriptor;
  to.distance = from.distance;
}

focal_train_params to_abi(const TrainParams& params) {
  focal_train_params result{};
  copy_train_fields(params, result);
  result.preset = static_cast<focal_preset>(params.preset);
  result.learn_confidence = params.learns_confidence;
  result.rigged_shapes = RiggedShapesParams{}.shapes;
  return result;
}

focal_train_params default_train_params() { return to_abi(TrainParams::from_preset(Preset::default_preset)); }

}  // namespace

FOCAL_STRUCT_WITH_DEFAULTS(focal_train_params, 48, default_train_params);
static_assert(sizeof(focal_train_params) == 64 && offsetof(focal_train_params, distance) == 60);
FOCAL_STRUCT(focal_model_info, 48);
static_assert(sizeof(focal_model_info) == 48 && offsetof(focal_model_info, file_bytes) == 40);

namespace {

Preset checked_preset(focal_preset preset) {
  check_range("focal_train_params.preset", preset, FOCAL_PRESET_DEFAULT, FOCAL_PRESET_PAPER);
  return static_cast<Preset>(preset);
}

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
  copy_train_fields(params, result);
  result.learns_confidence = params.learn_confidence != 0;
  return result;
}

const StockModel& stock_at(const ContextObject& context, uint32_t index) {
  check_index(index, context.stock().size(), "this installation", "stock models");
  return context.stock()[index];
}

focal_model* load(const focal_context* context, const char* path) {
  auto running = resolve<ContextObject>(context);
  const auto file = path_of(path);
  focal_model* model = nullptr;
  naming_file(file, [&] { model = publish_model(std::move(running), parse_model(read_file(file))); });
  return model;
}

}  // namespace

uint64_t ModelObject::file_bytes() const {
  return file_bytes_.get([&] { return serialise(*model).size(); });
}

focal_model* focal::publish_model(std::shared_ptr<const ContextObject> context, LandmarkModel model) {
  const auto object = std::make_shared<ModelObject>();
  object->context = std::move(context);
  object->info = info_of(model);
  if (!model.skeleton_template.empty()) {
    object->by_template = template_of_model(model.skeleton_template, model.landmark_names);
    for (const TemplateJoint& joint : object->by_template->joints)
      object->info.joint_names.push_back(joint.name);
  }
  object->model = std::make_shared<const LandmarkModel>(std::move(model));
  return publish(object, *object->context);
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
    *out_model = load(context, path);
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
  return guarded([&] {
    const auto object = resolve<ModelObject>(model);
    focal_train_params params = to_abi(object->info.params);
    // It does not stand in the parameters: the shapes learned of rigged characters.
    if (!object->info.joint_names.empty() && !object->by_template)
      params.rigged_shapes = object->info.shape_count;
    write_result(out_params, params);
  });
}

const char* focal_model_landmark_name(const focal_model* model, uint32_t index) {
  return guarded_value<const char*>([&] {
    return text_at(resolve<ModelObject>(model)->info.landmark_names, index, "the model", "landmarks");
  });
}

const char* focal_model_skeleton_template(const focal_model* model) {
  return guarded_value<const char*>([&] {
    const auto object = resolve<ModelObject>(model);
    return object->by_template ? object->model->skeleton_template.c_str() : nullptr;
  });
}

uint32_t focal_context_stock_count(const focal_context* context) {
  return guarded_value<uint32_t>([&] { return resolve<ContextObject>(context)->stock().size(); });
}

const char* focal_context_stock_name(const focal_context* context, uint32_t index) {
  return guarded_value<const char*>(
      [&] { return stock_at(*resolve<ContextObject>(context), index).name.c_str(); });
}

const char* focal_context_stock_path(const focal_context* context, uint32_t index) {
  return guarded_value<const char*>(
      [&] { return stock_at(*resolve<ContextObject>(context), index).path.c_str(); });
}

focal_status focal_model_load_stock(const focal_context* context, const char* name, focal_model** out_model) {
  return guarded([&] {
    require(out_model, "out_model");
    require(name, "name");
    *out_model = load(context, stock_model(resolve<ContextObject>(context)->stock(), name).path.c_str());
  });
}

const void* focal_blob_data(const focal_blob* blob) {
  return guarded_value<const void*>([&] { return resolve<BlobObject>(blob)->bytes.data(); });
}

uint64_t focal_blob_size(const focal_blob* blob) {
  return guarded_value<uint64_t>([&] { return resolve<BlobObject>(blob)->bytes.size(); });
}

focal_status focal_blob_destroy(focal_blob* blob) { return remove_handle(blob, HandleType::blob); }
