// Bodies whose hands are far too small for the proxy: sample hands on a large trunk.
#include "skeleton/detail_rig.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/archive.h"
#include "base/error.h"
#include "model/model_file.h"
#include "model/sections.h"
#include "skeleton/detail_region.h"
#include "skeleton/detail_training.h"
#include "skeleton/rig_transfer.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

creatures::Character hand(uint64_t seed) {
  const auto& families = creatures::families();
  const auto family =
      std::find_if(families.begin(), families.end(), [](const auto& f) { return f.name == "hand"; });
  return creatures::make_character(*family, "hand", seed);
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const Eigen::Index vertices = mesh.positions.rows(), triangles = mesh.triangles.rows();
  mesh.positions.conservativeResize(vertices + more.positions.rows(), 3);
  mesh.positions.bottomRows(more.positions.rows()) = more.positions;
  mesh.triangles.conservativeResize(triangles + more.triangles.rows(), 3);
  mesh.triangles.bottomRows(more.triangles.rows()) = more.triangles.array() + static_cast<int32_t>(vertices);
}

// Of rings of vertices round the y axis.
TriangleMesh ellipsoid(const Vector3& centre, const Vector3& radii, int32_t rings) {
  const int32_t around = 2 * rings;
  TriangleMesh mesh;
  mesh.positions.resize(Eigen::Index{rings + 1} * around, 3);
  mesh.triangles.resize(Eigen::Index{2} * rings * around, 3);
  for (int32_t r = 0; r <= rings; ++r)
    for (int32_t a = 0; a < around; ++a) {
      const double down = EIGEN_PI * (r + 0.02) / (rings + 0.04), turn = 2 * EIGEN_PI * a / around;
      const Vector3 way(std::sin(down) * std::sin(turn), std::cos(down), std::sin(down) * std::cos(turn));
      mesh.positions.row(r * around + a) = centre + radii.cwiseProduct(way);
      if (r == rings) continue;
      const int32_t here = r * around + a, next = r * around + (a + 1) % around;
      mesh.triangles.row(2 * here) << here, here + around, next;
      mesh.triangles.row(2 * here + 1) << next, here + around, next + around;
    }
  return mesh;
}

TriangleMesh trunk() {
  TriangleMesh mesh = ellipsoid({0, -4.2, 0}, {3.4, 3.8, 2.2}, 24);
  append(mesh,
         ellipsoid({1.5, -3.2, 2.2}, {0.9, 0.9, 0.9}, 12));  // so that front and back, left and right differ
  return mesh;
}

RiggedMesh body(uint64_t seed) {
  const creatures::Character from = hand(seed);
  const RiggedMesh part = rigged(from);
  TriangleMesh mesh = part.mesh->source;
  mesh.positions *= 10;  // in the decimetres of its design
  append(mesh, trunk());
  RiggedMesh result;
  result.rig.joints.push_back({"trunk", -1, Matrix4::Identity()});
  result.rig.joints[0].bind.topRightCorner<3, 1>() = Vector3(0, -4.2, 0);
  for (Joint joint : part.rig.joints) {
    ++joint.parent, joint.bind.topRightCorner<3, 1>() *= 10;
    result.rig.joints.push_back(std::move(joint));
  }
  for (VertexInfluences influences : part.rig.influences) {
    for (Influence& one : influences) ++one.joint;
    result.rig.influences.push_back(influences);
  }
  result.rig.influences.resize(static_cast<size_t>(mesh.vertex_count()), VertexInfluences{Influence{0, 1}});
  result.mesh = std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
  return result;
}

std::shared_ptr<const PreparedMesh> mitten() {
  TriangleMesh mesh = trunk();
  append(mesh, ellipsoid({0, -0.5, 0}, {0.28, 0.9, 0.22}, 12));
  append(mesh, ellipsoid({0, 0.9, 0}, {0.42, 0.95, 0.17}, 16));
  return std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
}

const std::vector<RiggedMesh>& teachers() {
  static const std::vector<RiggedMesh> all = {body(1), body(2), body(3)};
  return all;
}

std::shared_ptr<const LandmarkModel> model_without() {
  static const auto one = std::make_shared<const LandmarkModel>(
      train(training_set_of(teachers(), {.shapes = 6, .landmarks = 24}), small(), execution));
  return one;
}

std::shared_ptr<const LandmarkModel> model_with() {
  static const auto one = [] {
    auto model = std::make_shared<LandmarkModel>(*model_without());
    model->details = learn_details(teachers(), model->skeleton, 0, execution);
    return std::shared_ptr<const LandmarkModel>(model);
  }();
  return one;
}

CharacterRig rig_of(const std::shared_ptr<const LandmarkModel>& model,
                    const std::shared_ptr<const PreparedMesh>& mesh) {
  return transfer_rig(detect(model, mesh, {}, execution), execution);
}

bool is_finger(const std::string& name) {
  return name != "trunk" && name != "rightLowerArm" && name != "rightHand";
}

// Mean over the joints of the fingers, of the mesh's longest side.
double finger_error(const CharacterRig& found, const RiggedMesh& truth) {
  double sum = 0, count = 0;
  for (const Joint& joint : found.rig.joints)
    for (const Joint& real : truth.rig.joints)
      if (joint.name == real.name && is_finger(joint.name))
        sum += (joint.bind.topRightCorner<3, 1>() - real.bind.topRightCorner<3, 1>()).norm(), ++count;
  const MatrixX3& positions = truth.mesh->source.positions;
  return sum / count / (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff();
}

}  // namespace

TEST_CASE("a hand on a body is worth a second look, a hand by itself is not") {
  const auto found = [](const RiggedMesh& character) {
    std::vector<SkeletonJoint> skeleton;
    for (const Joint& joint : character.rig.joints) skeleton.push_back({joint.name, joint.parent});
    std::vector<std::string> names;
    for (const int32_t joint : detail_joints(skeleton, {{&character.rig, character.mesh->scale}}))
      names.push_back(skeleton[joint].name);
    return names;
  };
  CHECK(found(body(1)) == std::vector<std::string>{"rightHand"});
  CHECK(found(rigged(hand(1))).empty());
}

TEST_CASE("a part is cut out of the triangles and knows its vertices") {
  const RiggedMesh character = body(1);
  const TriangleMesh& mesh = character.mesh->source;
  std::vector<char> is_of_part(character.rig.joints.size(), 1);
  is_of_part[0] = 0;  // the trunk
  Similarity frame;
  frame.scale = 2, frame.offset = Vector3(0.1, -0.2, 0.3);
  frame.rotation = Eigen::AngleAxisd(0.3, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const DetailRegion region = cut_region(mesh, character.rig.influences, is_of_part, frame, -0.05);
  REQUIRE(region.mesh.vertex_count() > 500);
  REQUIRE(region.influences.size() == static_cast<size_t>(region.mesh.vertex_count()));
  int32_t cut = 0;
  for (int32_t v = 0; v < region.mesh.vertex_count(); ++v) {
    const Vector3 place = region.mesh.positions.row(v);
    CHECK(place.y() >= -0.05 - 1e-9);
    const int32_t source = region.source_vertex[v];
    cut += source < 0;
    CHECK(is_of_part[region.influences[v][0].joint]);
    if (source < 0) CHECK(place.y() == doctest::Approx(-0.05));
    if (source >= 0) CHECK((frame(place) - mesh.positions.row(source).transpose()).norm() < 1e-9);
  }
  CHECK(cut > 10);
  // Nothing above the plane is missing.
  int32_t kept = 0;
  for (int32_t v = 0; v < static_cast<int32_t>(character.rig.influences.size()); ++v) {
    const Vector3 place = frame.rotation.transpose() * (mesh.positions.row(v).transpose() - frame.offset) / 2;
    kept += is_of_part[character.rig.influences[v][0].joint] && place.y() > 0;
  }
  CHECK(region.mesh.vertex_count() - cut >= kept);
}

TEST_CASE(
    "fingers too small for the body's proxy are found by the second look, before a model is saved and "
    "after") {
  REQUIRE(model_with()->details.size() == 1);
  const DetailModel& detail = model_with()->details[0];
  CHECK(model_with()->skeleton[detail.joint].name == "rightHand");
  const RiggedMesh target = body(11);
  const CharacterRig before = rig_of(model_without(), target.mesh), after = rig_of(model_with(), target.mesh);
  MESSAGE("error of the fingers, before and after: ", finger_error(before, target), " ",
          finger_error(after, target));
  CHECK(after.left_out.empty());
  CHECK(finger_error(after, target) < 0.5 * finger_error(before, target));
  CHECK(finger_error(after, target) < 0.01);
  for (const VertexInfluences& influences : after.rig.influences) {
    float sum = 0;
    for (const Influence& one : influences) sum += one.weight;
    CHECK(sum == doctest::Approx(1).epsilon(1e-5));
  }
  const auto file = serialise(*model_with());
  const auto read = std::make_shared<const LandmarkModel>(parse_model(file));
  REQUIRE(read->details.size() == 1);
  CHECK(read->details[0].joints == detail.joints);
  CHECK(serialise(*read) == file);
  const CharacterRig again = rig_of(read, target.mesh);
  for (size_t j = 0; j < after.rig.joints.size(); ++j)
    CHECK((after.rig.joints[j].bind - again.rig.joints[j].bind).norm() < 1e-3);
}

TEST_CASE("a mitten gets no joints of fingers that move it") {
  const CharacterRig found = rig_of(model_with(), mitten());
  REQUIRE(found.left_out.size() == found.rig.joints.size());
  for (size_t j = 0; j < found.left_out.size(); ++j)
    CHECK(static_cast<bool>(found.left_out[j]) == is_finger(found.rig.joints[j].name));
  for (const VertexInfluences& influences : found.rig.influences)
    for (const Influence& one : influences)
      if (one.weight > 0) CHECK_FALSE(is_finger(found.rig.joints[one.joint].name));
  CHECK(std::any_of(found.warnings.begin(), found.warnings.end(), [](const std::string& text) {
    return text.find("beyond 'rightHand'") != std::string::npos;
  }));
}

TEST_CASE("a section of parts that contradicts its model is refused") {
  const auto read = [](const LandmarkModel& model) {
    ByteWriter out;
    write_details(model, out);
    LandmarkModel result;
    result.skeleton = model_with()->skeleton;
    const std::vector<std::byte> bytes = out.take();
    read_details(ByteReader(bytes, "parts"), result);
  };
  LandmarkModel model = *model_with();
  CHECK_NOTHROW(read(model));
  DetailModel& detail = model.details[0];
  const DetailModel good = detail;
  detail.joints[0] = 1000;
  CHECK_THROWS_AS(read(model), Error);
  detail = good, detail.joints.pop_back(), detail.reference.pop_back();
  CHECK_THROWS_AS(read(model), Error);
  detail = good, detail.joint = 0;  // the trunk, which is not of the part
  CHECK_THROWS_AS(read(model), Error);
  detail = good;
  auto deep = std::make_shared<LandmarkModel>(*good.model);  // a part with parts
  deep->details = {good}, detail.model = deep;
  CHECK_THROWS_AS(read(model), Error);
}
