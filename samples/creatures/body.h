// The flesh at rest: smoothly blended sweeps, as an implicit function that is negative inside.
#pragma once
#include <array>
#include <vector>

#include "geometry.h"

namespace creatures {

// A cross-section of a sweep: an ellipse whose front and back halves may have different depths.
struct Section {
  double at;                               // along the axis: 0 at its start, 1 at its end
  double side, front, back;                // half width and the two half depths
  double shift_front = 0, shift_side = 0;  // of the centre away from the straight axis
};

// From `at` on (fraction of the axis) the sweep follows `bone`; `softness` is the length of the transition.
struct BoneSpan {
  int bone;
  double at = 0, softness = 0;
};

// A straight axis dressed with cross-sections and closed by half-ellipsoid caps. One section makes an
// ellipsoid, two a rounded cone, more a limb with muscles.
struct Sweep {
  Vec3 from, to;
  Vec3 front;  // made orthogonal to the axis when the body is finished
  std::vector<Section> sections;
  double start_cap, end_cap;
  std::vector<BoneSpan> bones;
  double blend;           // width of the smooth union with what was there before
  double detail = 1;      // edge lengths wanted on it, relative to the creature's usual ones
  bool paired = false;    // stands for itself and its mirror image
  double pair_blend = 0;  // width of the smooth union of the two
  bool carve = false;     // is taken away instead of added
};

// Half axes along x, y and z.
Sweep ellipsoid(const Vec3& at, const Vec3& radii, int bone, double blend);
// A bone dressed in a rounded cone.
Sweep cone(const Vec3& from, const Vec3& to, double from_radius, double to_radius, int bone, double blend);

class Body {
 public:
  // `mirror_bone[b]` is the bone of the other side, or b itself on the middle line.
  Body(std::vector<Sweep> sweeps, std::vector<int> mirror_bone, std::array<double, 6> asymmetry);

  double distance(const Vec3& point) const;  // near the surface close to the true distance
  Vec3 gradient(const Vec3& point) const;
  Vec3 project(Vec3 point) const;                             // onto the surface, for points near it
  double detail(const Vec3& point) const;                     // of the flesh at this place of the surface
  std::vector<double> bone_weights(const Vec3& point) const;  // non-negative, not normalised
  // Bounding box, a little larger than the body.
  Eigen::AlignedBox3d bounds() const;
  int bone_count() const { return static_cast<int>(mirror_bone_.size()); }

 private:
  struct Prepared {
    Sweep shape;
    Vec3 axis, side, front, middle;
    double length, radius;                              // radius: of a ball around `middle` that holds it all
    std::vector<std::array<double, 5>> values, slopes;  // a section: side, front, back, two shifts
    std::array<double, 5> section(double y) const;
    double distance(const Vec3& point) const;
  };
  Vec3 warp(const Vec3& point) const;
  template <class Visit>
  void visit_surfaces(const Vec3& point, Visit visit) const;

  std::vector<Prepared> sweeps_;
  std::vector<int> mirror_bone_;
  std::array<double, 6> asymmetry_;
};

}  // namespace creatures
