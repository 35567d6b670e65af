// Stock models, installed with focal or in a folder that the user names: files NAME.focal, loaded by name.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace focal {

struct StockModel {
  std::string name, path;
};

// The folders to search, in order: the host's own folder (empty: none), those that FOCAL_MODELS lists, and
// those of an installation whose library is in library_folder (empty: unknown).
std::vector<std::string> stock_folders(const std::string& of_host, const std::string& library_folder);

// Sorted by name; the first folder that has a name takes precedence. Folders that are missing or unreadable
// are skipped.
std::vector<StockModel> stock_models_in(std::span<const std::string> folders);

// Throws file_not_found with the names of the existing ones.
const StockModel& stock_model(std::span<const StockModel> models, const std::string& name);

// A hint for errors without a model: the existing stock models, or how to get some.
std::string stock_hint(std::span<const StockModel> models);

}  // namespace focal
