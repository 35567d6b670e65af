// Section FEAT of a model file: the forest's features of a point besides its signature, and the forests that
// find the heading of a mesh.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

void write_features(const LandmarkModel& model, ByteWriter& out);
void read_features(ByteReader in, LandmarkModel& model);

}  // namespace focal
