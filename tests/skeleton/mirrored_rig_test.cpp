// Rigs of bodies that stand alike on both sides: mirror images to the bit.
#include "skeleton/mirrored_rig.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <random>

using namespace focal;

namespace {

// Pairs of vertices about the plane, some in it, and a lopsided rig for them: joints that lie up to 0.02 off, random weights.
struct Lopsided {
  explicit Lopsided(const MirrorPlane& plane, int pairs = 200, uint32_t seed = 1) : random(seed) {
    const Vector3 up = plane.normal.unitOrthogonal();
    const auto in_plane = [&](Vector3 p) -> Vector3 {
      return p - (plane.normal.dot(p) - plane.offset) * plane.normal;
    };
    mesh.positions.resize(2 * pairs + 20, 3);
    for (int i = 0; i < pairs; ++i) {
      const Vector3 p = in_plane(any()) + (0.1 + std::abs(number())) * plane.normal;
      mesh.positions.row(2 * i) = p.cast<float>().cast<double>();
      mesh.positions.row(2 * i + 1) = plane(p).cast<float>().cast<double>();
    }
    for (int i = 2 * pairs; i < mesh.positions.rows(); ++i) mesh.positions.row(i) = in_plane(any());
    add("hips", -1, in_plane(0.2 * any()));
    add("spine", 0, in_plane(0.2 * any() + 0.3 * up));
    for (const char* name : {"arm", "leg"}) {
      const Vector3 left = in_plane(any()) + 0.4 * plane.normal;
      add(std::string("left_") + name, 1, left + 0.01 * any());
      add(std::string("right_") + name, 1, plane(left) + 0.01 * any());
    }
    character.rig.influences.resize(static_cast<size_t>(mesh.positions.rows()));
    for (VertexInfluences& one : character.rig.influences) {
      std::vector<Influence> all;
      for (int32_t j = 0; j < 6; ++j) all.push_back({j, static_cast<float>(std::abs(number()))});
      one = heaviest(all);
    }
  }

  void add(const std::string& name, int32_t parent, const Vector3& place) {
    Joint joint{name, parent};
    joint.bind.topLeftCorner<3, 3>() =
        Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), Vector3::UnitX() + 0.2 * any())
            .toRotationMatrix();
    joint.bind.topRightCorner<3, 1>() = place;
    character.rig.joints.push_back(joint);
    character.tip.push_back(place + 0.1 * any());
    character.confidence.push_back(0.5 + 0.4 * number());
  }
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vector3 any() { return {number(), number(), number()}; }

  std::mt19937 random;
  TriangleMesh mesh;
  CharacterRig character;
};

std::vector<float> row_of(const VertexInfluences& influences) {
  std::vector<float> row(6, 0);
  for (const Influence& one : influences) row[one.joint] += one.weight;
  return row;
}

constexpr int32_t other_of[] = {0, 1, 3, 2, 5, 4};

}  // namespace

TEST_CASE("joints and weights of both sides become mirror images to the bit") {
  Lopsided body{{Vector3::UnitX(), 0}};
  const Lopsided before{{Vector3::UnitX(), 0}};
  make_symmetric(body.mesh, {}, body.character);
  CHECK(body.character.warnings.empty());
  const auto& joints = body.character.rig.joints;
  for (const int left : {2, 4}) {
    const Vector3 one = place_of(joints[left]), other = place_of(joints[left + 1]);
    CHECK(one == Vector3(-other[0], other[1], other[2]));
    CHECK((one - place_of(before.character.rig.joints[left])).norm() < 0.03);
    CHECK(body.character.tip[left] == Vector3(-body.character.tip[left + 1][0],
                                              body.character.tip[left + 1][1],
                                              body.character.tip[left + 1][2]));
    const Matrix3 turn = joints[left].bind.topLeftCorner<3, 3>(),
                  image = joints[left + 1].bind.topLeftCorner<3, 3>();
    CHECK(turn.determinant() == doctest::Approx(1));
    CHECK(image.determinant() == doctest::Approx(1));
    const Matrix3 mirror = Vector3(-1, 1, 1).asDiagonal();
    CHECK((turn - mirror * image * mirror).norm() < 1e-12);
  }
  for (const int middle : {0, 1}) CHECK(place_of(joints[middle])[0] == 0);
  const auto& influences = body.character.rig.influences;
  for (size_t v = 0; v + 20 < influences.size(); v += 2)
    for (size_t j = 0; j < 6; ++j) CHECK(row_of(influences[v])[j] == row_of(influences[v + 1])[other_of[j]]);
  for (size_t v = influences.size() - 20; v < influences.size(); ++v) {
    const std::vector<float> row = row_of(influences[v]);
    float sum = 0;
    for (size_t j = 0; j < 6; ++j) {
      sum += row[j];
      CHECK(row[j] == doctest::Approx(row[other_of[j]]).epsilon(1e-6));
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("the plane is found where the body is turned and stands elsewhere") {
  const MirrorPlane truth{Vector3(2, 0.3, -1).normalized(), 3.5};
  Lopsided body(truth);
  const MirroredVertices found =
      mirrored_vertices(body.mesh.positions, {Vector3(2, 0.35, -0.95).normalized(), 3.48});
  CHECK(found.share == 1);
  CHECK(std::abs(found.plane.normal.dot(truth.normal)) == doctest::Approx(1).epsilon(1e-9));
  make_symmetric(body.mesh, {}, body.character);
  const auto& joints = body.character.rig.joints;
  for (const int left : {2, 4})
    CHECK((place_of(joints[left]) - truth(place_of(joints[left + 1]))).norm() < 1e-5);
}

TEST_CASE("a fixed joint stays to the bit, the other side follows it") {
  Lopsided body{{Vector3::UnitX(), 0}};
  FixedJoints fixed(6);
  fixed[3] = place_of(body.character.rig.joints[3]);
  make_symmetric(body.mesh, fixed, body.character);
  const auto& joints = body.character.rig.joints;
  CHECK(place_of(joints[3]) == *fixed[3]);
  CHECK(place_of(joints[2]) == Vector3(-(*fixed[3])[0], (*fixed[3])[1], (*fixed[3])[2]));
}

TEST_CASE("a body that does not stand alike on both sides gets bones of the same lengths, and a warning") {
  Lopsided body{{Vector3::UnitX(), 0}};
  for (int v = 0; v < body.mesh.positions.rows(); v += 2)
    body.mesh.positions.row(v) += 0.2 * body.any().transpose();
  const auto before = body.character.rig.influences;
  make_symmetric(body.mesh, {}, body.character);
  REQUIRE(body.character.warnings.size() == 1);
  CHECK(body.character.warnings[0].find("is not symmetric") != std::string::npos);
  for (size_t v = 0; v < before.size(); ++v)
    CHECK(row_of(before[v]) == row_of(body.character.rig.influences[v]));
  const auto& joints = body.character.rig.joints;
  const auto length = [&](int j) { return (place_of(joints[j]) - place_of(joints[1])).norm(); };
  CHECK(length(2) == doctest::Approx(length(3)));
}

TEST_CASE("a rest pose becomes alike on both sides, too") {
  Lopsided body{{Vector3::UnitX(), 0}};
  for (const Joint& joint : body.character.rig.joints) body.character.rest.push_back(joint.bind);
  make_rest_symmetric(body.character);
  const auto& rest = body.character.rest;
  Vector3 between[2];
  for (const int i : {0, 1}) {
    const Vector3 left = rest[2 + 2 * i].topRightCorner<3, 1>(),
                  right = rest[3 + 2 * i].topRightCorner<3, 1>();
    between[i] = (left - right).normalized();
  }
  CHECK(std::abs(between[0].dot(between[1])) == doctest::Approx(1).epsilon(1e-9));
}
