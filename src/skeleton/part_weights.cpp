#include "skeleton/part_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "mesh/closest_point.h"
#include "mesh/components.h"

namespace focal {
namespace {
inline double env(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }

constexpr float least_weight = 0.02F;   // lighter influences are dropped
constexpr double same_place = 5e-4;     // of the mesh's extent
const double small_extent = env("F_EXT", 0.45);   // a rigid part's, of the mesh's
const double small_area = env("F_AREA", 0.25);     // a rigid part's, of the mesh's
const float one_bone = (float)env("F_ONE", 0.75);       // share of the main joint in a rigid part, at least
const float two_bones = (float)env("F_TWO", 0.9);       // of the two main ones in a tiny part
const double tiny_extent = env("F_TINY", 0.12);    // its extent, of the mesh's
constexpr double faces_other_way = 1.5; // mean edges of the analysed surface: how much farther the side that faces alike may be

double extent_of(const MatrixX3& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

// Of the nearest place and the nearest that faces the same way the latter, unless it is on another part of the body.
std::vector<SurfacePoint> places_of_vertices(const Proxy& proxy, const Execution& execution) {
  const TriangleMesh& full = proxy.full->surface;
  const TriangleMesh& coarse = proxy.coarse->surface;
  const MatrixX3 normals = area_normals(full);
  std::vector<SurfaceQuery> facing, any;
  for (int32_t v = 0; v < full.vertex_count(); ++v) {
    const Vector3 place =
        (full.positions.row(v).transpose() - proxy.coarse->centre) / proxy.coarse->scale;
    any.push_back({place, Vector3::Zero()});
    facing.push_back({place, normals.row(v).transpose()});
  }
  const double edge = mean_edge_length(coarse);
  std::vector<SurfacePoint> result = closest_points(coarse, any, 2 * edge, execution);
  const auto alike = closest_points(coarse, facing, 2 * edge, execution);
  for (size_t v = 0; v < result.size(); ++v) {
    const auto away = [&](const SurfacePoint& p) { return (position_of(coarse, p) - any[v].position).norm(); };
    if (alike[v].triangle >= 0 && away(alike[v]) < away(result[v]) + faces_other_way * edge)
      result[v] = alike[v];
  }
  return result;
}

RowMatrixf lifted(const RowMatrixf& weights, const SurfaceAnalysis& analysis, const Execution& execution) {
  if (analysis.proxy.is_full()) return weights;
  const auto places = places_of_vertices(analysis.proxy, execution);
  RowMatrixf result = RowMatrixf::Zero(static_cast<Eigen::Index>(places.size()), weights.cols());
  parallel_for_ranges(execution, result.rows(), 1024, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v)
      for (int c = 0; c < 3; ++c)
        result.row(v) += static_cast<float>(places[v].barycentric[c]) *
                         weights.row(analysis.surface().triangles(places[v].triangle, c));
  });
  return result;
}

// Per vertex the first one at its place.
std::vector<int32_t> first_at_place(const MatrixX3& positions, double tolerance) {
  std::unordered_map<uint64_t, std::vector<int32_t>> cells;
  const auto key = [](const Eigen::Vector3i& c) {
    return (static_cast<uint64_t>(static_cast<uint32_t>(c[0]) & 0x1FFFFF) << 42) |
           (static_cast<uint64_t>(static_cast<uint32_t>(c[1]) & 0x1FFFFF) << 21) |
           (static_cast<uint32_t>(c[2]) & 0x1FFFFF);
  };
  std::vector<int32_t> first(static_cast<size_t>(positions.rows()));
  for (int32_t v = 0; v < positions.rows(); ++v) {
    const Vector3 p = positions.row(v);
    const Eigen::Vector3i cell = (p / (2 * tolerance)).array().floor().cast<int>();
    first[v] = v;
    for (int corner = 0; corner < 27 && first[v] == v; ++corner) {
      const auto there = cells.find(key(cell + Eigen::Vector3i(corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1)));
      if (there == cells.end()) continue;
      for (const int32_t other : there->second)
        if ((positions.row(other).transpose() - p).norm() < tolerance) {
          first[v] = other;
          break;
        }
    }
    if (first[v] == v) cells[key(cell)].push_back(v);
  }
  return first;
}

// Vertices at one place take the mean of their weights, so that seams between parts stay closed.
void close_seams(RowMatrixf& weights, const MatrixX3& positions) {
  const std::vector<int32_t> first = first_at_place(positions, same_place * extent_of(positions));
  std::vector<float> count(first.size(), 1);
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<int32_t>(v))
      weights.row(first[v]) += weights.row(static_cast<Eigen::Index>(v)), ++count[first[v]];
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] == static_cast<int32_t>(v)) weights.row(first[v]) /= count[v];
  for (size_t v = 0; v < first.size(); ++v) weights.row(static_cast<Eigen::Index>(v)) = weights.row(first[v]);
}

struct Part {
  std::vector<int32_t> vertices;
  double area = 0;
  Eigen::RowVectorXf mean;  // weights
};

std::vector<Part> parts_of(const TriangleMesh& mesh, const RowMatrixf& weights) {
  const Components components = components_of(mesh);
  std::vector<Part> parts(static_cast<size_t>(components.count));
  const Vector area = area_normals(mesh).rowwise().norm();
  for (Part& part : parts) part.mean = Eigen::RowVectorXf::Zero(weights.cols());
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    Part& part = parts[components.of_vertex[v]];
    part.vertices.push_back(v), part.area += area[v];
    part.mean += static_cast<float>(area[v]) * weights.row(v);
  }
  for (Part& part : parts)
    if (const float sum = part.mean.sum(); sum > 0) part.mean /= sum;
  return parts;
}

// The weights that all vertices of a rigid part have; empty: it is none.
Eigen::RowVectorXf rigid_weights(const Part& part, const TriangleMesh& mesh, double extent, double area) {
  MatrixX3 positions(static_cast<Eigen::Index>(part.vertices.size()), 3);
  for (size_t i = 0; i < part.vertices.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) = mesh.positions.row(part.vertices[i]);
  const double size = extent_of(positions) / extent;
  if (size > small_extent || part.area > small_area * area) return {};
  Eigen::Index main = 0, second = 0;
  Eigen::RowVectorXf rest = part.mean;
  const float most = rest.maxCoeff(&main);
  rest[main] = 0;
  const float more = rest.maxCoeff(&second);
  Eigen::RowVectorXf result = Eigen::RowVectorXf::Zero(rest.size());
  if (most >= one_bone) return result[main] = 1, result;
  if (size > tiny_extent || most + more < two_bones) return {};
  result[main] = most / (most + more), result[second] = more / (most + more);
  return result;
}

void stiffen_parts(RowMatrixf& weights, const TriangleMesh& mesh) {
  const std::vector<Part> parts = parts_of(mesh, weights);
  if (parts.size() < 2) return;
  const double extent = extent_of(mesh.positions);
  double area = 0;
  for (const Part& part : parts) area += part.area;
  for (const Part& part : parts) {
    const Eigen::RowVectorXf rigid = rigid_weights(part, mesh, extent, area);
    if (rigid.size() > 0)
      for (const int32_t v : part.vertices) weights.row(v) = rigid;
  }
}

VertexInfluences influences_of(const Eigen::Ref<const Eigen::RowVectorXf>& weights) {
  std::vector<Influence> influences;
  const float total = weights.sum();
  for (Eigen::Index j = 0; j < weights.size(); ++j)
    if (weights[j] > least_weight * total) influences.push_back({static_cast<int32_t>(j), weights[j]});
  return heaviest(influences);
}

}  // namespace

std::vector<VertexInfluences> influences_by_parts(const SurfaceWeights& found, const SurfaceAnalysis& analysis,
                                                  const Execution& execution) {
  const PreparedMesh& full = *analysis.proxy.full;
  RowMatrixf weights = lifted(found.weights, analysis, execution);
  close_seams(weights, full.surface.positions);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) sharpen(weights.row(v), found.exponent);
  stiffen_parts(weights, full.surface);
  std::vector<VertexInfluences> result;
  for (const int32_t v : full.surface_vertex)
    result.push_back(v >= 0 ? influences_of(weights.row(v)) : VertexInfluences{});
  return result;
}

}  // namespace focal
