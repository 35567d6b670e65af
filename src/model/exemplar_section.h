// Section EXMP of a model file: the shapes of the exemplars one by one, which samples are theirs, how they bulge, where their marks lie to
// each other. Read after the targets and the exemplars, which it belongs to.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

// A number as the section keeps it. Detection uses no finer one, so that a model finds the same before it is saved and after.
float kept_bulge(float value);
float kept_direction(float value);

void write_exemplars(const LandmarkModel& model, ByteWriter& out);
void read_exemplars(ByteReader in, LandmarkModel& model);

}  // namespace focal
