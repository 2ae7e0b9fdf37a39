// SPDX-License-Identifier: Apache-2.0
#include "evaluate/sight_targets.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

#include "core/parse.hpp"
#include "core/site_reach.hpp"
#include "evaluate/field_of_view.hpp"
#include "scan/noise_model.hpp"
#include "vantage/error.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

constexpr double kDiffuse = 0.8;  // of spheres and checkerboards, which are made white

struct ClassBound {
  const char* name;
  double error_m;
};
constexpr std::array<ClassBound, 4> kClasses{{{"LOA20", 0.05}, {"LOA30", 0.015}, {"LOA40", 0.005}, {"LOA50", 0.001}}};

// On a target at the scanner's own height.
double points_at(const Scanner& scanner, double range, const TargetOptions& options) {
  const double disc = std::numbers::pi / 4 * options.diameter_m * options.diameter_m;
  return disc / (range * range * scanner.azimuth_step.in_radians() * scanner.zenith_step.in_radians());
}

// Repeated centres of the field check of docs/scanners.md differ by 0.04 and 0.05 mm, and by 0.3 mm between two
// stations once the vertical index is known: 0.2 mm each.
constexpr double kFitted_m = 0.0002;
constexpr double kFittedByUnknown_m = 0.001;  // by a scanner that does not state the rest; assumed

// A target's centre in the scan of a station; empty if the scan does not measure it.
std::optional<RegistrationTarget::Sighting> sighting_of(const Scanner& scanner, const PlacedStation& station,
                                                        std::size_t place, const Vec3& centre,
                                                        const TargetOptions& options) {
  const Vec3 level = centre - station.position;
  const std::array<Vec3, 3> turn = station.setup.survey_from_scanner();
  const Vec3 line = turn[0] * level.x + turn[1] * level.y + turn[2] * level.z;  // in the scanner's frame
  const double range = std::sqrt(dot(line, line));
  if (range < scanner.min_range_m || range > scanner.max_range_m) return std::nullopt;
  if (!in_field_of_view(scanner, line, range)) return std::nullopt;
  const double sin_zenith = std::sqrt(std::max(line.x * line.x + line.y * line.y, 1e-12)) / range;
  const double disc = std::numbers::pi / 4 * options.diameter_m * options.diameter_m;
  const double points =
      disc / (range * range * scanner.azimuth_step.in_radians() * scanner.zenith_step.in_radians() * sin_zenith);
  if (points < static_cast<double>(options.least_points)) return std::nullopt;
  const bool stated = scanner.angle_accuracy.in_radians() > 0 && scanner.range_accuracy_m > 0;
  const double fitted = options.sigma_m.value_or(stated ? kFitted_m : kFittedByUnknown_m),
               noise = table_sigma(scanner.noise, range, kDiffuse),
               variance = fitted * fitted + 3 * noise * noise / points;
  const double angle = scanner.angle_accuracy.in_radians() * range, scale = scanner.range_accuracy_ppm * 1e-6 * range;
  return RegistrationTarget::Sighting{
      place, std::sqrt(variance + angle * angle),
      std::sqrt(variance + scanner.range_accuracy_m * scanner.range_accuracy_m + scale * scale)};
}

}  // namespace

std::string to_string(AccuracyClass accuracy) { return kClasses[static_cast<std::size_t>(accuracy)].name; }

AccuracyClass accuracy_class_from_string(const std::string& text) {
  std::string upper = text;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (std::size_t k = 0; k < kClasses.size(); ++k)
    if (upper == kClasses[k].name) return static_cast<AccuracyClass>(k);
  throw Error(Errc::invalid_argument, "'" + text + "' is no class of accuracy: LOA20, LOA30, LOA40 or LOA50");
}

double largest_error_m(AccuracyClass accuracy) noexcept { return kClasses[static_cast<std::size_t>(accuracy)].error_m; }

double error_at_95_percent(double rms_m) noexcept { return 1.96 * rms_m; }

AccuracyClass wanted_class(const TargetOptions& options) noexcept {
  return options.accuracy_class.value_or(AccuracyClass::loa30);
}

double allowed_rms_m(const TargetOptions& options) {
  const double by_class = largest_error_m(wanted_class(options)) / error_at_95_percent(1);
  return options.largest_rms_m ? std::min(by_class, *options.largest_rms_m) : by_class;
}

double target_reach_m(const Scanner& scanner, const TargetOptions& options) {
  check(options);
  const double points = std::max(static_cast<double>(options.least_points), 1.0);
  return std::min(std::sqrt(points_at(scanner, 1, options) / points), scanner.max_range_m);
}

bool any_ties(std::span<const Target> targets) noexcept {
  return !std::ranges::all_of(targets, [](const Target& target) { return target.check; });
}

void check(const Target& target, const Vec3& origin) {
  require_in_reach(target.centre, origin, "target \"" + target.name + "\" is");
  check_number(target.control_m, "targets: the sigma of " + target.name, kAnyShare);
}

std::vector<RegistrationTarget> sight_targets(const Simulator& simulator, const ClashChecker& clash,
                                              std::span<const PlacedStation> stations, std::vector<Target>& targets,
                                              const TargetOptions& options) {
  check(options);
  std::vector<RegistrationTarget> sighted;
  for (Target& target : targets) {
    check(target, simulator.origin());
    RegistrationTarget one{.centre = target.centre - simulator.origin(), .control_m = target.control_m};
    target.stations.clear();
    for (std::size_t k = 0; k < stations.size(); ++k) {
      if (!active(stations[k])) continue;
      const Scanner& scanner = simulator.scanners()[stations[k].setup.scanner];
      const auto sighting = sighting_of(scanner, stations[k], k, target.centre, options);
      if (!sighting || !clash.sees(stations[k].position, target.centre)) continue;
      one.seen_by.push_back(*sighting);
      target.stations.push_back(k);
    }
    sighted.push_back(std::move(one));
  }
  return sighted;
}

}  // namespace vantage
