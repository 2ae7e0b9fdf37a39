// SPDX-License-Identifier: Apache-2.0
#include "cli/station_scanners.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vantage::cli {
namespace {

// A step that went through a table of degrees and back may differ in its last digit.
bool near(Angle a, Angle b) { return std::abs(a.in_radians() - b.in_radians()) <= 1e-12 * a.in_radians(); }

bool same(const Scanner& a, Scanner b) {
  if (!near(a.azimuth_step, b.azimuth_step) || !near(a.zenith_step, b.zenith_step)) return false;
  b.azimuth_step = a.azimuth_step, b.zenith_step = a.zenith_step;
  const auto text = [](const Setting& setting) { return setting.json; };
  return std::ranges::equal(settings(a), settings(b), {}, text, text);
}

std::uint32_t place_in(std::vector<Scanner>& scanners, const Scanner& scanner) {
  scanner.check();
  const auto found = std::ranges::find_if(scanners, [&](const Scanner& known) { return same(known, scanner); });
  const auto place = static_cast<std::uint32_t>(found - scanners.begin());
  if (found == scanners.end()) scanners.push_back(scanner);
  return place;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::uint32_t scanner_of(LoadedSite& site, const std::string& name, std::optional<Angle> step) {
  Scanner scanner = site.scanner;
  if (!name.empty() && name != site.scanner.name) {
    scanner = load_scanner(name, own_presets_file());
    scanner.height_m = site.scanner.height_m;
  }
  if (step) scanner.azimuth_step = scanner.zenith_step = *step;
  return place_in(site.scanners, scanner);
}

std::vector<std::uint32_t> scanners_with(LoadedSite& site, const std::string& site_preset,
                                         std::span<const std::string> steps) {
  std::vector<std::uint32_t> places;
  for (const std::string& step : steps) {
    Scanner scanner = site.scanner;
    if (const auto degrees = number_of(step)) {
      scanner.azimuth_step = scanner.zenith_step = Angle::degrees(*degrees);
    } else if (site_preset.empty()) {
      throw Error(Errc::invalid_argument,
                  "--search-step: '" + step + "' is no number of degrees; settings by name go with --scanner PRESET");
    } else {
      const Scanner preset =
          load_scanner(site_preset.substr(0, site_preset.find('@')) + "@" + step, own_presets_file());
      scanner.name = preset.name;
      scanner.azimuth_step = preset.azimuth_step, scanner.zenith_step = preset.zenith_step;
      scanner.points_per_second = preset.points_per_second;
    }
    const std::uint32_t place = place_in(site.scanners, scanner);
    if (std::ranges::count(places, place) > 0)
      throw Error(Errc::invalid_argument, "--search-step: '" + step + "' is there twice");
    places.push_back(place);
  }
  return places;
}

}  // namespace vantage::cli
