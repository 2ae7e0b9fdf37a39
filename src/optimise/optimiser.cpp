// SPDX-License-Identifier: Apache-2.0
// Parts of the public header that are common to all optimisers.
#include "vantage/optimiser.hpp"

#include <cmath>

#include "core/closest_name.hpp"
#include "optimise/baselines.hpp"
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

std::string to_string(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::cma_es: return "cma_es";
    case Algorithm::mo_cma_es: return "mo_cma_es";
    case Algorithm::nsga2: return "nsga2";
    case Algorithm::random_search: return "random_search";
  }
  return "unknown";
}

Algorithm algorithm_from_string(const std::string& name) {
  std::vector<std::string> known;
  for (const auto algorithm : {Algorithm::cma_es, Algorithm::mo_cma_es, Algorithm::nsga2, Algorithm::random_search}) {
    known.push_back(to_string(algorithm));
    if (name == known.back()) return algorithm;
  }
  throw Error(Errc::invalid_argument, "there is no optimiser \"" + name +
                                          "\"; take cma_es, mo_cma_es, nsga2 or random_search" +
                                          did_you_mean(name, known));
}

std::unique_ptr<Optimiser> make_optimiser(Algorithm algorithm, std::size_t dimension, std::size_t objectives,
                                          const OptimiserConfig& config) {
  switch (algorithm) {
    case Algorithm::cma_es:
      if (objectives != 1)
        throw Error(Errc::invalid_argument,
                    "CMA-ES: " + std::to_string(objectives) + " objectives; it takes one, mo_cma_es takes several");
      return std::make_unique<CmaEs>(dimension, config);
    case Algorithm::nsga2: return std::make_unique<optimise::Nsga2>(dimension, objectives, config);
    case Algorithm::random_search: return std::make_unique<optimise::RandomSearch>(dimension, objectives, config);
    case Algorithm::mo_cma_es: break;
  }
  return std::make_unique<MoCmaEs>(dimension, objectives, config);
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
