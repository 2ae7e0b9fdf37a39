// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage {

struct Colour {
  double r = 0, g = 0, b = 0;
};

constexpr Colour mix(const Colour& a, const Colour& b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// Piecewise linear through equally spaced colours; t in [0, 1], clamped.
template <std::size_t N>
constexpr Colour ramp(const std::array<Colour, N>& stops, double t) {
  const double at = (t > 0 ? (t < 1 ? t : 1) : 0) * (N - 1);
  const std::size_t i = at >= N - 1 ? N - 2 : static_cast<std::size_t>(at);
  return mix(stops[i], stops[i + 1], at - static_cast<double>(i));
}

// Coverage cartography: red (no point) through yellow to green (goal reached).
constexpr std::array<Colour, 3> kCoverageRamp{{{0.84, 0.10, 0.11}, {1.00, 0.85, 0.25}, {0.10, 0.59, 0.25}}};

// For rising quantities: dark blue through green to yellow (viridis), also readable in grey and by the colour-blind.
constexpr std::array<Colour, 9> kRisingRamp{{{0.267, 0.005, 0.329},
                                             {0.279, 0.175, 0.483},
                                             {0.230, 0.322, 0.546},
                                             {0.173, 0.449, 0.558},
                                             {0.128, 0.567, 0.551},
                                             {0.154, 0.680, 0.504},
                                             {0.369, 0.789, 0.383},
                                             {0.678, 0.864, 0.190},
                                             {0.993, 0.906, 0.144}}};

constexpr std::array<std::uint8_t, 3> to_bytes(const Colour& c) {
  const auto byte = [](double v) { return static_cast<std::uint8_t>((v < 0 ? 0 : v > 1 ? 1 : v) * 255 + 0.5); };
  return {byte(c.r), byte(c.g), byte(c.b)};
}

}  // namespace vantage
