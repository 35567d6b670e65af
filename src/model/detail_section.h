// Section DETL of a model file: the parts of the body that are analysed once more by themselves, each with a model of its own. Read
// after the skeleton, whose joints it names.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

void write_details(const LandmarkModel& model, ByteWriter& out);
void read_details(ByteReader in, LandmarkModel& model);

}  // namespace focal
