// Sections of a model file that have a file of code each.
#pragma once
#include "base/archive.h"
#include "model/landmark_model.h"

namespace focal {

// Section FEAT of a model file: the features of a point beside its signature, and the forests that find the heading of a mesh.
void write_features(const LandmarkModel& model, ByteWriter& out);
void read_features(ByteReader in, LandmarkModel& model);

// Section EXMP of a model file: for each exemplar its sample numbers, its bulge and the distances and
// directions between its landmarks. Read after the targets and the exemplars, which it refers to.
void write_exemplars(const LandmarkModel& model, ByteWriter& out);
void read_exemplars(ByteReader in, LandmarkModel& model);
// A number with the precision of the file. Detection uses no higher precision, so that a model gives the same
// results before and after saving.
float kept_bulge(float value);
float kept_direction(float value);

// Section DETL of a model file: the parts of the body that are analysed once more by themselves, each with a model of its own. Read
// after the skeleton, whose joints it names.
void write_details(const LandmarkModel& model, ByteWriter& out);
void read_details(ByteReader in, LandmarkModel& model);

}  // namespace focal
