// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "core/text.hpp"
#include "report/report.hpp"
#include "report/station_facts.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

std::string degrees(const Angle& angle) { return number(std::round(1e4 * angle.in_degrees()) / 1e4) + "°"; }

// "RTC360 (6 mm), a ray every 0.0344° …".
std::string scanner_text(const Scanner& scanner) {
  const std::string every =
      scanner.one_step() ? "a ray every " + degrees(scanner.azimuth_step)
      : !scanner.directions.empty()
          ? "directions that are no grid, every " + degrees(scanner.azimuth_step) + " on average"
      : !scanner.row_zeniths.empty()
          ? std::to_string(scanner.rows()) + " uneven rows, a ray every " + degrees(scanner.azimuth_step) + " across"
          : "a ray every " + degrees(scanner.azimuth_step) + " across and " + degrees(scanner.zenith_step) + " up";
  return (scanner.name == Scanner().name ? "" : scanner.name + ": ") + every + ", " + grouped(scanner.rays()) +
         " rays a scan, head " + fixed(scanner.height_m, 2) + " m over the ground, range " +
         number(scanner.min_range_m) + " to " + number(scanner.max_range_m) + " m, " + describe(scanner.noise);
}

std::string stations_text(const Evaluation& network) {
  const std::size_t existing = existing_count(network.stations);
  const auto left_out = std::ranges::count_if(network.stations, [](const PlacedStation& s) { return !active(s); });
  std::string text =
      std::to_string(network.stations.size()) + (network.stations.size() == 1 ? " station" : " stations");
  if (existing > 0) text += ", " + std::to_string(existing) + " of them there already";
  if (left_out > 0) text += ", " + std::to_string(left_out) + " left out for want of a place to stand";
  return text;
}

std::string time_text(const Visit& visit) {
  Round all = visit;
  double waiting = 0;
  if (!visit.sessions.empty()) {
    all = {};
    for (const Session& one : visit.sessions) {
      all.scan_min += one.scan_min, all.set_up_min += one.set_up_min, all.photos_min += one.photos_min;
      all.walk_m += one.walk_m, all.walk_min += one.walk_min, all.minutes += one.minutes, waiting += one.waiting_min;
    }
  }
  return "scans " + minutes_text(all.scan_min) + ", setting up " + minutes_text(all.set_up_min) +
         (all.photos_min > 0 ? ", photos " + minutes_text(all.photos_min) : "") + ", walking " +
         minutes_text(all.walk_min) + " (" + fixed(all.walk_m, 0) + " m)" +
         (waiting > 0 ? ", waiting " + minutes_text(waiting) : "") + ": " + minutes_text(all.minutes) + " in all";
}

// Returns the time of each scanner in use for one station.
std::string each_text(const Evaluation& network, std::span<const Scanner> scanners) {
  const Visit& visit = *network.visit;
  const auto stops = static_cast<double>(std::max<std::size_t>(1, visit.order.size()));
  std::string text;
  for (std::size_t k = 0; k < scanners.size(); ++k) {
    const bool used =
        std::ranges::any_of(network.stations, [&](const PlacedStation& s) { return s.setup.scanner == k; });
    if (!used) continue;
    const double scan = scanners[k].seconds() / 60;
    const double rest = (visit.set_up_min + visit.photos_min) / stops;
    text += (text.empty() ? "" : "; ") + (scanners.size() > 1 ? scanners[k].name + ": " : std::string()) +
            minutes_text(scan + rest) + ": scan " + minutes_text(scan) + ", setting up " +
            minutes_text(visit.set_up_min / stops) +
            (visit.photos_min > 0 ? ", photos " + minutes_text(visit.photos_min / stops) : "");
  }
  return text;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> report_facts(const Report& report, const Simulator& simulator) {
  const Evaluation& network = report.shown();
  std::vector<std::pair<std::string, std::string>> facts;
  for (const Scanner& scanner : simulator.scanners()) facts.emplace_back("scanner", scanner_text(scanner));
  facts.emplace_back("stations", stations_text(network));
  if (network.visit && !network.visit->order.empty()) {
    facts.emplace_back("at each", each_text(network, simulator.scanners()));
    facts.emplace_back("in all", time_text(*network.visit));
  }
  const SimulatorConfig& config = simulator.config();
  const double goal = std::round(10 * simulator.goal_density()) / 10;
  std::string checked = "surfaces are checked in cells of " + fixed(100 * simulator.voxel_size_m(), 1) +
                        " cm; each is captured with " + number(goal) + (goal == 1 ? " point" : " points");
  if (simulator.max_incidence())
    checked += "; points that meet the surface at more than " + degrees(*simulator.max_incidence()) + " do not count";
  facts.emplace_back("captured is", checked);
  facts.emplace_back("coordinates",
                     (report.crs.empty() ? "survey frame of the model, metres" : report.crs + ", metres") +
                         std::string("; x, y, z of the ground under the tripod"));
  facts.emplace_back("computed", "vantage " + std::string(version()) + ", seed " + std::to_string(config.seed));
  return facts;
}

}  // namespace vantage
