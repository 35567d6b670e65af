// What lies between the measured stages, with the same constants as in focal's own detection: which samples, which
// peaks, which candidates. Shared by the stock pipeline and the benchmarks of single stages.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/prepare.h"
#include "model/landmark_model.h"
#include "operators/operators.h"
#include "vote/peaks.h"

namespace focal_bench {

inline focal::Execution threads_of(int count) {
  return {.thread_count = count, .task = nullptr, .host_parallel_for = {}};
}

// A tenth of the vertices, at most 1,250.
std::vector<int32_t> drawn_samples(int32_t vertex_count);

using Peaks = std::vector<std::vector<int32_t>>;  // vertices, one list a landmark
Peaks peaks_of(const focal::RowMatrixf& votes, int32_t landmarks, const focal::TriangleMesh& mesh,
               const focal::Operators& operators, const focal::Execution& execution);

using DistanceFields = std::function<focal::RowMatrixf(std::span<const int32_t> vertices)>;  // vertices x all
// The constellation's choice, one vertex a landmark; -1: none.
std::vector<int32_t> choose_among(const Peaks& peaks, const focal::RowMatrixf& votes,
                                  const focal::LandmarkModel& model, const focal::PreparedMesh& mesh,
                                  const DistanceFields& fields, const focal::Execution& execution);

}  // namespace focal_bench
