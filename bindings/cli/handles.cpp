// The library's errors as CommandError.
#include "handles.h"

#include <string_view>

#include "command_error.h"

namespace focal_cli {

void check(focal_status status, const std::string& about) {
  if (status == FOCAL_OK) return;
  const std::string_view text = focal_last_error();
  static constexpr std::string_view mark = "\nhint: ";
  const size_t cut = text.find(mark);
  std::string hint(cut == std::string_view::npos ? std::string_view() : text.substr(cut + mark.size()));
  std::string message(text.substr(0, cut));
  if (message.empty()) message = focal_status_name(status);
  throw CommandError(about + message, std::move(hint));
}

std::vector<std::string> joint_names_of(const focal_model* model) {
  std::vector<std::string> names(focal_model_joint_count(model));
  for (uint32_t i = 0; i < names.size(); ++i) names[i] = focal_model_joint_name(model, i);
  return names;
}

}  // namespace focal_cli
