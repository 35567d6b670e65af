// A set of small horned eggs, each of its own proportions, written as the command reads it.
#include "tiny_set.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

namespace {

using Point = std::array<double, 3>;
constexpr int rings = 20, segments = 26;
constexpr double pi = 3.14159265358979323846;

struct Egg {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Point unit(const Point& p) {
  const double length = std::hypot(p[0], p[1], p[2]);
  return {p[0] / length, p[1] / length, p[2] / length};
}

const std::array<std::pair<const char*, Point>, 4> places = {{{"nose", unit({0, 0.3, 1})},
                                                              {"horn.L", unit({0.7, 1, 0.1})},
                                                              {"horn.R", unit({-0.7, 1, 0.1})},
                                                              {"tail", unit({0, -0.4, -1})}}};

double bump(const Point& direction, const Point& centre, double width) {
  const double apart =
      std::hypot(direction[0] - centre[0], direction[1] - centre[1], direction[2] - centre[2]);
  return std::exp(-apart * apart / (width * width));
}

void add_vertex(Egg& egg, const Point& direction, int number) {
  const double grown = 1 + 0.05 * std::sin(1.0 + 2.3 * number);
  double radius = 1;
  for (size_t i = 0; i < places.size(); ++i) {
    radius += (0.3 + 0.1 * static_cast<double>(i)) * grown * bump(direction, places[i].second, 0.4);
  }
  const Point stretch = {1, 1.3 * grown, 0.8 / grown};
  for (size_t axis = 0; axis < 3; ++axis) {
    egg.positions.push_back(static_cast<float>(radius * stretch[axis] * direction[axis]));
  }
}

Egg make_egg(int number) {
  Egg egg;
  add_vertex(egg, {0, 1, 0}, number);
  for (int ring = 1; ring < rings; ++ring) {
    for (int segment = 0; segment < segments; ++segment) {
      const double theta = pi * ring / rings, phi = 2 * pi * (segment + 0.5 * (ring % 2)) / segments;
      add_vertex(egg, {std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)},
                 number);
    }
  }
  add_vertex(egg, {0, -1, 0}, number);
  const auto at = [](int ring, int segment) -> uint32_t {
    if (ring == 0) return 0;
    if (ring == rings) return 1 + (rings - 1) * segments;
    return static_cast<uint32_t>(1 + (ring - 1) * segments + segment % segments);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int s = 0; s < segments; ++s) {
      if (ring > 0) egg.indices.insert(egg.indices.end(), {at(ring, s), at(ring + 1, s), at(ring, s + 1)});
      if (ring + 1 < rings)
        egg.indices.insert(egg.indices.end(), {at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)});
    }
  }
  return egg;
}

std::string bytes_of(const void* data, size_t size) {
  return std::string(static_cast<const char*>(data), size);
}

std::string chunk(const char* type, std::string bytes, char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
  const auto size = static_cast<uint32_t>(bytes.size());
  return bytes_of(&size, 4) + std::string(type, 4) + bytes;
}

std::string glb_of(const Egg& egg) {
  const std::string positions = bytes_of(egg.positions.data(), 4 * egg.positions.size());
  const std::string indices = bytes_of(egg.indices.data(), 4 * egg.indices.size());
  const nlohmann::json document = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"buffers", {{{"byteLength", positions.size() + indices.size()}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", positions.size()}},
        {{"buffer", 0}, {"byteOffset", positions.size()}, {"byteLength", indices.size()}}}},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", egg.positions.size() / 3},
         {"type", "VEC3"},
         {"min", {-9, -9, -9}},
         {"max", {9, 9, 9}}},
        {{"bufferView", 1}, {"componentType", 5125}, {"count", egg.indices.size()}, {"type", "SCALAR"}}}}};
  const std::string body = chunk("JSON", document.dump(), ' ') + chunk("BIN\0", positions + indices, '\0');
  const uint32_t head[3] = {0x46546C67, 2, static_cast<uint32_t>(12 + body.size())};
  return bytes_of(head, 12) + body;
}

nlohmann::json marks_of(const Egg& egg, const std::string& mesh) {
  nlohmann::json marks = nlohmann::json::array();
  for (const auto& [name, direction] : places) {
    size_t best = 0;
    double best_cosine = -2;
    for (size_t v = 0; 3 * v < egg.positions.size(); ++v) {
      const float* p = &egg.positions[3 * v];
      const Point here = unit({p[0], p[1], p[2]});
      const double cosine = here[0] * direction[0] + here[1] * direction[1] + here[2] * direction[2];
      if (cosine > best_cosine) best_cosine = cosine, best = v;
    }
    const float* p = &egg.positions[3 * best];
    marks.push_back({{"name", name}, {"vertex", best}, {"position", {p[0], p[1], p[2]}}});
  }
  return {{"format", "focal-landmarks"}, {"version", 1}, {"mesh", mesh + ".glb"}, {"landmarks", marks}};
}

}  // namespace

void write_tiny_set(const ScratchFolder& scratch, int train, int test) {
  nlohmann::json set = {{"name", "eggs"}, {"mirror", {{"horn.R", "horn.L"}}}};
  for (const auto& [name, direction] : places) set["landmark_names"].push_back(name);
  for (int number = 0; number < train + test; ++number) {
    const std::string name = "egg" + std::to_string(number);
    const Egg egg = make_egg(number);
    scratch.write(name + ".glb", glb_of(egg));
    scratch.write(name + ".landmarks.json", marks_of(egg, name).dump());
    set[number < train ? "train" : "test"].push_back(name);
  }
  scratch.write("set.json", set.dump());
}
