#include "skeleton/teachers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "skeleton/joint_match.h"

namespace focal {
namespace {

// Relative to the mesh's largest extent: joints not farther apart coincide.
constexpr double one_place = 1e-4;
constexpr double min_weighted = 0.5;  // share of the vertices that joints should move
constexpr size_t most_named = 4;      // maximum number of joints, or groups of characters, in one sentence
constexpr size_t max_numbered = 12;   // maximum number of characters in one sentence

using Names = std::vector<std::string>;

std::string listed(const Names& names) {
  return quoted(names, most_named) + (names.size() > most_named ? ", ..." : "");
}

std::string number_text(const std::vector<RiggedMesh>& characters, size_t index) {
  const std::string& file = characters[index].file;
  return std::to_string(index + 1) + (file.empty() ? "" : " (" + file + ")");
}

// "character 2 (b.glb)", "characters 2, 3 and 7".
std::string called(const std::vector<RiggedMesh>& characters, const std::vector<size_t>& which) {
  const size_t said = which.size() > max_numbered ? max_numbered - 1 : which.size();
  std::string text = which.size() == 1 ? "character " : "characters ";
  for (size_t i = 0; i < said; ++i)
    text += (i == 0 ? "" : i + 1 == which.size() ? " and " : ", ") + number_text(characters, which[i]);
  return text + (said < which.size() ? " and " + std::to_string(which.size() - said) + " more" : "");
}

// Only joints that move something: others are controls, which need no match.
std::vector<Names> moving_joints(const std::vector<RiggedMesh>& characters) {
  std::vector<Names> result;
  for (const RiggedMesh& character : characters) {
    const std::vector<double> moved = weight_below(character.rig);
    Names& names = result.emplace_back();
    for (size_t j = 0; j < moved.size(); ++j)
      if (moved[j] > 0) names.push_back(character.rig.joints[j].name);
  }
  return result;
}

std::map<std::string, int32_t> counted(const std::vector<Names>& characters) {
  std::map<std::string, int32_t> result;
  for (const Names& names : characters)
    for (const std::string& name : std::set<std::string>(names.begin(), names.end())) ++result[name];
  return result;
}

// Pairs of characters that share a joint, over all joints.
int64_t matches(const std::vector<Names>& characters) {
  int64_t result = 0;
  for (const auto& [name, count] : counted(characters)) result += int64_t{count} * (count - 1);
  return result;
}

// The spelling with most matching joints; of equal ones the one that changes less.
Spelling best_spelling(const std::vector<Names>& moving) {
  Spelling best = Spelling::as_written;
  int64_t most = matches(moving);
  for (const Spelling spelling :
       {Spelling::without_prefix, Spelling::without_any_prefix, Spelling::humanoid}) {
    std::vector<Names> tried;
    for (const Names& names : moving) tried.push_back(spelled(names, spelling));
    if (const int64_t count = matches(tried); count > most) most = count, best = spelling;
  }
  return best;
}

// Renames the joints as in the first character that has the joint.
void rename(std::vector<RiggedMesh>& characters, Spelling spelling, Names& warnings) {
  std::map<std::string, std::string> first;              // spelling -> name
  std::map<std::string, std::vector<size_t>> put_aside;  // prefix -> characters
  for (size_t c = 0; c < characters.size(); ++c) {
    auto& joints = characters[c].rig.joints;
    Names names;
    for (const Joint& joint : joints) names.push_back(joint.name);
    const Names plain = spelled(names, spelling);
    std::set<std::string> dropped;
    for (size_t j = 0; j < joints.size(); ++j) {
      joints[j].name = first.emplace(plain[j], names[j]).first->second;
      if (joints[j].name != names[j]) dropped.insert(names[j].substr(0, names[j].size() - plain[j].size()));
    }
    for (const std::string& prefix : dropped) put_aside[prefix].push_back(c);
  }
  for (const auto& [prefix, which] : put_aside)
    warnings.push_back(called(characters, which) +
                       (prefix.empty() ? ": joints are matched with those that have a prefix elsewhere"
                                       : ": the prefix '" + prefix +
                                             "' of the joints' names is ignored, so that they match"));
}

// What one character has in common with the others.
struct Shared {
  Names joints, others;
  double share() const {
    const size_t all = joints.size() + others.size();
    return all ? static_cast<double>(joints.size()) / static_cast<double>(all) : 0;
  }
};

std::vector<Shared> shared_joints(const std::vector<Names>& moving) {
  const auto count = counted(moving);
  std::vector<Shared> result;
  for (const Names& names : moving) {
    Shared& one = result.emplace_back();
    for (const std::string& name : names)
      // At least half of the others have it.
      (2 * (count.at(name) - 1) >= static_cast<int32_t>(moving.size()) - 1 ? one.joints : one.others)
          .push_back(name);
  }
  return result;
}

// One clause for all characters that share the same joints and have equally many.
Names clauses(const std::vector<RiggedMesh>& characters, const std::vector<Shared>& shared, double below) {
  std::map<std::tuple<double, Names, size_t>, std::vector<size_t>> groups;
  for (size_t c = 0; c < shared.size(); ++c)
    if (shared[c].share() < below)
      groups[{shared[c].share(), shared[c].joints, shared[c].others.size()}].push_back(c);
  Names result;
  for (const auto& [key, which] : groups) {
    const Shared& one = shared[which[0]];
    const std::string verb = which.size() == 1 ? " shares " : " share ";
    const std::string found = one.joints.empty() ? "none" : std::to_string(one.joints.size());
    result.push_back(called(characters, which) + verb + found + " of " +
                     std::to_string(one.joints.size() + one.others.size()) + " joints with the others" +
                     (one.joints.empty() ? "" : ": " + listed(one.joints)) +
                     (one.others.empty() ? "" : "; other joints are named " + listed(one.others)));
  }
  return result;
}

void check_shared(const std::vector<RiggedMesh>& characters, const std::vector<Names>& moving,
                  Names& warnings) {
  if (characters.size() < 2) return;
  const std::vector<Shared> shared = shared_joints(moving);
  std::vector<double> shares;
  for (const Shared& one : shared) shares.push_back(one.share());
  std::nth_element(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2),
                   shares.end());
  Names odd = clauses(characters, shared, 0.5);
  if (shares[shares.size() / 2] < 0.5) {
    std::string text = "the characters do not share one skeleton: ";
    for (size_t i = 0; i < std::min(odd.size(), most_named); ++i) text += (i ? "; " : "") + odd[i];
    throw Error(
        Status::invalid_argument, text + (odd.size() > most_named ? "; ..." : ""),
        "joints are matched by name: train with characters of one skeleton, or rename the joints alike");
  }
  warnings.insert(warnings.end(), odd.begin(), odd.end());
  Names left_out;
  for (const auto& [name, count] : counted(moving))
    if (2 * count < static_cast<int32_t>(characters.size())) left_out.push_back(name);
  if (!left_out.empty())
    warnings.push_back((left_out.size() == 1
                            ? "1 joint that fewer than half of the characters have is left out: "
                            : std::to_string(left_out.size()) +
                                  " joints that fewer than half of the characters have are left out: ") +
                       listed(left_out));
}

// Joints at one position define no landmarks, vertices without weights no parts.
void check_skin(const std::vector<RiggedMesh>& characters, size_t index, Names& warnings) {
  const RiggedMesh& character = characters[index];
  const auto say = [&](const std::string& what) { warnings.push_back(called(characters, {index}) + what); };
  if (const int64_t invalid = character.invalid_weights)
    say(": " + std::to_string(invalid) + (invalid == 1 ? " skin weight is" : " skin weights are") +
        " negative, NaN or infinite and left out");
  const std::vector<double> moved = weight_below(character.rig);
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  int32_t joints = 0;
  for (size_t j = 0; j < moved.size(); ++j) {
    if (moved[j] <= 0) continue;
    const Vector3 place = character.rig.joints[j].bind.topRightCorner<3, 1>();
    low = low.cwiseMin(place), high = high.cwiseMax(place), ++joints;
  }
  const MatrixX3 positions = analysed_positions(*character.mesh);
  const double size = (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff();
  if (joints > 1 && (high - low).maxCoeff() < one_place * size)
    say(": all of its " + std::to_string(joints) +
        " joints are at one position; check that its skeleton was exported in its bind pose");
  int64_t bare = 0;
  const auto& used = character.mesh->source_vertex;
  for (const int32_t v : used) bare += !(character.rig.influences[v][0].weight > 0);
  if (const double share = static_cast<double>(bare) / static_cast<double>(used.size());
      share > 1 - min_weighted)
    say(": " + std::to_string(static_cast<int>(100 * share)) + " % of its vertices have no skin weights");
}

}  // namespace

std::vector<double> weight_below(const Rig& rig) {
  std::vector<double> sum(rig.joints.size(), 0);
  for (const auto& influences : rig.influences)
    for (const Influence& one : influences) sum[one.joint] += one.weight;
  for (size_t j = rig.joints.size(); j-- > 0;)
    if (rig.joints[j].parent >= 0) sum[rig.joints[j].parent] += sum[j];
  return sum;
}

std::vector<std::string> match_teachers(std::vector<RiggedMesh>& characters) {
  Names warnings;
  for (size_t c = 0; c < characters.size(); ++c) check_skin(characters, c, warnings);
  if (const Spelling spelling = best_spelling(moving_joints(characters)); spelling != Spelling::as_written)
    rename(characters, spelling, warnings);
  check_shared(characters, moving_joints(characters), warnings);
  return warnings;
}

}  // namespace focal
