#include "cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace focal_robustness {
namespace {

using namespace focal;

CorruptedMesh start(const Shape& shape) { return intact(shape.mesh, shape.marks); }

Case damage(const std::string& name, const std::string& wanted,
            std::function<CorruptedMesh(CorruptedMesh, Random&)> how) {
  return {name, wanted, false, false, [how = std::move(how)](const Shape& shape, Random& random) {
            return Spoiled{how(start(shape), random), Matrix4::Identity(), 1};
          }};
}

double path_between(const Shape& shape, int32_t from, int32_t to) {
  const SurfacePoint &a = *shape.marks[from], &b = *shape.marks[to];
  const Vector lengths = edge_path_lengths(shape.mesh, a, std::numeric_limits<double>::infinity());
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    if (b.barycentric[i] > 0) nearest = std::min(nearest, lengths[shape.mesh.triangles(b.triangle, i)]);
  return nearest;
}

struct Limb {
  int32_t tip, last, next;  // landmarks: its end, the last one that goes with it, the first that stays
};

// All limbs go, each by a ball round its tip that ends halfway between the last mark to go and the next.
CorruptedMesh without(const Shape& shape, const std::vector<Limb>& limbs, CutEnd end) {
  CorruptedMesh corrupted = start(shape);
  for (const Limb& limb : limbs) {
    const double gone = limb.last == limb.tip ? 0 : path_between(shape, limb.tip, limb.last);
    const double stays = path_between(shape, limb.tip, limb.next);
    if (!corrupted.marks[limb.tip]) continue;
    corrupted = cut_ball(std::move(corrupted), *corrupted.marks[limb.tip], (gone + stays) / 2, end);
  }
  return corrupted;
}

Case amputation(const std::string& name, std::vector<Limb> limbs, CutEnd end) {
  return {name + (end == CutEnd::capped ? ", capped" : ""), "<= 4.0; 0.95, 0.95", true, false,
          [limbs = std::move(limbs), end](const Shape& shape, Random&) {
            return Spoiled{without(shape, limbs, end), Matrix4::Identity(), 1};
          }};
}

void add_amputations(const Shapes& shapes, std::vector<Case>& cases) {
  // The names of faust5k, else of the sample humanoids.
  const auto named = [&](const char* name, const char* otherwise) {
    const int32_t landmark = shapes.landmark(name);
    return landmark >= 0 ? landmark : shapes.landmark(otherwise);
  };
  const int32_t left_shoulder = shapes.landmark("shoulder.L");
  const Limb left{named("hand.L", "handTip.L"), shapes.landmark("elbow.L"), left_shoulder},
      right{named("hand.R", "handTip.R"), shapes.landmark("elbow.R"), shapes.landmark("shoulder.R")},
      head{named("head", "crown"), named("head", "chin"), left_shoulder};
  for (const Limb& l : {left, right, head})
    if (l.tip < 0 || l.last < 0 || l.next < 0) return;  // another set of marks
  for (const CutEnd end : {CutEnd::open, CutEnd::capped}) {
    cases.push_back(amputation("one arm gone", {left}, end));
    cases.push_back(amputation("both arms gone", {left, right}, end));
    cases.push_back(amputation("head gone", {head}, end));
  }
}

Case similarity(const std::string& name, double scale, double distance, int number) {
  return {name, "same to 1e-3", false, true, [=](const Shape& shape, Random& random) {
            Matrix4 map = random_similarity(scale, distance, random);
            for (int i = 1; i < number; ++i) map = random_similarity(scale, distance, random);
            if (distance == 0) map.setIdentity(), map.topLeftCorner<3, 3>() *= scale;
            return Spoiled{moved(start(shape), map), map, scale};
          }};
}

}  // namespace

std::vector<Case> all_cases(const Shapes& shapes) {
  std::vector<Case> cases{
      damage("clean", "", [](CorruptedMesh mesh, Random&) { return mesh; }),
      damage("noise 0.3 edge", "+0.5",
             [](CorruptedMesh mesh, Random& random) { return with_noise(std::move(mesh), 0.3, random); }),
      damage("60 vertex holes", "+0.3",
             [](CorruptedMesh mesh, Random& random) { return with_holes(std::move(mesh), 60, 0, random); }),
      damage("20 holes of 1.5", "+1.0",
             [](CorruptedMesh mesh, Random& random) { return with_holes(std::move(mesh), 20, 1.5, random); }),
      damage("40 holes of 2.5", "+3.0",
             [](CorruptedMesh mesh, Random& random) { return with_holes(std::move(mesh), 40, 2.5, random); }),
      damage("half resolution", "+0.3",
             [](CorruptedMesh mesh, Random& random) { return resampled(std::move(mesh), 0.5, random); }),
      damage("double resolution", "+0.3",
             [](CorruptedMesh mesh, Random& random) { return resampled(std::move(mesh), 2, random); })};
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    char text[32];
    std::snprintf(text, sizeof text, "scale %.0e", scale);
    cases.push_back(similarity(text, scale, 0, 1));
  }
  for (int i = 1; i <= 3; ++i) cases.push_back(similarity("rigid motion " + std::to_string(i), 1, 1, i));
  add_amputations(shapes, cases);
  return cases;
}

}  // namespace focal_robustness
