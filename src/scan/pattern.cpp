// SPDX-License-Identifier: Apache-2.0
#include "scan/pattern.hpp"

#include <array>
#include <cmath>

namespace vantage {
namespace {

template <class AngleOf>
void fill(std::vector<float>& sines, std::vector<float>& cosines, std::uint32_t count, const AngleOf& angle_of) {
  sines.resize(count);
  cosines.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = angle_of(k);
    sines[k] = static_cast<float>(std::sin(angle));
    cosines[k] = static_cast<float>(std::cos(angle));
  }
}

}  // namespace

RayPattern make_pattern(const Scanner& scanner) {
  RayPattern pattern;
  for (const Angle& zenith : scanner.row_zeniths) pattern.zeniths.push_back(zenith.in_radians());
  if (scanner.row_zeniths.empty() && scanner.directions.empty()) pattern.zenith_step = scanner.zenith_step.in_radians();
  pattern.azimuth_step = scanner.azimuth_step.in_radians();
  const RayAngles first = scanner.angles(0);
  pattern.first_zenith = first.zenith.in_radians();
  pattern.first_azimuth = first.azimuth.in_radians();
  pattern.min_range = static_cast<float>(scanner.min_range_m);
  pattern.max_range = static_cast<float>(scanner.max_range_m);
  if (!scanner.directions.empty()) {
    std::vector<double> zeniths, azimuths;
    for (std::uint64_t ray = 0; ray < scanner.rays(); ++ray) {
      const RayAngles angles = scanner.angles(ray);
      zeniths.push_back(angles.zenith.in_radians()), azimuths.push_back(angles.azimuth.in_radians());
    }
    pattern.list = std::make_shared<const DirectionList>(zeniths, azimuths);
    fill(pattern.sin_zenith, pattern.cos_zenith, scanner.rows(), [&](std::uint32_t row) { return zeniths[row]; });
    pattern.sin_azimuth = {0}, pattern.cos_azimuth = {1};
    return pattern;
  }
  fill(pattern.sin_zenith, pattern.cos_zenith, scanner.rows(), [&](std::uint32_t row) {
    return pattern.zeniths.empty() ? pattern.first_zenith + row * pattern.zenith_step : pattern.zeniths[row];
  });
  fill(pattern.sin_azimuth, pattern.cos_azimuth, scanner.columns(),
       [&](std::uint32_t column) { return pattern.first_azimuth + column * pattern.azimuth_step; });
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
