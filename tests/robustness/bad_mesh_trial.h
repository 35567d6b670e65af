// One mesh through the C API: made, analysed, its landmarks found and everything that can be asked for asked for.
#pragma once
#include <focal/focal.h>

#include <string>

#include "bad_mesh_kinds.h"

namespace focal_bad_meshes {

enum class Outcome : unsigned char {
  none,     // it did not come back: a crash, or too long
  usable,   // every result finite and in range
  refused,  // an error with a status, a message and a hint
  broken    // neither
};

struct Verdict {
  Outcome outcome = Outcome::none;
  std::string note;  // the error, or what is broken
};

// Judged without the library: at least 12 different places that are corners of triangles of three different places, and an
// area above 1e-10 of the squared size; triangles with a NaN, an infinite value or an index out of range left out.
bool should_be_usable(const BadMesh& mesh);
bool is_valid(const BadMesh& mesh);  // no such triangle or value

Verdict try_mesh(const focal_context* context, const focal_model* model, const BadMesh& mesh);
Verdict try_file(const focal_context* context, const focal_model* model, const std::string& path);

}  // namespace focal_bad_meshes
