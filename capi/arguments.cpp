#include "arguments.h"

#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/atomic_file.h"

namespace focal {
namespace {

// std::to_string and streams would ask the locale.
std::string number_text(double value) {
  char text[32];
  return {text, std::to_chars(text, std::end(text), value).ptr};
}

[[noreturn]] void refuse_point(const std::string& name, const std::string& problem, const std::string& hint) {
  throw Error(Status::invalid_landmark, name + ": " + problem, hint);
}

Vector3 checked_weights(const focal_surface_point& point, const std::string& name) {
  const Vector3 weights(point.barycentric[0], point.barycentric[1], point.barycentric[2]);
  const double sum = weights.sum();
  if (!(weights.minCoeff() >= 0) || !(sum > 0) || !std::isfinite(sum))
    refuse_point(name, "its barycentric weights are no point of a triangle",
                 "give three weights >= 0 that sum to 1");
  return weights / sum;
}

}  // namespace

std::filesystem::path path_of(const char* path) {
  if (!path || !*path)
    throw Error(Status::invalid_argument, path ? "the path is empty" : "the path is NULL",
                "pass a file's path");
  auto found = path_from_text(path);
  if (!found) throw Error(Status::invalid_argument, "the path is not UTF-8", "pass paths in UTF-8");
  return *std::move(found);
}

std::span<const std::byte> bytes_of(const void* data, uint64_t size) {
  require(data, "data");
  if (size > static_cast<uint64_t>(std::numeric_limits<std::ptrdiff_t>::max()))
    throw Error(Status::invalid_argument, "size is " + std::to_string(size) + " bytes",
                "pass the size of data");
  return {static_cast<const std::byte*>(data), static_cast<size_t>(size)};
}

void check_index(uint64_t index, uint64_t count, const char* owner, const char* things) {
  if (index < count) return;
  throw Error(Status::invalid_argument,
              std::string(owner) + " has " + std::to_string(count) + " " + things + ", there is no number " +
                  std::to_string(index),
              "count from 0");
}

void check_count(const char* name, uint64_t given, uint64_t wanted, const char* owner, const char* things,
                 const char* hint) {
  if (given == wanted) return;
  throw Error(Status::invalid_argument,
              std::string(name) + " is " + std::to_string(given) + ", " + owner + " has " +
                  std::to_string(wanted) + " " + things,
              hint ? hint : std::string("pass a block with an entry for each of the ") + things);
}

void check_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(Status::invalid_argument, std::string(name) + " is " + number_text(value),
              "choose a value from " + number_text(low) + " to " + number_text(high));
}

void check_flag(const char* name, int32_t value) { check_range(name, value, 0, 1); }

void check_reserved(const char* name, int64_t value) {
  if (value != 0)
    throw Error(Status::unsupported, std::string(name) + " sets a reserved field",
                "fill the struct with its *_init and leave reserved fields 0");
}

void require(const void* argument, const char* name) {
  if (!argument)
    throw Error(Status::invalid_argument, std::string(name) + " is NULL", "pass the address of a variable");
}

const char* text_at(const std::vector<std::string>& texts, uint64_t index, const char* owner,
                    const char* things) {
  check_index(index, texts.size(), owner, things);
  return texts[static_cast<size_t>(index)].c_str();
}

SurfacePoint point_in(const PreparedMesh& mesh, const focal_surface_point& point, const std::string& name) {
  if (point.triangle >= static_cast<uint32_t>(mesh.source.triangle_count()))
    refuse_point(name, "the mesh has no triangle " + std::to_string(point.triangle),
                 "triangles are numbered from 0 to " + std::to_string(mesh.source.triangle_count() - 1) +
                     "; FOCAL_NO_TRIANGLE marks an absent landmark");
  const SurfacePoint source{static_cast<int32_t>(point.triangle), checked_weights(point, name)};
  const SurfacePoint on_surface = to_surface(mesh, source);
  if (on_surface.triangle >= 0) return on_surface;
  Eigen::Index heaviest = 0;
  source.barycentric.maxCoeff(&heaviest);
  return vertex_in(mesh, static_cast<uint32_t>(mesh.source.triangles(source.triangle, heaviest)), name);
}

SurfacePoint vertex_in(const PreparedMesh& mesh, uint32_t vertex, const std::string& name) {
  if (vertex >= static_cast<uint32_t>(mesh.source.vertex_count()))
    refuse_point(name, "the mesh has no vertex " + std::to_string(vertex),
                 "vertices are numbered from 0 to " + std::to_string(mesh.source.vertex_count() - 1) +
                     "; FOCAL_NO_VERTEX marks an absent landmark");
  const int32_t on_surface = mesh.surface_vertex[vertex];
  if (on_surface < 0)
    refuse_point(name, "no triangle uses vertex " + std::to_string(vertex), "mark a vertex of the surface");
  return at_vertex(mesh.surface, on_surface);
}

focal_surface_point point_out(const SurfacePoint& source_point) {
  if (source_point.triangle < 0) return {FOCAL_NO_TRIANGLE, {0, 0, 0}};
  focal_surface_point point{static_cast<uint32_t>(source_point.triangle), {}};
  position_out(source_point.barycentric, point.barycentric);
  return point;
}

void position_out(const Vector3& position, float* out) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(position[i]);
}

}  // namespace focal
