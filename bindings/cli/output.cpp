// What a verb says on stdout, and where it may write.
#include "output.h"

#include <filesystem>
#include <iostream>

#include "command_error.h"
#include "landmark_text.h"
#include "paths.h"

namespace focal_cli {

Json triple(const float* values) { return {tidy(values[0]), tidy(values[1]), tidy(values[2])}; }

const char* status_name(focal_landmark_status status) {
  return status == FOCAL_LANDMARK_FOUND       ? "found"
         : status == FOCAL_LANDMARK_UNCERTAIN ? "uncertain"
                                              : "absent";
}

void print_json(const Json& document) {
  // Text that came from files may not be UTF-8; a broken name must not break the document.
  std::cout << document.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
}

void check_output_folder(const std::string& path) {
  const std::filesystem::path folder = path_of(path).parent_path();
  std::error_code code;
  if (!folder.empty() && !std::filesystem::is_directory(folder, code)) {
    throw CommandError("there is no folder '" + text_of(folder) + "' to write '" + path + "' into",
                       "make the folder first");
  }
  if (std::filesystem::is_directory(path_of(path), code)) {
    throw CommandError("'" + path + "' is a folder", "give the name of a file to write");
  }
}

}  // namespace focal_cli
