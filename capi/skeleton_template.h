// Skeleton templates as the caller writes them: JSON.
#pragma once
#include "skeleton/skeleton_template.h"

namespace focal {

// {"format": "focal-skeleton-template", "version": 1, "symmetric": false, "joints": [{"name", "parent", and one of "centre": [...],
// "surface": [...], "between": [a, b] with "share"; "tip"; "rest": [x, y, z]}]}. Throws invalid_file (no JSON), unsupported
// (limits, another version), invalid_argument (not of this form).
SkeletonTemplate parse_skeleton_template(const char* text);

}  // namespace focal
