// Sections of a model file that have a file of code each.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

// Section FEAT of a model file: what the forest knows of a point beside its signature, and how the heading of a mesh is found.
void write_features(const LandmarkModel& model, ByteWriter& out);
void read_features(ByteReader in, LandmarkModel& model);

// Section EXMP of a model file: the shapes of the exemplars one by one, which samples are theirs, how they bulge, where their marks lie to
// each other. Read after the targets and the exemplars, which it belongs to.
void write_exemplars(const LandmarkModel& model, ByteWriter& out);
void read_exemplars(ByteReader in, LandmarkModel& model);
// A number as the section keeps it. Detection uses no finer one, so that a model finds the same before it is saved and after.
float kept_bulge(float value);
float kept_direction(float value);

// Section DETL of a model file: the parts of the body that are analysed once more by themselves, each with a model of its own. Read
// after the skeleton, whose joints it names.
void write_details(const LandmarkModel& model, ByteWriter& out);
void read_details(ByteReader in, LandmarkModel& model);

}  // namespace focal
