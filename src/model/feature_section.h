// Section FEAT of a model file: what the forest knows of a point beside its signature, and how the heading of a mesh is found.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

void write_features(const LandmarkModel& model, ByteWriter& out);
void read_features(ByteReader in, LandmarkModel& model);

}  // namespace focal
