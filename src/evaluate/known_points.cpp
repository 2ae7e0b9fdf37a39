// SPDX-License-Identifier: Apache-2.0
#include "evaluate/known_points.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double kUnder_m = 0.1;        // in plan: a tripod is moved over a mark so near
constexpr double kUnderGround_m = 0.5;  // below the ground of the model

bool is_under(const Target& target, const PlacedStation& station) {
  const Vec3 away = target.centre - station.ground;
  return std::hypot(away.x, away.y) <= kUnder_m && away.z >= -kUnderGround_m && target.centre.z < station.position.z;
}

}  // namespace

bool may_be_set_up(const KnownPoints& known) {
  return known.seen.size() >= kFixing || (known.under && !known.seen.empty());
}

std::vector<KnownPoints> known_points(const Evaluation& evaluation) {
  const std::vector<Target>& targets = evaluation.targets;
  if (std::ranges::none_of(targets, [](const Target& target) { return target.control_m > 0; })) return {};
  std::vector<KnownPoints> all(evaluation.stations.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (!(targets[t].control_m > 0)) continue;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (active(evaluation.stations[k]) && is_under(targets[t], evaluation.stations[k])) all[k].under = t;
    for (const std::size_t k : targets[t].stations)
      if (all[k].under != t) all[k].seen.push_back(t);
  }
  return all;
}

std::string set_up_text(const KnownPoints& known, const Evaluation& evaluation) {
  const std::string many = std::to_string(known.seen.size());
  if (known.under && !known.seen.empty()) return "over " + evaluation.targets[*known.under].name + ", sights " + many;
  if (known.seen.size() >= kFixing)
    return "resection from " + many + (known.seen.size() < kChecking ? ", unchecked" : "");
  return known.seen.empty() ? (known.under ? "over a known point, none seen" : "none seen") : many + " seen, too few";
}

}  // namespace vantage
