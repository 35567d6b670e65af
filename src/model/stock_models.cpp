#include "model/stock_models.h"

#include <dirent.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.h"

namespace focal {
namespace {

#ifdef _WIN32
constexpr char list_separator = ';';
#else
constexpr char list_separator = ':';
#endif

void add_folders_of_variable(std::vector<std::string>& folders) {
  const char* value = std::getenv("FOCAL_MODELS");
  std::string list = value ? value : "";
  while (!list.empty()) {
    const size_t end = std::min(list.find(list_separator), list.size());
    if (end > 0) folders.emplace_back(list.substr(0, end));
    list.erase(0, end + 1);
  }
}

constexpr std::string_view suffix = ".focal";

bool is_file(const std::string& path) {
  struct stat found;
  return ::stat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode);
}

void add_models_in(const std::string& folder, std::vector<StockModel>& models) {
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(folder.c_str()), ::closedir);
  if (!listing) return;
  while (const dirent* entry = ::readdir(listing.get())) {
    const std::string_view file = entry->d_name;
    if (!file.ends_with(suffix) || file == suffix) continue;
    const std::string name(file.substr(0, file.size() - suffix.size())), path = folder + "/" + entry->d_name;
    const auto same = [&](const StockModel& one) { return one.name == name; };
    if (is_file(path) && std::none_of(models.begin(), models.end(), same)) models.push_back({name, path});
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
