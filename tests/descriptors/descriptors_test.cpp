// HKS, WKS, spin image and unique shape context against what is known of spheres and planes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "descriptors/descriptor.h"
#include "descriptors/local_support.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace focal {
DescriptorKind centre_distance_descriptor();  // the example of CONTRIBUTING.md
}

namespace {

using std::numbers::pi;
constexpr double reference_area = 2e4;  // to which the times of HKS belong

std::vector<int32_t> all_of(Eigen::Index n) {
  std::vector<int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

const DescriptorKind& kind_of(std::string_view name) {
  const auto kinds = descriptor_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.name == name; });
  REQUIRE(found != kinds.end());
  return *found;
}

// A mesh with all that descriptors look at.
struct Surface {
  TriangleMesh mesh;
  Operators operators;
  Eigenbasis basis;
  explicit Surface(TriangleMesh given, int32_t pairs = 60)
      : mesh(std::move(given)),
        operators(make_operators(mesh)),
        basis(eigenbasis(operators.L, operators.mass, {.count = pairs}, {})) {}
  RowMatrix describe(const DescriptorKind& kind, const std::vector<int32_t>& vertices) const {
    return kind.describe({mesh, operators, basis}, vertices, {});
  }
  RowMatrix describe(std::string_view name, const std::vector<int32_t>& vertices) const {
    return describe(kind_of(name), vertices);
  }
  RowMatrix describe(std::string_view name) const { return describe(name, all_of(mesh.vertex_count())); }
};

double time_of(int k) { return std::exp2(1 + 24.0 * k / 95); }

// The spectrum of the unit sphere: l (l + 1), 2 l + 1 times, up to degree `most`.
double sphere_sum(int most, const std::function<double(double lambda)>& weight) {
  double sum = 0;
  for (int l = 0; l <= most; ++l) sum += (2 * l + 1) * weight(l * (l + 1.0));
  return sum;
}

}  // namespace

TEST_CASE("HKS: its integral is the trace of the heat operator") {
  const Surface surface(with_radius(sphere(4), lump));
  const RowMatrix hks = surface.describe("hks");
  const double area = surface.operators.area;
  for (int k = 0; k < 96; k += 5) {
    const double trace = (-surface.basis.lambda.array() * area / reference_area * time_of(k)).exp().sum();
    CHECK(surface.operators.mass.dot(hks.col(k)) / area == doctest::Approx(trace).epsilon(1e-6));
  }
}

TEST_CASE("HKS: on the sphere the same everywhere, by its spectrum; while small, area / (4 pi t)") {
  const int degree = 6;
  const Surface surface(sphere(5), (degree + 1) * (degree + 1));
  const RowMatrix hks = surface.describe("hks");
  for (int k = 0; k < 96; k += 3) {
    const double t = time_of(k) * 4 * pi / reference_area;  // on the unit sphere
    const double truth = sphere_sum(degree, [&](double lambda) { return std::exp(-lambda * t); });
    CHECK(hks.col(k).mean() == doctest::Approx(truth).epsilon(0.01));
    CHECK(hks.col(k).maxCoeff() - hks.col(k).minCoeff() < 0.03 * truth);
    if (t > 0.08 && t < 0.15)
      CHECK(hks.col(k).mean() == doctest::Approx(4 * pi / (4 * pi * t)).epsilon(0.08));
  }
  CHECK(hks.col(95).maxCoeff() == doctest::Approx(1).epsilon(0.001));  // all heat is spread at last
}

TEST_CASE("WKS: every energy's share of the surface sums to 1, and on the sphere it is the same everywhere") {
  const Surface lumpy(with_radius(sphere(4), lump)), round(sphere(5), 49);  // degrees 0 to 6
  for (const Surface* surface : {&lumpy, &round}) {
    const RowMatrix wks = surface->describe("wks");
    const Vector share = wks.transpose() * surface->operators.mass / surface->operators.area;
    CHECK((share.array() - 1).abs().maxCoeff() < 1e-6);
  }
  const RowMatrix wks = round.describe("wks");
  CHECK((wks.array() - 1).abs().maxCoeff() < 0.03);
  CHECK((lumpy.describe("wks").array() - 1).abs().maxCoeff() > 0.5);
}

TEST_CASE("WKS by its definition, from a spectrum made up") {
  Eigenbasis basis;
  basis.lambda.resize(4), basis.Phi.resize(2, 4);
  basis.lambda << 0, 3, 7.5, 20;
  basis.Phi << 0.6, 0.1, -0.8, 1.1, 0.6, -1.2, 0.3, 0.2;
  Operators operators;
  operators.area = 2;
  const std::vector<int32_t> vertices = {1};
  const RowMatrix wks = kind_of("wks").describe({{}, operators, basis}, vertices, {});
  const double low = std::log(6.0), high = std::log(40.0) / 1.02, step = (high - low) / 95, sigma = 7 * step;
  for (int k = 0; k < 96; ++k) {
    double sum = 0, norm = 0;
    for (int i = 1; i < 4; ++i) {
      const double w =
          std::exp(-std::pow(low + k * step - std::log(2 * basis.lambda[i]), 2) / (2 * sigma * sigma));
      sum += w * std::pow(basis.Phi(1, i), 2), norm += w;
    }
    CHECK(wks(0, k) == doctest::Approx(2 * sum / norm).epsilon(1e-9));
  }
}

namespace {

// Bins as Johnson and Hebert fill them: each point is shared out over the bins whose centres it lies between.
void add_shared(Eigen::MatrixXd& image, double distance, double height, double share, double radius) {
  const auto spread = [](double at, double bin, Eigen::Index bins) {
    Vector weight(bins);
    for (Eigen::Index i = 0; i < bins; ++i)
      weight[i] = std::max(0.0, 1 - std::abs(at / bin - 0.5 - static_cast<double>(i)));
    return Vector(weight / weight.sum());
  };
  image += share * spread(std::min(distance, radius * 15 / 16), radius / 8, 8) *
           spread(height + radius, radius / 6, 12).transpose();
}

// The image of the cap of a sphere within `radius` of its pole: rings of equal angle.
Eigen::MatrixXd cap_image(double sphere_radius, double radius) {
  Eigen::MatrixXd image = Eigen::MatrixXd::Zero(8, 12);
  const double most = 2 * std::asin(radius / (2 * sphere_radius));
  const int rings = 20000;
  double total = 0;
  for (int i = 0; i < rings; ++i) {
    const double angle = (i + 0.5) * most / rings, share = std::sin(angle);
    add_shared(image, sphere_radius * std::sin(angle), sphere_radius * (std::cos(angle) - 1), share, radius);
    total += share;
  }
  return image / total;
}

double difference(const RowMatrix& signature, const Eigen::MatrixXd& truth) {
  return (Eigen::Map<const RowMatrix>(signature.data(), truth.rows(), truth.cols()) - truth).cwiseAbs().sum();
}

}  // namespace

TEST_CASE("spin image: of a sphere and of a plane as counted by hand") {
  const Surface round(sphere(6), 8);
  const double radius = support_radius * std::sqrt(round.operators.area);
  CHECK(difference(round.describe("spin-image", {100}), cap_image(1, radius)) < 0.05);
  const Surface flat(square(40, 0.3), 8);
  const double flat_radius = support_radius * 2;  // of an area of 4
  const std::vector<int32_t> middle = {flat.mesh.vertex_count() / 2};
  CHECK(difference(flat.describe("spin-image", middle), cap_image(1e4, flat_radius)) < 0.05);
  CHECK(difference(flat.describe("spin-image", middle), cap_image(1, flat_radius)) >
        0.2);  // the test can tell
  CHECK(round.describe("spin-image").rowwise().sum().isApprox(Vector::Ones(round.mesh.vertex_count()), 1e-9));
}

TEST_CASE("unique shape context: shells and heights of a sphere and of a plane as counted by hand") {
  // On plane and sphere alike the area within a straight distance r of a point is pi r^2.
  const auto shells_of = [](const RowMatrix& signature) {
    return Vector(Eigen::Map<const RowMatrix>(signature.data(), 3, 32).rowwise().sum());
  };
  Vector truth(3);
  for (int k = 0; k < 3; ++k) truth[k] = std::pow(std::exp2(k - 2), 2) - std::pow(std::exp2(k - 3), 2);
  const Surface round(sphere(6), 8), flat(square(40, 0.3), 8);
  const std::vector<int32_t> middle = {flat.mesh.vertex_count() / 2};
  for (const RowMatrix& signature :
       {round.describe("unique-shape-context", {100}), flat.describe("unique-shape-context", middle)}) {
    CHECK((shells_of(signature) - truth).cwiseAbs().maxCoeff() < 0.04);
    // All of it lies within 45 degrees of the tangent plane: in the two middle heights of the four.
    for (int shell = 0; shell < 3; ++shell)
      for (const int elevation : {0, 3})
        CHECK(signature.row(0).segment((shell * 4 + elevation) * 8, 8).sum() == 0);
  }
  // z points to where the surface is: the cap of a sphere lies on that side, all of it.
  const RowMatrix cap = round.describe("unique-shape-context", {100});
  for (int shell = 0; shell < 3; ++shell) CHECK(cap.row(0).segment((shell * 4 + 2) * 8, 8).sum() < 0.01);
}

TEST_CASE("no descriptor changes when the mesh is turned, moved and scaled, and all differ between points") {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  const Surface before(mesh);
  Random random(5);
  mesh.positions =
      ((40 * mesh.positions * random_rotation(random)).rowwise() + Eigen::RowVector3d(3, -8, 1)).eval();
  const Surface after(mesh);
  std::set<std::string_view> names;
  std::vector<DescriptorKind> kinds(descriptor_kinds().begin(), descriptor_kinds().end());
  kinds.push_back(centre_distance_descriptor());
  const auto all = all_of(mesh.vertex_count());
  for (const DescriptorKind& kind : kinds) {
    CAPTURE(kind.name);
    CHECK(names.insert(kind.name).second);
    CHECK(kind.dimension <= max_components);
    const RowMatrix one = before.describe(kind, all), other = after.describe(kind, all);
    CHECK(one.cols() == kind.dimension);
    CHECK(one.allFinite());
    // A vertex on the border between two bins may fall on its other side by a rounding: hardly any do.
    const Vector off = (one - other).rowwise().norm().array() / one.rowwise().norm().array();
    CHECK((off.array() > 1e-4).count() < 0.02 * static_cast<double>(off.size()));
    CHECK((one.rowwise() - one.colwise().mean()).rowwise().norm().mean() >
          0.02 * one.rowwise().norm().mean());
  }
}

TEST_CASE("unique shape context distinguishes a shape from its mirror image, a spin image does not") {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  const Surface before(mesh);
  mesh.positions.col(0) *= -1;
  mesh.triangles.col(1).swap(mesh.triangles.col(2));
  const Surface mirrored(mesh);
  const auto change = [&](std::string_view name) {
    const RowMatrix one = before.describe(name), other = mirrored.describe(name);
    return (one - other).norm() / one.norm();
  };
  CHECK(change("spin-image") < 1e-6);
  CHECK(change("unique-shape-context") > 0.3);
}
