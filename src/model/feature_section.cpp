#include <limits>

#include "model/feature_layout.h"
#include "model/forest_file.h"
#include "model/sections.h"

namespace focal {

void write_features(const LandmarkModel& model, ByteWriter& out) {
  out.u8(model.params.bulge), out.u8(model.params.oriented);
  if (!model.params.oriented) return;
  out.u32(static_cast<uint32_t>(model.facing_targets.rows()));
  if (!model.params.finds_heading) return;
  for (const float value : model.facing_targets.reshaped<Eigen::RowMajor>()) out.u16(place_to_file(value));
  out.u32(static_cast<uint32_t>(model.facing.trees.size()));
  for (const RegressionForest* forest : {&model.rising, &model.facing})
    write_forest(*forest, static_cast<int32_t>(model.facing_targets.rows()), out);
}

void read_features(ByteReader in, LandmarkModel& model) {
  model.params.bulge = in.u8("bulge") != 0, model.params.oriented = in.u8("orientation") != 0;
  if (model.params.oriented) {
    constexpr int32_t columns = 6;
    const int32_t rows = in.count("sample count", columns * 16);
    model.facing_targets.resize(rows, columns);
    for (float& value : model.facing_targets.reshaped<Eigen::RowMajor>())
      value = place_from_file(in.u16("place"));
    model.params.finds_heading = rows > 0;
    if (rows > 0) {
      const int32_t trees = in.i32("tree count", 1, std::numeric_limits<int32_t>::max());
      model.rising = read_forest(in, LeafKind::samples, trees, rows, invariant_feature_count(model.params));
      model.facing = read_forest(in, LeafKind::samples, trees, rows, upright_feature_count(model.params));
    }
  }
  in.expect_end();
}

}  // namespace focal
