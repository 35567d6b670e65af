#include <algorithm>
#include <cmath>

#include "descriptors/bulge.h"
#include "model/sections.h"

namespace focal {
namespace {

constexpr float longest_distance = 1000;  // distance in units of sqrt(area)
constexpr float bulge_steps = 32767, direction_steps = 127, most_direction = 2;

// Maps -most..most to 0..2 steps.
int32_t to_steps(float value, float most, float steps) {
  return static_cast<int32_t>(std::lround(std::clamp(value / most, -1.0F, 1.0F) * steps) +
                              std::lround(steps));
}
float from_steps(int32_t number, float most, float steps) {
  return (static_cast<float>(number) - steps) / steps * most;
}

}  // namespace

float kept_bulge(float value) { return from_steps(to_steps(value, 1, bulge_steps), 1, bulge_steps); }
float kept_direction(float value) {
  return from_steps(to_steps(value, most_direction, direction_steps), most_direction, direction_steps);
}

void write_exemplars(const LandmarkModel& model, ByteWriter& out) {
  const auto L = static_cast<Eigen::Index>(model.landmark_names.size());
  for (const int32_t shape : model.sample_shape) out.u16(static_cast<uint16_t>(shape));
  for (const Exemplar& shape : model.exemplars) {
    out.u8(static_cast<uint8_t>(shape.bulge.cols()));
    for (const float value : shape.bulge.reshaped<Eigen::RowMajor>())
      out.u16(static_cast<uint16_t>(to_steps(value, 1, bulge_steps)));
    const ConstellationSample& sample = shape.constellation;
    out.u8(sample.has_chirality);
    for (Eigen::Index i = 0; i < L * L; ++i) {
      out.f32(sample.distance.data()[i]);
      for (const RowMatrixf* way : {&sample.directions.x, &sample.directions.y})
        out.u8(static_cast<uint8_t>(to_steps(way->data()[i], most_direction, direction_steps)));
    }
  }
}

void read_exemplars(ByteReader in, LandmarkModel& model) {
  const auto L = static_cast<Eigen::Index>(model.landmark_names.size());
  const auto shapes = static_cast<int32_t>(model.exemplars.size());
  for (Eigen::Index s = 0; s < model.targets.rows(); ++s) {
    model.sample_shape.push_back(in.u16("shape of a sample"));
    if (model.sample_shape.back() >= shapes) in.fail("a sample is of no shape");
  }
  for (Exemplar& shape : model.exemplars) {
    const int32_t radii = in.u8("radii");
    if (radii != 0 && radii != static_cast<int32_t>(bulge_radii.size()))
      in.fail("the radii are not those of the method");
    shape.bulge.resize(shape.distances.rows(), radii);
    for (float& value : shape.bulge.reshaped<Eigen::RowMajor>())
      value = from_steps(in.u16("bulge"), 1, bulge_steps);
    ConstellationSample& sample = shape.constellation;
    sample.present = shape.marked;
    sample.has_chirality = in.u8("chirality") != 0;
    std::vector<float> distance, x, y;  // grown while reading: no allocation exceeds the file's size
    for (Eigen::Index i = 0; i < L * L; ++i) {
      distance.push_back(in.f32("distance of landmarks", 0, longest_distance));
      for (std::vector<float>* way : {&x, &y})
        way->push_back(from_steps(in.u8("direction"), most_direction, direction_steps));
    }
    const auto matrix = [&](const std::vector<float>& values) -> RowMatrixf {
      return Eigen::Map<const RowMatrixf>(values.data(), L, L);
    };
    sample.distance = matrix(distance), sample.directions = {matrix(x), matrix(y)};
  }
  in.expect_end();
}

}  // namespace focal
