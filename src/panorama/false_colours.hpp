// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "image/srgb.hpp"

namespace vantage {

// Linear colours of scales. Lightness falls (range) or rises (reflectivity) monotonically, so they also read in grey.
LinearColour range_colour(double share);         // 0 near, light; 1 far, dark
LinearColour reflectivity_colour(double share);  // 0 dark, 1 light
// Distinct for neighbouring numbers: hues by the golden section.
LinearColour mesh_colour(std::uint32_t mesh);

}  // namespace vantage
