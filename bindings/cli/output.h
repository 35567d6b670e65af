// What a verb says on stdout, and where it may write.
#pragma once
#include <focal/focal.h>

#include <nlohmann/json.hpp>
#include <string>

namespace focal_cli {

using Json = nlohmann::ordered_json;

Json triple(const float* values);  // each with its own shortest digits
const char* status_name(focal_landmark_status status);

void print_json(const Json& document);

// Throws when the folder of an output file is missing: said before the long work, not after it.
void check_output_folder(const std::string& path);

}  // namespace focal_cli
