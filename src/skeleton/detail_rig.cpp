#include "skeleton/detail_rig.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "model/landmark_model.h"
#include "skeleton/detail_evidence.h"
#include "skeleton/detail_region.h"
#include "skeleton/rig_transfer.h"

namespace focal {
namespace {

constexpr int32_t fewest_triangles = 40;  // of a region with more detail than the whole body's proxy
constexpr int32_t votes = 400;
// Evidence for joints in a part: chains as separate as on the training shapes (1), agreement of the bulge,
// bones of similar lengths. Hands with fingers of other game packs have 1.02 and more, mittens up to 1.01.
// Less is enough where the part of the other side has enough.
constexpr double separate_share = 2, bulge_share = 2, enough_support = 1.05, enough_beside_pair = 0.7;

// The frame in which most joints of the part are at the mean of the training shapes; some of them may be
// outliers.
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

// From the limb that ends in the part, where the joints beyond it are not sufficient: with the rotation of
// the part's root and the size proportional to the limb's.
Similarity frame_of_limb(const DetailModel& detail, const CharacterRig& rig, const Similarity& usual) {
  const auto& joints = rig.rig.joints;
  const auto number_of = [&](int32_t joint) {
    return static_cast<size_t>(std::find(detail.joints.begin(), detail.joints.end(), joint) -
                               detail.joints.begin());
  };
  const size_t root = number_of(detail.joint), limb = number_of(joints[detail.joint].parent);
  Similarity frame = usual;
  const auto place = [&](int32_t j) -> Vector3 { return joints[j].bind.topRightCorner<3, 1>(); };
  if (limb < detail.joints.size())
    frame.scale = (place(detail.joint) - place(detail.joints[limb])).norm() /
                  std::max((detail.reference[root] - detail.reference[limb]).norm(), 1e-6);
  const auto taught = std::find_if(detail.model->exemplars.begin(), detail.model->exemplars.end(),
                                   [&](const Exemplar& shape) { return shape.rig && shape.rig->bind[root]; });
  if (taught != detail.model->exemplars.end())
    frame.rotation = joints[detail.joint].bind.topLeftCorner<3, 3>() *
                     taught->rig->bind[root]->topLeftCorner<3, 3>().transpose();
  frame.offset = place(detail.joint) - frame.scale * frame.rotation * detail.reference[root];
  return frame;
}

// Rounds to steps much larger than rounding errors of the joints: otherwise the grid of cells in the frame
// would differ on another machine, and for a model that was saved.
Similarity rounded(Similarity frame) {
  constexpr double steps = 512;
  const auto whole = [](double x) { return std::round(steps * x) / steps; };
  Eigen::Quaterniond turn(frame.rotation);
  turn.coeffs() = turn.coeffs().unaryExpr(whole).eval();
  frame.rotation = turn.normalized().toRotationMatrix();
  frame.scale = std::exp(whole(std::log(frame.scale)));
  frame.offset = frame.scale * (frame.offset / frame.scale).unaryExpr(whole).eval();
  return frame;
}

bool are_alike(const Similarity& a, const Similarity& b) {
  constexpr double turned = 0.4, sized = 0.3, moved = 0.3;  // radians, of log scale, of the scale
  return Eigen::AngleAxisd(a.rotation.transpose() * b.rotation).angle() < turned &&
         std::abs(std::log(a.scale / b.scale)) < sized && (a.offset - b.offset).norm() < moved * a.scale;
}

// The result of one analysis of the part, and its evidence.
struct Look {
  Similarity frame;
  DetailRegion region;
  CharacterRig rig;
  double support = -std::numeric_limits<double>::infinity();
};

// No evidence for a part that is not at the end of the limb.
double support_of(const Detection& found, const CharacterRig& rig, const DetailModel& detail) {
  constexpr double farthest_root = 0.5;  // distance from its position in the body's rig, in the part's frame
  for (size_t i = 0; i < detail.joints.size(); ++i)
    if (detail.joints[i] == detail.joint &&
        (rig.rig.joints[i].bind.topRightCorner<3, 1>() - detail.reference[i]).norm() > farthest_root)
      return -std::numeric_limits<double>::infinity();
  return separate_share * median_separateness(found, rig) + bulge_share * found.bulge_agreement -
         bone_strain(detail.reference, rig);
}

Look look_at(const DetailModel& detail, const Detection& detection, const CharacterRig& rig,
             const Similarity& frame, const std::vector<char>& is_of_part, int32_t influences,
             const Execution& execution) {
  Look look{
      frame, cut_region(detection.mesh->source, rig.rig.influences, is_of_part, frame, detail.start), {}};
  if (look.region.mesh.triangle_count() < fewest_triangles) return look;
  DetectParams how;
  how.max_samples = votes;
  how.quality = Quality::interactive;
  how.keep_votes = false;
  try {
    const auto mesh = std::make_shared<const PreparedMesh>(prepare(
        std::move(look.region.mesh), {.analysed = AnalysedSurface::wrapped, .lenient = true}, execution));
    const Detection found = detect(detail.model, mesh, how, execution);
    look.rig = transfer_rig(found, execution, false, influences);
    look.support = support_of(found, look.rig, detail);
  } catch (const Error& error) {
    if (error.status() == Status::cancelled) throw;  // otherwise the part cannot be analysed
  }
  return look;
}

// The weights of the part, from its own rig, divide the weight that the whole-body rig gives to the part;
// without a rig its root gets all of it.
void share_weights(const DetailModel& detail, const std::vector<char>& is_below, int32_t influences,
                   size_t source, const VertexInfluences* own, Rig& rig) {
  const auto influences_of = [&](const auto& use) {
    for (const Influence& one : rig.influences[source]) use(one);
    if (rig.more.empty()) return;
    for (const Influence& one : rig.more[source]) use(one);
  };
  float of_part = 0, found = 0;
  influences_of([&](const Influence& one) { of_part += is_below[one.joint] ? one.weight : 0; });
  if (!(of_part > 0)) return;  // most vertices of a body
  Eigen::RowVectorXf weights = Eigen::RowVectorXf::Zero(static_cast<Eigen::Index>(rig.joints.size()));
  influences_of([&](const Influence& one) { weights[one.joint] += is_below[one.joint] ? 0 : one.weight; });
  if (own)
    for (const Influence& one : *own)
      if (is_below[detail.joints[one.joint]]) found += one.weight;
  if (!(found > 0)) weights[detail.joint] += of_part;
  if (own && found > 0)
    for (const Influence& one : *own)
      if (is_below[detail.joints[one.joint]])
        weights[detail.joints[one.joint]] += of_part * one.weight / found;
  rig.influences[source] = {};
  if (!rig.more.empty()) rig.more[source] = {};
  put_influences(weights, influences, source, rig);
}

void take_over(const Look& look, const DetailModel& detail, const std::vector<char>& is_below,
               int32_t influences, CharacterRig& rig) {
  auto& joints = rig.rig.joints;
  for (size_t i = 0; i < detail.joints.size(); ++i) {
    const int32_t j = detail.joints[i];
    if (!is_below[j]) continue;
    rig.tip[j] = look.frame(look.rig.tip[i]);
    if (j == detail.joint) continue;
    const Matrix4& bind = look.rig.rig.joints[i].bind;
    joints[j].bind.topRightCorner<3, 1>() = look.frame(bind.topRightCorner<3, 1>());
    joints[j].bind.topLeftCorner<3, 3>() = look.frame.rotation * bind.topLeftCorner<3, 3>();
    rig.confidence[j] = look.rig.confidence[i];
  }
  for (size_t v = 0; v < look.region.source_vertex.size(); ++v)
    if (const int32_t source = look.region.source_vertex[v]; source >= 0)
      share_weights(detail, is_below, influences, static_cast<size_t>(source), &look.rig.rig.influences[v],
                    rig.rig);
}

// The joints are at the mean of the training shapes and move no vertex: the mesh has no such parts, like a
// mitten without fingers.
void leave_out(const Look& look, const DetailModel& detail, const std::vector<char>& is_below,
               int32_t influences, CharacterRig& rig) {
  auto& joints = rig.rig.joints;
  if (rig.left_out.empty()) rig.left_out.assign(joints.size(), 0);
  int32_t count = 0;
  for (size_t i = 0; i < detail.joints.size(); ++i) {
    const int32_t j = detail.joints[i];
    if (!is_below[j] || j == detail.joint) continue;
    joints[j].bind.topRightCorner<3, 1>() = look.frame(detail.reference[i]);
    rig.tip[j] = look.frame(detail.reference[i]);
    rig.confidence[j] = 0, rig.left_out[j] = 1, ++count;
  }
  for (size_t v = 0; v < rig.rig.influences.size(); ++v)
    share_weights(detail, is_below, influences, v, nullptr, rig.rig);
  rig.warnings.push_back("the mesh shows no separate parts for the " + std::to_string(count) +
                         " joints beyond '" + joints[detail.joint].name + "': they move no vertex");
}

Look best_look(const DetailModel& detail, const Detection& detection, int32_t influences,
               const CharacterRig& rig, const Execution& execution) {
  const auto& joints = rig.rig.joints;
  const std::vector<char> is_below = at_or_below(joints, detail.joint);
  std::vector<char> is_of_part = is_below;
  if (const int32_t p = joints[detail.joint].parent; p >= 0) is_of_part[p] = 1;
  const Similarity frame = rounded(found_frame(detail, rig, is_below)),
                   by_limb = rounded(frame_of_limb(detail, rig, frame));
  Look look = look_at(detail, detection, rig, frame, is_of_part, influences, execution);
  if (look.support >= enough_support) return look;
  if (!are_alike(frame, by_limb)) {
    Look other = look_at(detail, detection, rig, by_limb, is_of_part, influences, execution);
    if (other.support > look.support) look = std::move(other);
  }
  if (look.support < enough_beside_pair) look.frame = by_limb;
  return look;
}

// A part exists if there is enough evidence; less is required where the same part of the other side exists.
std::vector<char> are_there(const std::vector<DetailModel>& details, const std::vector<Look>& looks,
                            const std::vector<Joint>& joints) {
  const std::vector<int32_t> other = other_sides(joints);
  std::vector<char> result;
  for (size_t d = 0; d < details.size(); ++d) {
    double needed = enough_support;
    for (size_t e = 0; e < details.size(); ++e)
      if (details[e].joint == other[details[d].joint] && looks[e].support >= enough_support)
        needed = enough_beside_pair;
    result.push_back(looks[d].support >= needed);
  }
  return result;
}

}  // namespace

void refine_details(const Detection& detection, int32_t influences, CharacterRig& rig,
                    const Execution& execution) {
  const std::vector<DetailModel>& details = detection.model->details;
  std::vector<Look> looks;  // all of them before the rig changes
  for (const DetailModel& detail : details) {
    execution.check_cancelled();
    looks.push_back(best_look(detail, detection, influences, rig, execution));
  }
  const std::vector<char> is_there = are_there(details, looks, rig.rig.joints);
  for (size_t d = 0; d < details.size(); ++d) {
    const std::vector<char> is_below = at_or_below(rig.rig.joints, details[d].joint);
    (is_there[d] ? take_over : leave_out)(looks[d], details[d], is_below, influences, rig);
  }
}

}  // namespace focal
