#include "skeleton/detail_rig.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "landmarks/model_parts.h"
#include "skeleton/detail_region.h"
#include "skeleton/rig_transfer.h"

namespace focal {
namespace {

constexpr int32_t fewest_triangles = 40;  // of a region that shows more than the whole body's proxy does
constexpr int32_t votes = 400;
constexpr double root_trust = 3;  // beside one of the joints beyond it

std::vector<char> part_of(const std::vector<Joint>& joints, int32_t root) {
  std::vector<char> result(joints.size(), 0);
  for (size_t j = 0; j < joints.size(); ++j)
    result[j] = static_cast<int32_t>(j) == root || (joints[j].parent >= 0 && result[joints[j].parent]);
  return result;
}

// The frame in which most joints of the part lie as in the mean of the training shapes: some of them may lie anywhere.
Similarity found_frame(const DetailModel& detail, const CharacterRig& rig,
                       const std::vector<char>& is_below) {
  constexpr int rounds = 12;
  const auto count = static_cast<Eigen::Index>(detail.joints.size());
  MatrixX3 from(count, 3), to(count, 3);
  Vector weight = Vector::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int32_t j = detail.joints[static_cast<size_t>(i)];
    from.row(i) = detail.reference[static_cast<size_t>(i)].transpose();
    to.row(i) = rig.rig.joints[j].bind.topRightCorner<3, 1>().transpose();
    if (is_below[j]) weight[i] = j == detail.joint ? root_trust : 0.05 + rig.confidence[j];
  }
  Similarity frame = fit_similarity(from, to, weight);
  for (int round = 0; round < rounds; ++round) {
    Vector away(count);
    std::vector<double> sorted;
    for (Eigen::Index i = 0; i < count; ++i) {
      away[i] = (frame(from.row(i).transpose()) - to.row(i).transpose()).norm();
      if (weight[i] > 0) sorted.push_back(away[i]);
    }
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double usual = std::max(*middle, 1e-6 * frame.scale);
    Vector trusted = weight;
    for (Eigen::Index i = 0; i < count; ++i) trusted[i] /= 1 + std::pow(away[i] / usual, 2);
    frame = fit_similarity(from, to, trusted);
  }
  return frame;
}

// The weights of the part, which come from its own rig, share what the whole-body rig gives to the part.
void share_weights(const CharacterRig& part, const DetailModel& detail, const DetailRegion& region,
                   const std::vector<char>& is_below, int32_t influences, CharacterRig& rig) {
  for (size_t v = 0; v < region.source_vertex.size(); ++v) {
    const int32_t source = region.source_vertex[v];
    if (source < 0) continue;
    Eigen::RowVectorXf weights = Eigen::RowVectorXf::Zero(static_cast<Eigen::Index>(rig.rig.joints.size()));
    float of_part = 0, found = 0;
    const auto take = [&](const VertexInfluences& all) {
      for (const Influence& one : all) (is_below[one.joint] ? of_part : weights[one.joint]) += one.weight;
    };
    take(rig.rig.influences[source]);
    if (!rig.rig.more.empty()) take(rig.rig.more[source]);
    for (const Influence& one : part.rig.influences[v])
      if (is_below[detail.joints[one.joint]]) found += one.weight;
    for (const Influence& one : part.rig.influences[v])
      if (is_below[detail.joints[one.joint]] && found > 0)
        weights[detail.joints[one.joint]] += of_part * one.weight / found;
    if (!(found > 0)) weights[detail.joint] += of_part;
    put_influences(weights, influences, static_cast<size_t>(source), rig.rig);
  }
}

void refine(const DetailModel& detail, const Detection& detection, int32_t influences, CharacterRig& rig,
            const Execution& execution) {
  auto& joints = rig.rig.joints;
  const std::vector<char> is_below = part_of(joints, detail.joint);
  std::vector<char> is_of_part = is_below;
  if (const int32_t p = joints[detail.joint].parent; p >= 0) is_of_part[p] = 1;
  const Similarity frame = found_frame(detail, rig, is_below);
  DetailRegion region =
      cut_region(detection.mesh->source, rig.rig.influences, is_of_part, frame, detail.start);
  if (region.mesh.triangle_count() < fewest_triangles) return;
  const auto mesh = std::make_shared<const PreparedMesh>(
      prepare(std::move(region.mesh), {.analysed = AnalysedSurface::wrapped, .lenient = true}, execution));
  DetectParams how;
  how.max_samples = votes;
  how.orientation = DetectParams::Orientation::known;
  how.keep_votes = false;
  const Detection found = detect(detail.model, mesh, how, execution);
  const CharacterRig part = transfer_rig(found, execution, false, influences);
  for (size_t i = 0; i < detail.joints.size(); ++i) {
    const int32_t j = detail.joints[i];
    if (!is_below[j]) continue;
    if (j != detail.joint) {
      joints[j].bind.topRightCorner<3, 1>() = frame(part.rig.joints[i].bind.topRightCorner<3, 1>());
      joints[j].bind.topLeftCorner<3, 3>() = frame.rotation * part.rig.joints[i].bind.topLeftCorner<3, 3>();
      rig.confidence[j] = part.confidence[i];
    }
    rig.tip[j] = frame(part.tip[i]);
  }
  share_weights(part, detail, region, is_below, influences, rig);
}

}  // namespace

void refine_details(const Detection& detection, int32_t influences, CharacterRig& rig,
                    const Execution& execution) {
  for (const DetailModel& detail : detection.model->details) {
    execution.check_cancelled();
    refine(detail, detection, influences, rig, execution);
  }
}

}  // namespace focal
