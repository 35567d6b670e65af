#include "model/stock_models.h"

#include <algorithm>

#include "base/error.h"
#include "base/system.h"

namespace focal {
namespace {

void add_folders_of_variable(std::vector<std::string>& folders) {
  std::string list = environment_variable("FOCAL_MODELS");
  while (!list.empty()) {
    const size_t end = std::min(list.find(list_separator), list.size());
    if (end > 0) folders.emplace_back(list.substr(0, end));
    list.erase(0, end + 1);
  }
}

constexpr std::string_view suffix = ".focal";

void add_models_in(const std::string& folder, std::vector<StockModel>& models) {
  for (const std::string& file : regular_files_in(folder)) {
    if (!file.ends_with(suffix) || file == suffix) continue;
    const std::string name = file.substr(0, file.size() - suffix.size());
    const auto same = [&](const StockModel& one) { return one.name == name; };
    if (std::none_of(models.begin(), models.end(), same)) models.push_back({name, folder + "/" + file});
  }
}

}  // namespace

std::vector<std::string> stock_folders(const std::string& of_host, const std::string& library_folder) {
  std::vector<std::string> folders;
  if (!of_host.empty()) folders.push_back(of_host);
  add_folders_of_variable(folders);
  if (library_folder.empty()) return folders;
  // A package that contains the library, a build folder, and the layout of `cmake --install` (lib, or
  // lib/x86_64-linux-gnu).
  for (const char* beside : {"/models", "/../models", "/../share/focal/models", "/../../share/focal/models"})
    folders.push_back(library_folder + beside);
  return folders;
}

std::vector<StockModel> stock_models_in(std::span<const std::string> folders) {
  std::vector<StockModel> models;
  for (const std::string& folder : folders) add_models_in(folder, models);
  std::sort(models.begin(), models.end(),
            [](const StockModel& a, const StockModel& b) { return a.name < b.name; });
  return models;
}

std::string stock_hint(std::span<const StockModel> models) {
  if (models.empty())
    return "no stock model is installed: samples/stock/make.sh makes humanoid, quadruped and hand, "
           "FOCAL_MODELS names "
           "the folders of models, and 'focal train --rigs' learns your own";
  std::string list;
  for (const StockModel& one : models) list += (list.empty() ? "" : ", ") + one.name;
  return "stock models: " + list;
}

const StockModel& stock_model(std::span<const StockModel> models, const std::string& name) {
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const StockModel& one) { return one.name == name; });
  if (found == models.end())
    throw Error(Status::file_not_found, "there is no stock model '" + name + "'", stock_hint(models));
  return *found;
}

}  // namespace focal
