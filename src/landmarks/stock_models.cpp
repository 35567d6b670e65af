#include "landmarks/stock_models.h"

#include <algorithm>
#include <cstdlib>

#include "base/error.h"

namespace focal {
namespace {

namespace fs = std::filesystem;

#ifdef _WIN32
constexpr char list_separator = ';';
#else
constexpr char list_separator = ':';
#endif

void add_folders_of_variable(std::vector<fs::path>& folders) {
  const char* value = std::getenv("FOCAL_MODELS");
  std::string list = value ? value : "";
  while (!list.empty()) {
    const size_t end = std::min(list.find(list_separator), list.size());
    if (end > 0) folders.emplace_back(list.substr(0, end));
    list.erase(0, end + 1);
  }
}

std::string utf8(const fs::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

void add_models_in(const fs::path& folder, std::vector<StockModel>& models) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code other;
    if (entry->path().extension() != ".focal" || !entry->is_regular_file(other)) continue;
    const std::string name = utf8(entry->path().stem());
    const auto same = [&](const StockModel& one) { return one.name == name; };
    if (std::none_of(models.begin(), models.end(), same)) models.push_back({name, entry->path()});
  }
}

}  // namespace

std::vector<fs::path> stock_folders(const fs::path& of_host, const fs::path& library_folder) {
  std::vector<fs::path> folders;
  if (!of_host.empty()) folders.push_back(of_host);
  add_folders_of_variable(folders);
  if (library_folder.empty()) return folders;
  // A package that carries the library, a build folder, and what `cmake --install` lays down (lib, or lib/x86_64-linux-gnu).
  for (const char* beside : {"models", "../models", "../share/focal/models", "../../share/focal/models"})
    folders.push_back((library_folder / beside).lexically_normal());
  return folders;
}

std::vector<StockModel> stock_models_in(std::span<const fs::path> folders) {
  std::vector<StockModel> models;
  for (const fs::path& folder : folders) add_models_in(folder, models);
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
