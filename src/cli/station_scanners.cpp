// SPDX-License-Identifier: Apache-2.0
#include "cli/station_scanners.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/command.hpp"

namespace vantage::cli {
namespace {

// Points fill a field of view except near its edge. A larger difference was set, or comes from the sky.
constexpr double kNarrower_deg = 10, kWider_deg = 2;
// Steps differ by less if they are the same setting.
constexpr double kSameStep = 0.02;

// Letters and digits alone, without a setting: makers and programs write names of models in many ways.
std::string model(std::string_view name) {
  std::string letters;
  for (const char c : name.substr(0, name.find('@')))
    if (std::isalnum(static_cast<unsigned char>(c))) letters += static_cast<char>(std::tolower(c));
  return letters;
}

// Key of the preset that a file calls `sensor`; empty if there is none.
std::string preset_called(const std::string& sensor) {
  const std::string wanted = model(sensor);
  if (std::ranges::none_of(wanted, [](unsigned char c) { return std::isalpha(c); })) return {};
  for (const ScannerPreset& preset : list_scanners(own_presets_file())) {
    const std::string name = model(load_scanner(preset.key, own_presets_file()).name), key = model(preset.key);
    if (wanted == key || name.ends_with(wanted) || wanted.ends_with(name) || (key.size() > 2 && wanted.ends_with(key)))
      return preset.key;
  }
  return {};
}

bool same_step(Angle a, Angle b) { return std::abs(a.in_radians() / b.in_radians() - 1) <= kSameStep; }

std::string degrees(Angle angle) { return fmt::format("{:.4g}°", angle.in_degrees()); }

// Settings of a scan where they are not those of `base`.
void take_settings(StationText& station, const importers::TakenSettings& scan, const Scanner& base) {
  if (scan.steps) {
    const auto [azimuth, zenith] = *scan.steps;
    if (!same_step(azimuth, base.azimuth_step) || !same_step(zenith, base.zenith_step)) {
      station.step = azimuth;
      if (!same_step(azimuth, zenith)) station.view.zenith_step = zenith;
    }
  }
  // The axis of a tilted scanner takes its heading, so that a part of a turn has none.
  const double sweep = scan.sweep.in_degrees(), turn = base.horizontal_angle.in_degrees();
  if (station.setup.tilt == Angle() && (sweep < turn - kNarrower_deg || sweep > turn + kWider_deg)) {
    station.view.horizontal = scan.sweep;
    const double heading = station.setup.heading.in_degrees() + scan.sweep_middle.in_degrees();
    station.setup.heading = Angle::degrees(std::remainder(heading - base.heading.in_degrees(), 360));
  }
  double first = base.zenith_start.in_degrees(), last = first + base.vertical_angle.in_degrees() / 2;
  const double top = scan.zeniths[0].in_degrees(), bottom = scan.zeniths[1].in_degrees();
  const bool other_top = top > first + kNarrower_deg || top < first - kWider_deg;
  const bool other_bottom = bottom < last - kNarrower_deg || bottom > last + kWider_deg;
  if (other_top) first = top;
  if (other_bottom) last = bottom;
  if (other_top || other_bottom)
    station.view.zenith_start = Angle::degrees(first), station.view.vertical = Angle::degrees(2 * (last - first));
  // Points show that the scanner reaches them, but not its range.
  if (scan.range_m[0] < base.min_range_m) station.view.nearest_m = scan.range_m[0];
  if (scan.range_m[1] > base.max_range_m) station.view.farthest_m = scan.range_m[1];
}

Scanner scanner_text(Site& site, const StationText& station) {
  Scanner scanner = site.scanner();
  if (!station.scanner.empty() && station.scanner != scanner.name) {
    const double height = scanner.height_m;
    scanner = load_scanner(station.scanner, own_presets_file());
    scanner.height_m = height;
  }
  const auto take = [](auto& value, const auto& given) {
    if (given) value = *given;
  };
  if (station.step || station.view.zenith_step) {
    const Angle azimuth = station.step.value_or(scanner.azimuth_step),
                zenith = station.step.value_or(scanner.zenith_step);
    scanner.set_steps(azimuth, station.view.zenith_step.value_or(zenith));
  }
  take(scanner.horizontal_angle, station.view.horizontal), take(scanner.vertical_angle, station.view.vertical);
  take(scanner.zenith_start, station.view.zenith_start);
  take(scanner.min_range_m, station.view.nearest_m), take(scanner.max_range_m, station.view.farthest_m);
  return scanner;
}

std::string quoted(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kNamed); ++k) text += (k > 0 ? ", \"" : "\"") + names[k] + "\"";
  return names.size() > kNamed ? text + fmt::format(" and {} more", names.size() - kNamed) : text;
}

// Names of scans by the values that their file lacks, and of the scanners that are assumed.
struct Assumed {
  std::vector<std::string> unknown, stepless, by_density, bases;

  std::string text(const std::string& file, const std::string& own) const {
    std::string text = file + " tells neither range limits nor noise: those of " + quoted(bases) + " are assumed";
    if (!unknown.empty())
      text += fmt::format("; no scanner here is called {}, so the plan's own, {}, counts", quoted(unknown), own);
    if (!stepless.empty()) text += "; so few points tell no step, and the scanner's is assumed: " + quoted(stepless);
    if (!by_density.empty()) text += "; steps by the density of points: " + quoted(by_density);
    return text;
  }
};

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

}  // namespace

std::uint32_t scanner_of(Site& site, const StationText& station) { return site.place_of(scanner_text(site, station)); }

std::vector<StationText> stations_of_scans(Site& site, const std::string& file, Program& program) {
  std::vector<importers::TakenScan> scans;
  {
    ProgressLine line(program.console, "reading scans");
    scans = importers::taken_scans(file, {.report = [&](double done) { line.update(done); }, .stop = program.stop});
  }
  if (scans.empty()) throw Stopped{};
  std::vector<StationText> stations;
  Assumed assumed;
  for (const importers::TakenScan& scan : scans) {
    StationText station{.position = scan.head, .name = scan.name, .setup = scan.setup};
    const std::string preset = preset_called(scan.sensor);
    // The site's own may have been set in another way than its preset.
    if (!preset.empty() && model(load_scanner(preset, own_presets_file()).name) != model(site.scanner().name))
      station.scanner = preset;
    const Scanner base = scanner_text(site, station);
    if (scan.settings) take_settings(station, *scan.settings, base);
    const Scanner scanner = scanner_text(site, station);
    if (preset.empty()) add_once(assumed.unknown, scan.sensor.empty() ? scan.name : scan.sensor);
    if (!scan.settings || !scan.settings->steps)
      assumed.stepless.push_back(scan.name);
    else if (!scan.settings->steps_by_grid)
      assumed.by_density.push_back(scan.name);
    add_once(assumed.bases, base.name);
    const std::string steps = scanner.azimuth_step == scanner.zenith_step
                                  ? degrees(scanner.azimuth_step)
                                  : degrees(scanner.azimuth_step) + " × " + degrees(scanner.zenith_step);
    spdlog::info("existing \"{}\" at {:.3f},{:.3f},{:.3f}: {}, every {}, {} around, zenith {} to {}", scan.name,
                 scan.head.x, scan.head.y, scan.head.z, scanner.name, steps, degrees(scanner.horizontal_angle),
                 degrees(scanner.zenith_start),
                 degrees(Angle::degrees(scanner.zenith_start.in_degrees() + scanner.vertical_angle.in_degrees() / 2)));
    stations.push_back(std::move(station));
  }
  spdlog::info("{}", assumed.text(file, site.scanner().name));
  return stations;
}

}  // namespace vantage::cli
