// focal rig --keep-skeleton: new weights for the joints that a file has.
#pragma once
#include "options.h"

namespace focal_cli {

void keep_skeleton(const std::string& mesh, const std::string& output, int32_t influences,
                   const CommonOptions& options);

}  // namespace focal_cli
