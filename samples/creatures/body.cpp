// The flesh at rest: smoothly blended sweeps, as an implicit function that is negative inside.
#include "body.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace creatures {
namespace {

// Cubic polynomial smooth minimum: differs from min only where |a - b| < width, and is twice differentiable.
double smooth_min(double a, double b, double width) {
  if (width <= 0) return std::min(a, b);
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * h * width / 6;
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Sweep ellipsoid(const Vec3& at, const Vec3& radii, int bone, double blend) {
  return {.from = at,
          .to = at,
          .front = Vec3::UnitZ(),
          .sections = {{0, radii.x(), radii.z(), radii.z()}},
          .start_cap = radii.y(),
          .end_cap = radii.y(),
          .bones = {{bone}},
          .blend = blend};
}

Sweep cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius, int bone, double blend) {
  return {.from = from,
          .to = to,
          .front = (to - from).unitOrthogonal(),
          .sections = {{0, from_radius, from_radius, from_radius}, {1, to_radius, to_radius, to_radius}},
          .start_cap = from_radius,
          .end_cap = to_radius,
          .bones = {{bone}},
          .blend = blend};
}

Body::Body(std::vector<Sweep> sweeps, std::vector<int> mirror_bone, std::array<double, 6> asymmetry)
    : mirror_bone_(std::move(mirror_bone)), asymmetry_(asymmetry) {
  for (Sweep& shape : sweeps) {
    Prepared s;
    s.length = (shape.to - shape.from).norm();
    s.axis = s.length > 0 ? Vec3((shape.to - shape.from) / s.length) : Vec3::UnitY();
    s.side = s.axis.cross(shape.front).normalized();
    s.front = s.side.cross(s.axis);
    s.middle = 0.5 * (shape.from + shape.to);
    double reach = std::max(shape.start_cap, shape.end_cap), thick = 0;
    for (const Section& c : shape.sections) {
      s.values.push_back({c.side, c.front, c.back, c.shift_front, c.shift_side});
      thick = std::max(thick, std::max({c.side, c.front, c.back}) + std::hypot(c.shift_front, c.shift_side));
    }
    s.radius = std::hypot(0.5 * s.length + reach, thick);
    // Catmull-Rom slopes inside, none at the ends so that the caps join smoothly.
    s.slopes.assign(s.values.size(), {0, 0, 0, 0, 0});
    for (size_t i = 1; i + 1 < s.values.size(); ++i)
      for (size_t k = 0; k < 5; ++k)
        s.slopes[i][k] = (s.values[i + 1][k] - s.values[i - 1][k]) /
                         ((shape.sections[i + 1].at - shape.sections[i - 1].at) * s.length);
    s.shape = std::move(shape);
    sweeps_.push_back(std::move(s));
  }
}

std::array<double, 5> Body::Prepared::section(double y) const {
  if (values.size() == 1 || y <= shape.sections.front().at * length) return values.front();
  if (y >= shape.sections.back().at * length) return values.back();
  size_t i = 1;
  while (y > shape.sections[i].at * length) ++i;
  const double y0 = shape.sections[i - 1].at * length, h = shape.sections[i].at * length - y0;
  const double t = (y - y0) / h, u = 1 - t;
  std::array<double, 5> c;
  for (size_t k = 0; k < 5; ++k)
    c[k] = u * u * ((1 + 2 * t) * values[i - 1][k] + t * h * slopes[i - 1][k]) +
           t * t * ((1 + 2 * u) * values[i][k] - u * h * slopes[i][k]);
  return c;
}

// First-order distance to an ellipsoid, |q|(|q| - 1) / |grad|, with the radii of the nearest cross-section.
double Body::Prepared::distance(const Vec3& point) const {
  const Vec3 q = point - shape.from;
  double y = q.dot(axis);
  const auto [a, b_front, b_back, shift_front, shift_side] = section(y);
  const double x = q.dot(side) - shift_side, z = q.dot(front) - shift_front;
  const double b = z > 0 ? b_front : b_back, c = y < 0 ? shape.start_cap : shape.end_cap;
  y = y < 0 ? y : std::max(y - length, 0.0);
  const double u = x / a, v = y / c, w = z / b;
  const double k0 = std::sqrt(u * u + v * v + w * w);
  const double k1 = std::sqrt(u * u / (a * a) + v * v / (c * c) + w * w / (b * b));
  return k1 < 1e-9 ? -std::min(a, b) : k0 * (k0 - 1) / k1;
}

// No creature is exactly symmetric: a gentle wave, a different one for each individual.
Vec3 Body::warp(const Vec3& p) const {
  const auto& s = asymmetry_;
  return p + Vec3(s[0] * std::sin(3 * p.y() + 2 * p.z() + s[1]),
                  s[2] * std::sin(3 * p.x() + 2 * p.z() + s[3]),
                  s[4] * std::sin(4 * p.y() + 2 * p.x() + s[5]));
}

double Body::distance(const Vec3& point) const {
  const Vec3 p = warp(point), m = mirrored(p);
  double total = 1e9;
  for (const Prepared& s : sweeps_) {
    const double width = s.shape.blend;
    double far = (p - s.middle).norm() - s.radius;
    if (s.shape.paired) far = std::min(far, (m - s.middle).norm() - s.radius);
    // The approximate distance is never less than 0.4 of the true one: too far away to matter.
    if (0.4 * far > std::abs(total) + std::max(width, s.shape.pair_blend)) continue;
    double d = s.distance(p);
    if (s.shape.paired) d = smooth_min(d, s.distance(m), s.shape.pair_blend);
    total = s.shape.carve ? -smooth_min(-total, d, width) : smooth_min(total, d, width);
  }
  return total;
}

// From the four corners of a tetrahedron: four evaluations instead of six.
Vec3 Body::gradient(const Vec3& p) const {
  constexpr double h = 1e-5;
  Vec3 g = Vec3::Zero();
  for (const Vec3& corner : {Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, 1, 1)})
    g += corner * distance(p + h * corner);
  return g / (4 * h);
}

Vec3 Body::project(Vec3 p) const {
  for (int i = 0; i < 4; ++i) {
    const double d = distance(p);
    if (std::abs(d) < 1e-5) break;
    const Vec3 g = gradient(p);
    p -= d / std::max(g.squaredNorm(), 0.1) * g;
  }
  return p;
}

// Calls visit(sweep, is the mirror image, closeness, point in the sweep's own half) for the sweeps whose
// surface passes near `point`; closeness is 1 for the closest and falls smoothly to 0.
template <class Visit>
void Body::visit_surfaces(const Vec3& point, Visit visit) const {
  const Vec3 p = warp(point), m = mirrored(p);
  std::vector<std::array<double, 2>> distances;
  double least = 1e9;
  for (const Prepared& s : sweeps_) {
    distances.push_back({s.shape.carve ? 1e9 : s.distance(p), 1e9});
    if (s.shape.paired && !s.shape.carve) distances.back()[1] = s.distance(m);
    least = std::min({least, distances.back()[0], distances.back()[1]});
  }
  for (size_t i = 0; i < sweeps_.size(); ++i)
    for (int other = 0; other < 2; ++other) {
      const double reach = std::max(sweeps_[i].shape.blend, 0.01);
      const double closeness = 1 - (distances[i][other] - least) / reach;
      if (closeness > 0) visit(sweeps_[i], other == 1, smooth_step(closeness), other ? m : p);
    }
}

double Body::detail(const Vec3& point) const {
  double sum = 0, weight = 0;
  visit_surfaces(point, [&](const Prepared& s, bool, double closeness, const Vec3&) {
    sum += closeness * s.shape.detail;
    weight += closeness;
  });
  return sum / weight;
}

std::vector<double> Body::bone_weights(const Vec3& point) const {
  std::vector<double> weights(mirror_bone_.size(), 0.0);
  visit_surfaces(point, [&](const Prepared& s, bool other, double closeness, const Vec3& p) {
    const double y = (p - s.shape.from).dot(s.axis);
    double rest = closeness;
    for (size_t i = s.shape.bones.size(); i-- > 0 && rest > 0;) {
      const BoneSpan& span = s.shape.bones[i];
      const double share =
          i == 0 ? 1 : smooth_step(0.5 + (y - span.at * s.length) / std::max(span.softness, 1e-6));
      weights[other ? mirror_bone_[span.bone] : span.bone] += share * rest;
      rest *= 1 - share;
    }
  });
  return weights;
}

Eigen::AlignedBox3d Body::bounds() const {
  Eigen::AlignedBox3d box;
  for (const Prepared& s : sweeps_) {
    if (s.shape.carve) continue;
    for (const Section& c : s.shape.sections) {
      const Vec3 centre =
          s.shape.from + c.at * (s.shape.to - s.shape.from) + c.shift_front * s.front + c.shift_side * s.side;
      const double r = 0.02 + std::max({c.side, c.front, c.back, s.shape.start_cap, s.shape.end_cap});
      for (const Vec3& p : {centre, s.shape.paired ? mirrored(centre) : centre}) {
        box.extend(p - Vec3::Constant(r));
        box.extend(p + Vec3::Constant(r));
      }
    }
  }
  return box;
}

}  // namespace creatures
