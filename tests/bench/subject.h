// What the benchmarks run on: the marked meshes of a real set, or sample characters where there is none.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/landmark_model.h"
#include "model/training_set.h"

namespace focal_bench {

struct Subject {
  std::string name;  // with the number of vertices, for tables
  focal::TrainingSet training;
  focal::TriangleMesh test;  // not trained on; as a host would give it
};

// A set with the marks of its test split.
struct MarkedSet {
  std::string name;
  focal::TrainingSet training;
  std::vector<std::string> test_names;
  std::vector<focal::MarkedShape> test;
};
std::optional<MarkedSet> marked_set(const std::string& name);

// The set of that name in the folder $FOCAL_EVALUATION_DATA.
std::optional<Subject> real_set(const std::string& name);

// `shapes` people to learn from and one to test on, of about vertex_count vertices each.
Subject sample_people(int shapes, int32_t vertex_count);

// The real set, else ten sample people of 12,500 vertices.
Subject set_or_people(const std::string& name);

std::shared_ptr<const focal::LandmarkModel> trained(const Subject& subject, const focal::TrainParams& params,
                                                    int threads);

}  // namespace focal_bench
