// Section DETL of a model file: the body parts that get a second analysis of their own, each with its own
// model. Read after the skeleton, whose joints it refers to.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

void write_details(const LandmarkModel& model, ByteWriter& out);
void read_details(ByteReader in, LandmarkModel& model);

}  // namespace focal
