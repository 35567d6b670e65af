// Grounds, shapes around the character and props apart are found; what belongs to a character never is.
#include "mesh/scenery.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "evaluation_data.h"
#include "gltf/one_call.h"
#include "mesh/prepare.h"
#include "sample_humanoid.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

TriangleMesh placed(TriangleMesh mesh, const Vector3& size, const Vector3& centre) {
  mesh.positions = mesh.positions * size.asDiagonal();
  mesh.positions.rowwise() += centre.transpose();
  return mesh;
}

TriangleMesh coarse_ball(double radius, const Vector3& centre, int levels = 2) {
  return placed(sphere(levels), Vector3::Constant(radius), centre);
}

// Across y; the sheet is square() from z turned to y.
TriangleMesh ground(double half_size, const Vector3& centre, int half = 1) {
  TriangleMesh mesh = square(half);
  mesh.positions.col(1).swap(mesh.positions.col(2));
  return placed(std::move(mesh), Vector3::Constant(half_size), centre);
}

TriangleMesh box(const Vector3& half_size, const Vector3& centre) {
  TriangleMesh mesh;
  mesh.positions.resize(8, 3), mesh.triangles.resize(12, 3);
  for (int v = 0; v < 8; ++v) mesh.positions.row(v) << (v & 1) - 0.5, (v >> 1 & 1) - 0.5, (v >> 2) - 0.5;
  mesh.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
      1, 3, 5, 3, 7, 5;
  return placed(std::move(mesh), 2 * half_size, centre);
}

class Scene {
 public:
  Scene& add(const std::string& name, const TriangleMesh& thing, bool is_character = false) {
    const int32_t vertices = mesh_.vertex_count(), triangles = mesh_.triangle_count();
    pieces_.push_back({name, triangles, thing.triangle_count(), is_character});
    mesh_.positions.conservativeResize(vertices + thing.vertex_count(), 3);
    mesh_.triangles.conservativeResize(triangles + thing.triangle_count(), 3);
    mesh_.positions.bottomRows(thing.vertex_count()) = thing.positions;
    mesh_.triangles.bottomRows(thing.triangle_count()) = thing.triangles.array() + vertices;
    return *this;
  }
  // As one mesh, without pieces.
  Scene& join() { return pieces_.clear(), *this; }
  Scene& scale(double factor) { return mesh_.positions *= factor, *this; }
  // y becomes z.
  Scene& turn() {
    const MatrixX3 before = mesh_.positions;
    mesh_.positions.col(1) = -before.col(2), mesh_.positions.col(2) = before.col(1);
    return *this;
  }

  PreparedMesh prepared() const { return prepare(mesh_, {.leave_out_scenery = true, .pieces = pieces_}); }
  // "Ground sheet; Orb apart": what is left out, and with * where the piece is left out in part.
  std::string left_out() const {
    std::string result;
    for (const Scenery& one : prepared().scenery) {
      constexpr const char* kinds[] = {"", " sheet", " enclosure", " apart"};
      result += (result.empty() ? "" : "; ") + (pieces_.empty() ? "" : pieces_[one.piece].name) +
                kinds[static_cast<int>(one.kind)] + (one.whole_piece ? "" : "*");
    }
    return result;
  }

 private:
  TriangleMesh mesh_;
  std::vector<MeshPiece> pieces_;
};

const TriangleMesh& body() {
  static const TriangleMesh one = [] {
    const auto character = humanoid(12);
    return mesh_at(character.rest.positions, character);
  }();
  return one;
}

struct Extent {
  Vector3 low = body().positions.colwise().minCoeff(), high = body().positions.colwise().maxCoeff();
  Vector3 centre = (low + high) / 2, feet = Vector3(centre.x(), low.y(), centre.z());
  double height = high.y() - low.y(), width = high.x() - low.x(), diagonal = (high - low).norm();
};

Scene with_body() { return Scene().add("Body", body()); }

// The triangles of the body with all corners on one side of a plane.
TriangleMesh part_of_body(const Vector3& normal, double offset) {
  std::vector<Eigen::RowVector3i> kept;
  for (int32_t t = 0; t < body().triangle_count(); ++t) {
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside &= body().positions.row(body().triangles(t, i)).dot(normal) > offset;
    if (inside) kept.push_back(body().triangles.row(t));
  }
  TriangleMesh part{body().positions, MatrixX3i(static_cast<Eigen::Index>(kept.size()), 3)};
  for (size_t t = 0; t < kept.size(); ++t) part.triangles.row(static_cast<Eigen::Index>(t)) = kept[t];
  return part;
}

}  // namespace

TEST_CASE("a single part is never touched") {
  CHECK(with_body().left_out() == "");
  CHECK(Scene().add("Plate", square(4)).left_out() == "");
}

TEST_CASE("a ground is left out, of any size and cut") {
  const Extent e;
  for (const double half_size : {0.8 * e.width, 2 * e.width, 50 * e.width}) {
    CAPTURE(half_size);
    CHECK(with_body().add("Ground", ground(half_size, e.feet)).left_out() == "Ground sheet");
  }
  CHECK(with_body().add("Ground", ground(3 * e.width, e.feet, 20)).left_out() == "Ground sheet");
  CHECK(with_body().add("Slab", box({2 * e.width, 0.03, 2 * e.width}, e.feet)).left_out() == "Slab sheet");
  CHECK(with_body().add("Ground", ground(2 * e.width, e.feet)).turn().left_out() == "Ground sheet");
  for (const double factor : {1e-20, 1e20})
    CHECK(with_body().add("Ground", ground(2 * e.width, e.feet)).scale(factor).left_out() == "Ground sheet");
}

TEST_CASE("of a mesh without pieces, and of one piece, single parts are left out") {
  const Extent e;
  const auto scene = [&] { return with_body().add("Ground", ground(2 * e.width, e.feet)); };
  const PreparedMesh joined = scene().join().prepared();
  REQUIRE(joined.scenery.size() == 1);
  CHECK_FALSE(joined.scenery[0].whole_piece);
  CHECK(joined.components == 1);
  CHECK(joined.surface.triangle_count() == body().triangle_count());
  CHECK(joined.scenery_triangles == 8);
  CHECK(degenerate_triangles(joined) == 0);
  CHECK(joined.surface_vertex.back() == -1);
  CHECK(joined.surface_triangle.back() == -1);
  CHECK_FALSE(joined.is_wrapped);
}

TEST_CASE("the analysis is that of the character alone, in the numbers of the whole") {
  const Extent e;
  const PreparedMesh alone = prepare(body());
  const PreparedMesh scene =
      Scene().add("Ground", ground(2 * e.width, e.feet)).add("Body", body()).prepared();
  CHECK(scene.surface.positions == alone.surface.positions);
  CHECK(scene.scale == alone.scale);
  CHECK(scene.source.vertex_count() == body().vertex_count() + 9);
  CHECK(scene.source_triangle[0] == 8);
  CHECK(analysed_positions(scene) == alone.source.positions);
  REQUIRE(scene.warnings.size() == 1);
  CHECK(scene.warnings[0].starts_with("left out of the analysis: Ground, a flat sheet"));
  CHECK(prepare(scene.source).components == 2);  // unless it is asked for, nothing is left out
}

TEST_CASE("a backdrop, and a room of several sheets") {
  const Extent e;
  const double d = e.diagonal;
  const TriangleMesh wall = placed(square(1), {3 * d, 3 * d, 1}, e.centre - Vector3(0, 0, d));
  CHECK(with_body().add("Wall", wall).left_out() == "Wall sheet");
  CHECK(with_body().add("Wall", wall).add("Floor", ground(2 * d, e.feet)).left_out() ==
        "Wall sheet; Floor sheet");
}

TEST_CASE("a shape that contains the character is left out") {
  const Extent e;
  const double d = e.diagonal;
  CHECK(with_body().add("Bounds", coarse_ball(0.6 * d, e.centre)).left_out() == "Bounds enclosure");
  CHECK(with_body().add("Sky", coarse_ball(40 * d, e.centre, 5)).left_out() == "Sky enclosure");
  CHECK(with_body().add("Box", box(0.51 * (e.high - e.low), e.centre)).left_out() == "Box enclosure");
  const Vector3 torso(0.25 * e.width, 0.4 * e.height, 0.3);  // hands and feet reach out of it
  CHECK(with_body().add("Collider", box(torso, e.centre)).left_out() == "Collider enclosure");
  CHECK(with_body().add("Sky", coarse_ball(9 * d, e.feet)).add("Ground", ground(5 * d, e.feet)).left_out() ==
        "Sky enclosure; Ground sheet");
}

TEST_CASE("what stands apart is left out, on a ground too") {
  const Extent e;
  const Vector3 far = e.centre + Vector3(2.5 * e.diagonal, 0, 0);
  CHECK(with_body().add("Icosphere", coarse_ball(0.2, far)).left_out() == "Icosphere apart");
  CHECK(with_body().add("Icosphere", coarse_ball(0.2, far)).add("Ground", ground(2, e.feet)).left_out() ==
        "Icosphere apart; Ground sheet");
  const Vector3 beside(e.high.x() + 0.6 * e.diagonal, e.centre.y(), e.centre.z());
  CHECK(with_body().add("Icosphere", coarse_ball(0.1, beside)).left_out() == "Icosphere apart");
}

TEST_CASE("clothes, weapons and what floats near the character stay") {
  const Extent e;
  const Vector3 back = e.centre - Vector3(0, 0, 0.2), hand(e.low.x(), e.centre.y(), e.centre.z());
  const auto stays = [&](const char* what, const TriangleMesh& thing) {
    CAPTURE(what);
    CHECK(with_body().add(what, thing).left_out() == "");
  };
  stays("cape", placed(square(4), {0.35 * e.width, 0.4 * e.height, 1}, back));
  stays("large wings", placed(square(1), {0.9 * e.width, 0.55 * e.height, 1}, back));
  stays("flag", placed(square(1), {1.3, 1.3, 1}, {e.low.x() - 1.3, e.centre.y(), e.low.z() - 0.1}));
  stays("fin through the body", placed(square(1), {3, 3, 1}, e.centre));
  stays("shield", placed(sphere(3), {0.4, 0.4, 0.02}, hand));
  stays("sword", box({0.02, 0.7, 0.02}, hand));
  stays("sombrero", ground(0.9 * e.width, {e.centre.x(), e.high.y() - 0.1, e.centre.z()}, 8));
  stays("base below the feet", ground(0.25, e.feet));
  stays("orb", coarse_ball(0.1, {e.high.x() + 0.25 * e.height, e.high.y(), e.centre.z()}));
  stays("eye", coarse_ball(0.02, {e.centre.x(), 0.93 * e.high.y(), e.centre.z()}, 4));
  stays("helmet", coarse_ball(0.15, {e.centre.x(), 0.93 * e.high.y(), e.centre.z()}));
  stays("skirt", placed(sphere(3), {0.3, 0.3, 0.3}, e.centre - Vector3(0, 0.2, 0)));
  stays("robe", placed(body(), {1.05, 1.01, 1.05}, Vector3(0, -0.001, 0)));
  stays("twin of the same size", placed(body(), {1, 1, 1}, {4 * e.diagonal, 0, 0}));
}

TEST_CASE("a character in pieces keeps all of them") {
  const Extent e;
  Scene floating;  // arms cut off at the elbows, and moved away
  const double elbow = 0.3 * e.width;
  TriangleMesh right = part_of_body(Vector3::UnitX(), e.centre.x() + elbow);
  TriangleMesh left = part_of_body(-Vector3::UnitX(), -e.centre.x() + elbow);
  REQUIRE(right.triangle_count() > 50);
  right.positions.col(0).array() += 0.25 * e.height, left.positions.col(0).array() -= 0.25 * e.height;
  TriangleMesh middle = part_of_body(Vector3::UnitX(), e.centre.x() - elbow);
  floating.add("Torso", middle).add("HandR", right).add("HandL", left);
  CHECK(floating.left_out() == "");
  CHECK(Scene()
            .add("Torso", coarse_ball(0.4, {0, 1, 0}, 3))
            .add("HandR", coarse_ball(0.1, {1.2, 1, 0}))
            .add("HandL", coarse_ball(0.1, {-1.2, 1, 0}))
            .left_out() == "");
}

TEST_CASE("round bodies and flat ones are bodies") {
  const Scene round = Scene()
                          .add("Body", coarse_ball(1, {0, 0, 0}, 3))
                          .add("EyeR", coarse_ball(0.2, {0.4, 0.3, 0.85}, 4))
                          .add("EyeL", coarse_ball(0.2, {-0.4, 0.3, 0.85}, 4))
                          .add("FootR", coarse_ball(0.3, {0.5, -0.85, 0.1}, 3))
                          .add("FootL", coarse_ball(0.3, {-0.5, -0.85, 0.1}, 3));
  CHECK(round.left_out() == "");
  const Scene slime = Scene()
                          .add("Slime", coarse_ball(1, {0, 0, 0}, 3))
                          .add("Core", coarse_ball(0.4, {0, 0, 0}, 4))
                          .add("EyeR", coarse_ball(0.1, {0.3, 0.3, 0.7}, 3))
                          .add("EyeL", coarse_ball(0.1, {-0.3, 0.3, 0.7}, 3));
  CHECK(slime.left_out() == "");
  const Scene paper = Scene()
                          .add("Card", square(5))
                          .add("EyeR", placed(square(2), {0.1, 0.1, 1}, {0.3, 0.4, 0.01}))
                          .add("EyeL", placed(square(2), {0.1, 0.1, 1}, {-0.3, 0.4, 0.01}));
  CHECK(paper.left_out() == "");
}

TEST_CASE("what is stuck into a round body does not make a dome of it") {
  const auto figure = [](const Vector3& at) {
    const Extent e;
    return placed(placed(body(), Vector3::Ones(), -e.centre), Vector3::Constant(0.25), at);
  };
  CHECK(Scene().add("Ball", coarse_ball(1, {0, 0, 0})).add("Badge", figure({0, 0, 0.97})).left_out() == "");
  Scene studs;
  studs.add("Ball", coarse_ball(1, {0, 0, 0}));
  for (const double side : {-0.8, 0.8})
    studs.add("Stud", figure({side, 0, 0}))
        .add("Stud", figure({0, side, 0}))
        .add("Stud", figure({0, 0, side}));
  CHECK(studs.left_out() == "");
}

TEST_CASE("what has a skin stays, and shows what the character is") {
  const Extent e;
  CHECK(Scene().add("Body", body(), true).add("Ground", ground(2, e.feet), true).left_out() == "");
  const Vector3 far = e.centre + Vector3(4 * e.diagonal, 0, 0);
  const TriangleMesh large = coarse_ball(0.5, far, 6);  // with more vertices than the body, but convex
  CHECK(with_body().add("Prop", large).left_out() == "Prop apart");
  CHECK(Scene().add("Body", body(), true).add("Prop", large).left_out() == "Prop apart");
  CHECK(Scene().add("Body", body(), true).add("Prop", large, true).left_out() == "");
}

TEST_CASE("the cases of a ground and of a hidden collider") {
  const char* data = std::getenv("FOCAL_EVALUATION_DATA");
  const auto folder = std::filesystem::path(data ? data : "") / ".." / "cases";
  if (!std::filesystem::exists(folder / "26_ground")) {
    std::cout << "skipped: no cases beside FOCAL_EVALUATION_DATA\n";
    return;
  }
  const GltfMesh statue = read_gltf(folder / "26_ground" / "statue.glb");
  const PreparedMesh prepared = prepare(statue.mesh, {.leave_out_scenery = true, .pieces = statue.pieces});
  REQUIRE(prepared.scenery.size() == 1);
  CHECK(describe(prepared.scenery[0], statue.pieces).starts_with("node 'Ground'"));
  const GltfMesh godot = read_gltf(folder / "06_hidden_collider" / "godot.glb");
  CHECK(godot.hidden == std::vector<std::string>{"node 'CharacterCollider'"});
  CHECK(godot.mesh.vertex_count() == 5184);
}
