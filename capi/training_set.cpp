// The builder of what training starts from.
#include <algorithm>
#include <cstring>
#include <string>
#include <unordered_set>
#include <utility>

#include "arguments.h"
#include "boundary.h"
#include "objects.h"
#include "skeleton/teachers.h"
#include "skeleton/template_file.h"

using namespace focal;

namespace {

std::vector<std::string> checked_names(const char* const* names, uint64_t count) {
  if (!names && count == 0) return {};  // a set of rigged characters
  require(names, "landmark_names");
  check_range("landmark_count", static_cast<double>(count), 1, 4096);
  std::vector<std::string> result;
  std::unordered_set<std::string> seen;
  for (uint64_t i = 0; i < count; ++i) {
    if (!names[i] || !*names[i])
      throw Error(Status::invalid_argument, "landmark name " + std::to_string(i) + " is empty",
                  "give every landmark a name");
    if (!seen.insert(names[i]).second)
      throw Error(Status::invalid_argument, std::string("two landmarks are named \"") + names[i] + "\"",
                  "give every landmark its own name");
    result.emplace_back(names[i]);
  }
  return result;
}

// place(prepared mesh, number, name) gives the mark with that number, or nothing where it is absent.
template <class Place>
void add(focal_training_set* handle, const focal_mesh* mesh, const void* marks, uint64_t count,
         Place&& place) {
  const auto object = resolve<TrainingSetObject>(handle);
  const auto prepared = resolve<MeshObject>(mesh)->mesh;
  const auto& names = object->set.landmark_names;
  if (names.empty())
    throw Error(Status::invalid_argument, "the training set was created without landmark names",
                "add rigged characters to it, or create one with landmark names");
  require(marks, "landmarks");
  if (count != names.size())
    throw Error(
        Status::invalid_argument,
        std::to_string(count) + " landmarks given, the training set has " + std::to_string(names.size()),
        "give one for each name, in the same order; an absent one has no triangle or vertex");
  MarkedShape shape{prepared, {}};
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string name =
        "landmark \"" + names[i] + "\" of training mesh " + std::to_string(object->set.shapes.size());
    shape.marks.push_back(place(*prepared, i, name));
  }
  object->set.shapes.push_back(std::move(shape));
}

RiggedMesh rigged(const MeshObject& mesh) {
  const SourceFile& file = file_of(mesh, "the mesh has no glTF file to take a skeleton from");
  int64_t invalid_weights = 0;
  auto rig = file.document.rig(file.primitives, &invalid_weights);
  if (!rig)
    throw Error(Status::invalid_argument, "the mesh has no skin",
                "add a rigged character, or mark landmarks on the mesh with focal_training_set_add");
  const auto is_moved = [](const VertexInfluences& influences) { return influences[0].weight > 0; };
  if (std::none_of(rig->influences.begin(), rig->influences.end(), is_moved))
    throw Error(Status::invalid_argument, "no vertex of the mesh is moved by a joint of its skin",
                "paint skin weights, or export them (JOINTS_0, WEIGHTS_0)");
  return {mesh.mesh, std::move(*rig), mesh.name, invalid_weights};
}

}  // namespace

focal_status focal_training_set_create(const focal_context* context, const char* const* landmark_names,
                                       uint64_t landmark_count, focal_training_set** out_set) {
  return guarded([&] {
    require(out_set, "out_set");
    const auto object = std::make_shared<TrainingSetObject>();
    object->context = resolve<ContextObject>(context);
    object->set.landmark_names = checked_names(landmark_names, landmark_count);
    *out_set = publish(object, *object->context);
  });
}

focal_status focal_training_set_destroy(focal_training_set* set) {
  return remove_handle(set, HandleType::training_set);
}

focal_status focal_training_set_add(focal_training_set* set, const focal_mesh* mesh,
                                    const focal_surface_point* landmarks, uint64_t landmark_count) {
  return guarded([&] {
    add(set, mesh, landmarks, landmark_count,
        [&](const PreparedMesh& prepared, size_t i, const std::string& name) -> std::optional<SurfacePoint> {
          if (landmarks[i].triangle == FOCAL_NO_TRIANGLE) return std::nullopt;
          return point_in(prepared, landmarks[i], name);
        });
  });
}

focal_status focal_training_set_add_vertices(focal_training_set* set, const focal_mesh* mesh,
                                             const uint32_t* vertices, uint64_t landmark_count) {
  return guarded([&] {
    add(set, mesh, vertices, landmark_count,
        [&](const PreparedMesh& prepared, size_t i, const std::string& name) -> std::optional<SurfacePoint> {
          if (vertices[i] == FOCAL_NO_VERTEX) return std::nullopt;
          return vertex_in(prepared, vertices[i], name);
        });
  });
}

focal_status focal_training_set_add_rig(focal_training_set* set, const focal_mesh* mesh) {
  return guarded([&] {
    const auto object = resolve<TrainingSetObject>(set);
    if (!object->set.landmark_names.empty())
      throw Error(Status::invalid_argument, "the training set has landmark names of its own",
                  "create one for rigged characters with landmark_count 0");
    object->characters.push_back(rigged(*resolve<MeshObject>(mesh)));
  });
}

focal_status focal_training_set_set_skeleton(focal_training_set* set, const char* skeleton_template) {
  return guarded([&] {
    const auto object = resolve<TrainingSetObject>(set);
    if (object->set.landmark_names.empty())
      throw Error(
          Status::invalid_argument, "the training set was created without landmark names",
          "a model of rigged characters has their skeleton; templates are for landmarks marked by hand");
    if (skeleton_template && std::strlen(skeleton_template) > longest_template)
      throw Error(Status::unsupported, "the skeleton template is longer than 1 MiB",
                  "leave out nodes that are not joints");
    if (skeleton_template)
      check_template(parse_skeleton_template(skeleton_template), object->set.landmark_names);
    object->set.skeleton_template = skeleton_template ? skeleton_template : "";
  });
}

focal_status focal_training_set_check(focal_training_set* set) {
  return guarded([&] {
    const auto object = resolve<TrainingSetObject>(set);
    object->warnings.clear();
    if (!object->set.landmark_names.empty()) return;
    if (object->characters.empty())
      throw Error(Status::invalid_argument, "the training set has no rigged character",
                  "add one with focal_training_set_add_rig");
    std::vector<RiggedMesh> characters = object->characters;
    object->warnings = match_teachers(characters);
  });
}

uint32_t focal_training_set_warning_count(const focal_training_set* set) {
  return guarded_value<uint32_t>([&] { return resolve<TrainingSetObject>(set)->warnings.size(); });
}

const char* focal_training_set_warning(const focal_training_set* set, uint32_t index) {
  return guarded_value<const char*>([&] {
    return text_at(resolve<TrainingSetObject>(set)->warnings, index, "the training set", "warnings");
  });
}

uint64_t focal_training_set_landmark_count(const focal_training_set* set) {
  return guarded_value<uint64_t>([&] { return resolve<TrainingSetObject>(set)->set.landmark_names.size(); });
}

uint64_t focal_training_set_mesh_count(const focal_training_set* set) {
  return guarded_value<uint64_t>([&] {
    const auto object = resolve<TrainingSetObject>(set);
    return object->set.shapes.size() + object->characters.size();
  });
}
