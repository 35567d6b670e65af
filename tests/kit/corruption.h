// Corruptions that only tests and measurements use, beside those of training (augmentation/corruption.h).
#pragma once
#include "augmentation/corruption.h"

namespace focal {

// Loses every vertex p with (p - point) . normal > 0.
CorruptedMesh cut_beyond(CorruptedMesh corrupted, const Vector3& point, const Vector3& normal, CutEnd end);

// About factor times the vertices: below 1 decimated by quadric error, above 1 the longest edges split at random places
// along them, which leaves the surface as it is. old_triangle of a decimated mesh is -1 throughout.
CorruptedMesh resampled(CorruptedMesh corrupted, double factor, Random& random);

// By any affine map that does not mirror.
CorruptedMesh moved(CorruptedMesh corrupted, const Matrix4& map);
// A uniformly random turn about the origin, then a move by up to `distance` along each axis, after scaling.
Matrix4 random_similarity(double scale, double distance, Random& random);

}  // namespace focal
