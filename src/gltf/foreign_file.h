// Detects files of other types passed as glTF.
#pragma once
#include <cstddef>
#include <span>

namespace focal {

// Throws invalid_file, with a hint, when the first bytes are those of another file type.
void refuse_foreign_file(std::span<const std::byte> bytes);

}  // namespace focal
