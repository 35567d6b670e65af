// Files that are passed for glTF and are something else.
#pragma once
#include <cstddef>
#include <span>

namespace focal {

// Throws invalid_file, with what to do, when the first bytes are plainly those of another kind of file.
void refuse_foreign_file(std::span<const std::byte> bytes);

}  // namespace focal
