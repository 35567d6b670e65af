// C arguments, checked: paths, blocks of bytes, numbers, indices, texts by number, points of a surface; and points on their way back.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "focal/focal.h"
#include "mesh/prepare.h"

namespace focal {

// UTF-8 on every platform. Throws invalid_argument: NULL or empty.
std::filesystem::path path_of(const char* path);

// What goes wrong inside a file names the file: runs body(), puts the path before the message of an Error
// that lacks it and says nothing of handles or parameters.
template <class Body>
void naming_file(const std::filesystem::path& path, Body&& body) {
  try {
    body();
  } catch (const Error& error) {
    const std::string name = text_of(path), message = error.what();
    const bool about_call =
        error.status() == Status::invalid_handle || error.status() == Status::invalid_argument;
    if (about_call || message.find(name) != std::string::npos) throw;
    throw Error(error.status(), name + ": " + message, error.hint());
  }
}

// Throws invalid_argument: NULL, or a size beyond the address space.
std::span<const std::byte> bytes_of(const void* data, uint64_t size);

// Throws invalid_argument: "OWNER has 3 THINGS, not a number 7".
void check_index(uint64_t index, uint64_t count, const char* owner, const char* things);
// Throws invalid_argument: "vertex_count is 3, the mesh has 7 vertices".
void check_count(const char* name, uint64_t given, uint64_t wanted, const char* owner, const char* things,
                 const char* hint = nullptr);
// Throws invalid_argument unless low <= value <= high; NaN is outside.
void check_range(const char* name, double value, double low, double high);
void check_flag(const char* name, int32_t value);
void check_reserved(const char* name, int64_t value);
// The out_ argument is asked for before any work is done. Throws invalid_argument: NULL.
void require(const void* argument, const char* name);

const char* text_at(const std::vector<std::string>& texts, uint64_t index, const char* owner,
                    const char* things);

// On mesh.surface. Weights are scaled to sum 1; a point in a triangle that was dropped moves to its heaviest
// corner. Throws invalid_landmark: no such triangle or vertex, weights that are not >= 0, nothing of the
// surface there. `name` says which point it is.
SurfacePoint point_in(const PreparedMesh& mesh, const focal_surface_point& point, const std::string& name);
SurfacePoint vertex_in(const PreparedMesh& mesh, uint32_t vertex, const std::string& name);

// In the caller's numbers.
focal_surface_point point_out(const SurfacePoint& source_point);
void position_out(const Vector3& position, float* out);

}  // namespace focal
