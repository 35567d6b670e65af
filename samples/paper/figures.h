// The figures: each asks one question of a set and answers it with a row of pictures for each preset.
#pragma once
#include <string>
#include <vector>

#include "experiment.h"

namespace paper {

// A section of the page for each figure, as HTML with the pictures inside.
std::string figures_of(const focal::Context& context, const Set& set);

}  // namespace paper
