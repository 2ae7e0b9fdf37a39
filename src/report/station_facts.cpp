// SPDX-License-Identifier: Apache-2.0
#include "report/station_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/first_numbers.hpp"
#include "core/text.hpp"
#include "evaluate/known_points.hpp"
#include "map/section.hpp"
#include "report/coverage_cells.hpp"
#include "report/place_names.hpp"

namespace vantage {
namespace {

// Height of walls over the ground, and step of heights at which they are searched: stations within one share a search.
constexpr double kWall_m = 1.2, kHeights_m = 0.5;
// Walls that reach this much higher, over ground or target, are fixed: cars and most furniture are lower.
constexpr double kOverWall_m = 0.8, kOverTarget_m = 0.4;
constexpr std::uint64_t kSeen = 400'000;  // voxels in the sample for shares

void add_round(std::vector<StationFacts>& facts, const Evaluation& network) {
  std::size_t visited = 0;
  for (const SheetRound& one : sheet_rounds(network)) {
    if (!one.round) continue;
    for (std::size_t k = 0; k < one.round->order.size(); ++k) {
      StationFacts& f = facts[one.stations[k]];
      f.visit = ++visited, f.stop = k + 1, f.walk_m = one.round->legs_m[k];
      f.done_min = one.round->arrive_min[k] + one.round->stay_min[k];
      if (one.start_min) f.done_at = clock_text(*one.start_min + f.done_min);
    }
  }
}

// Field software registers a scan to the one before by default. The first scan of a session has none before it.
void add_register_to(std::vector<StationFacts>& facts, const Evaluation& network) {
  const std::optional<StationLinks> links = network.links();
  if (!links) return;
  const auto linked = [&](std::size_t a, std::size_t b) {
    return links->values(a, b) > 0 && links->values(a, b) >= links->least;
  };
  std::vector<std::size_t> before;
  for (std::size_t k = 0; k < facts.size(); ++k)
    if (network.stations[k].existing && active(network.stations[k])) before.push_back(k);
  for (const std::size_t k : visiting_order(facts)) {
    if (facts[k].visit == 0) continue;
    const bool begins = facts[k].stop == 1 && facts[k].visit > 1;
    if (!before.empty() && (begins || !linked(before.back(), k))) {
      const std::size_t strongest =
          *std::ranges::max_element(before, {}, [&](std::size_t other) { return links->values(other, k); });
      facts[k].register_to =
          linked(strongest, k) ? "register to " + facts[strongest].name : "no link to a station before it";
    }
    before.push_back(k);
  }
}

// Finds the corners of each spot in plan, among walls at nearly its height; none for a spot that is not a number.
std::vector<std::vector<WallCorner>> corners_of(std::span<const Vec3> spots, double stays_m, const SceneData& scene) {
  std::map<long, std::vector<std::size_t>> by_height;
  for (std::size_t k = 0; k < spots.size(); ++k)
    if (std::isfinite(spots[k].z)) by_height[std::lround(spots[k].z / kHeights_m)].push_back(k);
  std::vector<std::vector<WallCorner>> found(spots.size());
  for (const auto& [height, here] : by_height) {
    Box box;
    for (const std::size_t k : here) box.extend(spots[k]);
    const auto lines_at = [&](double z) {
      std::vector<std::array<Vec3, 2>> lines = section_lines(scene, z);
      std::erase_if(lines, [&](const std::array<Vec3, 2>& line) {
        const auto [low, high] = std::minmax({line[0].x, line[1].x});
        const auto [south, north] = std::minmax({line[0].y, line[1].y});
        return high < box.min.x - WallCorners::kReach_m || low > box.max.x + WallCorners::kReach_m ||
               north < box.min.y - WallCorners::kReach_m || south > box.max.y + WallCorners::kReach_m;
      });
      return lines;
    };
    const double z = static_cast<double>(height) * kHeights_m;
    const WallCorners corners(lines_at(z), lines_at(z + stays_m));
    for (const std::size_t k : here) found[k] = corners.nearest(spots[k].x, spots[k].y);
  }
  return found;
}

void add_corners(std::vector<StationFacts>& facts, std::span<const PlacedStation> stations, const SceneData& scene) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> spots;
  for (const PlacedStation& s : stations)  // others are not set up
    spots.push_back(active(s) ? s.ground + Vec3{0, 0, kWall_m} : Vec3{kNone, kNone, kNone});
  const auto corners = corners_of(spots, kOverWall_m, scene);
  for (std::size_t k = 0; k < facts.size(); ++k) facts[k].corners = corners[k];
}

void add_alone(std::vector<StationFacts>& facts, const VoxelField* field, const Simulator& simulator) {
  if (!field || field->stations.empty() || simulator.voxel_count() == 0) return;
  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(std::min(kSeen, simulator.voxel_count()));
  std::vector<std::uint32_t> alone, seer;
  for (const std::uint32_t voxel : sample) {
    const Seer by = seer_of(*field, voxel);
    if (by == 0 || by == kSeveralStations || by > facts.size()) continue;
    alone.push_back(voxel), seer.push_back(by - 1u);
  }
  const PlaceNames names(simulator.scene());
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(alone);
  std::vector<std::map<std::string, std::size_t>> where(facts.size());
  for (std::size_t i = 0; i < alone.size(); ++i) ++where[seer[i]][names.of(patches[i])];
  for (std::size_t k = 0; k < facts.size(); ++k) {
    std::vector<std::pair<std::size_t, std::string>> places;
    std::size_t all = 0;
    for (const auto& [name, count] : where[k]) places.emplace_back(count, name), all += count;
    std::ranges::stable_sort(places, std::ranges::greater{}, [](const auto& place) { return place.first; });
    facts[k].alone = static_cast<double>(all) / static_cast<double>(sample.size());
    constexpr std::size_t kNamed = 2;
    for (std::size_t p = 0; p < std::min(kNamed, places.size()); ++p)
      facts[k].alone_where += (p > 0 ? ", " : "") + places[p].second;
  }
}

}  // namespace

std::vector<StationFacts> station_facts(const Report& report, const Simulator& simulator) {
  const Evaluation& network = report.shown();
  std::vector<StationFacts> facts;
  for (const std::string& name : station_names(network.stations, network.names)) facts.push_back({.name = name});
  for (std::size_t k = 0; k < facts.size(); ++k) {
    const PlacedStation& s = network.stations[k];
    facts[k].note = s.existing                        ? "there before"
                    : s.status == StationStatus::hole ? "no ground"
                    : active(s)                       ? ""
                                                      : "left out";
  }
  for (const Target& target : network.targets)
    for (const std::size_t k : target.stations)
      facts[k].targets += (facts[k].targets.empty() ? "" : ", ") + target.name;
  const std::vector<KnownPoints> known = known_points(network);
  for (std::size_t k = 0; k < known.size(); ++k)
    if (may_be_set_up(known[k])) facts[k].set_up = set_up_text(known[k], network);
  add_round(facts, network);
  add_register_to(facts, network);
  add_corners(facts, network.stations, simulator.scene().data());
  add_alone(facts, report.options.field, simulator);
  return facts;
}

std::vector<TargetFacts> target_facts(const Report& report, const Simulator& simulator) {
  const Evaluation& network = report.shown();
  const std::vector<std::string> names = station_names(network.stations, network.names);
  std::vector<Vec3> spots;
  for (const Target& target : network.targets) spots.push_back(target.centre);
  const auto corners = corners_of(spots, kOverTarget_m, simulator.scene().data());
  std::vector<TargetFacts> facts;
  for (std::size_t k = 0; k < network.targets.size(); ++k) {
    const Target& target = network.targets[k];
    TargetFacts& one = facts.emplace_back(TargetFacts{.corners = corners[k]});
    one.kind = target.check           ? "check of the vertical index"
               : target.proposed      ? "proposed"
               : target.control_m > 0 ? "± " + number(1000 * target.control_m) + " mm"
                                      : "there before";
    for (const std::size_t station : target.stations) {
      const Vec3 away = target.centre - network.stations[station].position;
      one.stations += (one.stations.empty() ? "" : ", ") + names[station] + " " + fixed(std::hypot(away.x, away.y), 2);
    }
  }
  return facts;
}

std::vector<SheetRound> sheet_rounds(const Evaluation& network) {
  const std::size_t existing = existing_count(network.stations);
  const auto of = [&](const Round& round, std::string name) {
    SheetRound one{.round = &round, .name = std::move(name)};
    for (const std::size_t station : round.order) one.stations.push_back(existing + station);
    return one;
  };
  if (!network.visit) return {SheetRound{}};
  if (network.visit->sessions.empty()) return {of(*network.visit, "")};
  std::vector<SheetRound> rounds;
  for (const Session& session : network.visit->sessions) {
    rounds.push_back(of(session, "Day " + std::to_string(session.day) + ", crew " + std::to_string(session.crew)));
    rounds.back().start_min = session.start_min;
  }
  return rounds;
}

std::string session_links(const Session& session, const Evaluation& network) {
  if (network.overlap_matrix.size() == 0 && network.scan_overlap_matrix.size() == 0) return "not measured";
  const std::string within = session.parts > 1 ? "in " + std::to_string(session.parts) + " parts" : "within";
  if (network.visit->sessions.size() == 1) return within;
  return within + (session.parts > 1 ? "; " : ", and ") + (session.linked ? "to others" : "to no other session");
}

std::string batteries_text(const Round& round) {
  std::string text;
  for (const BatteryUse& use : round.batteries)
    text += (text.empty() ? "" : ", ") + std::to_string(use.batteries) +
            (round.batteries.size() > 1 ? " of " + use.instrument : "");
  return text;
}

std::vector<std::size_t> visiting_order(const std::vector<StationFacts>& facts) {
  std::vector<std::size_t> order = first_numbers(facts.size());
  std::ranges::stable_sort(order, {},
                           [&](std::size_t k) { return facts[k].visit == 0 ? facts.size() + 1 : facts[k].visit; });
  return order;
}

std::string tape_text(const std::vector<WallCorner>& corners) {
  std::string text;
  for (const WallCorner& corner : corners)
    text += (text.empty() ? "" : " + ") + std::string(corner.wall ? "wall " : "") + fixed(corner.distance_m, 2);
  return text;
}

std::string minutes_text(double minutes) {
  if (minutes > 0 && minutes < 1) return std::to_string(std::max(1LL, std::llround(60 * minutes))) + " s";
  const auto whole = static_cast<long long>(std::llround(minutes));
  const std::string rest = std::to_string(whole % 60) + " min";
  return whole < 60 ? rest : std::to_string(whole / 60) + " h " + rest;
}

}  // namespace vantage
