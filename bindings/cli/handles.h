// The handles of focal.h, destroyed by themselves, and its errors as CommandError.
#pragma once
#include <focal/focal.h>

#include <memory>
#include <string>
#include <vector>

namespace focal_cli {

template <auto destroy>
struct Destroyer {
  template <typename Handle>
  void operator()(Handle* handle) const {
    destroy(handle);
  }
};
template <typename Handle, auto destroy>
using Owned = std::unique_ptr<Handle, Destroyer<destroy>>;

using Context = Owned<focal_context, focal_context_destroy>;
using Task = Owned<focal_task, focal_task_destroy>;
using Mesh = Owned<focal_mesh, focal_mesh_destroy>;
using TrainingSet = Owned<focal_training_set, focal_training_set_destroy>;
using Model = Owned<focal_model, focal_model_destroy>;
using Detection = Owned<focal_detection, focal_detection_destroy>;
using Skeleton = Owned<focal_skeleton, focal_skeleton_destroy>;

// Throws the library's own message and hint, after `about` ("mesh 'a': ") where the library cannot know it.
void check(focal_status status, const std::string& about = "");

// owned<Mesh>(focal_mesh_load_gltf, context, path, nullptr): calls, checks, and takes the out_ handle over.
template <typename Owner, typename Function, typename... Arguments>
Owner owned(Function function, Arguments... arguments) {
  typename Owner::pointer handle = nullptr;
  check(function(arguments..., &handle));
  return Owner(handle);
}

// A parameter or result struct of focal.h after its init function: initialised(focal_mesh_info_init).
template <typename Struct>
Struct initialised(focal_status (*init)(Struct*, size_t)) {
  Struct value;
  check(init(&value, sizeof value));
  return value;
}

// Of the skeleton that a model of rigged characters has learned; empty for others.
std::vector<std::string> joint_names_of(const focal_model* model);

}  // namespace focal_cli
