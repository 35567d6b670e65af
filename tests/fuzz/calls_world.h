// What an input of the target `calls` can choose from: handles of every kind, good and bad, and the arguments around them.
#pragma once
#include <focal/focal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

extern "C" {
#include "capi/shapes.h"
}
#include "fuzz.h"

namespace fuzz {

// Bytes as a stream of choices; 0 for ever after the end.
struct Choices {
  const uint8_t* data;
  size_t size, at = 0;
  uint32_t byte() { return at < size ? data[at++] : 0; }
  uint32_t below(uint32_t n) { return byte() % n; }
  bool ended() const { return at >= size; }
  double number() {  // now and then a senseless one
    static const double odd[] = {0, -1, 1, 0.5, 1e300, NAN, INFINITY, 1e-300};
    const uint32_t b = byte();
    return b < 16 ? odd[b % 8] : b / 64.0;
  }
};

enum Kind { contexts, meshes, sets, models, detections, analyses, maps, skeletons, tasks, blobs, kinds };

template <class Handle, focal_status (*destroy)(Handle*)>
void destroy_as(void* handle) {
  destroy(static_cast<Handle*>(handle));
}
constexpr void (*destroyers[kinds])(void*) = {destroy_as<focal_context, focal_context_destroy>,
                                              destroy_as<focal_mesh, focal_mesh_destroy>,
                                              destroy_as<focal_training_set, focal_training_set_destroy>,
                                              destroy_as<focal_model, focal_model_destroy>,
                                              destroy_as<focal_detection, focal_detection_destroy>,
                                              destroy_as<focal_analysis, focal_analysis_destroy>,
                                              destroy_as<focal_correspondence, focal_correspondence_destroy>,
                                              destroy_as<focal_skeleton, focal_skeleton_destroy>,
                                              destroy_as<focal_task, focal_task_destroy>,
                                              destroy_as<focal_blob, focal_blob_destroy>};

struct World {
  Choices choose;
  std::vector<void*> handles[kinds];
  int trainings = 0, detections_made = 0;

  void keep(Kind kind, void* handle) {
    if (handle) handles[kind].push_back(handle);
  }
  // Mostly one of the kind; else NULL, one of another kind, or an address of ours.
  template <class Handle>
  Handle* pick(Kind kind) {
    const uint32_t b = choose.byte();
    if (b % 16 == 1) return nullptr;
    if (b % 16 == 2) kind = static_cast<Kind>(b / 16 % kinds);
    if (b % 16 == 3) return reinterpret_cast<Handle*>(this);
    auto& of_kind = handles[kind];
    return of_kind.empty() ? nullptr : static_cast<Handle*>(of_kind[b / 16 % of_kind.size()]);
  }
  // In an order that the input chooses; those destroyed before are stale, and said to be so.
  void destroy(Kind kind, void* handle) { destroyers[kind](handle); }
  ~World() {
    for (int kind = 0; kind < kinds; ++kind)
      for (void* handle : handles[kind]) destroy(static_cast<Kind>(kind), handle);
  }
};

inline focal_status answered(focal_status status) {
  if (status == FOCAL_OK) return status;
  insist(status != FOCAL_ERROR_INTERNAL, focal_last_error());
  insist(std::strcmp(focal_status_name(status), "FOCAL_ERROR_UNKNOWN") != 0, "every status has a name");
  insist(std::strstr(focal_last_error(), "\nhint: ") != nullptr, "every error has a hint");
  return status;
}

// A struct of parameters: absent, as init fills it, or corrupted somewhere.
template <class Params>
const Params* params_of(World& world, Params& params, focal_status (*init)(Params*, size_t)) {
  const uint32_t b = world.choose.byte();
  if (b % 4 == 0) return nullptr;
  const size_t size = b % 16 == 1 ? std::min<size_t>(b, sizeof params) : sizeof params;
  if (answered(init(&params, size)) != FOCAL_OK) return nullptr;
  return &params;
}

inline std::vector<unsigned char>& glb() {
  static std::vector<unsigned char> file;
  if (file.empty()) {
    shape body = shape_create(6, 0);
    size_t size = 0;
    unsigned char* bytes = shape_glb(&body, &size);
    file.assign(bytes, bytes + size);
    std::free(bytes);
    shape_destroy(&body);
  }
  return file;
}

// A model of the tiny bodies, as bytes.
inline const std::vector<unsigned char>& model_bytes() {
  static std::vector<unsigned char> file;
  if (!file.empty()) return file;
  focal_context* context = nullptr;
  focal_model* model = nullptr;
  focal_blob* blob = nullptr;
  focal_train_params params;
  focal_context_create(nullptr, &context);
  focal_training_set* set = shape_training_set(context, 6, 3);
  focal_train_params_init(&params, sizeof params);
  params.tree_count = 2, params.eigenpair_count = 16, params.learn_confidence = 0,
  params.max_samples_per_shape = 30;
  insist(focal_model_train(set, &params, nullptr, &model) == FOCAL_OK, "the tiny model is trained");
  insist(focal_model_save_memory(model, &blob) == FOCAL_OK, "the tiny model is saved");
  const auto* data = static_cast<const unsigned char*>(focal_blob_data(blob));
  file.assign(data, data + focal_blob_size(blob));
  focal_blob_destroy(blob), focal_model_destroy(model), focal_training_set_destroy(set),
      focal_context_destroy(context);
  return file;
}

}  // namespace fuzz
