// The parts of the page: sections with words, tables, figures side by side.
#pragma once
#include <string>
#include <vector>

#include "picture/drawing.h"

namespace paper {

// differs: what is not as in the paper, and why.
std::string section(const std::string& title, const std::string& words, const std::string& differs,
                    const std::string& body);

// The first row is the head.
std::string table(const std::vector<std::vector<std::string>>& rows);

std::string pictures(const std::vector<picture::Figure>& figures, size_t columns);

std::string fixed(double value, int digits);

extern const char* const kHead;  // of the page, up to its sections

}  // namespace paper
