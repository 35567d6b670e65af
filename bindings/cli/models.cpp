// focal models: the stock models of this installation, and what each of them finds.
#include "models.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "command_error.h"
#include "options.h"
#include "output.h"
#include "paths.h"
#include "text_table.h"

namespace focal_cli {
namespace {

// A plain name, and no file.
bool may_be_stock_model(const std::string& text) {
  std::error_code error;
  return text.find_first_of("/\\") == std::string::npos && !text.ends_with(".focal") &&
         !std::filesystem::exists(path_of(text), error);
}

Json description_of(const focal_context* context, const StockModel& stock) {
  Json entry = {{"name", stock.name}, {"file", stock.path}};
  try {
    const auto model = owned<Model>(focal_model_load, context, stock.path.c_str());
    auto info = initialised(focal_model_info_init);
    check(focal_model_get_info(model.get(), &info));
    Json landmarks = Json::array();
    for (uint32_t i = 0; i < info.landmark_count; ++i)
      landmarks.push_back(focal_model_landmark_name(model.get(), i));
    entry.update({{"shapes", info.shape_count},
                  {"landmarks", landmarks},
                  {"joints", joint_names_of(model.get())},
                  {"bytes", info.file_bytes}});
  } catch (const CommandError& error) {  // one file that is damaged does not hide the others
    entry["error"] = error.what();
  }
  return entry;
}

void print_models(const Json& report) {
  if (report["models"].empty()) return;
  std::vector<std::vector<std::string>> rows = {{"model", "joints", "landmarks", "learned from", "size"}};
  for (const Json& one : report["models"])
    if (one.contains("error"))
      rows.push_back({one["name"], "-", "-", "cannot be read", "-"});
    else
      rows.push_back({one["name"], std::to_string(one["joints"].size()),
                      std::to_string(one["landmarks"].size()), one["shapes"].dump() + " shapes",
                      bytes_text(one["bytes"].get<double>())});
  print_table(std::cout, rows);
  std::cout << "\nfocal rig " << report["models"][0]["name"].get<std::string>() << " MESH.glb -o OUT.glb\n";
}

void models(const CommonOptions& options) {
  const Context context = make_context(options);
  Json list = Json::array();
  for (const StockModel& stock : stock_models(context.get()))
    list.push_back(description_of(context.get(), stock));
  const Json report = {{"models", list}};
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  print_models(report);
  if (list.empty()) std::cerr << "hint: " << model_hint(context.get()) << "\n";
}

}  // namespace

std::vector<StockModel> stock_models(const focal_context* context) {
  std::vector<StockModel> list;
  const uint32_t count = focal_context_stock_count(context);
  for (uint32_t i = 0; i < count; ++i)
    list.push_back({focal_context_stock_name(context, i), focal_context_stock_path(context, i)});
  return list;
}

std::string model_hint(const focal_context* context) {
  try {
    owned<Model>(focal_model_load_stock, context, "");
  } catch (const CommandError& error) {
    return error.hint;
  }
  return "";
}

bool is_stock_model(const focal_context* context, const std::string& path_or_name) {
  if (!may_be_stock_model(path_or_name)) return false;
  const auto all = stock_models(context);
  return std::any_of(all.begin(), all.end(), [&](const StockModel& one) { return one.name == path_or_name; });
}

Model load_model(const focal_context* context, const std::string& path_or_name) {
  if (is_stock_model(context, path_or_name))
    return owned<Model>(focal_model_load_stock, context, path_or_name.c_str());
  if (!may_be_stock_model(path_or_name)) return owned<Model>(focal_model_load, context, path_or_name.c_str());
  throw CommandError("there is no model file or stock model '" + path_or_name + "'", model_hint(context));
}

void add_model_argument(CLI::App& verb, std::string& path_or_name) {
  verb.add_option("MODEL", path_or_name, "Model file, or the name of a stock model: focal models")
      ->type_name("")
      ->required();
}

void add_models(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("models", "List the stock models, which you use by name");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(*verb, *options);
  verb->callback([options] { models(*options); });
}

}  // namespace focal_cli
