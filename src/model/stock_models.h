// Models that come with focal, or lie in a folder that the user names: files NAME.focal, loaded by name.
//
// Texts and system calls, no std::filesystem: its paths and iterators end the process where memory is refused.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace focal {

struct StockModel {
  std::string name, path;
};

// Where they are looked for, in order: the host's own folder (empty: none), those that FOCAL_MODELS lists, and those that belong to
// an installation whose library lies in library_folder (empty: not known).
std::vector<std::string> stock_folders(const std::string& of_host, const std::string& library_folder);

// By name; of files of one name that of the first folder counts. Folders that are missing or cannot be read hold none.
std::vector<StockModel> stock_models_in(std::span<const std::string> folders);

// Throws file_not_found, naming those that are there.
const StockModel& stock_model(std::span<const StockModel> models, const std::string& name);

// What to do without a model, for the end of an error: which stock models there are, or how to get them.
std::string stock_hint(std::span<const StockModel> models);

}  // namespace focal
