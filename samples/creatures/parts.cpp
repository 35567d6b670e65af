// Pieces that make up a game character: tubes, boxes, sheets, each with its own skin.
#include "parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace creatures {
namespace {

// Linear between the sections, smoothed in time: enough for rings.
Section section_at(const Sweep& sweep, double at) {
  const std::vector<Section>& all = sweep.sections;
  if (all.size() == 1 || at <= all.front().at) return all.front();
  if (at >= all.back().at) return all.back();
  size_t i = 1;
  while (at > all[i].at) ++i;
  const Section &a = all[i - 1], &b = all[i];
  const double t = (at - a.at) / (b.at - a.at), s = 0.5 * (t + t * t * (3 - 2 * t));
  const auto mix = [s](double x, double y) { return x + s * (y - x); };
  return {at,
          mix(a.side, b.side),
          mix(a.front, b.front),
          mix(a.back, b.back),
          mix(a.shift_front, b.shift_front),
          mix(a.shift_side, b.shift_side)};
}

// One ring of a tube: its section, its place along the axis and how much a cap narrows it.
struct Ring {
  Section section;
  double along, scale;
};

std::vector<Ring> rings_of(const Sweep& sweep, const Tube& how, double length) {
  const Section first = section_at(sweep, how.from), last = section_at(sweep, how.to);
  const double quarter = 0.5 * EIGEN_PI / std::max(how.caps, 1);
  std::vector<Ring> rings;
  if (!how.open_start)
    for (int k = how.caps - 1; k > 0; --k)
      rings.push_back(
          {first, how.from * length - sweep.start_cap * std::sin(k * quarter), std::cos(k * quarter)});
  const int bands = length > 0 ? std::max(how.rings, 1) : 0;
  for (int k = 0; k <= bands; ++k) {
    const double at = bands ? how.from + (how.to - how.from) * k / bands : 0;
    rings.push_back({section_at(sweep, at), at * length, 1});
  }
  if (!how.open_end)
    for (int k = 1; k < how.caps; ++k)
      rings.push_back({last, how.to * length + sweep.end_cap * std::sin(k * quarter), std::cos(k * quarter)});
  return rings;
}

Eigen::Vector2d on_outline(double angle, double square) {
  const double power = 1 - 0.9 * square, c = std::cos(angle), s = std::sin(angle);
  return {std::copysign(std::pow(std::abs(c), power), c), std::copysign(std::pow(std::abs(s), power), s)};
}

}  // namespace

Mesh tube(const Sweep& sweep, const Tube& how) {
  const double length = (sweep.to - sweep.from).norm();
  const Vec3 axis = length > 0 ? Vec3((sweep.to - sweep.from) / length) : Vec3::UnitY();
  const Vec3 side = axis.cross(sweep.front).normalized(), front = side.cross(axis);
  const std::vector<Ring> rings = rings_of(sweep, how, length);
  const int n = how.sides, rows = static_cast<int>(rings.size());
  Mesh mesh;
  const auto middle = [&](const Ring& r) -> Vec3 {
    return sweep.from + r.along * axis + r.section.shift_side * side + r.section.shift_front * front;
  };
  for (const Ring& r : rings)
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d o = r.scale * on_outline((2 * j + 1) * EIGEN_PI / n, how.square);
      mesh.positions.push_back(middle(r) + o.x() * r.section.side * side +
                               o.y() * (o.y() > 0 ? r.section.front : r.section.back) * front);
    }
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * n + j, b = i * n + (j + 1) % n;
      mesh.triangles.push_back({a, a + n, b + n});
      mesh.triangles.push_back({a, b + n, b});
    }
  const auto close = [&](const Ring& r, double cap, int row, bool end) {
    const int pole = static_cast<int>(mesh.positions.size());
    const double base = end ? how.to * length : how.from * length, out = how.caps > 0 ? cap : 0;
    mesh.positions.push_back(middle({r.section, base + (end ? out : -out), 1}));
    for (int j = 0; j < n; ++j) {
      const int a = row * n + j, b = row * n + (j + 1) % n;
      mesh.triangles.push_back(end ? Triangle{pole, b, a} : Triangle{pole, a, b});
    }
  };
  if (!how.open_start) close(rings.front(), sweep.start_cap, 0, false);
  if (!how.open_end) close(rings.back(), sweep.end_cap, rows - 1, true);
  return mesh;
}

Mesh sheet(int columns, int rows, const std::function<Vec3(double, double)>& point) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.positions.push_back(point(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + columns + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

Mesh clip(const Mesh& mesh, const std::function<double(const Vec3&)>& f) {
  Mesh kept;
  std::vector<double> values;
  std::vector<int> moved(mesh.positions.size(), -1);
  std::map<std::pair<int, int>, int> cuts;
  for (const Vec3& p : mesh.positions) values.push_back(f(p));
  const auto keep = [&](int v) {
    if (moved[v] < 0) {
      moved[v] = static_cast<int>(kept.positions.size());
      kept.positions.push_back(mesh.positions[v]);
    }
    return moved[v];
  };
  const auto cut = [&](int a, int b) {
    const auto [at, fresh] = cuts.try_emplace(std::minmax(a, b), static_cast<int>(kept.positions.size()));
    if (fresh) {
      // Away from the corners, so that no sliver has an edge of length zero.
      const double t = std::clamp(values[a] / (values[a] - values[b]), 0.02, 0.98);
      kept.positions.push_back((1 - t) * mesh.positions[a] + t * mesh.positions[b]);
    }
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    std::vector<int> loop;
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (values[a] < 0) loop.push_back(keep(a));
      if ((values[a] < 0) != (values[b] < 0)) loop.push_back(values[a] < 0 ? cut(a, b) : cut(b, a));
    }
    for (size_t k = 2; k < loop.size(); ++k) kept.triangles.push_back({loop[0], loop[k - 1], loop[k]});
  }
  return kept;
}

Mesh mirrored(const Mesh& mesh) {
  Mesh other;
  for (const Vec3& p : mesh.positions) other.positions.push_back(mirrored(p));
  for (const Triangle& t : mesh.triangles) other.triangles.push_back({t[0], t[2], t[1]});
  return other;
}

void append(Mesh& mesh, const Mesh& more) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const Triangle& t : more.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

void drop_loose_vertices(Part& part) {
  Part kept{part.name, {}, {}};
  std::vector<int> moved(part.mesh.positions.size(), -1);
  for (Triangle t : part.mesh.triangles) {
    for (int& v : t) {
      if (moved[v] < 0) {
        moved[v] = static_cast<int>(kept.mesh.positions.size());
        kept.mesh.positions.push_back(part.mesh.positions[v]);
        kept.skin.push_back(part.skin[v]);
      }
      v = moved[v];
    }
    kept.mesh.triangles.push_back(t);
  }
  part = std::move(kept);
}

Sweep inflated(Sweep sweep, double by) {
  for (Section& s : sweep.sections) {
    s.side += by;
    s.front += by;
    s.back += by;
  }
  sweep.start_cap += by;
  sweep.end_cap += by;
  return sweep;
}

WeightField rigid(int bone, int bone_count) {
  std::vector<double> weights(static_cast<size_t>(bone_count), 0.0);
  weights[static_cast<size_t>(bone)] = 1;
  return [weights](const Vec3&) { return weights; };
}

WeightField ridden(const Body& body, std::vector<int> bones) {
  return [&body, bones = std::move(bones)](const Vec3& p) {
    const std::vector<double> all = body.bone_weights(p);
    std::vector<double> some(all.size(), 0.0);
    double total = 0;
    for (int b : bones) total += some[b] = all[b];
    if (total < 1e-3) some[bones.front()] = 1;
    return some;
  };
}

std::vector<Influences> skin_mesh(const Mesh& mesh, const WeightField& weights, int rounds) {
  std::vector<std::vector<double>> all;
  for (const Vec3& p : mesh.positions) all.push_back(weights(p));
  return skin_of(std::move(all), mesh.triangles, rounds);
}

}  // namespace creatures
