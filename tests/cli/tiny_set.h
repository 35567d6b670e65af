// A set of small horned eggs, each of its own proportions, written as the command reads it.
#pragma once
#include <string>

#include "scratch_folder.h"

// Meshes egg0.. of some 500 vertices with landmarks nose, horn.L, horn.R and tail; train: the first `train`
// of them, test: the last `test`.
void write_tiny_set(const ScratchFolder& scratch, int train, int test);
