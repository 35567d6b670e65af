// A model by the path of its file, or a stock model by its name.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "handles.h"

namespace focal_cli {

// A file of that path counts before a stock model of that name.
bool is_stock_model(const focal_context* context, const std::string& path_or_name);
Model load_model(const focal_context* context, const std::string& path_or_name);

struct StockModel {
  std::string name, path;
};

// Those that this installation has, by name.
std::vector<StockModel> stock_models(const focal_context* context);

// MODEL, which a verb needs.
void add_model_argument(CLI::App& verb, std::string& path_or_name);

// What to do without a model: the names of the stock models, or how to get some.
std::string model_hint(const focal_context* context);

}  // namespace focal_cli
