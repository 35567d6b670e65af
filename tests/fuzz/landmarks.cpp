// Any text as a landmark file of each format (the first byte chooses) or as a skeleton template: refused with a message, or read, written
// and read again.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "command_error.h"
#include "fuzz.h"
#include "landmark_files.h"
#include "skeleton/template_file.h"

namespace {

void read_landmarks(focal_cli::LandmarkFormat format, std::string_view text) {
  focal_cli::LandmarkFile file;
  try {
    file = focal_cli::parse_landmarks(format, text);
  } catch (const focal_cli::CommandError& error) {
    fuzz::insist(error.what()[0] != '\0', "an error says something");
    return;
  } catch (const nlohmann::json::exception&) {
    return;  // told of with the file's name by whoever opened it
  }
  for (const auto& mark : file.landmarks) {
    fuzz::insist(!mark.name.empty(), "landmarks have names");
    if (mark.position)
      for (const double x : *mark.position) fuzz::insist(std::isfinite(x), "positions are finite");
  }
  if (format != focal_cli::LandmarkFormat::own_json) return;  // the others leave absent landmarks out
  const std::string written = focal_cli::format_landmarks(format, file);
  fuzz::insist(focal_cli::parse_landmarks(format, written).landmarks.size() == file.landmarks.size(),
               "nothing is lost");
}

}  // namespace

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  constexpr int formats = 5;
  if (data[0] % (formats + 1) < formats) {
    read_landmarks(static_cast<focal_cli::LandmarkFormat>(data[0] % (formats + 1)), text);
    return 0;
  }
  try {
    focal::parse_skeleton_template(text.c_str());
  } catch (const focal::Error& error) {
    fuzz::insist(error.status() != focal::Status::internal && !error.hint().empty(),
                 "an error has a status and a hint");
  }
  return 0;
}
