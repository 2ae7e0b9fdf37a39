// SPDX-License-Identifier: Apache-2.0
#include "map/missed_colours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

Triple times(const Matrix& m, const Triple& v) {
  Triple product{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) product[r] += m[r][c] * v[c];
  return product;
}

// Colours as the three kinds of dichromats see linear sRGB (Machado, Oliveira, Fernandes: A physiologically-based model
// for simulation of color vision deficiency, 2009; severity 1.0).
constexpr Matrix kUsual{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix kProtan{
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kDeutan{
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};
constexpr Matrix kTritan{
    {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};

// CIE 1976 L*a*b*, D65.
Triple lab(const Matrix& eyes, const Colour& colour) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  Triple seen = times(eyes, {linear(colour.r), linear(colour.g), linear(colour.b)});
  for (double& v : seen) v = std::clamp(v, 0.0, 1.0);
  const Triple xyz = times({{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}}, seen);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f(xyz[0] / 0.9505), y = f(xyz[1]), z = f(xyz[2] / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(MissedColours, AreToldApartByAllEyes) {
  constexpr double kJustNoticed = 2.3;  // of two colours side by side (Mahy et al., 1994)
  for (const auto& [eyes, whose] :
       {std::pair{kUsual, "usual"}, {kProtan, "without red"}, {kDeutan, "without green"}, {kTritan, "without blue"}})
    for (const MissedStyle& one : kMissedStyles)
      for (const MissedStyle& other : kMissedStyles) {
        if (one.why == other.why) continue;
        const Triple a = lab(eyes, one.colour), b = lab(eyes, other.colour);
        EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 8 * kJustNoticed)
            << whose << ": " << one.words << " and " << other.words;
      }
}

}  // namespace
}  // namespace vantage
