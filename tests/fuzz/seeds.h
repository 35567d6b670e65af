// The inputs that fuzzing starts from, and the mesh that analyses among them are of. Numbers are the same on every machine.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "fuzz.h"
#include "mesh/prepare.h"

namespace fuzz {

std::shared_ptr<const focal::PreparedMesh>
small_mesh();  // a box of 3 x 3 x 6 with a vertex at each whole number

std::map<std::string, Bytes> seeds();  // "TARGET/NAME" -> bytes

}  // namespace fuzz
