// SPDX-License-Identifier: Apache-2.0
#include "plan/greedy.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "plan/simulator_evaluator.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Evenly spread points of the unit square that any number of points may be taken of (Roberts: The Unreasonable
// Effectiveness of Quasirandom Sequences, 2018): multiples of 1/g and 1/g², g the real root of g³ = g + 1, modulo 1.
Uv spread_point(const PlacementOracle& site, std::size_t k) {
  constexpr double g = 1.32471795724474602596;
  const auto part = [k](double step) {
    const double x = 0.5 + static_cast<double>(k + 1) * step;
    return x - std::floor(x);
  };
  return {site.uv_min.u + part(1 / g) * (site.uv_max.u - site.uv_min.u),
          site.uv_min.v + part(1 / (g * g)) * (site.uv_max.v - site.uv_min.v)};
}

// Where most of the box is hole, this many points are tried for each that is wanted.
constexpr std::size_t kTries = 50;
// Candidates evaluated together once their gains have aged: enough to keep a device busy, few enough to waste little.
constexpr std::size_t kLazyBatch = 16;

struct Candidate {
  PlacedStation station;
  double gain = 0;          // upper bound of what it adds
  std::size_t seen_at = 0;  // number of chosen stations when it was computed
  bool chosen = false;
};

}  // namespace

GreedyResult choose_greedily(const PlacementOracle& site, NetworkEvaluator& evaluator, const GreedyConfig& config,
                             const Progress& progress) {
  if (config.stations < 1 || config.stations + config.fixed.size() > max_stations)
    throw Error(Errc::invalid_argument, "greedy: 1 to " + std::to_string(max_stations) +
                                            " stations can be chosen, kept ones included, not " +
                                            std::to_string(config.stations + config.fixed.size()));
  if (config.candidates < 1) throw Error(Errc::invalid_argument, "greedy: at least one candidate is needed");
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < kTries * config.candidates && candidates.size() < config.candidates; ++k) {
    const PlacedStation station = place_station(site, spread_point(site, k), site.height_m);
    if (station.status == StationStatus::ok) candidates.push_back({.station = station});
  }
  if (candidates.empty())
    throw Error(Errc::invalid_argument, "greedy: none of " + std::to_string(kTries * config.candidates) +
                                            " positions is in the search area and free of clashes");

  GreedyResult result;
  std::vector<PlacedStation>& chosen = result.stations;
  const PlacedNetwork kept = existing_stations(site, config.fixed, config.fixed_setups);
  double covered = 0;
  if (!kept.empty()) {
    const std::vector<PlacedNetwork> one{kept};
    const auto value = evaluator.evaluate(one, {.voxels = config.sample_voxels}, {.report = {}, .stop = progress.stop});
    ++result.evaluations;
    result.cancelled = !value;
    if (!value) return result;
    covered = value->front().front();
  }
  std::vector<std::size_t> order(candidates.size());
  // above any gain: all are evaluated first
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k, candidates[k].gain = 2;
  const auto better = [&](std::size_t a, std::size_t b) {
    return candidates[a].gain != candidates[b].gain ? candidates[a].gain > candidates[b].gain : a < b;
  };
  while (chosen.size() < config.stations) {
    std::sort(order.begin(), order.end(), better);
    Candidate& first = candidates[order.front()];
    if (first.seen_at == chosen.size() && first.gain <= 1) {
      first.chosen = true;
      covered += first.gain;
      first.gain = -1;  // behind all others: a second scanner on the same spot sees nothing new
      chosen.push_back(first.station);
      result.coverage.push_back(covered);
      progress(static_cast<double>(chosen.size()) / static_cast<double>(config.stations));
      if (chosen.size() < config.stations && chosen.size() == candidates.size())
        throw Error(Errc::invalid_argument, "greedy: " + std::to_string(config.stations) +
                                                " stations cannot be chosen from " + std::to_string(candidates.size()) +
                                                " candidates; ask for more candidates");
      continue;
    }
    std::vector<std::size_t> stale;
    for (const std::size_t k : order) {
      if (candidates[k].chosen) continue;
      const bool fresh = candidates[k].seen_at == chosen.size() && candidates[k].gain <= 1;
      if (fresh || (candidates[k].gain <= 1 && stale.size() == kLazyBatch)) break;
      stale.push_back(k);
    }
    std::vector<PlacedNetwork> networks;
    for (const std::size_t k : stale) {
      PlacedNetwork& network = networks.emplace_back(kept);
      network.insert(network.end(), chosen.begin(), chosen.end());
      network.push_back(candidates[k].station);
    }
    const std::size_t chunk = evaluator.chunk() == 0 ? networks.size() : evaluator.chunk();
    for (std::size_t at = 0; at < networks.size(); at += chunk) {
      const std::size_t n = std::min(chunk, networks.size() - at);
      const auto values = evaluator.evaluate(std::span(networks).subspan(at, n), {.voxels = config.sample_voxels},
                                             {.report = {}, .stop = progress.stop});
      if (!values || progress.stopped()) {
        result.cancelled = true;
        return result;
      }
      for (std::size_t i = 0; i < n; ++i) {
        Candidate& candidate = candidates[stale[at + i]];
        candidate.gain = std::clamp((*values)[i].front() - covered, 0.0, 1.0);
        candidate.seen_at = chosen.size();
      }
      result.evaluations += n;
    }
  }
  return result;
}

GreedyResult greedy_network(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                            const GreedyConfig& config, const Progress& progress) {
  const PlacementOracle site = make_placement_oracle(area, clash, simulator.scanner());
  SimulatorEvaluator evaluator(simulator, measures_of(coverage_fix(config.stations)),
                               {.sampled = config.sample_voxels > 0, .kept = config.fixed.size()});
  return choose_greedily(site, evaluator, config, progress);
}

}  // namespace vantage
