#include "bad_mesh_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

extern "C" {
#include "capi/shapes.h"
}

namespace focal_bad_meshes {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// A ball with three limbs, 74 to 244 vertices: sound.
BadMesh body(Chance& chance) {
  shape made = shape_create(static_cast<int>(chance.between(6, 11)), chance.uniform(0, 0.2f));
  BadMesh mesh{{made.positions, made.positions + 3 * made.vertex_count},
               {made.indices, made.indices + made.index_count}};
  shape_destroy(&made);
  return mesh;
}

// Columns x rows quads over place(u, v), u and v from 0 to 1.
template <class Place>
BadMesh grid(uint32_t columns, uint32_t rows, const Place& place) {
  BadMesh mesh;
  for (uint32_t j = 0; j <= rows; ++j)
    for (uint32_t i = 0; i <= columns; ++i) {
      const auto at = place(static_cast<float>(i) / static_cast<float>(columns),
                            static_cast<float>(j) / static_cast<float>(rows));
      mesh.add_vertex(at[0], at[1], at[2]);
    }
  for (uint32_t j = 0; j < rows; ++j)
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
      mesh.add_triangle(a, a + 1, b), mesh.add_triangle(a + 1, b + 1, b);
    }
  return mesh;
}
using Place = std::array<float, 3>;

void append(BadMesh& mesh, const BadMesh& other, float x = 0, float y = 0, float z = 0) {
  const uint32_t base = mesh.vertex_count();
  for (uint32_t v = 0; v < other.vertex_count(); ++v)
    mesh.add_vertex(other.positions[3 * v] + x, other.positions[3 * v + 1] + y,
                    other.positions[3 * v + 2] + z);
  for (const uint32_t v : other.indices) mesh.indices.push_back(base + v);
}

template <class Change>
void for_each_vertex(BadMesh& mesh, const Change& change) {
  for (uint32_t v = 0; v < mesh.vertex_count(); ++v) change(&mesh.positions[3 * v]);
}
void scale(BadMesh& mesh, float x, float y, float z) {
  for_each_vertex(mesh, [&](float* p) { p[0] *= x, p[1] *= y, p[2] *= z; });
}
void turn_over(BadMesh& mesh, uint32_t t) { std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]); }

float power_of_ten(Chance& chance, float low, float high) {
  return std::pow(10.0f, chance.uniform(low, high));
}

// ---- what spoils a mesh

void add_fins(BadMesh& mesh, Chance& chance) {
  for (uint32_t fins = chance.between(1, 20); fins > 0; --fins) {
    const uint32_t t = chance.below(mesh.triangle_count()), corner = chance.below(3);
    const uint32_t a = mesh.indices[3 * t + corner], b = mesh.indices[3 * t + (corner + 1) % 3];
    const float* p = &mesh.positions[3 * a];
    const float out = chance.uniform(1.1f, 2);
    mesh.add_triangle(a, b, mesh.add_vertex(p[0] * out, p[1] * out, p[2] * out + 0.01f));
  }
}
void weld_at_random(BadMesh& mesh, Chance& chance) {
  for (uint32_t pairs = chance.between(1, 8); pairs > 0; --pairs) {
    const uint32_t from = chance.below(mesh.vertex_count()), to = chance.below(mesh.vertex_count());
    std::replace(mesh.indices.begin(), mesh.indices.end(), from, to);
  }
}
void flip_patch(BadMesh& mesh, Chance& chance) {
  const uint32_t first = chance.below(mesh.triangle_count()), count = chance.below(mesh.triangle_count());
  for (uint32_t t = first; t < std::min(first + count, mesh.triangle_count()); ++t) turn_over(mesh, t);
}
void flip_at_random(BadMesh& mesh, Chance& chance) {
  const float share = chance.uniform(0.02f, 1);
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
    if (chance.uniform() < share) turn_over(mesh, t);
}
void repeat_triangles(BadMesh& mesh, Chance& chance) {
  for (uint32_t count = mesh.triangle_count(), t = 0; t < count; ++t) {
    if (chance.below(3) > 0) continue;
    mesh.add_triangle(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2], mesh.indices[3 * t]);
    if (chance.below(2)) turn_over(mesh, mesh.triangle_count() - 1);
  }
}
void flatten_triangles(BadMesh& mesh, Chance& chance) {  // slivers: a corner moves onto the opposite side
  const float left = chance.below(2) ? 0 : power_of_ten(chance, -7, -2);
  for (uint32_t count = chance.between(1, 30); count > 0; --count) {
    const uint32_t* corner = &mesh.indices[3 * chance.below(mesh.triangle_count())];
    for (int i = 0; i < 3; ++i) {
      const float middle = 0.5f * (mesh.positions[3 * corner[1] + i] + mesh.positions[3 * corner[2] + i]);
      float& at = mesh.positions[3 * corner[0] + i];
      at = middle + left * (at - middle);
    }
  }
}
void add_zero_areas(BadMesh& mesh, Chance& chance) {  // over T-junctions
  for (uint32_t count = chance.between(1, 30); count > 0; --count) {
    const uint32_t t = chance.below(mesh.triangle_count()), a = mesh.indices[3 * t],
                   b = mesh.indices[3 * t + 1];
    const float *p = &mesh.positions[3 * a], *q = &mesh.positions[3 * b];
    mesh.add_triangle(a, b, mesh.add_vertex((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2));
    if (chance.below(2)) mesh.add_triangle(a, a, b);
  }
}
void pull_spikes(BadMesh& mesh, Chance& chance) {
  for (uint32_t count = chance.between(1, 5); count > 0; --count) {
    const float out = power_of_ten(chance, 1, 5);
    float* p = &mesh.positions[3 * chance.below(mesh.vertex_count())];
    for (int i = 0; i < 3; ++i) p[i] *= out;
  }
}
void cut_holes(BadMesh& mesh, Chance& chance) {
  const float share = chance.uniform(0.02f, 0.6f);
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
    if (chance.uniform() >= share) kept.insert(kept.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
  mesh.indices = kept;
}
void jitter(BadMesh& mesh, Chance& chance) {
  const float amount = power_of_ten(chance, -6, 0.5f);
  for (float& x : mesh.positions) x += amount * chance.uniform(-1, 1);
}
void tear_apart(BadMesh& mesh,
                Chance& chance) {  // own corners for every triangle; sometimes cracks between them
  const float crack = chance.below(2) ? 0 : power_of_ten(chance, -7, -2);
  BadMesh torn;
  for (const uint32_t v : mesh.indices) {
    const float* p = &mesh.positions[3 * v];
    torn.indices.push_back(torn.vertex_count());
    torn.add_vertex(p[0] + crack * chance.uniform(), p[1] + crack * chance.uniform(),
                    p[2] + crack * chance.uniform());
  }
  mesh = torn;
}
void spoil_positions(BadMesh& mesh, Chance& chance) {
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()};
  for (uint32_t count = chance.between(1, 6); count > 0; --count)
    mesh.positions[chance.below(3 * mesh.vertex_count())] = values[chance.below(3)];
}
void spoil_indices(BadMesh& mesh, Chance& chance) {
  for (uint32_t count = chance.between(1, 8); count > 0; --count)
    mesh.indices[chance.below(3 * mesh.triangle_count())] =
        chance.below(2) ? 0xFFFFFFFFu - chance.below(9) : mesh.vertex_count() + chance.below(9);
}
void grade(BadMesh& mesh, Chance& chance) {  // triangles of all sizes
  const float base = chance.uniform(2, 8);
  for_each_vertex(mesh, [&](float* p) {
    const float factor = std::pow(base, 3 * p[0]);
    for (int i = 0; i < 3; ++i) p[i] *= factor;
  });
}
void add_unused(BadMesh& mesh, Chance& chance) {
  for (uint32_t count = chance.between(1, 50); count > 0; --count)
    mesh.add_vertex(chance.uniform(-9, 9), chance.uniform(-9, 9), chance.uniform(-9, 9));
}
void squeeze(BadMesh& mesh, Chance& chance) {
  const float thin = chance.below(3) ? power_of_ten(chance, -8, -2) : 0;
  scale(mesh, 1, chance.below(2) ? thin : 1, thin);
}
void make_huge(BadMesh& mesh, Chance& chance) {
  const float by = power_of_ten(chance, 10, 30);
  scale(mesh, by, by, by);
}
void make_tiny(BadMesh& mesh, Chance& chance) {
  const float by = power_of_ten(chance, -30, -10);
  scale(mesh, by, by, by);
}
void move_away(BadMesh& mesh, Chance& chance) {
  const float far = power_of_ten(chance, 3, 6.3f);
  for_each_vertex(mesh, [&](float* p) { p[0] += far, p[1] -= far; });
}
void line_up(BadMesh& mesh, Chance&) {
  for_each_vertex(mesh, [](float* p) { p[1] = 2 * p[0], p[2] = -p[0]; });
}
void press_flat(BadMesh& mesh, Chance& chance) {
  const float height = chance.uniform(-1, 1);
  for_each_vertex(mesh, [&](float* p) { p[2] = height; });
}
void keep_few(BadMesh& mesh, Chance& chance) {
  mesh.indices.resize(3 * chance.between(1, std::min(mesh.triangle_count(), 30u)));
}

// ---- what is bad from the start

BadMesh soup(Chance& chance) {
  BadMesh mesh;
  for (uint32_t corners = 3 * chance.between(1, 90); corners > 0; --corners)
    mesh.indices.push_back(mesh.add_vertex(chance.uniform(), chance.uniform(), chance.uniform()));
  return mesh;
}
BadMesh tangle(Chance& chance) {  // triangles between random vertices
  BadMesh mesh;
  for (uint32_t vertices = chance.between(4, 150); vertices > 0; --vertices)
    mesh.add_vertex(chance.uniform(), chance.uniform(), chance.uniform());
  for (uint32_t corners = 3 * chance.between(4, 400); corners > 0; --corners)
    mesh.indices.push_back(chance.below(mesh.vertex_count()));
  return mesh;
}
BadMesh book(Chance& chance) {  // pages that share a spine
  BadMesh mesh;
  const uint32_t pages = chance.between(3, 8);
  for (uint32_t page = 0; page < pages; ++page) {
    const float turn = 2 * pi * static_cast<float>(page) / static_cast<float>(pages);
    append(mesh, grid(chance.between(2, 4), 6, [&](float u, float v) {
             return Place{u * std::cos(turn), u * std::sin(turn), 2 * v};
           }));
  }
  return mesh;
}
BadMesh one_sided_strip(Chance& chance) {
  const uint32_t columns = chance.between(8, 40), rows = chance.between(1, 5);
  const float turns = static_cast<float>(2 * chance.below(2) + 1) / 2;
  BadMesh mesh = grid(columns, rows, [&](float u, float v) {
    const float along = 2 * pi * u, across = turns * along, width = v - 0.5f,
                r = 1 + width * std::cos(across);
    return Place{r * std::cos(along), r * std::sin(along), width * std::sin(across)};
  });
  for (uint32_t& v : mesh.indices)  // its end joins its beginning, upside down
    if (v % (columns + 1) == columns) v = (rows - v / (columns + 1)) * (columns + 1);
  return mesh;
}
BadMesh klein_bottle(Chance& chance) {
  const uint32_t columns = chance.between(8, 16), rows = chance.between(6, 12);
  BadMesh mesh = grid(columns, rows, [&](float u, float v) {
    const float a = 2 * pi * u, b = 2 * pi * v;
    const float r = 2.5f + std::cos(a / 2) * std::sin(b) - std::sin(a / 2) * std::sin(2 * b);
    return Place{r * std::cos(a), r * std::sin(a),
                 std::sin(a / 2) * std::sin(b) + std::cos(a / 2) * std::sin(2 * b)};
  });
  for (uint32_t& v : mesh.indices) {
    if (v / (columns + 1) == rows) v %= columns + 1;
    if (v % (columns + 1) == columns) v = (rows - v / (columns + 1)) % rows * (columns + 1);
  }
  return mesh;
}
BadMesh crumbs(Chance& chance) {  // many parts
  BadMesh mesh;
  if (chance.below(2)) mesh = body(chance);
  for (uint32_t parts = chance.between(4, 40); parts > 0; --parts) {
    const float x = chance.uniform(-3, 3), y = chance.uniform(-3, 3), z = chance.uniform(-3, 3);
    const uint32_t a = mesh.add_vertex(x, y, z), b = mesh.add_vertex(x + 0.1f, y, z),
                   c = mesh.add_vertex(x, y + 0.2f, z), d = mesh.add_vertex(x, y, z + 0.3f);
    mesh.add_triangle(a, c, b), mesh.add_triangle(a, b, d), mesh.add_triangle(b, c, d),
        mesh.add_triangle(a, d, c);
  }
  return mesh;
}
BadMesh fan(Chance& chance) {  // one vertex of many triangles; or a strip without an inner vertex
  BadMesh mesh;
  const uint32_t count = chance.between(12, 250);
  const bool strip = chance.below(2);
  for (uint32_t i = 0; i < count; ++i) {
    const float at = static_cast<float>(i) / static_cast<float>(count);
    if (strip)
      mesh.add_vertex(10 * at, static_cast<float>(i % 2), at * at);
    else
      mesh.add_vertex(std::cos(2 * pi * at), std::sin(2 * pi * at), i ? 0.0f : 1.0f);
  }
  for (uint32_t i = strip ? 0 : 1; i + 2 < count; ++i) mesh.add_triangle(strip ? i : 0, i + 1, i + 2);
  return mesh;
}
BadMesh overlapping(Chance& chance) {
  BadMesh mesh = body(chance);
  append(mesh, body(chance), chance.uniform(-0.5f, 0.5f), 0, 0);
  return mesh;
}

struct Kind {
  const char* name;
  BadMesh (*begin)(Chance&);
  void (*spoil)(BadMesh&, Chance&);  // may be none
};
constexpr Kind all_kinds[] = {
    {"triangle soup", soup, nullptr},
    {"tangle of shared vertices", tangle, nullptr},
    {"fins", body, add_fins},
    {"book", book, nullptr},
    {"bow ties", body, weld_at_random},
    {"flipped patch", body, flip_patch},
    {"flipped at random", body, flip_at_random},
    {"Moebius strip", one_sided_strip, nullptr},
    {"Klein bottle", klein_bottle, nullptr},
    {"repeated triangles", body, repeat_triangles},
    {"slivers", body, flatten_triangles},
    {"zero areas", body, add_zero_areas},
    {"spikes", body, pull_spikes},
    {"many parts", crumbs, nullptr},
    {"holes", body, cut_holes},
    {"huge", body, make_huge},
    {"tiny", body, make_tiny},
    {"far away", body, move_away},
    {"NaN and infinity", body, spoil_positions},
    {"indices out of range", body, spoil_indices},
    {"collinear", body, line_up},
    {"flat", body, press_flat},
    {"few triangles", body, keep_few},
    {"thin", body, squeeze},
    {"noise", body, jitter},
    {"torn apart", body, tear_apart},
    {"unused vertices", body, add_unused},
    {"overlapping bodies", overlapping, nullptr},
    {"fans and strips", fan, nullptr},
    {"graded", body, grade},
};

BadMesh several_at_once(Chance& chance) {
  const auto any = [&] { return all_kinds[chance.below(std::size(all_kinds))]; };
  BadMesh mesh = any().begin(chance);
  for (uint32_t count = chance.between(2, 4); count > 0;) {
    const Kind kind = any();
    if (!kind.spoil || mesh.indices.empty()) continue;
    // Random indices may already name no vertex; those that follow expect that they do.
    if (kind.spoil != spoil_indices) kind.spoil(mesh, chance), --count;
    if (mesh.indices.empty()) break;
  }
  return mesh;
}

}  // namespace

const std::vector<std::string>& kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Kind& kind : all_kinds) result.emplace_back(kind.name);
    result.emplace_back("several at once");
    return result;
  }();
  return names;
}

BadMesh make(size_t kind, uint64_t seed) {
  Chance chance(seed * 1000 + kind);
  if (kind == std::size(all_kinds)) return several_at_once(chance);
  BadMesh mesh = all_kinds[kind].begin(chance);
  if (all_kinds[kind].spoil) all_kinds[kind].spoil(mesh, chance);
  return mesh;
}

}  // namespace focal_bad_meshes
