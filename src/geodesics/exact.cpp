// Exact distances on a triangle mesh: windows (beams of straight lines that cross an edge) are propagated
// over the triangles unfolded into the plane, nearest first.
// J. Mitchell, D. Mount, C. Papadimitriou, "The Discrete Geodesic Problem", 1987; J. Chen, Y. Han, "Shortest
// Paths on a Polyhedron", 1990 (one corner, one split); S. Xin, G. Wang, "Improving Chen and Han's Algorithm
// on the Discrete Geodesic Problem", 2009 (nearest first, and a filter for useless windows).
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "geodesics/distance.h"
#include "geodesics/half_edges.h"

namespace focal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double slack = 1e-10;           // relative: windows that tie are kept
constexpr double min_width = 1e-12;       // of an edge
constexpr int64_t check_interval = 2048;  // windows between two checks for cancellation

// Lines from (x, y), y <= 0, through the points begin..end of a half-edge into the triangle on its left.
struct Window {
  int32_t half_edge;
  double begin, end;
  double x, y;
  double offset;  // distance from the source to the point where the lines start
  double reach(double at) const { return offset + std::hypot(at - x, y); }
  double nearest() const { return reach(std::clamp(x, begin, end)); }
};

struct Event {
  double distance;
  Window window;  // half_edge -1: a vertex event
  int32_t vertex;
  bool operator<(const Event& other) const { return distance > other.distance; }  // nearest on top
};

// The propagation from one source.
class Propagation {
 public:
  Propagation(const HalfEdges& edges, const std::vector<std::vector<std::pair<int32_t, double>>>& bridges)
      : edges_(edges),
        bridges_(bridges),
        distance_(bridges.size(), infinity),
        corner_(edges.origin.size(), {infinity, 0}) {}

  void start_at(int32_t vertex) {
    distance_[vertex] = 0;
    spread_from(vertex);
  }
  void start_in(int32_t triangle, const MatrixX3& positions, const Vector3& place) {
    for (int32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      const Vector3 a = positions.row(edges_.origin[h]), b = positions.row(edges_.target(h));
      improve(edges_.origin[h], (place - a).norm());
      const int32_t twin = edges_.twin[h];
      if (twin < 0 || !(edges_.length[h] > 0)) continue;
      const double along = (place - b).dot(a - b) / edges_.length[h];
      const double away = (place - b - along * (a - b) / edges_.length[h]).norm();
      push({twin, 0, edges_.length[h], along, -away, 0});
    }
  }

  void run(const Execution& execution) {
    for (int64_t step = 0; !queue_.empty(); ++step) {
      if (step % check_interval == 0) execution.check_cancelled();
      const Event event = queue_.top();
      queue_.pop();
      if (event.window.half_edge >= 0)
        spread(event.window);
      else if (event.distance == distance_[event.vertex])
        spread_from(event.vertex);
    }
  }
  const std::vector<double>& distance() const { return distance_; }

 private:
  void improve(int32_t vertex, double distance) {
    if (!(distance < distance_[vertex])) return;
    distance_[vertex] = distance;
    if (edges_.bends[vertex]) queue_.push({distance, {-1, 0, 0, 0, 0, 0}, vertex});
  }

  void push(const Window& window) { queue_.push({window.nearest(), window, -1}); }

  // Starts windows in every triangle around a vertex at which paths bend.
  void spread_from(int32_t vertex) {
    const double offset = distance_[vertex];
    for (const auto& [other, length] : bridges_[vertex]) improve(other, offset + length);
    for (const int32_t h : edges_.from(vertex)) {
      const int32_t opposite = HalfEdges::next(h), back = HalfEdges::previous(h);
      improve(edges_.target(h), offset + edges_.length[h]);
      improve(edges_.origin[back], offset + edges_.length[back]);
      const int32_t twin = edges_.twin[opposite];
      if (twin < 0) continue;
      const double length = edges_.length[twin];  // the twin has the opposite direction
      const Window window{twin,  0, length, length - edges_.apex_x[opposite], -edges_.apex_y[opposite],
                          offset};
      if (leads_somewhere(window, vertex, true)) push(window);
    }
  }

  // Xin and Wang, Theorem 3.2: no line of a window is a shortest path when one of the corners of the triangle
  // that it crosses is much nearer. third: the corner opposite to its half-edge; from_left: the lines entered
  // beside the half-edge's target.
  bool leads_somewhere(const Window& w, int32_t third, bool from_left) const {
    const double length = edges_.length[w.half_edge];
    const double at_begin = w.reach(w.begin) * (1 - slack), at_end = w.reach(w.end) * (1 - slack);
    if (distance_[edges_.origin[w.half_edge]] + w.end < at_end) return false;
    if (distance_[edges_.target(w.half_edge)] + length - w.begin < at_begin) return false;
    const int32_t behind = edges_.twin[w.half_edge];
    const double x = length - edges_.apex_x[behind], y = edges_.apex_y[behind];
    const double across = std::hypot(x - (from_left ? w.begin : w.end), y);
    return !(distance_[third] + across < (from_left ? at_begin : at_end));
  }

  void spread(const Window& w);
  void push_child(const Window& w, double from, double to, bool ends_at_apex, bool is_left);

  const HalfEdges& edges_;
  const std::vector<std::vector<std::pair<int32_t, double>>>& bridges_;
  std::vector<double> distance_;
  struct Corner {
    double distance, crossing;
  };
  std::vector<Corner> corner_;  // per half-edge: the window that reaches the opposite corner first
  std::priority_queue<Event> queue_;
};

// The lines of w that cross its half-edge between from and to, and leave the triangle by its half-edge on the
// left or right.
void Propagation::push_child(const Window& w, double from, double to, bool ends_at_apex, bool is_left) {
  const int32_t h = w.half_edge, out = is_left ? HalfEdges::previous(h) : HalfEdges::next(h);
  const int32_t twin = edges_.twin[out], third = is_left ? edges_.target(h) : edges_.origin[h];
  const double length = edges_.length[out], apex_x = edges_.apex_x[h], apex_y = edges_.apex_y[h];
  if (twin < 0 || !(length > 0) || !(from < to)) return;
  // The child's x axis is along the twin: on the left from the origin of h to the apex, on the right from the
  // apex on.
  const double ox = is_left ? 0 : apex_x, oy = is_left ? 0 : apex_y;
  const double ux = (is_left ? apex_x : edges_.length[h] - apex_x) / length,
               uy = (is_left ? apex_y : -apex_y) / length;
  Window child{twin, 0, length, 0, 0, w.offset};
  child.x = (w.x - ox) * ux + (w.y - oy) * uy;
  child.y = std::min((w.y - oy) * ux - (w.x - ox) * uy, 0.0);
  const auto meet = [&](double at) {  // where the line through (at, 0) crosses the twin
    const double x = (at - ox) * ux - oy * uy, y = -oy * ux - (at - ox) * uy, fall = child.y - y;
    return std::clamp(fall < 0 ? child.x + child.y / fall * (x - child.x) : x, 0.0, length);
  };
  child.begin = ends_at_apex && !is_left ? 0 : meet(from);
  child.end = ends_at_apex && is_left ? length : meet(to);
  if (child.end - child.begin > min_width * length && leads_somewhere(child, third, is_left)) push(child);
}

void Propagation::spread(const Window& w) {
  const int32_t h = w.half_edge;
  const double x = edges_.apex_x[h], y = edges_.apex_y[h];
  const double crossing = w.x - (x - w.x) * w.y / (y - w.y);  // of the line to the apex
  const double at = std::clamp(crossing, w.begin, w.end);
  const double distance = w.reach(at) + std::hypot(x - at, y);
  improve(edges_.origin[HalfEdges::previous(h)], distance);
  const bool sees_apex = at == crossing;
  bool goes_left = true, goes_right = true;
  if (sees_apex) {
    // Of two windows that see the corner, the later one is cut off by the other's line to it.
    Corner& best = corner_[h];
    if (distance > best.distance * (1 + slack))
      (crossing < best.crossing ? goes_right : goes_left) = false;
    else if (distance < best.distance)
      best = {distance, crossing};
  }
  if (goes_left) push_child(w, w.begin, at, sees_apex, true);
  if (goes_right) push_child(w, at, w.end, sees_apex, false);
}

class ExactDistance final : public Distance {
 public:
  explicit ExactDistance(const MeasuredSurface& surface)
      : Distance(surface.mesh),
        edges_(half_edges_of(surface.mesh, surface.bridges)),
        bridges_(surface.mesh.vertex_count()) {
    distance_bound_ = diameter_bound(surface.mesh, surface.operators.L);
    for (const auto& [a, b] : surface.bridges) {
      const double length = (positions_.row(a) - positions_.row(b)).norm();
      bridges_[a].emplace_back(b, length), bridges_[b].emplace_back(a, length);
    }
  }

 private:
  void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const override {
    std::fill_n(out, static_cast<size_t>(vertex_count()) * lanes, 0.0f);
    for (size_t j = 0; j < sources.size(); ++j) {
      Propagation propagation(edges_, bridges_);
      start(propagation, sources[j]);
      propagation.run(execution);
      const std::vector<double>& distance = propagation.distance();
      for (size_t v = 0; v < distance.size();
           ++v)  // vertices that are not connected get the largest possible distance
        out[v * lanes + j] = static_cast<float>(std::min(distance[v], distance_bound_));
    }
  }

  void start(Propagation& propagation, const Source& source) const {
    constexpr double whole = 1 - 1e-9;
    Vector3 place = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      if (source.weight[i] > whole) return propagation.start_at(source.vertex[i]);
      place += source.weight[i] * positions_.row(source.vertex[i]).transpose();
    }
    propagation.start_in(source.triangle, positions_, place);
  }

  HalfEdges edges_;
  std::vector<std::vector<std::pair<int32_t, double>>> bridges_;  // per vertex: the other end and the length
};

}  // namespace

DistanceKind exact_distance() {
  return {"exact", true, true, [](const MeasuredSurface& surface, const Execution&) {
            return std::shared_ptr<const Distance>(std::make_shared<ExactDistance>(surface));
          }};
}

}  // namespace focal
