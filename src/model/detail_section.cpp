#include <algorithm>

#include "base/error.h"
#include "model/model_file.h"
#include "model/sections.h"

namespace focal {
namespace {

// For coordinates of a part's joints in its frame, where the mean joint distance is 1.
constexpr float farthest_joint = 1e6F;

// Reads the part's own model file, with the same validation.
std::shared_ptr<const LandmarkModel> read_part(ByteReader& in, size_t joints) {
  const uint64_t size = in.u64("size of a part's model");
  std::shared_ptr<LandmarkModel> part;
  try {
    part =
        std::make_shared<LandmarkModel>(parse_model(in.raw("a part's model", size), PartsOfModel::refused));
  } catch (const Error& error) {
    in.fail(std::string("a part's model: ") + error.what());
  }
  if (part->skeleton.size() != joints) in.fail("a part's model has another number of joints");
  return part;
}

DetailModel read_detail(ByteReader& in, const std::vector<SkeletonJoint>& skeleton) {
  const auto last = static_cast<int32_t>(skeleton.size()) - 1;
  DetailModel detail;
  detail.joint = in.i32("root of a part", 0, last);
  detail.start = in.f32("start of a part", -farthest_joint, farthest_joint);
  const int32_t joints = in.count("joint count", 4 * 32, 1);
  for (int32_t i = 0; i < joints; ++i) {
    detail.joints.push_back(in.i32("joint", 0, last));
    Vector3& place = detail.reference.emplace_back();
    for (double& x : place) x = in.f32("place", -farthest_joint, farthest_joint);
  }
  if (std::find(detail.joints.begin(), detail.joints.end(), detail.joint) == detail.joints.end())
    in.fail("a part lacks its root");
  detail.model = read_part(in, detail.joints.size());
  return detail;
}

}  // namespace

void write_details(const LandmarkModel& model, ByteWriter& out) {
  out.u32(static_cast<uint32_t>(model.details.size()));
  for (const DetailModel& detail : model.details) {
    out.i32(detail.joint);
    out.f32(static_cast<float>(detail.start));
    out.u32(static_cast<uint32_t>(detail.joints.size()));
    for (size_t i = 0; i < detail.joints.size(); ++i) {
      out.i32(detail.joints[i]);
      for (const double x : detail.reference[i]) out.f32(static_cast<float>(x));
    }
    const std::vector<std::byte> part = serialise(*detail.model);
    out.u64(part.size());
    out.raw(part);
  }
}

void read_details(ByteReader in, LandmarkModel& model) {
  const int32_t count = in.count("part count", 5 * 32, 1);
  for (int32_t d = 0; d < count; ++d) model.details.push_back(read_detail(in, model.skeleton));
  in.expect_end();
}

}  // namespace focal
