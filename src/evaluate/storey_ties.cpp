// SPDX-License-Identifier: Apache-2.0
#include "evaluate/storey_ties.hpp"

#include <algorithm>
#include <cmath>

#include "core/graph.hpp"
#include "core/person.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

// A slope is hardly longer than the line between two heads. A stair is, and short: the way between stations at its two
// ends, or in front of these.
constexpr double kAlongSlope = 1.5, kStair_m = 15;

double apart_m(const PlacedStation& a, const PlacedStation& b) {
  const Vec3 apart = b.position - a.position;
  return std::sqrt(dot(apart, apart));
}

double longest_way_m(double apart_m) { return std::max(kStair_m, kAlongSlope * apart_m); }

}  // namespace

bool crosses_storeys(const PlacedStation& a, const PlacedStation& b) {
  return std::abs(a.ground.z - b.ground.z) >= person::kHeight_m;
}

std::vector<std::uint8_t> past_stairs(std::span<const PlacedStation> stations,
                                      std::span<const std::pair<std::size_t, std::size_t>> pairs,
                                      const OnSite& on_site) {
  std::vector<Vec3> grounds;
  for (const PlacedStation& station : stations) grounds.push_back(station.ground);
  std::vector<OnSite::Way> ways;
  std::vector<std::size_t> crossing;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [a, b] = pairs[k];
    if (!crosses_storeys(stations[a], stations[b])) continue;
    crossing.push_back(k);
    ways.push_back({.a = a, .b = b, .metres = longest_way_m(apart_m(stations[a], stations[b]))});
  }
  std::vector<std::uint8_t> past(pairs.size(), 0);
  const std::vector<std::uint8_t> longer = on_site.longer(grounds, ways);
  for (std::size_t k = 0; k < crossing.size(); ++k) past[crossing[k]] = longer[k];
  return past;
}

std::vector<StoreyTie> storey_ties_of(const Evaluation& evaluation, const OnSite& on_site) {
  const std::optional<StationLinks> links = evaluation.links();
  if (!links) return {};
  const std::vector<PlacedStation>& stations = evaluation.stations;
  const auto crosses = [&](std::size_t a, std::size_t b) { return crosses_storeys(stations[a], stations[b]); };
  const auto tie_of = [&](std::size_t a, std::size_t b) {
    return StoreyTie{.a = a,
                     .b = b,
                     .value = links->values(a, b),
                     .apart_m = apart_m(stations[a], stations[b]),
                     .way_m = on_site.way_m(stations[a].ground, stations[b].ground).value_or(0)};
  };
  const auto by_the_way = [](const StoreyTie& tie) { return tie.way_m <= longest_way_m(tie.apart_m); };
  // The strongest tree, in which a link on one level, or along the way, is stronger than any other.
  const auto weight = [&](std::size_t a, std::size_t b) {
    const double value = links->values(a, b);
    if (!active(stations[a]) || !active(stations[b]) || !(value > 0 && value >= links->least)) return 0.0;
    return !crosses(a, b) || by_the_way(tie_of(a, b)) ? 1 + value : value;
  };
  std::vector<StoreyTie> ties;
  for (const TreeEdge& edge : strongest_spanning_tree(stations.size(), weight))
    if (edge.weight > 0 && crosses(edge.from, edge.to))
      if (const StoreyTie tie = tie_of(std::min(edge.from, edge.to), std::max(edge.from, edge.to)); !by_the_way(tie))
        ties.push_back(tie);
  return ties;
}

}  // namespace vantage
