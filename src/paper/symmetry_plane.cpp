// Pairs of points with similar neighbourhoods vote for the plane between them; the plane that agrees best
// with the surface wins.
// N. J. Mitra, L. J. Guibas, M. Pauly, "Partial and Approximate Symmetry Detection for 3D Geometry", 2006.
// Their principal curvatures are replaced by moments of the surface in balls, which carry the same
// information without differentiating a noisy mesh: H. Pottmann et al., "Principal curvatures from the
// integral invariant viewpoint", 2007.
#include "paper/symmetry_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/random.h"
#include "mesh/nearest_vertex.h"

namespace focal {
namespace {

// All lengths are in units of sqrt(area), relative to the surface's centroid.
constexpr int32_t cloud_size = 6000, probe_stride = 8;  // every eighth point of the cloud is a probe
constexpr std::array<double, 3> ball_radii = {0.08, 0.16, 0.3};
constexpr int moments_per_ball = 5, signature_size = moments_per_ball * int(ball_radii.size());
constexpr int partners_per_probe = 24;
constexpr double min_pair_distance = 0.04, max_normal_residual = 0.5;
constexpr size_t max_votes = 3000, mode_count = 16, finalist_count = 4;
constexpr double angle_bandwidth = 0.12, offset_bandwidth = 0.03;  // of the mean shift
constexpr double support_tolerance = 0.02;

struct Cloud {
  MatrixX3 points, normals;
};

struct Plane {
  Vector3 normal;
  double offset;
  Vector3 reflect(const Vector3& p) const { return p - 2 * (normal.dot(p) - offset) * normal; }
  Vector3 reflect_direction(const Vector3& v) const { return v - 2 * normal.dot(v) * normal; }
};

struct Vote {
  Plane plane;
  double weight;
};

struct Probes {
  std::vector<int32_t> cloud_index;
  RowMatrix signatures;  // every column of variance 1
  // From each point to the centroid of its middle ball: a second direction besides the normal.
  MatrixX3 leans;
};

struct Scored {
  Plane plane;
  double score;
};

MatrixX3 corner_products(const TriangleMesh& mesh) {
  MatrixX3 products(mesh.triangle_count(), 3);
  for (int32_t f = 0; f < mesh.triangle_count(); ++f) {
    const auto corner = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(f, i)); };
    products.row(f) = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  }
  return products;
}

MatrixX3 vertex_normals(const TriangleMesh& mesh, const MatrixX3& products) {
  MatrixX3 normals = MatrixX3::Zero(mesh.vertex_count(), 3);
  for (int32_t f = 0; f < mesh.triangle_count(); ++f)
    for (int i = 0; i < 3; ++i) normals.row(mesh.triangles(f, i)) += products.row(f);
  normals.rowwise().normalize();
  return normals;
}

// Stratified by area: point i is in the i-th of cloud_size equal shares of it.
Cloud sample_surface(const TriangleMesh& mesh, uint64_t seed) {
  const MatrixX3 products = corner_products(mesh), normals = vertex_normals(mesh, products);
  const Vector areas = products.rowwise().norm();
  const double share = areas.sum() / cloud_size;
  Random random(seed);
  Cloud cloud{MatrixX3(cloud_size, 3), MatrixX3(cloud_size, 3)};
  double passed = 0;
  int32_t face = 0;
  for (int32_t i = 0; i < cloud_size; ++i) {
    const double target = (i + random.uniform()) * share;
    while (face + 1 < mesh.triangle_count() && passed + areas[face] < target) passed += areas[face++];
    const double root = std::sqrt(random.uniform()), side = random.uniform();
    const Vector3 weights(1 - root, root * (1 - side), root * side);
    cloud.points.row(i).setZero(), cloud.normals.row(i).setZero();
    for (int k = 0; k < 3; ++k) {
      cloud.points.row(i) += weights[k] * mesh.positions.row(mesh.triangles(face, k));
      cloud.normals.row(i) += weights[k] * normals.row(mesh.triangles(face, k));
    }
    cloud.normals.row(i).normalize();
  }
  return cloud;
}

// Moments of the cloud in a ball around point i: area, lean along the normal, extents. Returns the lean.
Vector3 ball_moments(const Cloud& cloud, int32_t i, const std::vector<int32_t>& in_ball, double radius,
                     double* out) {
  const Vector3 centre = cloud.points.row(i);
  Vector3 sum = Vector3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const int32_t j : in_ball) {
    const Vector3 d = (cloud.points.row(j).transpose() - centre) / radius;
    sum += d, squares += d * d.transpose();
  }
  const auto count = static_cast<double>(in_ball.size());
  const Vector3 lean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - lean * lean.transpose();
  out[0] = count / (cloud_size * std::numbers::pi * radius * radius);
  out[1] = lean.dot(cloud.normals.row(i).transpose());
  Eigen::Map<Vector3>(out + 2) =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return lean;
}

Probes describe(const Cloud& cloud, const Execution& execution) {
  const int32_t count = cloud_size / probe_stride;
  Probes probes{std::vector<int32_t>(count), RowMatrix(count, signature_size), MatrixX3(count, 3)};
  parallel_for_ranges(execution, count, 32, [&](int64_t begin, int64_t end) {
    std::vector<int32_t> nearby;
    for (int64_t p = begin; p < end; ++p) {
      const auto i = static_cast<int32_t>(p * probe_stride);
      probes.cloud_index[p] = i;
      nearby.resize(cloud_size);
      std::iota(nearby.begin(), nearby.end(), 0);
      const Vector squared = (cloud.points.rowwise() - cloud.points.row(i)).rowwise().squaredNorm();
      for (size_t ball = ball_radii.size(); ball-- > 0;) {  // each ball contains the next smaller one
        const double r = ball_radii[ball];
        std::erase_if(nearby, [&](int32_t j) { return squared[j] > r * r; });
        double* out = &probes.signatures(p, static_cast<int>(ball) * moments_per_ball);
        const Vector3 lean = ball_moments(cloud, i, nearby, r, out);
        if (ball == 1) probes.leans.row(p) = lean;
      }
    }
  });
  probes.signatures.rowwise() -= probes.signatures.colwise().mean().eval();
  for (int c = 0; c < signature_size; ++c) {
    const double deviation = std::sqrt(probes.signatures.col(c).squaredNorm() / count);
    // Components that hardly vary carry no information.
    probes.signatures.col(c) /= std::max(deviation, 1e-3);
  }
  return probes;
}

// The vote of the pair (p, q) for the plane half-way between them; weight 0 unless the plane also maps normal
// to normal and lean to lean.
Vote pair_vote(const Cloud& cloud, const Probes& probes, int32_t p, int32_t q, double signature_distance) {
  const Vector3 a = cloud.points.row(probes.cloud_index[p]), b = cloud.points.row(probes.cloud_index[q]);
  const double distance = (a - b).norm();
  if (distance < min_pair_distance) return {{Vector3::UnitX(), 0}, 0};
  Plane plane{(a - b) / distance, 0};
  plane.offset = plane.normal.dot(a + b) / 2;
  const auto residual = [&](const MatrixX3& directions, int32_t i, int32_t j) {
    return (plane.reflect_direction(directions.row(i)) - directions.row(j).transpose()).norm();
  };
  const double normal = residual(cloud.normals, probes.cloud_index[p], probes.cloud_index[q]);
  const double lean = residual(probes.leans, p, q);
  if (normal > max_normal_residual) return {plane, 0};
  return {plane, std::exp(-signature_distance - normal * normal / 0.1 - lean * lean / 0.02)};
}

std::vector<Vote> collect_votes(const Cloud& cloud, const Probes& probes, const Execution& execution) {
  const auto count = static_cast<int32_t>(probes.cloud_index.size());
  std::vector<std::array<Vote, partners_per_probe>> found(count);
  parallel_for_ranges(execution, count, 32, [&](int64_t begin, int64_t end) {
    std::vector<std::pair<double, int32_t>> partners(count);
    for (int64_t p = begin; p < end; ++p) {
      const Vector squared =
          (probes.signatures.rowwise() - probes.signatures.row(p)).rowwise().squaredNorm() / signature_size;
      for (int32_t q = 0; q < count; ++q) partners[q] = {squared[q], q};
      const int32_t kept = std::min(partners_per_probe, count);
      std::partial_sort(partners.begin(), partners.begin() + kept, partners.end());
      for (int32_t k = 0; k < kept; ++k)
        found[p][k] =
            pair_vote(cloud, probes, static_cast<int32_t>(p), partners[k].second, partners[k].first);
    }
  });
  std::vector<Vote> votes;
  for (const auto& row : found)
    for (const Vote& vote : row)
      if (vote.weight > 0) votes.push_back(vote);
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.weight > b.weight; });
  if (votes.size() > max_votes) votes.resize(max_votes);
  return votes;
}

// Squared distance of two planes in bandwidths; sign receives +1 or -1 for the same or the opposite normal.
double plane_distance(const Plane& a, const Plane& b, double& sign) {
  sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
  const double turn = (a.normal - sign * b.normal).squaredNorm() / (angle_bandwidth * angle_bandwidth);
  const double shift = (a.offset - sign * b.offset) / offset_bandwidth;
  return turn + shift * shift;
}

// One step of the mean shift from `at`; density receives the kernel sum there.
Plane shift_to_mean(const std::vector<Vote>& votes, const Plane& at, double& density) {
  Vector3 normal = Vector3::Zero();
  double offset = 0, sign = 1;
  density = 0;
  for (const Vote& vote : votes) {
    const double squared = plane_distance(at, vote.plane, sign);
    if (squared > 9) continue;
    const double weight = vote.weight * std::exp(-squared / 2);
    normal += weight * sign * vote.plane.normal, offset += weight * sign * vote.plane.offset,
        density += weight;
  }
  if (density <= 0) return at;
  return {normal.normalized(), offset / density};
}

// Modes of the votes' density in the space of planes, the strongest first (mean shift of Mitra et al.,
// Section 4).
std::vector<Plane> find_modes(const std::vector<Vote>& votes, const Execution& execution) {
  std::vector<double> density(votes.size());
  parallel_for_ranges(execution, static_cast<int64_t>(votes.size()), 64, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) shift_to_mean(votes, votes[i].plane, density[i]);
  });
  std::vector<Plane> modes;
  while (modes.size() < mode_count) {
    const auto densest = std::max_element(density.begin(), density.end());
    if (densest == density.end() || *densest <= 0) break;
    Plane mode = votes[static_cast<size_t>(densest - density.begin())].plane;
    *densest = 0;
    double unused = 0, sign = 1;
    for (int step = 0; step < 10; ++step) mode = shift_to_mean(votes, mode, unused);
    modes.push_back(mode);
    for (size_t i = 0; i < votes.size(); ++i)
      if (plane_distance(mode, votes[i].plane, sign) < 4) density[i] = 0;
  }
  return modes;
}

// The point of the surface nearest to a reflected point.
struct Answer {
  Vector3 point;
  double distance, agreement;  // agreement of the normals, -1..1
};

class Reflector {
 public:
  Reflector(const Cloud& cloud, const Probes& probes) : cloud_(cloud), probes_(probes), tree_(cloud.points) {}
  int32_t count() const { return static_cast<int32_t>(probes_.cloud_index.size()); }
  Vector3 point(int32_t probe) const { return cloud_.points.row(probes_.cloud_index[probe]); }

  Answer answer(const Plane& plane, int32_t probe) const {
    const Vector3 reflected = plane.reflect(point(probe));
    const int32_t nearest = tree_.nearest(reflected).first;
    const Vector3 normal = cloud_.normals.row(nearest), site = cloud_.points.row(nearest);
    // Within the spacing of the cloud the surface is approximated by the tangent plane.
    Vector3 along = reflected - site;
    along -= along.dot(normal) * normal;
    if (along.norm() > spacing) along *= spacing / along.norm();
    const Vector3 on_surface = site + along;
    const Vector3 image = plane.reflect_direction(cloud_.normals.row(probes_.cloud_index[probe]));
    return {on_surface, (reflected - on_surface).norm(), image.dot(normal)};
  }

 private:
  static constexpr double spacing = 0.02;
  const Cloud& cloud_;
  const Probes& probes_;
  NearestVertex tree_;
};

double match_weight(const Answer& answer, double tolerance) {
  const double relative = answer.distance / tolerance;
  return answer.agreement <= 0 ? 0 : answer.agreement * std::exp(-relative * relative);
}

double score(const Reflector& reflector, const Plane& plane, double tolerance, int32_t stride) {
  double sum = 0;
  int32_t count = 0;
  for (int32_t p = 0; p < reflector.count(); p += stride, ++count)
    sum += match_weight(reflector.answer(plane, p), tolerance);
  return sum / std::max(count, 1);
}

// One ICP step: the plane whose reflection maps the probes best onto their nearest points, by weighted least
// squares. The offset is that of the mean midpoint, the normal the eigenvector of sum w p q^T with the
// smallest eigenvalue.
Plane refine_step(const Reflector& reflector, const Plane& plane, double tolerance, int32_t stride) {
  std::vector<std::pair<Vector3, Vector3>> pairs;
  std::vector<double> weights;
  Vector3 middle = Vector3::Zero();
  double total = 0;
  for (int32_t p = 0; p < reflector.count(); p += stride) {
    const Answer answer = reflector.answer(plane, p);
    const double weight = match_weight(answer, tolerance);
    if (weight < 1e-3) continue;
    pairs.emplace_back(reflector.point(p), answer.point), weights.push_back(weight);
    middle += weight * (reflector.point(p) + answer.point) / 2, total += weight;
  }
  if (pairs.size() < 10) return plane;
  middle /= total;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Matrix3d product = (pairs[i].first - middle) * (pairs[i].second - middle).transpose();
    moments += weights[i] * (product + product.transpose());
  }
  const Vector3 normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  return {normal, normal.dot(middle)};
}

// Refines with a tolerance that shrinks from coarse to final.
Scored refine(const Reflector& reflector, Plane plane, int steps, int32_t stride) {
  constexpr double coarse = 0.08;
  for (int step = 0; step < steps; ++step) {
    const double fraction = steps > 1 ? static_cast<double>(step) / (steps - 1) : 1;
    const double tolerance = coarse * std::pow(support_tolerance / coarse, fraction);
    plane = refine_step(reflector, plane, tolerance, stride);
  }
  return {plane, score(reflector, plane, support_tolerance, stride)};
}

std::vector<Scored> refine_all(const Reflector& reflector, const std::vector<Plane>& planes, int steps,
                               int32_t stride, const Execution& execution) {
  std::vector<Scored> refined(planes.size());
  parallel_for(execution, static_cast<int64_t>(planes.size()),
               [&](int64_t i) { refined[i] = refine(reflector, planes[i], steps, stride); });
  std::stable_sort(refined.begin(), refined.end(),
                   [](const Scored& a, const Scored& b) { return a.score > b.score; });
  return refined;
}

double support_of(const Reflector& reflector, const Plane& plane) {
  int32_t answered = 0;
  for (int32_t p = 0; p < reflector.count(); ++p) {
    const Answer answer = reflector.answer(plane, p);
    answered += answer.distance < support_tolerance && answer.agreement > 0.7;
  }
  return static_cast<double>(answered) / reflector.count();
}

}  // namespace

SymmetryPlane symmetry_plane(const TriangleMesh& mesh, uint64_t seed, const Execution& execution) {
  Cloud cloud = sample_surface(mesh, seed);
  const double scale = std::sqrt(surface_area(mesh));
  const Vector3 centre = cloud.points.colwise().mean();
  if (!(scale > 0)) return {};
  cloud.points = (cloud.points.rowwise() - centre.transpose()) / scale;
  const Probes probes = describe(cloud, execution);
  const std::vector<Plane> modes = find_modes(collect_votes(cloud, probes, execution), execution);
  if (modes.empty()) return {};
  const Reflector reflector(cloud, probes);
  const std::vector<Scored> coarse = refine_all(reflector, modes, 5, 3, execution);
  std::vector<Plane> finalists;
  for (const Scored& scored : coarse)
    if (finalists.size() < finalist_count) finalists.push_back(scored.plane);
  const Plane best = refine_all(reflector, finalists, 12, 1, execution).front().plane;
  return {best.normal, best.offset * scale + best.normal.dot(centre), support_of(reflector, best)};
}

}  // namespace focal
