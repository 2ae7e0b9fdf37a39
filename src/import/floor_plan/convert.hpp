// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage::floor_plan {

struct Settings {
  std::string unit;                      // empty: as the drawing says
  std::vector<std::string> wall_layers;  // patterns; empty: by names or lines
  double wall_height_m = 2.7;
};

// NAME=VALUE of unit, wall-layer (which may be repeated) and wall-height. Throws Refused.
void read_setting(Settings& settings, const std::string& text);

// Returns the bytes of a GLB: the floor plan of a DXF as rooms of that height. Several files are storeys, from the
// lowest, in the same coordinates. Throws Refused.
std::string convert(const std::vector<std::filesystem::path>& files, const Settings& settings);

}  // namespace vantage::floor_plan
