// Skeleton templates as people write them: JSON.
#pragma once
#include <string>
#include <vector>

#include "skeleton/skeleton_template.h"

namespace focal {

// {"format": "focal-skeleton-template", "version": 1, "symmetric": false, "joints": [{"name", "parent", and one of "centre": [...],
// "surface": [...], "between": [a, b] with "share"; "tip"; "rest": [x, y, z]}]}. Throws invalid_file (no JSON), unsupported
// (limits, another version), invalid_argument (not of this form).
SkeletonTemplate parse_skeleton_template(const char* text);

// The one that a model file carries over its landmarks. Throws invalid_file: a corrupt file can hold text that is not a template.
SkeletonTemplate template_of_model(const std::string& text, const std::vector<std::string>& landmarks);

}  // namespace focal
