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
std::string to_string(Problem);                   ///< "coverage-fix", …
Problem problem_from_string(const std::string&);  ///< Throws Error invalid_argument and lists the problems.
std::vector<std::string> objective_names(Problem);

/// Weights of the scalarised fitness (equation 1, with section 5.1.2's Φ): λ1 coverage + λ2 Φ + λ3 Δ, where Φ =
/// 2^((N_max − N)/(N_max − N_min)) − 1 and Δ = 1 / connected parts of the graph of stations that see each other within
/// range. A baseline.
struct FitnessWeights {
  double coverage = 0.4, station_count = 0.4, visibility = 0.2;
};

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
  std::size_t population = 0;                      ///< 0: 10 for coverage_fix, 20 for a fitness, else 100.
  std::size_t iterations = 100;                    ///< Of `population` evaluations each.
  double sigma0 = 0.2;
  MoAlgorithm algorithm = MoAlgorithm::mo_cma_es;  ///< Of the problems with several objectives.
  MoCmaEsConfig::Scheme scheme = MoCmaEsConfig::Scheme::steady_state;
  std::size_t batch = 0;            ///< Offspring at once in the steady state; 0: chosen by the engine.
  std::uint64_t sample_voxels = 0;  ///< 0: exact search; else sampled with so many voxels.
  /// Head positions of an initial network: the first mean of CMA-ES, a first member of MO-CMA-ES; empty: random. Where
  /// the number of stations is searched, the first N of them are a first member for each N that they suffice for.
  std::vector<Vec3> start = {};
  /// Stations to keep (already scanned): the first of every network, added to stations_min..max.
  std::vector<Vec3> fixed = {};
  /// Lowest and highest height of the head above the search area, searched per station; empty: the scanner's height for
  /// all.
  std::optional<std::array<double, 2>> heights_m = std::nullopt;
  /// Above 0: a network is only wanted if links of at least this Overlap_ij connect all its stations. Others are ranked
  /// behind every connected one, by how many parts they fall into.
  double min_link_overlap = 0;
  /// Only with coverage_min: instead of a front, CMA-ES looks for the one network with the largest fitness.
  std::optional<FitnessWeights> fitness = std::nullopt;
  std::size_t redraws = 8;  ///< How often a candidate's stations in holes or clashes are drawn again.
  double max_seconds = 0;   ///< Of this call's search; looked at between evaluations. 0: no limit.
  std::optional<double> target_hypervolume = std::nullopt;
  std::size_t stagnation_iterations = 0;
  std::uint64_t seed = 1;
  std::filesystem::path checkpoint = {};  ///< File to write every minute and when the search ends; empty: none.
  double checkpoint_seconds = 60;         ///< How often.
  /// Go on from the checkpoint; from the start where there is none yet. Limits (iterations, seconds, hypervolume,
  /// stagnation) may differ from the run that wrote it, nothing else.
  bool resume = false;
};

/// "1 - coverage", … in the order of the objective vectors; "1 - fitness" where there is a fitness.
std::vector<std::string> objective_names(const PlanConfig& config);
/// Whether the search ends with one network, by CMA-ES: coverage_fix, or a fitness.
bool has_one_objective(const PlanConfig& config);

/// One network of the front.
struct PlanEntry {
  std::vector<double> x;  ///< Decision vector: u1, v1, …, uN, vN [, h1, …, hN] [, α].
  std::vector<PlacedStation> stations;
  double coverage = 0, overlap = 0;  ///< As the search saw them; NaN where it kept none and nothing was confirmed.
  double coverage_se = 0, overlap_se = 0;        ///< Standard errors; 0 when exact.
  bool confirmed = false;                        ///< Whether the exact values below were computed.
  double exact_coverage = 0, exact_overlap = 0;  ///< Evaluated again with every ray.
  OverlapMatrix exact_overlap_matrix;
  /// Judged by every ray, another confirmed entry is as good in all objectives and better in one.
  bool dominated = false;
  std::vector<std::uint64_t> points_on_surveyed;  ///< Per station, exact.
};

/// One line of the history, an iteration each.
struct PlanIteration {
  std::size_t iteration = 0, evaluations = 0;
  double hypervolume = 0;                  ///< Of the front, against (1, …, 1).
  std::vector<std::vector<double>> front;  ///< Objective vectors.
  double seconds = 0;                      ///< Since the start. Never part of what must be reproducible.
};

struct PlanResult {
  std::vector<PlanEntry> front;  ///< By falling coverage. One entry where there is one objective.
  std::vector<PlanIteration> history;
  /// Final, as the search saw it; reference point (1, …, 1). Of the one objective 1 − v it is v: the coverage or the
  /// fitness of the best network.
  double hypervolume = 0;
  double exact_hypervolume = 0;  ///< The same by every ray; NaN where an abort left entries unconfirmed.
  std::uint64_t evaluations = 0;
  std::uint64_t redrawn = 0, drawn = 0;   ///< Stations drawn again out of a hole or a clash, and all drawn.
  std::uint64_t resumed_evaluations = 0;  ///< How many of the evaluations a checkpoint brought.
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

/// A snapshot for whoever watches.
struct PlanProgress {
  std::size_t iteration = 0, iterations = 0;
  std::uint64_t evaluations = 0;
  double hypervolume = 0, evaluations_per_second = 0;
  double seconds_left = 0;  ///< Below 0: not known yet.
  std::string phase;        ///< "search" or "confirm"
};

/// Runs the search. Borrows the simulator for the call. Same inputs, same seed: same result but for seconds.
/// `stop` ends the search; what was found so far is still confirmed. `abort` ends the confirmation too: entries that it
/// did not reach have `confirmed` false. Throws Error: invalid_argument (more than 64 stations, min above max, a
/// checkpoint of another run, …), malformed_file (a damaged checkpoint) and what the simulator throws; the checkpoint
/// is written before an exception leaves.
PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const PlanConfig& config,
                const std::function<void(const PlanProgress&)>& watch = {}, std::stop_token stop = {},
                std::stop_token abort = {});

struct GreedyConfig {
  std::size_t stations = 4;              ///< How many to choose.
  std::size_t candidates = 300;          ///< Positions to choose from, spread evenly over the search area's (u, v).
  std::uint64_t sample_voxels = 20'000;  ///< 0: with every ray.
  std::vector<Vec3> fixed = {};          ///< Stations that are there already; neither counted nor returned.
};

/// What `greedy_network` chose.
struct GreedyResult {
  std::vector<PlacedStation> stations;  ///< In the order of choosing: the first k are the choice for k.
  std::vector<double> coverage;         ///< After each.
  std::uint64_t evaluations = 0;
  bool cancelled = false;
};

/// Greedy set cover: takes the candidate that adds most coverage, again and again. Coverage is submodular, so a
/// candidate's gain can only shrink and most need not be looked at twice (Minoux: Accelerated greedy algorithms for
/// maximizing submodular set functions, 1978). A baseline, and a first network for `PlanConfig::start`. Throws Error
/// invalid_argument where no candidate can stand.
GreedyResult greedy_network(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                            const GreedyConfig& config = {}, const Progress& progress = {});

/// Decision vector to stations: locate, raise by `height_m`, check for clashes.
std::vector<PlacedStation> place_stations(const SearchArea& area, const ClashChecker& clash, double height_m,
                                          std::span<const double> uvs);
Network to_network(std::span<const PlacedStation> stations);

/// The overlap graph as registration sees it: which stations hang together, and by what.
struct Connectivity {
  std::size_t parts = 0;                                     ///< Connected parts.
  std::vector<std::size_t> part;                             ///< Per station, the part it is in, from 0.
  std::vector<std::pair<std::size_t, std::size_t>> bridges;  ///< Links without which a part falls in two, i < j.
  /// Where there is one part: the weakest link of the strongest spanning tree, and its overlap. What the registration
  /// hangs by.
  std::pair<std::size_t, std::size_t> weakest_link{0, 0};
  double weakest_overlap = 0;
};
/// Links are the pairs whose overlap is above 0 and at least `min_overlap`.
Connectivity connectivity(const OverlapMatrix& overlap, double min_overlap);
/// Two stations of less overlap count as not linked in reports and pictures, unless a plan asks for another bound.
inline constexpr double default_link_overlap = 0.01;
/// The bound for a plan's reports: its `min_link_overlap` where it has one, else `default_link_overlap`.
double link_overlap(const PlanConfig& config);

}  // namespace vantage
