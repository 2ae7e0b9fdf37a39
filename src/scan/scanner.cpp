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

constexpr double kFloorGuard = 1e-9;      // makes 360° / 0.1° 3600 and not 3599
constexpr double kAngleGuard_deg = 1e-9;  // 360° given in radians may exceed 360° by rounding
constexpr double kStepGuard = 1e-9;       // of a mean step that was written in degrees
constexpr double kMaxSteps = 16'777'216;  // 2^24 per direction: 0.00002° over a full turn

double steps(Angle sweep, Angle step) { return std::floor(sweep.in_radians() / step.in_radians() + kFloorGuard); }

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
  if (count > kMaxSteps) refuse(member + " in degrees", degrees, "so large that there are at most 2^24 steps");
}

// Returns the azimuth from the middle of the sweep, within half a turn.
double from_middle(const RayAngles& angles) {
  const double azimuth = angles.azimuth.in_radians();
  return std::abs(azimuth) <= std::numbers::pi ? azimuth : std::remainder(azimuth, 2 * std::numbers::pi);
}

// Least and largest zenith, and the largest distance of an azimuth from the middle of the sweep, in radians.
struct ListedField {
  double first = std::numbers::pi, last = 0, aside = 0;
};
ListedField field_of(const std::vector<RayAngles>& directions) {
  ListedField field;
  for (const RayAngles& angles : directions) {
    field.first = std::min(field.first, angles.zenith.in_radians());
    field.last = std::max(field.last, angles.zenith.in_radians());
    field.aside = std::max(field.aside, std::abs(from_middle(angles)));
  }
  return field;
}

// Returns the step of a grid with as many rays in the same field.
double listed_step(const std::vector<RayAngles>& directions) {
  constexpr double kNarrowest = 1e-4;  // radians; for fields that are a line or a point
  const ListedField field = field_of(directions);
  const double tall = std::max(field.last - field.first, kNarrowest), wide = std::max(2 * field.aside, kNarrowest);
  return std::min({std::sqrt(tall * wide / static_cast<double>(directions.size())), tall, wide});
}

void check_directions(const Scanner& scanner) {
  const std::vector<RayAngles>& directions = scanner.directions;
  if (!scanner.row_zeniths.empty())
    throw Error(Errc::invalid_argument,
                "scanner: there are both directions and row_zeniths, but only one may be given");
  if (static_cast<double>(directions.size()) > kMaxSteps)
    refuse("the number of directions", static_cast<double>(directions.size()), "at most 2^24");
  if (!scanner.times_s.empty() && scanner.times_s.size() != directions.size())
    refuse("the number of times_s", static_cast<double>(scanner.times_s.size()),
           "that of directions, " + std::to_string(directions.size()) + ", or 0");
  const auto member = [](const char* name, std::size_t k) { return name + ("[" + std::to_string(k) + "]"); };
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const double zenith = directions[k].zenith.in_degrees(), azimuth = directions[k].azimuth.in_degrees();
    if (!(zenith >= 0 && zenith <= 180 + kAngleGuard_deg))
      refuse(member("directions", k) + ": zenith in degrees", zenith, "from 0 to 180");
    if (!(azimuth >= -360 - kAngleGuard_deg && azimuth <= 360 + kAngleGuard_deg))
      refuse(member("directions", k) + ": azimuth in degrees", azimuth, "from -360 to 360");
  }
  for (std::size_t k = 0; k < scanner.times_s.size(); ++k) {
    const double time = scanner.times_s[k], before = k > 0 ? scanner.times_s[k - 1] : 0;
    if (!(std::isfinite(time) && time >= before))
      refuse(member("times_s", k), time, "finite and at least the time before it, " + ten_digits(before));
  }
  const double step = listed_step(directions);
  for (const Angle& own : {scanner.azimuth_step, scanner.zenith_step})
    if (!(std::abs(own.in_radians() / step - 1) <= kStepGuard))
      refuse("a step in degrees", own.in_degrees(),
             "the mean step of directions, " + ten_digits(step * 180 / std::numbers::pi) +
                 ", as set_directions() sets it");
  const ListedField field = field_of(directions);
  const double first = scanner.zenith_start.in_radians(), last = first + scanner.vertical_angle.in_radians() / 2;
  if (field.first < first - kAngleGuard_deg || field.last > last + kAngleGuard_deg ||
      2 * field.aside > scanner.horizontal_angle.in_radians() + kAngleGuard_deg)
    throw Error(Errc::invalid_argument, "scanner: directions must lie in the field, which set_directions() sets");
}

// Returns the mean step of rows that are not all one step apart.
double mean_step(const std::vector<Angle>& rows) {
  return (rows.back().in_radians() - rows.front().in_radians()) / static_cast<double>(rows.size() - 1);
}

void check_rows(const Scanner& scanner) {
  const std::vector<Angle>& rows = scanner.row_zeniths;
  if (static_cast<double>(rows.size()) > kMaxSteps)
    refuse("the number of row_zeniths", static_cast<double>(rows.size()), "at most 2^24");
  const double first = scanner.zenith_start.in_degrees(), last = first + scanner.vertical_angle.in_degrees() / 2;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double zenith = rows[i].in_degrees();
    const std::string member = "row_zeniths[" + std::to_string(i) + "] in degrees";
    if (!(zenith >= 0 && zenith <= 180 + kAngleGuard_deg)) refuse(member, zenith, "from 0 to 180");
    if (i > 0 && !(rows[i - 1] < rows[i]))
      refuse(member, zenith, "above the zenith before it, " + ten_digits(rows[i - 1].in_degrees()));
  }
  if (rows.front().in_degrees() < first - kAngleGuard_deg || rows.back().in_degrees() > last + kAngleGuard_deg)
    throw Error(Errc::invalid_argument, "scanner: row_zeniths from " + ten_digits(rows.front().in_degrees()) + " to " +
                                            ten_digits(rows.back().in_degrees()) +
                                            " degrees must lie in the vertical field, " + ten_digits(first) + " to " +
                                            ten_digits(last) + ", which set_row_zeniths() sets");
  if (rows.size() > 1 && !(std::abs(mean_step(rows) / scanner.zenith_step.in_radians() - 1) <= kStepGuard))
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
  if (!directions.empty()) return static_cast<std::uint32_t>(directions.size());
  return row_zeniths.empty() ? static_cast<std::uint32_t>(steps(zenith_sweep(*this), zenith_step))
                             : static_cast<std::uint32_t>(row_zeniths.size());
}

std::uint32_t Scanner::columns() const {
  return directions.empty() ? static_cast<std::uint32_t>(steps(horizontal_angle, azimuth_step)) : 1;
}

RayAngles Scanner::angles(std::uint64_t ray) const {
  if (!directions.empty())
    return {directions[ray].zenith, Angle::radians(heading.in_radians() + directions[ray].azimuth.in_radians())};
  const double row = static_cast<double>(ray / columns()), column = static_cast<double>(ray % columns());
  return {row_zeniths.empty() ? Angle::radians(zenith_start.in_radians() + (row + 0.5) * zenith_step.in_radians())
                              : row_zeniths[ray / columns()],
          Angle::radians(heading.in_radians() - 0.5 * horizontal_angle.in_radians() +
                         (column + 0.5) * azimuth_step.in_radians())};
}

double Scanner::time_s(std::uint64_t ray) const {
  return times_s.empty() ? static_cast<double>(ray) / points_per_second : times_s[ray];
}

double Scanner::seconds() const {
  return times_s.empty() ? static_cast<double>(rays()) / points_per_second : times_s.back();
}

void Scanner::set_steps(Angle azimuth, Angle zenith) {
  if (!directions.empty())
    throw Error(Errc::invalid_argument, "the scanner \"" + name + "\" has a list of directions, which have no step");
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

void Scanner::set_directions(std::vector<RayAngles> taken, std::vector<double> taken_s) {
  directions = std::move(taken), times_s = std::move(taken_s);
  if (directions.empty()) return;
  const ListedField field = field_of(directions);
  const double step = listed_step(directions), tall = std::max(field.last - field.first, step),
               wide = std::max(2 * field.aside, step);
  zenith_start = Angle::radians(std::clamp(field.first, 0.0, std::numbers::pi - tall));
  vertical_angle = Angle::radians(2 * tall), horizontal_angle = Angle::radians(wide);
  azimuth_step = zenith_step = Angle::radians(step);
}

void Scanner::check() const {
  if (!std::isfinite(heading.in_degrees())) refuse("heading in degrees", heading.in_degrees(), "finite");
  if (directions.empty() && !times_s.empty())
    refuse("the number of times_s", static_cast<double>(times_s.size()), "0 without directions");
  if (!directions.empty()) check_directions(*this);
  if (!row_zeniths.empty()) check_rows(*this);
  const double horizontal = horizontal_angle.in_degrees(), vertical = vertical_angle.in_degrees();
  if (!(horizontal > 0 && horizontal <= 360 + kAngleGuard_deg))
    refuse("horizontal_angle in degrees", horizontal, "in (0, 360]");
  if (!(vertical > 0 && vertical <= 360 + kAngleGuard_deg))
    refuse("vertical_angle in degrees", vertical, "in (0, 360]");
  const double start = zenith_start.in_degrees();
  if (!(start >= 0 && start + vertical / 2 <= 180 + kAngleGuard_deg))
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
  if (!(dropout >= 0 && dropout < 1)) refuse("dropout", dropout, "from 0 to below 1");
  const double arcsec = angle_accuracy.in_degrees() * 3600;
  if (!(arcsec >= 0 && arcsec <= 3600)) refuse("angle_accuracy in arc seconds", arcsec, "from 0 to 3600");
  if (!(range_accuracy_m >= 0 && range_accuracy_m <= 1)) refuse("range_accuracy_m", range_accuracy_m, "from 0 to 1");
  if (!(range_accuracy_ppm >= 0 && range_accuracy_ppm <= 10'000))
    refuse("range_accuracy_ppm", range_accuracy_ppm, "from 0 to 10000");
  const double tilt_arcsec = tilt_accuracy.in_degrees() * 3600;
  if (!(tilt_arcsec >= 0 && tilt_arcsec <= 18'000))
    refuse("tilt_accuracy in arc seconds", tilt_arcsec, "from 0 to 18000");
  check_number(points_per_second, "scanner: points_per_second", kMeasurable);
  const auto check_battery = [](double lasts, const char* what) {
    if (lasts != 0 && !(lasts >= 1 && lasts <= 1e6)) refuse(what, lasts, "0, or from 1 to 1e6");
  };
  check_battery(battery_min, "battery_min");
  check_battery(battery_scans, "battery_scans");
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
