// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/graph.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

constexpr double kStorey_m = 1.8;  // as between the levels of a plan
// A slope is hardly longer than the line between two heads. A stair is, and short: the way between stations at its two
// ends, or in front of these.
constexpr double kAlongSlope = 1.5, kStair_m = 15;

}  // namespace

std::vector<StoreyTie> storey_ties_of(const Evaluation& evaluation, const OnSite& on_site) {
  const std::optional<StationLinks> links = evaluation.links();
  if (!links) return {};
  const std::vector<PlacedStation>& stations = evaluation.stations;
  const auto crosses = [&](std::size_t a, std::size_t b) {
    return std::abs(stations[a].ground.z - stations[b].ground.z) >= kStorey_m;
  };
  const auto tie_of = [&](std::size_t a, std::size_t b) {
    const Vec3 apart = stations[b].position - stations[a].position;
    return StoreyTie{.a = a,
                     .b = b,
                     .value = links->values(a, b),
                     .apart_m = std::sqrt(dot(apart, apart)),
                     .way_m = on_site.way_m(stations[a].ground, stations[b].ground).value_or(0)};
  };
  const auto by_the_way = [](const StoreyTie& tie) {
    return tie.way_m <= std::max(kStair_m, kAlongSlope * tie.apart_m);
  };
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
