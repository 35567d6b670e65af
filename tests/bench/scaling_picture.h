// The picture of a scaling run: seconds and peak memory against the number of vertices, both axes logarithmic.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace focal_bench {

// rows: as focal_bench_scaling --json prints them. Returns an SVG that reads on light and dark pages.
std::string scaling_picture(const nlohmann::json& rows);

}  // namespace focal_bench
