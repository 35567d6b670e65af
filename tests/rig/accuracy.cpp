// How well skeletons and skin weights are transferred: learns from rigged characters, rigs others in unknown poses, prints errors.
// Not a test with bounds: the figures go into docs/accuracy.md.
//   focal_rig_accuracy [--train A,B] [--test C,D] [--model FILE] [--seed N]
// Names of makehuman in FOCAL_EVALUATION_DATA, or of --set FOLDER that focal_creatures wrote; by default its train and test
// splits. --model: kept there and used again.
// --test left-out: of the training split the last four meshes are judged, by the others, to choose between ways.
#include <Eigen/Geometry>
#include <cstdio>
#include <iostream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "base/atomic_file.h"
#include "base/random.h"
#include "base/stopwatch.h"
#include "correspondence/segmentation.h"
#include "evaluation_data.h"
#include "landmarks/train.h"
#include "model/model_file.h"
#include "rig/rigged_file.h"
#include "rig/skeleton_metrics.h"
#include "skeleton/rig_transfer.h"

namespace {

using namespace focal;
using Path = std::filesystem::path;

const Execution execution;  // one a core

struct Truth {
  std::vector<std::string> name, parent;
  std::vector<Vector3> place, rest;
  std::vector<Matrix3> turn;  // of the world
  MatrixX3 rest_positions;
  Rig rig;  // of the rest pose
};

Vector3 vector_of(const nlohmann::json& values) {
  return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

Truth read_truth(const Path& set, const std::string& name) {
  Truth truth;
  const auto file = focal_test::read_json(set / (name + ".joints.json"));
  for (const auto& joint : file["joints"]) {
    truth.name.push_back(joint["name"]);
    truth.parent.push_back(joint["parent"].is_null() ? "" : joint["parent"].get<std::string>());
    truth.place.push_back(vector_of(joint["position"])), truth.rest.push_back(vector_of(joint["rest"]));
    const auto& q = joint["rotation"];
    truth.turn.push_back(
        Eigen::Quaterniond(q[3].get<double>(), q[0], q[1], q[2]).normalized().toRotationMatrix());
  }
  const RiggedMesh rigged = focal_test::read_rig(set / (name + ".rig.glb"));
  truth.rest_positions = rigged.mesh->source.positions, truth.rig = rigged.rig;
  return truth;
}

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> result;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) result.push_back(word);
  return result;
}

struct Errors {
  std::vector<double> joints;  // of body height
  std::map<std::string, std::vector<double>> by_joint;
  std::map<std::string, std::vector<double>> turn_by_joint;  // degrees
  double weights = 0, posed = 0, turn = 0, seconds = 0;
  focal_test::SkeletonMetrics skeleton;
  double parts = 0, k_means = 0, random_k_means = 0;  // mean intersection over union
  double height = 0;
};

// Undoes the true rotations with the skeleton and weights that were found: how far from the rest pose the vertices end.
double reposing_error(const CharacterRig& found, const Truth& truth, const MatrixX3& positions) {
  const auto& joints = found.rig.joints;
  std::vector<Matrix4> back(joints.size(), Matrix4::Identity());
  std::vector<Vector3> to(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    const auto at = static_cast<size_t>(std::find(truth.name.begin(), truth.name.end(), joints[j].name) -
                                        truth.name.begin());
    const Vector3 place = joints[j].bind.topRightCorner<3, 1>();
    const int32_t p = joints[j].parent;
    if (p < 0)
      to[j] = truth.rest[at] + (place - truth.place[at]);
    else
      to[j] = to[p] + back[p].topLeftCorner<3, 3>() * (place - joints[p].bind.topRightCorner<3, 1>());
    back[j].topLeftCorner<3, 3>() = truth.turn[at].transpose();
    back[j].topRightCorner<3, 1>() = to[j] - truth.turn[at].transpose() * place;
  }
  const MatrixX3 moved = skinned(positions, found.rig.influences, back);
  return (moved - truth.rest_positions).rowwise().norm().mean();
}

double weight_difference(const CharacterRig& found, const Truth& truth) {
  double sum = 0;
  for (size_t v = 0; v < found.rig.influences.size(); ++v) {
    std::map<std::string, double> difference;
    for (const Influence& one : found.rig.influences[v])
      if (one.weight > 0) difference[found.rig.joints[one.joint].name] += one.weight;
    for (const Influence& one : truth.rig.influences[v])
      if (one.weight > 0) difference[truth.rig.joints[one.joint].name] -= one.weight;
    for (const auto& [name, d] : difference) sum += std::abs(d);
  }
  return sum / static_cast<double>(found.rig.influences.size());
}

// Per vertex the number, among the truth's names, of the joint that moves it most.
std::vector<int32_t> main_joints(const Rig& rig, const Truth& truth) {
  std::vector<int32_t> result;
  for (const auto& influences : rig.influences) {
    const std::string& name = rig.joints[influences[0].joint].name;
    result.push_back(
        static_cast<int32_t>(std::find(truth.name.begin(), truth.name.end(), name) - truth.name.begin()));
  }
  return result;
}

// Mean over the true labels, by area.
double mean_iou(const std::vector<int32_t>& found, const std::vector<int32_t>& truth,
                const std::vector<double>& area) {
  std::map<int32_t, double> both, any;
  for (size_t t = 0; t < truth.size(); ++t) {
    any[truth[t]] += area[t];
    if (found[t] == truth[t])
      both[truth[t]] += area[t];
    else
      any[found[t]] += area[t];
  }
  double sum = 0, count = 0;
  const std::set<int32_t> labels(truth.begin(), truth.end());
  for (const int32_t label : labels) sum += both[label] / any[label], ++count;
  return sum / count;
}

// Each cluster takes the true label that most of it has: the best that can be said for it.
std::vector<int32_t> named_by_truth(const std::vector<int32_t>& cluster, const std::vector<int32_t>& truth,
                                    const std::vector<double>& area) {
  std::map<int32_t, std::map<int32_t, double>> votes;
  for (size_t t = 0; t < truth.size(); ++t) votes[cluster[t]][truth[t]] += area[t];
  std::vector<int32_t> result;
  for (const int32_t c : cluster)
    result.push_back(std::max_element(votes[c].begin(), votes[c].end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first);
  return result;
}

void judge_parts(const Detection& detection, const CharacterRig& found, const Truth& truth, Errors& errors) {
  const PreparedMesh& mesh = *detection.mesh;
  std::vector<double> area;
  for (int32_t t = 0; t < mesh.source.triangle_count(); ++t) {
    const Vector3 a = mesh.source.positions.row(mesh.source.triangles(t, 0)),
                  b = mesh.source.positions.row(mesh.source.triangles(t, 1)),
                  c = mesh.source.positions.row(mesh.source.triangles(t, 2));
    area.push_back((b - a).cross(c - a).norm());
  }
  const auto true_labels = triangle_labels(mesh, main_joints(truth.rig, truth));
  errors.parts = mean_iou(triangle_labels(mesh, main_joints(found.rig, truth)), true_labels, area);
  const auto clusters = segment_k_means(detection, execution);
  errors.k_means = mean_iou(named_by_truth(clusters, true_labels, area), true_labels, area);
  Random random(1);
  const auto seeds = sample_without_replacement(random, detection.analysis->surface().vertex_count(),
                                                static_cast<int32_t>(detection.places.size()));
  const auto others = segment_k_means(detection, execution, seeds);
  errors.random_k_means = mean_iou(named_by_truth(others, true_labels, area), true_labels, area);
}

Matrix3 rest_axes(const Truth& truth, const std::string& name) {
  for (const Joint& joint : truth.rig.joints)
    if (joint.name == name)
      return Eigen::Quaterniond(Matrix3(joint.bind.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  return Matrix3::Identity();
}

Errors judge(const std::shared_ptr<const LandmarkModel>& model, const Path& set, const std::string& name) {
  const Truth truth = read_truth(set, name);
  const auto mesh =
      std::make_shared<const PreparedMesh>(prepare(GltfDocument::open(set / (name + ".glb")).mesh().mesh));
  Stopwatch watch;
  const Detection detection = detect(model, mesh, DetectParams{}, execution);
  const CharacterRig found = transfer_rig(detection, execution);
  Errors errors;
  errors.seconds = watch.lap();
  errors.height = truth.rest_positions.col(1).maxCoeff() - truth.rest_positions.col(1).minCoeff();
  for (size_t t = 0; t < truth.name.size(); ++t)
    for (const Joint& joint : found.rig.joints)
      if (joint.name == truth.name[t]) {
        const Vector3 place = joint.bind.topRightCorner<3, 1>();
        errors.joints.push_back((place - truth.place[t]).norm() / errors.height);
        errors.by_joint[joint.name].push_back(errors.joints.back());
        const Matrix3 turned = truth.turn[t] * rest_axes(truth, joint.name),
                      found_turn = joint.bind.topLeftCorner<3, 3>();
        const double turn =
            Eigen::AngleAxisd(turned.transpose() * found_turn).angle() * 180 / std::numbers::pi;
        errors.turn_by_joint[joint.name].push_back(turn);
        errors.turn += turn / static_cast<double>(truth.name.size());
      }
  errors.weights = weight_difference(found, truth);
  errors.posed = reposing_error(found, truth, mesh->source.positions) / errors.height;
  judge_parts(detection, found, truth, errors);
  std::vector<Joint> true_joints;
  for (size_t t = 0; t < truth.name.size(); ++t) {
    const auto parent = std::find(truth.name.begin(), truth.name.end(), truth.parent[t]);
    true_joints.push_back({truth.name[t], -1});
    if (parent != truth.name.end())
      true_joints.back().parent = static_cast<int32_t>(parent - truth.name.begin());
    true_joints.back().bind.topRightCorner<3, 1>() = truth.place[t];
  }
  errors.skeleton = focal_test::compare_skeletons(found.rig.joints, true_joints, mesh->source);
  return errors;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x / static_cast<double>(values.size());
  return sum;
}

void print_row(const std::string& name, std::vector<double> joints, const std::vector<double>& rest) {
  std::sort(joints.begin(), joints.end());
  std::printf("%-14s %8.2f %8.2f %8.2f", name.c_str(), 100 * mean(joints),
              100 * joints[joints.size() * 95 / 100], 100 * joints.back());
  for (const double x : rest) std::printf(" %8.3f", x);
  std::printf("\n");
}

void judge_all(const std::shared_ptr<const LandmarkModel>& model, const Path& set,
               const std::vector<std::string>& names) {
  const std::vector<const char*> columns = {"joints %", "p95 %",   "worst %", "turn",   "weights", "posed %",
                                            "parts",    "k-means", "random",  "J2J %",  "J2B %",   "B2B %",
                                            "IoU",      "prec.",   "recall",  "seconds"};
  std::printf("%-14s", "mesh");
  for (const char* column : columns) std::printf(" %8s", column);
  std::printf("\n");
  std::vector<double> joints, sums;
  std::map<std::string, std::vector<double>> by_joint, turn_by_joint;
  for (const auto& name : names) {
    const Errors e = judge(model, set, name);
    const auto& s = e.skeleton;
    const std::vector<double> rest = {e.turn,
                                      e.weights,
                                      100 * e.posed,
                                      e.parts,
                                      e.k_means,
                                      e.random_k_means,
                                      100 * s.joints_to_joints,
                                      100 * s.joints_to_bones,
                                      100 * s.bones_to_bones,
                                      s.iou,
                                      s.precision,
                                      s.recall,
                                      e.seconds};
    print_row(name, e.joints, rest);
    sums.resize(rest.size());
    for (size_t i = 0; i < rest.size(); ++i) sums[i] += rest[i] / static_cast<double>(names.size());
    joints.insert(joints.end(), e.joints.begin(), e.joints.end());
    for (const auto& [joint, values] : e.turn_by_joint)
      turn_by_joint[joint].insert(turn_by_joint[joint].end(), values.begin(), values.end());
    for (const auto& [joint, values] : e.by_joint)
      by_joint[joint].insert(by_joint[joint].end(), values.begin(), values.end());
  }
  print_row("all", joints, sums);
  for (const auto& [joint, values] : by_joint)
    std::printf("  %-16s %.2f %%, turned by %.0f degrees\n", joint.c_str(), 100 * mean(values),
                mean(turn_by_joint[joint]));
}

}  // namespace

int main(int count, char** arguments) {
  std::map<std::string, std::string> options{
      {"--train", ""}, {"--test", ""}, {"--model", ""}, {"--set", ""}, {"--seed", "0"}};
  for (int i = 1; i + 1 < count; i += 2) {
    if (!options.contains(arguments[i])) return std::cerr << "unknown option " << arguments[i] << '\n', 2;
    options[arguments[i]] = arguments[i + 1];
  }
  std::optional<Path> set =
      options["--set"].empty() ? focal_test::evaluation_set("makehuman") : Path(options["--set"]);
  if (!set) return 0;
  const auto splits = focal_test::read_json(*set / "set.json");
  auto train_names = words(options["--train"]), test_names = words(options["--test"]);
  using Names = std::vector<std::string>;
  if (train_names.empty()) train_names = splits["train"].get<Names>();
  if (test_names.empty()) test_names = splits["test"].get<Names>();
  if (options["--test"] == "left-out") {
    test_names.assign(train_names.end() - 4, train_names.end());
    train_names.resize(train_names.size() - 4);
  }
  Stopwatch watch;
  std::shared_ptr<const LandmarkModel> model;
  if (std::filesystem::exists(options["--model"])) {
    model = std::make_shared<const LandmarkModel>(parse_model(read_file(options["--model"])));
  } else {
    std::vector<RiggedMesh> characters;
    for (const auto& name : train_names)
      characters.push_back(focal_test::read_rig(*set / (name + ".rig.glb")));
    RiggedShapesParams how;
    how.seed = std::stoull(options["--seed"]);
    TrainParams params;
    params.seed = how.seed;
    model = std::make_shared<const LandmarkModel>(train(training_set_of(characters, how), params, execution));
    if (!options["--model"].empty()) write_file_atomically(options["--model"], serialise(*model));
  }
  std::printf("%zu characters, %zu landmarks, %zu joints, %.0f s\n", train_names.size(),
              model->landmark_names.size(), model->skeleton.size(), watch.lap());
  judge_all(model, *set, test_names);
  return 0;
}
