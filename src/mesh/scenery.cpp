#include "mesh/scenery.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mesh/box.h"
#include "mesh/scenery_shapes.h"

namespace focal {
namespace {

constexpr size_t max_candidates = 64, max_samples = 20000;
constexpr double convex = 0.95;    // share of the area, see ConvexBody
constexpr int32_t max_rounds = 4;  // each may expose more: a ground below a distant helper

struct Part {
  std::vector<int32_t> triangles;
  Box box;
  int32_t vertex_count = 0;
  int32_t piece = -1;         // of its first triangle; others may be welded to it
  bool is_character = false;  // never scenery
  bool is_sheet = false;      // large and flat: possibly scenery, so not used to measure other parts
  std::optional<SceneryKind> found;

  bool counts() const { return !found && !is_sheet; }
  bool may_be_scenery() const { return !found && !is_character; }
};

using Group = std::vector<int32_t>;  // numbers of parts
using Mask = std::vector<char>;      // one per part

class SceneryFinder {
 public:
  SceneryFinder(const TriangleMesh& surface, const Components& components,
                std::span<const int32_t> source_triangle, std::span<const MeshPiece> pieces)
      : surface_(surface), components_(components), pieces_(pieces), parts_(components.count) {
    make_parts(source_triangle);
    const auto n = static_cast<size_t>(surface.vertex_count());
    for (size_t v = 0; v < n; v += 1 + n / max_samples) samples_.push_back(static_cast<int32_t>(v));
  }
  FoundScenery find();

 private:
  void make_parts(std::span<const int32_t> source_triangle);
  std::vector<Group> candidates() const;
  Mask mask_of(const Group& group) const;
  Group rest_of(const Mask& group) const;
  std::vector<int32_t> samples_of_rest(const Mask& group) const;
  std::vector<int32_t> triangles_of(const Group& group) const;
  Box box_of(const Group& group) const;
  double vertices_of(const Group& group) const;
  bool is_ground_or_backdrop(const Group& group, const FlatSheet& sheet) const;
  bool encloses_character(const Group& group) const;
  bool hangs_together(const Group& rest, double size) const;
  bool mark(const std::vector<Group>& groups, SceneryKind kind);  // whether there are any
  bool find_sheets();
  bool find_enclosures();
  bool find_apart();
  Group lone_helpers(const Group& joined) const;
  bool is_convex(int32_t part) const;
  Group surely_character() const;
  Group joined_to(Group joined) const;
  bool leaves_character() const;
  FoundScenery result() const;

  const TriangleMesh& surface_;
  const Components& components_;
  std::span<const MeshPiece> pieces_;
  std::vector<Part> parts_;
  std::vector<int32_t> samples_;   // vertices
  std::vector<int32_t> piece_of_;  // per triangle
};

void SceneryFinder::make_parts(std::span<const int32_t> source_triangle) {
  int32_t piece = 0;
  const auto end = [&](int32_t p) { return pieces_[p].first_triangle + pieces_[p].triangle_count; };
  for (int32_t t = 0; t < surface_.triangle_count(); ++t) {
    while (piece + 1 < static_cast<int32_t>(pieces_.size()) && source_triangle[t] >= end(piece)) ++piece;
    piece_of_.push_back(piece);
    Part& part = parts_[components_.of_vertex[surface_.triangles(t, 0)]];
    part.triangles.push_back(t);
    if (part.piece < 0) part.piece = piece;
    if (!pieces_.empty()) part.is_character |= pieces_[piece].is_character;
  }
  for (int32_t v = 0; v < surface_.vertex_count(); ++v) {
    Part& part = parts_[components_.of_vertex[v]];
    part.box.add(Vector3(surface_.positions.row(v)));
    ++part.vertex_count;
  }
}

std::vector<int32_t> SceneryFinder::triangles_of(const Group& group) const {
  std::vector<int32_t> result;
  for (const int32_t p : group)
    result.insert(result.end(), parts_[p].triangles.begin(), parts_[p].triangles.end());
  return result;
}

Box SceneryFinder::box_of(const Group& group) const {
  Box box;
  for (const int32_t p : group) box.add(parts_[p].box);
  return box;
}

double SceneryFinder::vertices_of(const Group& group) const {
  double count = 0;
  for (const int32_t p : group) count += parts_[p].vertex_count;
  return count;
}

// All parts of one piece together, and each part alone; the largest of them, in descending order.
std::vector<Group> SceneryFinder::candidates() const {
  constexpr double large = 0.25;  // of everything not found so far
  std::vector<Group> of_piece(std::max<size_t>(pieces_.size(), 1)), result;
  for (size_t p = 0; p < parts_.size(); ++p) {
    if (!parts_[p].may_be_scenery()) continue;
    result.push_back({static_cast<int32_t>(p)});
    of_piece[parts_[p].piece].push_back(static_cast<int32_t>(p));
  }
  for (Group& group : of_piece)
    if (group.size() > 1) result.push_back(std::move(group));
  Box all;
  for (const Part& part : parts_)
    if (!part.found) all.add(part.box);
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < result.size(); ++i)
    if (const double size = box_of(result[i]).diagonal(); size >= large * all.diagonal())
      order.emplace_back(-size, i);
  std::sort(order.begin(), order.end());
  std::vector<Group> largest;
  for (size_t i = 0; i < std::min(order.size(), max_candidates); ++i)
    largest.push_back(std::move(result[order[i].second]));
  return largest;
}

Mask SceneryFinder::mask_of(const Group& group) const {
  Mask mask(parts_.size(), 0);
  for (const int32_t p : group) mask[p] = 1;
  return mask;
}

Group SceneryFinder::rest_of(const Mask& group) const {
  Group rest;
  for (size_t p = 0; p < parts_.size(); ++p)
    if (parts_[p].counts() && !group[p]) rest.push_back(static_cast<int32_t>(p));
  return rest;
}

std::vector<int32_t> SceneryFinder::samples_of_rest(const Mask& group) const {
  std::vector<int32_t> result;
  for (const int32_t v : samples_) {
    const int32_t part = components_.of_vertex[v];
    if (parts_[part].counts() && !group[part]) result.push_back(v);
  }
  return result;
}

// Wings and capes are sheets too: a sheet to leave out must extend beyond everything else, be on one side of
// it and be much larger.
bool SceneryFinder::is_ground_or_backdrop(const Group& group, const FlatSheet& sheet) const {
  constexpr double covered = 0.97, slack = 0.02, wrong_side = 0.05, min_height = 0.05;
  constexpr double larger = 4, ground_larger = 1.5, horizontal = 0.99;
  Box box;
  const std::vector<int32_t> rest = samples_of_rest(mask_of(group));
  if (rest.empty()) return false;
  std::vector<double> heights;
  std::vector<Eigen::Vector2d> shadow;
  for (const int32_t v : rest) {
    const Vector3 at = surface_.positions.row(v);
    box.add(at), shadow.push_back(on_sheet(sheet, at));
    heights.push_back(sheet.normal.dot(at - sheet.centre));
  }
  const double margin = slack * box.diagonal();
  const auto [low, high] = std::ranges::minmax(heights);
  const auto count = static_cast<double>(rest.size());
  const auto above = std::count_if(heights.begin(), heights.end(), [&](double h) { return h > margin; });
  const auto below = std::count_if(heights.begin(), heights.end(), [&](double h) { return h < -margin; });
  const auto inside = std::count_if(
      rest.begin(), rest.end(), [&](int32_t v) { return covers(sheet, surface_.positions.row(v), margin); });
  const bool lies = std::abs(sheet.normal.y()) > horizontal;
  if (lies && (sheet.normal.y() > 0) != (above > below)) return false;  // above the character, like a hat
  const double area = polygon_area(convex_outline(std::move(shadow)));
  return static_cast<double>(inside) >= covered * count && high - low >= min_height * box.diagonal() &&
         static_cast<double>(std::min(above, below)) <= wrong_side * count &&
         sheet.outline_area >= (lies ? ground_larger : larger) * area;
}

bool SceneryFinder::find_sheets() {
  std::vector<std::pair<Group, FlatSheet>> sheets;
  for (Part& part : parts_) part.is_sheet = false;
  for (Group& group : candidates()) {
    const auto sheet = flat_sheet(surface_, triangles_of(group));
    if (!sheet) continue;
    for (const int32_t p : group) parts_[p].is_sheet = true;
    sheets.emplace_back(std::move(group), *sheet);
  }
  std::vector<Group> found;
  for (auto& [group, sheet] : sheets)
    if (is_ground_or_backdrop(group, sheet)) found.push_back(std::move(group));
  return mark(found, SceneryKind::sheet);
}

// Limbs attached to a round body are separate without it; a character in a dome is not.
bool SceneryFinder::hangs_together(const Group& rest, double size) const {
  constexpr double touching = 0.05, most = 0.8;  // relative to the size
  if (rest.empty()) return false;
  const auto main = *std::max_element(rest.begin(), rest.end(), [&](int32_t a, int32_t b) {
    return parts_[a].box.diagonal() < parts_[b].box.diagonal();
  });
  Box joined = parts_[main].box;
  std::vector<char> is_joined(parts_.size(), 0);
  is_joined[main] = 1;
  for (bool grows = true; grows && joined.diagonal() < most * size;) {
    grows = false;
    for (const int32_t p : rest)
      if (!is_joined[p] && gap(joined, parts_[p].box) <= touching * size)
        joined.add(parts_[p].box), is_joined[p] = 1, grows = true;
  }
  return joined.diagonal() >= most * size;
}

bool SceneryFinder::encloses_character(const Group& group) const {
  constexpr double thick = 0.1, max_inside = 0.6, all_inside = 0.99;
  constexpr double same_size = 0.5, larger = 1.2, simple = 0.25, no_body = 0.4;
  const ConvexBody body = convex_body(surface_, triangles_of(group));
  const double size = body.box.diagonal();
  if (body.share < convex || (body.box.high - body.box.low).minCoeff() < thick * size) return false;
  const Mask mask = mask_of(group);
  const Group rest = rest_of(mask);
  const double rest_size = box_of(rest).diagonal();
  if (rest.empty()) return false;
  const std::vector<int32_t> samples = samples_of_rest(mask);
  const auto inside = static_cast<double>(std::count_if(
      samples.begin(), samples.end(), [&](int32_t v) { return body.contains(surface_.positions.row(v)); }));
  const auto count = static_cast<double>(samples.size());
  // Eyes in a round body are small and visible.
  const bool is_simple = vertices_of(group) <= simple * vertices_of(rest) && inside >= max_inside * count &&
                         rest_size >= same_size * size;
  const bool is_around = size >= larger * rest_size && inside >= all_inside * count;
  return (is_simple || is_around) && hangs_together(rest, rest_size) &&
         convex_body(surface_, triangles_of(rest)).share < no_body;
}

bool SceneryFinder::find_enclosures() {
  std::vector<Group> found;
  for (Group& group : candidates())
    if (encloses_character(group)) found.push_back(std::move(group));
  return mark(found, SceneryKind::enclosure);
}

bool SceneryFinder::mark(const std::vector<Group>& groups, SceneryKind kind) {
  for (const Group& group : groups)
    for (const int32_t p : group) parts_[p].found = kind;
  return !groups.empty();
}

// Parts that are certainly the character; otherwise the part with the most vertices, a convex one only if the
// eight largest are.
Group SceneryFinder::surely_character() const {
  constexpr size_t most = 8;
  Group parts = rest_of(Mask(parts_.size(), 0)), sure;
  for (const int32_t p : parts)
    if (parts_[p].is_character) sure.push_back(p);
  if (!sure.empty() || parts.empty()) return sure;
  std::stable_sort(parts.begin(), parts.end(),
                   [&](int32_t a, int32_t b) { return parts_[a].vertex_count > parts_[b].vertex_count; });
  parts.resize(std::min(parts.size(), most));
  const auto body = std::find_if(parts.begin(), parts.end(), [&](int32_t p) { return !is_convex(p); });
  return {body == parts.end() ? parts.front() : *body};
}

// The parts nearer to the character than its own size, found iteratively.
Group SceneryFinder::joined_to(Group joined) const {
  constexpr double far = 0.75;  // relative to the size of the joined parts, or of the largest part
  Group others = rest_of(mask_of(joined));
  double largest = 0;
  for (const int32_t p : others) largest = std::max(largest, parts_[p].box.diagonal());
  Box box = box_of(joined);
  for (size_t before = 0; before != joined.size();) {
    before = joined.size();
    std::erase_if(others, [&](int32_t p) {
      if (gap(box, parts_[p].box) > far * std::max(box.diagonal(), largest)) return false;
      box.add(parts_[p].box), joined.push_back(p);
      return true;
    });
  }
  return joined;
}

bool SceneryFinder::is_convex(int32_t part) const {
  return convex_body(surface_, parts_[part].triangles).share >= convex;
}

// A single convex object beside the character without a similar one elsewhere: floating hands come in pairs.
Group SceneryFinder::lone_helpers(const Group& joined) const {
  constexpr double far = 0.35, small = 0.5, alike = 0.02;
  constexpr size_t many = 1000;  // all pairs are compared
  Group result;
  if (joined.size() < 2 || joined.size() > many) return result;
  for (const int32_t p : joined) {
    if (!parts_[p].may_be_scenery()) continue;
    const double size = parts_[p].box.diagonal();
    Box rest;
    bool is_alone = true;
    for (const int32_t other : joined) {
      if (other == p) continue;
      rest.add(parts_[other].box);
      is_alone &= parts_[other].vertex_count != parts_[p].vertex_count ||
                  std::abs(parts_[other].box.diagonal() - size) > alike * size;
    }
    if (is_alone && size <= small * rest.diagonal() && gap(rest, parts_[p].box) >= far * rest.diagonal() &&
        is_convex(p))
      result.push_back(p);
  }
  return result;
}

bool SceneryFinder::find_apart() {
  const Group start = surely_character();
  if (start.empty()) return false;
  const Group joined = joined_to(start);
  Group apart = rest_of(mask_of(joined)), bodies = apart;
  if (!is_convex(start[0])) std::erase_if(bodies, [&](int32_t p) { return is_convex(p); });
  if (vertices_of(bodies) >= vertices_of(joined)) return false;  // ambiguous: unknown which is the character
  std::erase_if(apart, [&](int32_t p) { return !parts_[p].may_be_scenery(); });
  const Group lone = lone_helpers(joined);
  apart.insert(apart.end(), lone.begin(), lone.end());
  return !apart.empty() && mark({apart}, SceneryKind::apart);
}

bool SceneryFinder::leaves_character() const {
  constexpr int32_t least = 12;  // vertices; see smallest_surface of prepare
  int32_t vertices = 0;
  for (const Part& part : parts_)
    if (!part.found) vertices += part.vertex_count;
  return vertices >= least;
}

FoundScenery SceneryFinder::result() const {
  FoundScenery result;
  const size_t pieces = std::max<size_t>(pieces_.size(), 1);
  Mask has_character(pieces, 0);
  std::vector<Scenery> of_piece(pieces);
  for (const Part& part : parts_)
    for (const int32_t t : part.triangles) {
      const int32_t piece = piece_of_[t];
      if (!part.found) has_character[piece] = 1;
      if (!part.found) continue;
      result.triangles.resize(surface_.triangle_count(), 0);
      result.triangles[t] = 1;
      if (of_piece[piece].triangle_count++ == 0) of_piece[piece].kind = *part.found;
    }
  for (size_t p = 0; p < pieces; ++p) {
    of_piece[p].piece = static_cast<int32_t>(p), of_piece[p].whole_piece = !has_character[p];
    if (of_piece[p].triangle_count > 0) result.parts.push_back(of_piece[p]);
  }
  return result;
}

FoundScenery SceneryFinder::find() {
  for (int32_t round = 0; round < max_rounds; ++round) {
    bool changed = find_sheets();
    changed |= find_enclosures();
    changed |= find_apart();
    if (!changed) break;
  }
  for (Part& part : parts_) part.is_sheet = false;  // kept sheets may be apart
  find_apart();
  return leaves_character() ? result() : FoundScenery{};
}

const char* reason(SceneryKind kind) {
  switch (kind) {
    case SceneryKind::sheet:
      return "a flat sheet that reaches beyond the character on all sides";
    case SceneryKind::enclosure:
      return "a convex shape that contains most of the character";
    case SceneryKind::apart:
      return "separate from the character";
  }
  return "";
}

}  // namespace

FoundScenery find_scenery(const TriangleMesh& surface, const Components& components,
                          std::span<const int32_t> source_triangle, std::span<const MeshPiece> pieces) {
  if (components.count < 2) return {};
  return SceneryFinder(surface, components, source_triangle, pieces).find();
}

std::string describe(const Scenery& scenery, std::span<const MeshPiece> pieces) {
  const std::string name = pieces.empty() ? "the mesh" : pieces[scenery.piece].name;
  const std::string count = std::to_string(scenery.triangle_count);
  return (scenery.whole_piece ? name : count + " triangles of " + name) + ", " + reason(scenery.kind);
}

}  // namespace focal
