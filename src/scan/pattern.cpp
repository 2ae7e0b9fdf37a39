// SPDX-License-Identifier: Apache-2.0
#include "scan/pattern.hpp"

#include <array>
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

std::optional<Turn> make_turn(const StationSetup& setup) {
  if (!setup.turned()) return std::nullopt;
  const auto rounded = [](const Vec3& row) {
    return Float3{static_cast<float>(row.x), static_cast<float>(row.y), static_cast<float>(row.z)};
  };
  const std::array<Vec3, 3> rows = setup.survey_from_scanner();
  return Turn{rounded(rows[0]), rounded(rows[1]), rounded(rows[2])};
}

}  // namespace vantage
