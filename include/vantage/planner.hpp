// SPDX-License-Identifier: Apache-2.0
/// Searches for networks of stations: the four problems of Table 2. The one header where optimiser and simulator meet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/objective.hpp"
#include "vantage/optimiser.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Table 2 of the method.
enum class Problem {
  coverage_fix,          ///< 1 − coverage; CMA-ES.
  coverage_overlap_fix,  ///< 1 − coverage, 1 − overlap.
  coverage_min,          ///< 1 − coverage, α.
  coverage_overlap_min,  ///< 1 − coverage, 1 − overlap, α.
};
std::string to_string(Problem);                 ///< "coverage-fix", …
Problem problem_from_string(const std::string&);  ///< Throws Error invalid_argument and lists the problems.
std::vector<std::string> objective_names(Problem);

/// What became of one station of a decision vector.
enum class StationStatus { ok, hole, clash };
std::string to_string(StationStatus);

struct PlacedStation {
  Uv uv;
  Vec3 position;  ///< The scanner's head, survey frame; the ground plus the height. (0, 0, 0) in a hole.
  StationStatus status = StationStatus::ok;
};

struct PlanConfig {
  Problem problem = Problem::coverage_overlap_fix;
  std::size_t stations_min = 4, stations_max = 4;  ///< Equal for the FIX problems.
  std::size_t population = 0;        ///< 0: 10 for coverage_fix, else 100.
  std::size_t iterations = 100;      ///< Of `population` evaluations each.
  double sigma0 = 0.2;
  MoAlgorithm algorithm = MoAlgorithm::mo_cma_es;  ///< Of the problems with several objectives.
  MoCmaEsConfig::Scheme scheme = MoCmaEsConfig::Scheme::steady_state;
  std::size_t batch = 0;             ///< Offspring at once in the steady state; 0: chosen by the engine.
  std::uint64_t sample_voxels = 0;   ///< 0: exact search; else sampled with so many voxels.
  /// Head positions of an initial network: the first mean of CMA-ES, a first member of MO-CMA-ES; empty: random.
  std::vector<Vec3> start = {};
  std::vector<Vec3> fixed = {};      ///< Stations to keep (already scanned): the first of every network, added to stations_min..max.
  /// Lowest and highest height of the head above the search area, searched per station; empty: the scanner's height for all.
  std::optional<std::array<double, 2>> heights_m = std::nullopt;
  /// Above 0: a network is only wanted if links of at least this Overlap_ij connect all its stations. Others are ranked behind
  /// every connected one, by how many parts they fall into.
  double min_link_overlap = 0;
  std::size_t redraws = 8;           ///< How often a candidate's stations in holes or clashes are drawn again.
  double max_seconds = 0;            ///< Of this call's search; looked at between evaluations. 0: no limit.
  std::optional<double> target_hypervolume = std::nullopt;
  std::size_t stagnation_iterations = 0;
  std::uint64_t seed = 1;
  std::filesystem::path checkpoint = {};  ///< File to write every minute and when the search ends; empty: none.
  double checkpoint_seconds = 60;         ///< How often.
  /// Go on from the checkpoint; from the start where there is none yet. Limits (iterations, seconds, hypervolume, stagnation) may
  /// differ from the run that wrote it, nothing else.
  bool resume = false;
};

/// One network of the front.
struct PlanEntry {
  std::vector<double> x;          ///< Decision vector: u1, v1, …, uN, vN [, h1, …, hN] [, α].
  std::vector<PlacedStation> stations;
  double coverage = 0, overlap = 0;              ///< As the search saw them.
  double coverage_se = 0, overlap_se = 0;        ///< Standard errors; 0 when exact.
  bool confirmed = false;                        ///< Whether the exact values below were computed.
  double exact_coverage = 0, exact_overlap = 0;  ///< Evaluated again with every ray.
  OverlapMatrix exact_overlap_matrix;
  std::vector<std::uint64_t> points_on_surveyed; ///< Per station, exact.
};

/// One line of the history, an iteration each.
struct PlanIteration {
  std::size_t iteration = 0, evaluations = 0;
  double hypervolume = 0;                         ///< For coverage_fix: the best coverage.
  std::vector<std::vector<double>> front;         ///< Objective vectors.
  double seconds = 0;                             ///< Since the start. Never part of what must be reproducible.
};

struct PlanResult {
  std::vector<PlanEntry> front;    ///< By falling coverage. One entry for coverage_fix.
  std::vector<PlanIteration> history;
  double hypervolume = 0;          ///< Final, as the search saw it; reference point (1, …, 1).
  std::uint64_t evaluations = 0;
  std::uint64_t redrawn = 0, drawn = 0;  ///< Stations drawn again out of a hole or a clash, and all drawn.
  std::uint64_t resumed_evaluations = 0; ///< How many of the evaluations a checkpoint brought.
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

/// A snapshot for whoever watches.
struct PlanProgress {
  std::size_t iteration = 0, iterations = 0;
  std::uint64_t evaluations = 0;
  double hypervolume = 0, evaluations_per_second = 0, seconds_left = 0;
  std::string phase;  ///< "search" or "confirm"
};

/// Runs the search. Borrows the simulator for the call. Same inputs, same seed: same result but for seconds.
/// `stop` ends the search; what was found so far is still confirmed. `abort` ends the confirmation too: entries that it did not
/// reach have `confirmed` false.
/// Throws Error: invalid_argument (more than 64 stations, min above max, a checkpoint of another run, …), malformed_file (a damaged
/// checkpoint) and what the simulator throws; the checkpoint is written before an exception leaves.
PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const PlanConfig& config,
                const std::function<void(const PlanProgress&)>& watch = {}, std::stop_token stop = {}, std::stop_token abort = {});

/// Decision vector to stations: locate, raise by `height_m`, check for clashes.
std::vector<PlacedStation> place_stations(const SearchArea& area, const ClashChecker& clash, double height_m,
                                          std::span<const double> uvs);
Network to_network(std::span<const PlacedStation> stations);

/// The overlap graph as registration sees it: which stations hang together, and by what.
struct Connectivity {
  std::size_t parts = 0;          ///< Connected parts.
  std::vector<std::size_t> part;  ///< Per station, the part it is in, from 0.
  std::vector<std::pair<std::size_t, std::size_t>> bridges;  ///< Links without which a part falls in two, i < j.
  /// Where there is one part: the weakest link of the strongest spanning tree, and its overlap. What the registration hangs by.
  std::pair<std::size_t, std::size_t> weakest_link{0, 0};
  double weakest_overlap = 0;
};
/// Links are the pairs whose overlap is above 0 and at least `min_overlap`.
Connectivity connectivity(const OverlapMatrix& overlap, double min_overlap);

}  // namespace vantage
