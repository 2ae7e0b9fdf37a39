// SPDX-License-Identifier: Apache-2.0
#include "evaluate/steep_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "evaluate/field_of_view.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kLookedAt = 20'000;  // voxels
constexpr double kLeastCosine = 0.5;         // of the incidence: a target on the surface shows its face up to 60°
constexpr double kOffSurface_m = 0.02;       // rays end before the surface that they are to meet

// A station that may sight a place, by angles and lengths alone.
struct SteepSight {
  std::size_t station = 0;
  double height_m = 0, range_m = 0;  // above or below the head
};

// Order: height to a decimetre, as an index error moves a sight sideways by itself times the height; then range.
std::tuple<double, double> rank_of(const SteepSight& sight) {
  return {-std::round(10 * sight.height_m), sight.range_m};
}

std::vector<SteepSight> sights_of(const VoxelPatch& patch, const Evaluation& evaluation,
                                  const std::vector<std::size_t>& stations, std::span<const Scanner> scanners,
                                  double side) {
  std::vector<SteepSight> sights;
  for (const std::size_t k : stations) {
    const PlacedStation& station = evaluation.stations[k];
    const Scanner& scanner = scanners[station.setup.scanner];
    const Vec3 level = patch.point - station.position;
    const double range = std::sqrt(dot(level, level));
    if (range < scanner.min_range_m || range > std::min(kLongestSight_m, scanner.max_range_m)) continue;
    if (elevation_deg(station.position, patch.point) <= kLeastElevation_deg) continue;
    if (-side * dot(level, patch.normal) < kLeastCosine * range) continue;
    const std::array<Vec3, 3> turn = station.setup.survey_from_scanner();
    if (in_field_of_view(scanner, turn[0] * level.x + turn[1] * level.y + turn[2] * level.z, range))
      sights.push_back({k, std::abs(level.z), range});
  }
  std::ranges::stable_sort(sights, {}, rank_of);
  return sights;
}

struct SteepPlace {
  std::size_t patch = 0;
  double side = 1;
  std::vector<SteepSight> sights;
  // The second best sight decides, since a check takes two.
  std::tuple<double, double> rank() const { return rank_of(sights[1]); }
};

// Stations that see the best place, with its centre; none if there is no place.
Target best_place(const std::vector<VoxelPatch>& patches, const Evaluation& evaluation,
                  const std::vector<std::size_t>& stations, std::span<const Scanner> scanners,
                  const ClashChecker& clash) {
  std::vector<SteepPlace> places;
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (const double side : {-1.0, 1.0})
      if (SteepPlace place{p, side, sights_of(patches[p], evaluation, stations, scanners, side)};
          place.sights.size() > 1 && patches[p].area_m2 > 0)
        places.push_back(std::move(place));
  std::ranges::stable_sort(places, {}, &SteepPlace::rank);
  std::tuple<double, double> least;
  Target best{.centre = {}, .proposed = true, .stations = {}, .check = true};
  for (const SteepPlace& place : places) {
    if (!best.stations.empty() && place.rank() >= least) break;
    const VoxelPatch& patch = patches[place.patch];
    const Vec3 before = patch.point + patch.normal * (place.side * kOffSurface_m);
    std::vector<SteepSight> seen;
    for (const SteepSight& sight : place.sights)
      if (clash.sees(evaluation.stations[sight.station].position, before)) seen.push_back(sight);
    if (seen.size() < 2) continue;
    const std::tuple rank = rank_of(seen[1]);
    if (!best.stations.empty() && rank >= least) continue;
    least = rank;
    best.centre = patch.point;
    best.stations.clear();
    for (const SteepSight& sight : seen) best.stations.push_back(sight.station);
    std::ranges::sort(best.stations);
  }
  return best;
}

}  // namespace

bool wants_steep_check(const Evaluation& evaluation) {
  constexpr double kMuchRandom = 1.2;  // ratio to the random error above which a check is wanted
  return std::ranges::count_if(evaluation.stations, active) > 1 && evaluation.registration &&
         evaluation.registration->rms_m > kMuchRandom * evaluation.registration->random_m;
}

std::string instrument_of(const Scanner& scanner) { return scanner.name.substr(0, scanner.name.find(" @")); }

double elevation_deg(const Vec3& head, const Vec3& point) {
  const Vec3 line = point - head;
  return std::abs(std::atan2(line.z, std::hypot(line.x, line.y))) * 180 / std::numbers::pi;
}

void add_steep_checks(Evaluation& evaluation, const Simulator& simulator, const ClashChecker& clash) {
  evaluation.no_steep_check.clear();
  std::erase_if(evaluation.targets, [](const Target& target) { return target.check; });
  if (!wants_steep_check(evaluation) || simulator.voxel_count() == 0) return;
  std::map<std::string, std::vector<std::size_t>> instruments;
  for (std::size_t k = 0; k < evaluation.stations.size(); ++k) {
    const Scanner& scanner = simulator.scanners()[evaluation.stations[k].setup.scanner];
    if (active(evaluation.stations[k]) && scanner.angle_accuracy.in_radians() > 0)
      instruments[instrument_of(scanner)].push_back(k);
  }
  const std::vector<std::uint32_t> voxels = simulator.sampled_voxels(std::min(kLookedAt, simulator.voxel_count()));
  const std::vector<VoxelPatch> patches = simulator.voxel_patches(voxels);
  std::set<std::string> names;
  for (const Target& target : evaluation.targets) names.insert(target.name);
  std::size_t number = 0;
  for (const auto& [instrument, stations] : instruments) {
    Target place = best_place(patches, evaluation, stations, simulator.scanners(), clash);
    if (place.stations.empty()) {
      evaluation.no_steep_check.push_back(instrument);
      continue;
    }
    do place.name = "C" + std::to_string(++number);
    while (names.contains(place.name));
    evaluation.targets.push_back(std::move(place));
  }
}

}  // namespace vantage
