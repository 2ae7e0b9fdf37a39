// SPDX-License-Identifier: Apache-2.0
#include "panorama/false_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace vantage {
namespace {

using Code = glm::dvec3;  // sRGB, 0 to 255

LinearColour from_code(const Code& code) {
  LinearColour colour{0, 0, 0, 1};
  for (int i = 0; i < 3; ++i)
    colour[i] = linear_from_srgb8(static_cast<std::uint8_t>(std::lround(std::clamp(code[i], 0.0, 255.0))));
  return colour;
}

LinearColour along(std::span<const Code> stops, double share) {
  const double x = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  return from_code(stops[k] + (stops[k + 1] - stops[k]) * (x - static_cast<double>(k)));
}

constexpr std::array<Code, 7> kRangeStops{Code{250, 240, 160}, Code{246, 184, 84}, Code{226, 108, 76},
                                          Code{180, 56, 116},  Code{116, 42, 142}, Code{60, 40, 126},
                                          Code{20, 24, 74}};
constexpr std::array<Code, 5> kReflectivityStops{Code{16, 20, 36}, Code{30, 74, 98}, Code{58, 138, 122},
                                                 Code{150, 196, 112}, Code{250, 240, 164}};

}  // namespace

LinearColour range_colour(double share) { return along(kRangeStops, share); }
LinearColour reflectivity_colour(double share) { return along(kReflectivityStops, share); }

LinearColour mesh_colour(std::uint32_t mesh) {
  const double hue = std::fmod(0.08 + mesh * (std::numbers::phi - 1), 1.0) * 6;
  const double light = 1 - 0.16 * (mesh % 3), grey = 0.40 + 0.14 * (mesh % 2);  // value, and the grey part of it
  Code code;
  for (int i = 0; i < 3; ++i) {
    // Red, green and blue are full within one sixth of their hue and 0 beyond two.
    const double away = std::abs(std::remainder(hue - 2.0 * i, 6.0));
    code[i] = 255 * light * (grey + (1 - grey) * std::clamp(2 - away, 0.0, 1.0));
  }
  return from_code(code);
}

}  // namespace vantage
