// Serialises a model: the .focal file. docs/model-format.md describes it.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "model/landmark_model.h"

namespace focal {

std::vector<std::byte> serialise(const LandmarkModel& model);

// Validates everything: a returned model can be used without further checks. Throws invalid_file (not a
// model, truncated, corrupt, inconsistent) and unsupported_version. parts: whether the model may have parts
// with models of their own (see DetailModel); the models of parts may not.
enum class PartsOfModel { allowed, refused };
LandmarkModel parse_model(std::span<const std::byte> file, PartsOfModel parts = PartsOfModel::allowed);

}  // namespace focal
