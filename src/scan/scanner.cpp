// SPDX-License-Identifier: Apache-2.0
#include "vantage/scanner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "core/parse.hpp"
#include "core/site_reach.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double floor_guard = 1e-9;      // makes 360° / 0.1° 3600 and not 3599
constexpr double angle_guard_deg = 1e-9;  // 360° given in radians may exceed 360° by rounding
constexpr double step_guard = 1e-9;       // of a mean step that was written in degrees
constexpr double max_steps = 16'777'216;  // 2^24 per direction: 0.00002° over a full turn

double steps(Angle sweep, Angle step) { return std::floor(sweep.in_radians() / step.in_radians() + floor_guard); }

Angle zenith_sweep(const Scanner& scanner) { return Angle::radians(scanner.vertical_angle.in_radians() / 2); }

std::string ten_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

[[noreturn]] void refuse(const std::string& member, double value, const std::string& must) {
  throw Error(Errc::invalid_argument, "scanner: " + member + " is " + ten_digits(value) + ", but must be " + must);
}

void check_step(const std::string& member, Angle step, const char* sweep_name, Angle sweep) {
  const double degrees = step.in_degrees();
  if (!(std::isfinite(degrees) && degrees > 0)) refuse(member + " in degrees", degrees, "above 0");
  const double count = steps(sweep, step);
  if (count < 1)
    refuse(member + " in degrees", degrees,
           std::string("at most ") + sweep_name + ", " + ten_digits(sweep.in_degrees()));
  if (count > max_steps) refuse(member + " in degrees", degrees, "so large that there are at most 2^24 steps");
}

// Of rows that are not all one step apart.
double mean_step(const std::vector<Angle>& rows) {
  return (rows.back().in_radians() - rows.front().in_radians()) / static_cast<double>(rows.size() - 1);
}

void check_rows(const Scanner& scanner) {
  const std::vector<Angle>& rows = scanner.row_zeniths;
  if (static_cast<double>(rows.size()) > max_steps)
    refuse("the number of row_zeniths", static_cast<double>(rows.size()), "at most 2^24");
  const double first = scanner.zenith_start.in_degrees(), last = first + scanner.vertical_angle.in_degrees() / 2;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double zenith = rows[i].in_degrees();
    const std::string member = "row_zeniths[" + std::to_string(i) + "] in degrees";
    if (!(zenith >= 0 && zenith <= 180)) refuse(member, zenith, "from 0 to 180");
    if (i > 0 && !(rows[i - 1] < rows[i]))
      refuse(member, zenith, "above the zenith before it, " + ten_digits(rows[i - 1].in_degrees()));
  }
  if (rows.front().in_degrees() < first - angle_guard_deg || rows.back().in_degrees() > last + angle_guard_deg)
    throw Error(Errc::invalid_argument, "scanner: row_zeniths from " + ten_digits(rows.front().in_degrees()) + " to " +
                                            ten_digits(rows.back().in_degrees()) +
                                            " degrees must lie in the vertical field, " + ten_digits(first) + " to " +
                                            ten_digits(last) + ", which set_row_zeniths() sets");
  if (rows.size() > 1 && !(std::abs(mean_step(rows) / scanner.zenith_step.in_radians() - 1) <= step_guard))
    refuse("zenith_step in degrees", scanner.zenith_step.in_degrees(),
           "the mean step of row_zeniths, " + ten_digits(mean_step(rows) * 180 / std::numbers::pi) +
               ", as set_row_zeniths() sets it");
}

void check_noise(const NoiseTable& noise) {
  if (noise.empty()) return;
  if (noise.distances_m.empty() || noise.reflectivities.empty() ||
      noise.sigma_m.size() != noise.distances_m.size() * noise.reflectivities.size()) {
    throw Error(Errc::invalid_argument, "scanner: the noise table has " + std::to_string(noise.sigma_m.size()) +
                                            " values, but must have reflectivities × distances = " +
                                            std::to_string(noise.reflectivities.size()) + " × " +
                                            std::to_string(noise.distances_m.size()));
  }
  for (std::size_t i = 0; i < noise.distances_m.size(); ++i) {
    const double distance = noise.distances_m[i];
    if (!(std::isfinite(distance) && distance >= 0)) refuse("a noise table distance in metres", distance, "0 or more");
    if (i > 0 && distance <= noise.distances_m[i - 1])
      refuse("a noise table distance in metres", distance, "above the one before it");
  }
  for (std::size_t i = 0; i < noise.reflectivities.size(); ++i) {
    const double reflectivity = noise.reflectivities[i];
    if (!(reflectivity >= 0 && reflectivity <= 1)) refuse("a noise table reflectivity", reflectivity, "in [0, 1]");
    if (i > 0 && reflectivity <= noise.reflectivities[i - 1])
      refuse("a noise table reflectivity", reflectivity, "above the one before it");
  }
  for (const double sigma : noise.sigma_m) {
    if (!(std::isfinite(sigma) && sigma >= 0)) refuse("a noise table standard deviation in metres", sigma, "0 or more");
  }
}

}  // namespace

std::uint32_t Scanner::rows() const {
  return row_zeniths.empty() ? static_cast<std::uint32_t>(steps(zenith_sweep(*this), zenith_step))
                             : static_cast<std::uint32_t>(row_zeniths.size());
}

std::uint32_t Scanner::columns() const { return static_cast<std::uint32_t>(steps(horizontal_angle, azimuth_step)); }

RayAngles Scanner::angles(std::uint64_t ray) const {
  const double row = static_cast<double>(ray / columns()), column = static_cast<double>(ray % columns());
  return {row_zeniths.empty() ? Angle::radians(zenith_start.in_radians() + (row + 0.5) * zenith_step.in_radians())
                              : row_zeniths[ray / columns()],
          Angle::radians(heading.in_radians() - 0.5 * horizontal_angle.in_radians() +
                         (column + 0.5) * azimuth_step.in_radians())};
}

void Scanner::set_steps(Angle azimuth, Angle zenith) {
  azimuth_step = azimuth;
  if (row_zeniths.empty()) zenith_step = zenith;
}

void Scanner::set_row_zeniths(std::vector<Angle> zeniths) {
  row_zeniths = std::move(zeniths);
  if (row_zeniths.empty()) return;
  zenith_start = row_zeniths.front();
  vertical_angle = Angle::radians(2 * (row_zeniths.back().in_radians() - zenith_start.in_radians()));
  if (row_zeniths.size() > 1) {
    zenith_step = Angle::radians(mean_step(row_zeniths));
  } else {
    const double step = azimuth_step.in_radians();
    zenith_start = Angle::radians(std::clamp(zenith_start.in_radians() - step / 2, 0.0, std::numbers::pi - step));
    vertical_angle = Angle::radians(2 * step), zenith_step = azimuth_step;
  }
}

void Scanner::check() const {
  if (!std::isfinite(heading.in_degrees())) refuse("heading in degrees", heading.in_degrees(), "finite");
  if (!row_zeniths.empty()) check_rows(*this);
  const double horizontal = horizontal_angle.in_degrees(), vertical = vertical_angle.in_degrees();
  if (!(horizontal > 0 && horizontal <= 360 + angle_guard_deg))
    refuse("horizontal_angle in degrees", horizontal, "in (0, 360]");
  if (!(vertical > 0 && vertical <= 360 + angle_guard_deg))
    refuse("vertical_angle in degrees", vertical, "in (0, 360]");
  const double start = zenith_start.in_degrees();
  if (!(start >= 0 && start + vertical / 2 <= 180 + angle_guard_deg))
    refuse("zenith_start in degrees", start,
           "0 or more, and at most 180 with half of vertical_angle, " + ten_digits(vertical / 2));
  check_step("azimuth_step", azimuth_step, "horizontal_angle", horizontal_angle);
  check_step("zenith_step", zenith_step, "half of vertical_angle", zenith_sweep(*this));
  if (!(height_m >= 0 && height_m <= kSiteReach_m)) refuse("height_m", height_m, "from 0 to 1e6");
  if (!(std::isfinite(min_range_m) && min_range_m >= 0)) refuse("min_range_m", min_range_m, "0 or more");
  if (!(std::isfinite(max_range_m) && max_range_m > min_range_m))
    refuse("max_range_m", max_range_m, "finite and above min_range_m, " + ten_digits(min_range_m));
  const double divergence = beam_divergence.in_radians() * 1e3;
  if (!(divergence >= 0 && divergence < 100)) refuse("beam_divergence in mrad", divergence, "in [0, 100)");
  if (!(std::isfinite(exit_diameter_m) && exit_diameter_m >= 0))
    refuse("exit_diameter_m", exit_diameter_m, "0 or more");
  if (!(detection_range_m >= 0 && detection_range_m <= 1e6))
    refuse("detection_range_m", detection_range_m, "from 0 to 1e6");
  if (!(detection_reflectivity > 0 && detection_reflectivity <= 1))
    refuse("detection_reflectivity", detection_reflectivity, "above 0 and at most 1");
  const double arcsec = angle_accuracy.in_degrees() * 3600;
  if (!(arcsec >= 0 && arcsec <= 3600)) refuse("angle_accuracy in arc seconds", arcsec, "from 0 to 3600");
  if (!(range_accuracy_m >= 0 && range_accuracy_m <= 1)) refuse("range_accuracy_m", range_accuracy_m, "from 0 to 1");
  if (!(range_accuracy_ppm >= 0 && range_accuracy_ppm <= 10'000))
    refuse("range_accuracy_ppm", range_accuracy_ppm, "from 0 to 10000");
  check_number(points_per_second, "scanner: points_per_second", measurable);
  check_noise(noise);
}

std::string describe(const NoiseTable& noise) {
  if (noise.empty()) return "no noise table: exact ranges";
  const std::size_t distances = noise.distances_m.size(), reflectivities = noise.reflectivities.size();
  if (noise.sigma_m.size() == 1)
    return "one figure of noise, of " + ten_digits(noise.distances_m.front()) +
           " m, for all distances and reflectivities";
  return "noise of " + std::to_string(distances) + (distances == 1 ? " distance" : " distances") + " and " +
         std::to_string(reflectivities) + (reflectivities == 1 ? " reflectivity" : " reflectivities");
}

NoiseTable rtc360_noise() {
  return {.distances_m = {5, 10, 20, 40, 60},
          .reflectivities = {0.08, 0.21, 0.89},
          .sigma_m = {0.0005, 0.0006, 0.0007, 0.0025, 0.0050,    // black
                      0.0004, 0.0005, 0.0006, 0.0008, 0.0020,    // grey
                      0.0003, 0.0004, 0.0005, 0.0006, 0.0010}};  // white
}

}  // namespace vantage
