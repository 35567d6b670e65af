// Draws meshes, landmarks found on them, and rigged ones in a pose of their animations.
#include <focal/focal.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "drawing.h"
#include "surface.h"

namespace {

constexpr const char* usage =
    "usage: focal_picture [--columns N] OUT.svg "
    "MESH.glb[,MARKS.json[,CAPTION[,PITCH[,YAW[,ANIMATION,SECONDS]]]]] ...\n"
    "  MARKS.json: landmarks, or what `focal rig --json` reports, whose joints and bones are drawn\n";

void check(focal_status status) {
  if (status != FOCAL_OK) throw std::runtime_error(focal_last_error());
}

template <class Handle>
using Owned = std::unique_ptr<Handle, focal_status (*)(Handle*)>;

void load_mesh(const focal_context* context, const std::string& path, const std::string& animation,
               double seconds, picture::Figure& figure) {
  focal_mesh_params params;
  check(focal_mesh_params_init(&params, sizeof params));
  if (!animation.empty()) params.pose_animation = animation.c_str(), params.pose_time = seconds;
  focal_mesh* loaded = nullptr;
  check(focal_mesh_load_gltf(context, path.c_str(), &params, &loaded));
  const Owned<focal_mesh> mesh(loaded, focal_mesh_destroy);
  focal_mesh_info info;
  check(focal_mesh_info_init(&info, sizeof info));
  check(focal_mesh_get_info(mesh.get(), &info));
  const float* positions = focal_mesh_positions(mesh.get());
  const uint32_t* triangles = focal_mesh_triangles(mesh.get());
  for (uint64_t i = 0; i < 3 * info.vertex_count; i += 3)
    figure.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
  for (uint64_t i = 0; i < 3 * info.triangle_count; i += 3)
    figure.triangles.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
}

void add_skeleton(const nlohmann::json& joints, picture::Figure& figure) {
  std::map<std::string, size_t> number;
  for (const auto& joint : joints) {
    const std::string name = joint.at("name");
    number[name] = figure.marks.size();
    figure.marks.push_back(
        {.name = name, .position = joint.at("position").get<picture::Point>(), .inside = true});
    if (const auto& parent = joint.at("parent"); parent.is_string())
      figure.bones.push_back({number.at(parent), number[name]});
  }
}

void load_marks(const std::string& path, picture::Figure& figure) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  const auto document = nlohmann::json::parse(file);
  if (document.contains("joints")) return add_skeleton(document["joints"], figure);
  for (const auto& landmark : document.at("landmarks")) {
    const std::string status = landmark.value("status", "found");
    if (status == "absent" || !landmark.contains("position") || landmark["position"].is_null()) continue;
    figure.marks.push_back(
        {landmark.at("name"), landmark.at("position").get<picture::Point>(), status == "uncertain"});
  }
}

picture::Figure load_figure(const focal_context* context, const std::string& argument) {
  std::istringstream words(argument);
  std::string mesh, marks, pitch, yaw, animation, seconds = "0";
  picture::Figure figure;
  std::getline(words, mesh, ',');
  std::getline(words, marks, ',');
  std::getline(words, figure.caption, ',');
  std::getline(words, pitch, ',');
  std::getline(words, yaw, ',');
  std::getline(words, animation, ',') && std::getline(words, seconds, ',');
  load_mesh(context, mesh, animation, std::stod(seconds), figure);
  if (!marks.empty()) load_marks(marks, figure);
  if (!pitch.empty()) figure.pitch = std::stod(pitch);
  figure.yaw = yaw.empty() ? picture::best_yaw(figure) : std::stod(yaw);
  return figure;
}

}  // namespace

int main(int argc, char** argv) {
  size_t columns = 0;
  if (argc > 2 && std::string(argv[1]) == "--columns") {
    columns = std::strtoul(argv[2], nullptr, 10);
    argv += 2, argc -= 2;
  }
  if (argc < 3) return std::fputs(usage, stderr), 2;
  try {
    focal_context* created = nullptr;
    check(focal_context_create(nullptr, &created));
    const Owned<focal_context> context(created, focal_context_destroy);
    std::vector<picture::Figure> figures;
    for (int i = 2; i < argc; ++i) figures.push_back(load_figure(context.get(), argv[i]));
    std::ofstream out(argv[1], std::ios::binary);
    out << picture::draw(figures, columns);
    if (!out.flush()) throw std::runtime_error(std::string("cannot write ") + argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "focal_picture: %s\n", error.what());
    return 1;
  }
  return 0;
}
