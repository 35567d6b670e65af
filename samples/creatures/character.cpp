// One finished character: mesh, skin, pose and landmarks.
#include "character.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polygonise.h"
#include "remesh.h"

namespace creatures {
namespace {

// Weights of the body, smoothed so that no crease of the blend shows when bent.
std::vector<Influences> skin(const Body& body, const Mesh& mesh) {
  std::vector<std::vector<double>> weights;
  for (const Vec3& p : mesh.positions) weights.push_back(body.bone_weights(p));
  return skin_of(std::move(weights), mesh.triangles, 6);
}

// Where the ray leaves the body: steps along it, then bisection.
Vec3 leave(const Body& body, const Vec3& inside, const Vec3& direction) {
  const Vec3 d = direction.normalized();
  double in = 0, out = 0;
  while (body.distance(inside + out * d) < 0) {
    in = out;
    out += 0.005;
  }
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (in + out);
    (body.distance(inside + middle * d) < 0 ? in : out) = middle;
  }
  return inside + in * d;
}

// C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5, as barycentric coordinates: the closest point of the
// triangle is the projection, or else the closest one of its three sides.
Vec3 closest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  Vec3 w;
  for (int k = 0; k < 3; ++k)
    w[k] = (t[(k + 2) % 3] - t[(k + 1) % 3]).cross(p - t[(k + 1) % 3]).dot(n) / n.squaredNorm();
  if (w.minCoeff() >= 0) return w;
  double least = 1e9;
  Vec3 best = Vec3::UnitX();
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = t[(k + 1) % 3] - t[k];
    const double s = std::clamp((p - t[k]).dot(side) / side.squaredNorm(), 0.0, 1.0);
    const double d = (t[k] + s * side - p).squaredNorm();
    if (d >= least) continue;
    least = d;
    best.setZero();
    best[k] = 1 - s;
    best[(k + 1) % 3] = s;
  }
  return best;
}

Landmark nearest_on_mesh(const std::string& name, const Mesh& mesh, const Vec3& p) {
  Landmark found{name, -1, {}, -1};
  double least = 1e9;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const std::array<Vec3, 3> corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    const Vec3 w = closest_on_triangle(p, corners);
    const double d = (w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] - p).norm();
    if (d >= least) continue;
    least = d;
    found.triangle = static_cast<int>(i);
    found.barycentric = w;
    found.vertex = *std::min_element(t.begin(), t.end(), [&](int a, int b) {
      return (mesh.positions[a] - p).squaredNorm() < (mesh.positions[b] - p).squaredNorm();
    });
  }
  return found;
}

}  // namespace

void add_landmarks(Character& made, const Body& body, const std::vector<Anchor>& anchors) {
  for (const Anchor& a : anchors) {
    const Vec3 p = leave(body, a.inside, a.direction);
    made.landmarks.push_back(nearest_on_mesh(a.paired ? a.name + ".L" : a.name, made.rest, p));
    if (!a.paired) continue;
    const Vec3 q = leave(body, mirrored(a.inside), mirrored(a.direction));
    made.landmarks.push_back(nearest_on_mesh(a.name + ".R", made.rest, q));
  }
}

void pose_character(Character& made, const std::vector<Freedom>& freedoms, Random& random) {
  const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
  made.pose = random_pose(made.skeleton, freedoms, heading, random);
  double rest_floor = 1e9, floor = 1e9;
  for (size_t v = 0; v < made.rest.positions.size(); ++v) {
    made.posed.push_back(bend(made.rest.positions[v], made.skin[v], made.pose));
    rest_floor = std::min(rest_floor, made.rest.positions[v].y());
    floor = std::min(floor, made.posed.back().y());
  }
  const Vec3 lift(0, rest_floor - floor, 0);
  for (Vec3& p : made.posed) p += lift;
  for (Eigen::Isometry3d& motion : made.pose) motion.pretranslate(lift);
}

Character make_character(const Family& family, const std::string& name, uint64_t seed) {
  Random random(seed);
  if (family.make) return family.make(name, random);
  const Design design = family.design(random);
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(random.uniform(0, 3),
                        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 1).normalized()) *
      Eigen::Quaterniond::Identity();
  const Vec3 shift(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
  const double cell = design.lattice_cell * random.uniform(0.9, 1.1);
  const int vertices = static_cast<int>(random.uniform(3300, 5800));

  Character made{name, design.skeleton, {}, {}, {}, {}, {}};
  made.rest = remesh(polygonise(design.body, cell, rotation, shift), design.body, vertices, random);
  made.skin = skin(design.body, made.rest);
  add_landmarks(made, design.body, design.anchors);
  for (Vec3& p : made.rest.positions) p *= design.scale;
  for (Joint& joint : made.skeleton.joints) {
    joint.rest *= design.scale;
    joint.tip *= design.scale;
  }
  pose_character(made, design.freedoms, random);
  return made;
}

}  // namespace creatures
