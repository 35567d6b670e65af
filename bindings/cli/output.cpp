// What a verb says on stdout, and where it may write.
#include "output.h"

#include <filesystem>
#include <iostream>

#include "command_error.h"

namespace focal_cli {

void print_json(const Json& document) {
  // Text that came from files may not be UTF-8; a broken name must not break the document.
  std::cout << document.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
}

void check_output_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code code;
  if (!folder.empty() && !std::filesystem::is_directory(folder, code)) {
    throw CommandError("there is no folder '" + folder.string() + "' to write '" + path + "' into",
                       "make the folder first");
  }
  if (std::filesystem::is_directory(path, code)) {
    throw CommandError("'" + path + "' is a folder", "give the name of a file to write");
  }
}

}  // namespace focal_cli
