// SPDX-License-Identifier: Apache-2.0
// Parts of the public header that are common to all optimisers.
#include "vantage/optimiser.hpp"

#include <cmath>

#include "optimise/hypervolume.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

optimise::PointSet checked(std::span<const double> points, std::size_t objectives) {
  if (objectives < 1 || objectives > 6)
    throw Error(Errc::invalid_argument, "hypervolume: " + std::to_string(objectives) + " objectives; it takes 1 to 6");
  if (points.size() % objectives != 0)
    throw Error(Errc::invalid_argument, "hypervolume: " + std::to_string(points.size()) +
                                            " values are no whole number of points of " + std::to_string(objectives) +
                                            " objectives");
  return {points, objectives};
}

void check_reference(std::span<const double> points, std::size_t objectives, std::span<const double> reference) {
  if (reference.size() != objectives)
    throw Error(Errc::invalid_argument, "hypervolume: the reference point has " + std::to_string(reference.size()) +
                                            " coordinates for " + std::to_string(objectives) + " objectives");
  for (const double r : reference)
    if (!std::isfinite(r))
      throw Error(Errc::invalid_argument,
                  "hypervolume: the reference point holds " + std::to_string(r) + "; it must be finite");
  for (const double v : points)
    if (v == -std::numeric_limits<double>::infinity())
      throw Error(Errc::invalid_argument, "hypervolume: a point holds -infinity, its volume has no bound");
}

}  // namespace

std::string to_string(StopReason reason) {
  switch (reason) {
    case StopReason::running: return "running";
    case StopReason::max_evaluations: return "max_evaluations";
    case StopReason::max_iterations: return "max_iterations";
    case StopReason::target_reached: return "target_reached";
    case StopReason::converged: return "converged";
    case StopReason::stagnated: return "stagnated";
    case StopReason::flat: return "flat";
    case StopReason::invalid_objective: return "invalid_objective";
    case StopReason::ill_conditioned: return "ill_conditioned";
    case StopReason::diverged: return "diverged";
    case StopReason::max_time: return "max_time";
    case StopReason::cancelled: return "cancelled";
  }
  return "unknown";
}

Bounds Bounds::uniform(std::size_t dimension, double lower, double upper) {
  return {std::vector<double>(dimension, lower), std::vector<double>(dimension, upper)};
}

double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference) {
  const auto set = checked(points, objectives);
  check_reference(points, objectives, reference);
  return optimise::volume(set, reference);
}

std::vector<double> hypervolume_contributions(std::span<const double> points, std::size_t objectives,
                                              std::span<const double> reference) {
  const auto set = checked(points, objectives);
  check_reference(points, objectives, reference);
  return optimise::contributions(set, reference);
}

std::vector<std::size_t> non_dominated_ranks(std::span<const double> points, std::size_t objectives) {
  const auto set = checked(points, objectives);
  std::vector<double> values(points.begin(), points.end());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto p = std::span(values).subspan(i * objectives, objectives);
    for (const double v : p) {
      if (!std::isnan(v)) continue;
      for (double& w : p) w = std::numeric_limits<double>::infinity();  // dominated by all points with finite values
      break;
    }
  }
  return optimise::ranks({values, objectives});
}

}  // namespace vantage
