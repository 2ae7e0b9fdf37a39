// SPDX-License-Identifier: Apache-2.0
#include "site/site_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/parse.hpp"
#include "vantage/error.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

// A step read back from a table in degrees may differ in its last digit.
bool near(Angle a, Angle b) { return std::abs(a.in_radians() - b.in_radians()) <= 1e-12 * a.in_radians(); }

bool same(const Scanner& a, Scanner b) {
  if (!near(a.azimuth_step, b.azimuth_step) || !near(a.zenith_step, b.zenith_step)) return false;
  b.azimuth_step = a.azimuth_step, b.zenith_step = a.zenith_step;
  const auto text = [](const Setting& setting) { return setting.json; };
  return std::ranges::equal(settings(a), settings(b), {}, text, text);
}

}  // namespace

double spacing_for(const std::string& deliverable) {
  constexpr double kHalfALine_m = 1e-4;  // on paper
  constexpr Interval kScales{.low = 1, .high = 10'000};
  if (deliverable.starts_with("1:"))
    return kHalfALine_m * parse_number(deliverable.substr(2), "scale of \"" + deliverable + "\"", kScales);
  try {
    return largest_error_m(accuracy_class_from_string(deliverable));
  } catch (const Error&) {
    throw Error(Errc::invalid_argument,
                "'" + deliverable + "' is neither the scale of a drawing, such as 1:50, nor one of LOA20 to LOA50");
  }
}

TargetOptions with_class_of(const SiteOptions& site, TargetOptions target) {
  if (!target.accuracy_class && site.deliverable && !site.deliverable->starts_with("1:"))
    target.accuracy_class = accuracy_class_from_string(*site.deliverable);
  return target;
}

Scanner site_scanner(const SiteOptions& options, double scale) {
  Scanner scanner;
  scanner.height_m *= scale;
  scanner.min_range_m *= scale;
  scanner.max_range_m *= scale;
  if (options.scanner) {
    const double height = scanner.height_m;  // no preset knows the tripod
    scanner = load_scanner(*options.scanner, own_presets_file());
    scanner.height_m = height;
  }
  if (options.steps) scanner.set_steps((*options.steps)[0], (*options.steps)[1]);
  const auto take = [](auto& value, const auto& given) {
    if (given) value = *given;
  };
  take(scanner.heading, options.heading);
  take(scanner.horizontal_angle, options.horizontal_angle);
  take(scanner.vertical_angle, options.vertical_angle);
  take(scanner.zenith_start, options.zenith_start);
  take(scanner.height_m, options.height_m);
  take(scanner.points_per_second, options.points_per_second);
  if (options.range_m) {
    scanner.min_range_m = (*options.range_m)[0], scanner.max_range_m = (*options.range_m)[1];
    if (!(scanner.min_range_m < scanner.max_range_m))
      throw Error(Errc::invalid_argument, "range: the nearest distance must be below the farthest, and " +
                                              std::to_string(scanner.min_range_m) + " is not below " +
                                              std::to_string(scanner.max_range_m));
  }
  if (options.noise) scanner.noise = load_noise(*options.noise);
  if (options.beam) {
    scanner.beam_divergence = Angle::radians((*options.beam)[0] * 1e-3);
    scanner.exit_diameter_m = (*options.beam)[1] * 1e-3;
  }
  if (options.detection) {
    scanner.detection_range_m = (*options.detection)[0];
    scanner.detection_reflectivity = (*options.detection)[1];
  }
  take(scanner.dropout, options.dropout);
  if (options.battery) scanner.battery_min = (*options.battery)[0], scanner.battery_scans = (*options.battery)[1];
  if (options.calibration) {
    scanner.angle_accuracy = Angle::degrees((*options.calibration)[0] / 3600);
    scanner.range_accuracy_m = (*options.calibration)[1] * 1e-3;
    scanner.range_accuracy_ppm = (*options.calibration)[2];
  }
  scanner.check();
  return scanner;
}

std::string noise_source(const SiteOptions& options, const Scanner& scanner) {
  const std::string noise = scanner.noise.empty() ? "off"
                            : options.noise       ? *options.noise
                                                  : options.scanner.value_or("off");
  return noise.ends_with(".csv") ? std::filesystem::absolute(noise).string() : noise;
}

void detect_every_echo(Scanner& scanner) { scanner.detection_range_m = 0, scanner.detection_reflectivity = 1; }

std::uint32_t place_in(std::span<const Scanner> scanners, const Scanner& scanner) {
  scanner.check();
  const auto found = std::ranges::find_if(scanners, [&](const Scanner& known) { return same(known, scanner); });
  return static_cast<std::uint32_t>(found - scanners.begin());
}

}  // namespace vantage
