// SPDX-License-Identifier: Apache-2.0
#include "scan/pattern.hpp"

#include <cmath>

namespace vantage {
namespace {

void fill(std::vector<float>& sines, std::vector<float>& cosines, double first, double step, std::uint32_t count) {
  sines.resize(count);
  cosines.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = first + k * step;
    sines[k] = static_cast<float>(std::sin(angle));
    cosines[k] = static_cast<float>(std::cos(angle));
  }
}

}  // namespace

RayPattern make_pattern(const Scanner& scanner) {
  RayPattern pattern;
  pattern.zenith_step = scanner.zenith_step.in_radians();
  pattern.azimuth_step = scanner.azimuth_step.in_radians();
  const RayAngles first = scanner.angles(0);
  pattern.first_zenith = first.zenith.in_radians();
  pattern.first_azimuth = first.azimuth.in_radians();
  pattern.min_range = static_cast<float>(scanner.min_range_m);
  pattern.max_range = static_cast<float>(scanner.max_range_m);
  fill(pattern.sin_zenith, pattern.cos_zenith, pattern.first_zenith, pattern.zenith_step, scanner.rows());
  fill(pattern.sin_azimuth, pattern.cos_azimuth, pattern.first_azimuth, pattern.azimuth_step, scanner.columns());
  return pattern;
}

}  // namespace vantage
