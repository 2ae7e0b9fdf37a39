// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "cover/benders_master.hpp"
#include "cover/network.hpp"
#include "cover/swaps.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Subtracted before a bound is rounded up: far below a station, far above rounding.
constexpr double kWhole = 1e-6;

}  // namespace

StationsBound min_cover(const CoverProblem& asked, const BoundConfig& config, const Progress& progress) {
  check(asked), check(config);
  const CoverageMatrix& matrix = asked.matrix;
  if (matrix.candidates() == 0) throw Error(Errc::invalid_argument, "cover: there are no candidates");
  if (!(asked.coverage > 0 && asked.coverage <= 1))
    throw Error(Errc::invalid_argument, "cover: the wanted coverage is " + std::to_string(asked.coverage) +
                                            ", but must be above 0 and at most 1");
  CoverProblem problem = asked;
  problem.graph = nullptr, problem.link = 0, problem.most = matrix.candidates();
  StationsBound result;
  BendersMaster master(problem, matrix.candidates());
  std::vector<std::size_t> chosen = greedy(problem);
  if (matrix.coverage(chosen) >= problem.coverage) {
    result.chosen = drop_and_swap(problem, std::move(chosen), progress.stop);
    std::vector<double> taken(matrix.candidates());
    for (std::size_t at = problem.existing.size(); at < result.chosen.size(); ++at) taken[result.chosen[at]] = 1;
    master.cut_at(taken);
  }
  const Relaxed relaxed = master.min_stations(problem.coverage, config.tolerance, config.max_seconds, progress);
  result.possible = std::isfinite(relaxed.bound);
  result.complete = relaxed.complete;
  result.relaxation = relaxed.bound;
  if (result.possible) result.at_least = static_cast<std::size_t>(std::max(std::ceil(relaxed.bound - kWhole), 0.0));
  progress(1);
  return result;
}

}  // namespace vantage
