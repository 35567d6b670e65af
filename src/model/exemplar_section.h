// Section EXMP of a model file: for each exemplar its sample numbers, its bulge and the distances and
// directions between its landmarks. Read after the targets and the exemplars, which it refers to.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

// A number with the precision of the file. Detection uses no higher precision, so that a model gives the same
// results before and after saving.
float kept_bulge(float value);
float kept_direction(float value);

void write_exemplars(const LandmarkModel& model, ByteWriter& out);
void read_exemplars(ByteReader in, LandmarkModel& model);

}  // namespace focal
