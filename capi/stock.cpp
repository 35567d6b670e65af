// Models that come with focal.
#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "model.h"
#include "model/model_file.h"

using namespace focal;

namespace {

const StockModel& stock_at(const ContextObject& context, uint32_t index) {
  check_index(index, context.stock().size(), "this installation", "stock models");
  return context.stock()[index];
}

}  // namespace

uint32_t focal_context_stock_count(const focal_context* context) {
  return guarded_value<uint32_t>(
      0, [&] { return static_cast<uint32_t>(resolve<ContextObject>(context)->stock().size()); });
}

const char* focal_context_stock_name(const focal_context* context, uint32_t index) {
  return guarded_value<const char*>(
      nullptr, [&] { return stock_at(*resolve<ContextObject>(context), index).name.c_str(); });
}

const char* focal_context_stock_path(const focal_context* context, uint32_t index) {
  return guarded_value<const char*>(
      nullptr, [&] { return stock_at(*resolve<ContextObject>(context), index).path.c_str(); });
}

focal_status focal_model_load_stock(const focal_context* context, const char* name, focal_model** out_model) {
  return guarded([&] {
    require(out_model, "out_model");
    require(name, "name");
    auto running = resolve<ContextObject>(context);
    const auto file = path_of(stock_model(running->stock(), name).path.c_str());
    naming_file(file, [&] { *out_model = publish_model(std::move(running), parse_model(read_file(file))); });
  });
}
