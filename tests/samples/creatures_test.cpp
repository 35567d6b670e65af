// The sample characters keep what their users rely on: sound surfaces, skins, landmarks, and the same bytes again.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "creatures/character.h"
#include "creatures/write.h"
#include "surface_checks.h"

using namespace creatures;

namespace {

constexpr int seeds = 3;

// Made once for all the tests below.
const std::vector<Character>& characters() {
  static const std::vector<Character> all = [] {
    std::vector<Character> made;
    for (const Family& family : families())
      for (uint64_t seed = 1; seed <= seeds; ++seed)
        made.push_back(make_character(family, std::string(family.name) + std::to_string(seed), seed));
    return made;
  }();
  return all;
}

std::string bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Vec3 place(const Landmark& mark, const Mesh& mesh) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) p += mark.barycentric[k] * mesh.positions[mesh.triangles[mark.triangle][k]];
  return p;
}

}  // namespace

TEST_CASE("the checks see what they are to find") {
  Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const checks::Topology sound = checks::topology(tetrahedron);
  CHECK(sound.closed_and_oriented);
  CHECK(sound.fans_whole);
  CHECK(sound.components == 1);
  CHECK(sound.euler == 2);
  CHECK(checks::volume(tetrahedron) == doctest::Approx(1.0 / 6));
  CHECK(checks::self_intersections(tetrahedron) == 0);

  Mesh two = tetrahedron;  // a second one, moved so that it cuts the first
  for (const Vec3& p : tetrahedron.positions) two.positions.push_back(p + Vec3(0.2, 0.17, 0.15));
  for (const Triangle& t : tetrahedron.triangles) two.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  CHECK(checks::topology(two).components == 2);
  CHECK(checks::self_intersections(two) > 0);

  Mesh pinched = two;  // the two share a vertex and nothing else
  for (Triangle& t : pinched.triangles) std::replace(t.begin(), t.end(), 4, 0);
  CHECK_FALSE(checks::topology(pinched).fans_whole);

  tetrahedron.triangles.pop_back();
  CHECK_FALSE(checks::topology(tetrahedron).closed_and_oriented);
}

TEST_CASE("sample characters are closed, manifold, outward and in one piece") {
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    const checks::Topology topology = checks::topology(c.rest);
    CHECK(topology.closed_and_oriented);
    CHECK(topology.fans_whole);
    CHECK(topology.components == 1);
    CHECK(topology.euler == 2);
    CHECK(checks::volume(c.rest) > 0);
    CHECK(c.rest.positions.size() >= 2800);
    CHECK(c.rest.positions.size() <= 6500);
  }
}

TEST_CASE("sample characters do not intersect themselves at rest") {
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    CHECK(checks::self_intersections(c.rest) == 0);
  }
}

TEST_CASE("triangles of sample characters are well shaped") {
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    double mean = 0, worst = 1;
    for (const Triangle& t : c.rest.triangles) {
      // 1 for an equilateral triangle, 0 for a degenerate one.
      const Vec3 a = c.rest.positions[t[1]] - c.rest.positions[t[0]],
                 b = c.rest.positions[t[2]] - c.rest.positions[t[1]],
                 d = c.rest.positions[t[0]] - c.rest.positions[t[2]];
      const double quality =
          2 * std::sqrt(3.0) * a.cross(b).norm() / (a.squaredNorm() + b.squaredNorm() + d.squaredNorm());
      mean += quality / static_cast<double>(c.rest.triangles.size());
      worst = std::min(worst, quality);
    }
    CHECK(mean > 0.85);
    CHECK(worst > 0.1);
  }
}

TEST_CASE("skins of sample characters are convex combinations of existing joints") {
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    REQUIRE(c.skin.size() == c.rest.positions.size());
    std::set<int> used;
    double off = 0, least = 0;
    for (const Influences& v : c.skin) {
      double sum = 0;
      for (int k = 0; k < max_influences; ++k) {
        sum += v.weights[k];
        least = std::min(least, v.weights[k]);
        if (v.weights[k] > 0.4) used.insert(v.joints[k]);
      }
      off = std::max(off, std::abs(sum - 1));
    }
    CHECK(off < 1e-12);
    CHECK(least >= 0);
    CHECK(used.size() == c.skeleton.joints.size());  // every joint leads some vertex
  }
}

TEST_CASE("landmarks of sample characters lie on the mesh, apart, on their own sides") {
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    CHECK(c.landmarks.size() >= 16);
    const double size = std::sqrt(std::cbrt(checks::volume(c.rest)));
    std::set<int> vertices;
    for (const Landmark& mark : c.landmarks) {
      CAPTURE(mark.name);
      CHECK(mark.barycentric.minCoeff() >= -1e-9);
      CHECK(mark.barycentric.sum() == doctest::Approx(1));
      const Triangle& t = c.rest.triangles[mark.triangle];
      CHECK(std::find(t.begin(), t.end(), mark.vertex) != t.end());
      vertices.insert(mark.vertex);
      const double x = place(mark, c.rest).x();
      if (mark.name.ends_with(".L")) CHECK(x > 0.002 * size);
      if (mark.name.ends_with(".R")) CHECK(x < -0.002 * size);
    }
    CHECK(vertices.size() == c.landmarks.size());
  }
}

TEST_CASE("sample characters face forward and stand upright at rest") {
  const auto at = [](const Character& c, const std::string& name) {
    for (const Landmark& mark : c.landmarks)
      if (mark.name == name) return place(mark, c.rest);
    FAIL("no landmark " << name);
    return Vec3();
  };
  for (const Character& c : characters()) {
    CAPTURE(c.name);
    if (c.name.starts_with("humanoid")) {
      CHECK(at(c, "nose").z() > at(c, "crown").z());
      CHECK(at(c, "toeTip.L").z() > at(c, "heel.L").z());
      CHECK(at(c, "crown").y() > at(c, "knee.L").y());
      CHECK(at(c, "navel").z() > at(c, "lowerBack").z());
    } else if (c.name.starts_with("quadruped")) {
      CHECK(at(c, "nose").z() > at(c, "tailTip").z());
      CHECK(at(c, "withers").y() > at(c, "belly").y());
    } else if (c.name.starts_with("insect")) {
      CHECK(at(c, "head").z() > at(c, "abdomenTip").z());
    } else {
      CHECK(at(c, "palm").z() > at(c, "backOfHand").z());
      CHECK(at(c, "thumbTip").x() > at(c, "littleTip").x());  // a right hand
    }
  }
}

TEST_CASE("different seeds make different individuals and triangulations, the same seed the same bytes") {
  const auto folder = std::filesystem::temp_directory_path() / "focal_creatures_test";
  for (size_t f = 0; f < families().size(); ++f) {
    const Character &one = characters()[f * seeds], &other = characters()[f * seeds + 1];
    CHECK(one.rest.positions.size() != other.rest.positions.size());
    CHECK((one.skeleton.joints.back().tip - other.skeleton.joints.back().tip).norm() > 0);
    const Character again = make_character(families()[f], one.name, 1);
    write_character(one, folder / "one");
    write_character(again, folder / "again");
    for (const char* ending : {".glb", ".rig.glb", ".joints.json", ".landmarks.json"}) {
      const std::string first = bytes(folder / "one" / (one.name + ending));
      CHECK(first.size() > 1000);
      CHECK(first == bytes(folder / "again" / (one.name + ending)));
    }
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("bending by no motion changes nothing, by a common motion moves all alike") {
  const Influences shared{{0, 1, 2, 0}, {0.5, 0.3, 0.2, 0}};
  const Vec3 p(0.3, -0.2, 0.7);
  CHECK((bend(p, shared, Pose(3, Eigen::Isometry3d::Identity())) - p).norm() < 1e-12);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(2.1, Vec3(1, 2, 3).normalized())).pretranslate(Vec3(4, 5, 6));
  CHECK((bend(p, shared, Pose(3, motion)) - motion * p).norm() < 1e-12);
}
