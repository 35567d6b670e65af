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

constexpr int game_seeds = 12;

// Of parts, which may be open and may overlap: only what holds for all of them is checked.
const std::vector<Character>& game_characters() {
  static const std::vector<Character> all = [] {
    std::vector<Character> made;
    for (const Family& family : game_families())
      for (uint64_t seed = 1; seed <= game_seeds; ++seed)
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

// Convex combinations of the joints, each of which has more than `lead` of some vertex.
void check_skin(const Character& c, double lead) {
  REQUIRE(c.skin.size() == c.rest.positions.size());
  std::set<int> used;
  double off = 0, least = 0;
  for (const Influences& v : c.skin) {
    double sum = 0;
    for (int k = 0; k < max_influences; ++k) {
      sum += v.weights[k];
      least = std::min(least, v.weights[k]);
      if (v.weights[k] > lead) used.insert(v.joints[k]);
    }
    off = std::max(off, std::abs(sum - 1));
  }
  CHECK(off < 1e-12);
  CHECK(least >= 0);
  CHECK(used.size() == c.skeleton.joints.size());
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
    check_skin(c, 0.4);
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

TEST_CASE("pieces of game characters share no vertex and make up the whole mesh") {
  for (const Character& c : game_characters()) {
    CAPTURE(c.name);
    CHECK(c.pieces.size() >= 1);
    CHECK(c.pieces.size() <= 60);
    size_t triangle = 0;
    int vertex = 0;
    bool inside = true;
    for (const Piece& piece : c.pieces) {
      CHECK(piece.triangles > 0);
      for (int t = 0; t < piece.triangles; ++t, ++triangle)
        for (int v : c.rest.triangles.at(triangle)) inside &= v >= vertex && v < vertex + piece.vertices;
      vertex += piece.vertices;
    }
    CHECK(inside);
    CHECK(triangle == c.rest.triangles.size());
    CHECK(static_cast<size_t>(vertex) == c.rest.positions.size());
    CHECK(c.posed.size() == c.rest.positions.size());
  }
}

TEST_CASE("skins of game characters are convex, use every joint, and leave eyes on the head alone") {
  for (const Character& c : game_characters()) {
    CAPTURE(c.name);
    check_skin(c, 0.3);
    size_t vertex = 0;
    for (const Piece& piece : c.pieces) {
      if (piece.name.starts_with("eye"))
        for (int v = 0; v < piece.vertices; ++v) {
          const Influences& eye = c.skin[vertex + static_cast<size_t>(v)];
          CHECK(c.skeleton.joints[eye.joints[0]].name == "head");
          CHECK(eye.weights[0] == 1);
        }
      vertex += static_cast<size_t>(piece.vertices);
    }
  }
}

TEST_CASE("game characters stand on the ground, hold their joints, and look forward") {
  for (const Character& c : game_characters()) {
    CAPTURE(c.name);
    Eigen::AlignedBox3d box;
    for (const Vec3& p : c.rest.positions) box.extend(p);
    CHECK(box.min().allFinite());
    CHECK(box.max().allFinite());
    CHECK(box.min().y() == doctest::Approx(0));
    for (size_t j = 0; j < c.skeleton.joints.size(); ++j) {
      const Joint& joint = c.skeleton.joints[j];
      CAPTURE(joint.name);
      CHECK(box.exteriorDistance(joint.rest) < 0.01 * box.diagonal().norm());
      if (joint.name.starts_with("left")) CHECK(joint.rest.x() > 0);
      CHECK((mirrored(joint.rest) - c.skeleton.joints[c.skeleton.mirror[j]].rest).norm() < 1e-12);
      if (joint.name == "leftToes") CHECK(joint.tip.z() > joint.rest.z());
    }
    CHECK(c.landmarks.size() >= 16);
  }
}

TEST_CASE("game humanoids have heads from small to large and arms from level to hanging") {
  double small_head = 1, large_head = 0, high = -1, low = 1;
  for (int i = 0; i < game_seeds; ++i) {
    const Skeleton& s = game_characters()[static_cast<size_t>(i)].skeleton;
    const auto named = [&](const char* name) {
      for (const Joint& joint : s.joints)
        if (joint.name == name) return joint;
      FAIL("no joint " << name);
      return Joint();
    };
    const Joint head = named("head"), arm = named("leftUpperArm");
    const double share = (head.tip - head.rest).norm() / head.tip.y();
    const double rise = (arm.tip - arm.rest).normalized().y();
    small_head = std::min(small_head, share), large_head = std::max(large_head, share);
    high = std::max(high, rise), low = std::min(low, rise);
    CHECK(s.joints.size() == 22);
  }
  CHECK(small_head < 0.16);
  CHECK(large_head > 0.28);
  CHECK(high > -0.15);
  CHECK(low < -0.7);
}

TEST_CASE("a game character's files are the same again, with a mesh for each piece") {
  const auto folder = std::filesystem::temp_directory_path() / "focal_game_creatures_test";
  for (size_t f = 0; f < game_families().size(); ++f) {
    const Character& one = game_characters()[f * game_seeds];
    const Character again = make_character(game_families()[f], one.name, 1);
    write_character(one, folder / "one");
    write_character(again, folder / "again");
    for (const char* ending : {".glb", ".rig.glb", ".joints.json", ".landmarks.json"})
      CHECK(bytes(folder / "one" / (one.name + ending)) == bytes(folder / "again" / (one.name + ending)));
    const std::string rig = bytes(folder / "one" / (one.name + ".rig.glb"));
    size_t skins = 0;
    for (size_t at = rig.find("\"WEIGHTS_0\""); at != std::string::npos;
         at = rig.find("\"WEIGHTS_0\"", at + 1))
      ++skins;
    CHECK(skins == one.pieces.size());
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
