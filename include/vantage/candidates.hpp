// SPDX-License-Identifier: Apache-2.0
/// Candidate positions of stations, and the points that each alone leaves. Points of several stations in a voxel add
/// up, so one pass over single stations answers all questions of choice (vantage/cover.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "vantage/attainable.hpp"
#include "vantage/cover.hpp"
#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"
#include "vantage/site.hpp"
#include "vantage/targets.hpp"

namespace vantage {

/// Coverage matrix of single stations on a sample of the voxels; its elements are the sampled voxels.
///
/// An amount is a station's points in a voxel, up to the goal. If voxels have different goals, points count by
/// `Simulator::point_weight`. Each column is counted as a network of one station. Noise is keyed by a station's place
/// in its network, so the same station has other noise at another place. Without noise, sums of columns equal the
/// counts of `Simulator::evaluate_sampled`, up to the goal; with noise they are another draw of the same distribution.
class SampledCoverage {
 public:
  SampledCoverage() = default;
  /// Makes one without stations.
  SampledCoverage(const Simulator& simulator, std::uint64_t sample_voxels);

  const CoverageMatrix& matrix() const noexcept { return matrix_; }              ///< A column for each station.
  std::size_t size() const noexcept { return matrix_.candidates(); }             ///< Number of stations.
  const std::vector<std::uint32_t>& voxels() const noexcept { return voxels_; }  ///< Voxel of each element, ascending.
  std::uint64_t population() const noexcept { return population_; }              ///< Number of surveyed voxels.
  std::uint64_t sample_voxels() const noexcept { return sample_voxels_; }        ///< The requested number.
  /// True if the last stations are missing.
  bool cancelled() const noexcept { return cancelled_; }

  /// Appends the first `most` stations of another one. Throws Error invalid_argument if its sample differs.
  void append(const SampledCoverage& other, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Equation 8 for a network of these stations, with the standard error of the sample.
  Estimate coverage(std::span<const std::size_t> stations) const;
  /// The same for all stations.
  Estimate coverage() const;

 private:
  friend SampledCoverage sample_coverage(Simulator&, std::span<const PlacedStation>, std::uint64_t, const Progress&,
                                         CountTo);
  Estimate coverage_of(std::span<const std::uint32_t> amounts) const;
  std::uint32_t amount(std::uint32_t element, std::uint32_t points) const;

  CoverageMatrix matrix_;
  std::vector<std::uint32_t> voxels_;
  std::vector<std::uint32_t> point_weights_;  // by element; empty: 1
  std::uint64_t population_ = 0, sample_voxels_ = 0;
  bool cancelled_ = false;
};

/// Traces stations one by one on a sample of `sample_voxels`. A station that is not `StationStatus::ok` covers nothing.
/// A cancelled call holds the first stations and has `cancelled()` set. With `CountTo::one` amounts only tell which
/// voxels each station sees.
SampledCoverage sample_coverage(Simulator& simulator, std::span<const PlacedStation> stations,
                                std::uint64_t sample_voxels, const Progress& progress = {},
                                CountTo count_to = CountTo::goal);

/// Scan overlap of each pair (the shared surface as a share of the smaller scan), on a sample of `sample_voxels` of
/// `surroundings`, the simulator of all surfaces (`surroundings_of()`). A stopped call has overlaps of the first
/// stations.
StationGraph overlap_graph(Simulator& surroundings, std::span<const PlacedStation> stations,
                           std::uint64_t sample_voxels = 10'000, const Progress& progress = {});

/// Allowed positions (`StationStatus::ok`) at the first scanner's height, at most `most`, spread evenly over the ground
/// in square metres. The first n are spread evenly too, for every n. There may be fewer if most of the ground is
/// forbidden. Uses no random numbers. Throws Error invalid_argument if no position is allowed.
std::vector<PlacedStation> candidate_positions(Site& site, std::size_t most);

/// Settings of `find_candidates()`.
struct CandidateConfig {
  std::size_t first = 128;  ///< Initial number; it is doubled until a limit holds.
  std::size_t most = 4096;  ///< Largest number.
  /// Stops once doubling raises attainable coverage by less than this share, and no ground is farther than 3 m from a
  /// candidate.
  double change = 0.01;
  std::uint64_t sample_voxels = 20'000;  ///< May be `every_voxel`.
  std::uint32_t scanner = 0;             ///< Scanner on each, an index into `Simulator::scanners()`.
  double max_seconds = 0;  ///< Time limit for growing; 0: none. With a limit the result depends on the machine.
};

/// Its members as named values, for results.
Settings settings(const CandidateConfig& config);

/// Evenly spread allowed positions, and the coverage of stations on them.
class Candidates {
 public:
  const std::vector<PlacedStation>& stations() const noexcept { return stations_; }  ///< All are ok.
  const SampledCoverage& coverage() const noexcept { return coverage_; }             ///< For these stations, in order.
  /// The most points that a station on one of them leaves in each voxel of the sample.
  const AttainableCounts& attainable_counts() const noexcept { return attainable_counts_; }
  /// The coverage matrix with attainable counts as goals: its F is the share of what is attainable.
  CoverageMatrix captured_matrix() const;
  /// Attainable coverage, with the standard error of the sample.
  const Estimate& attainable() const noexcept { return attainable_; }
  /// Relative change of it by the last doubling; 1 if there was none.
  double change() const noexcept { return change_; }
  /// Error of what is attainable from the positions that were not tried: the last change, 0 if there are none.
  double growth() const noexcept { return ended_ == "all" ? 0 : change_; }
  /// Why growth ended: "enough" (the change is below the wanted one), "all" (there is no further allowed position),
  /// "most", "time", "cancelled".
  const std::string& ended() const noexcept { return ended_; }
  /// Largest distance from a tried allowed position to its nearest candidate: typical of neighbours.
  double spacing_m() const noexcept { return spacing_m_; }

 private:
  friend Candidates find_candidates(Site&, const CandidateConfig&, const Progress&);
  static void add_unseen(Candidates& found, Site& site, std::span<const PlacedStation> others,
                         const Progress& progress);
  void raise_attainable(std::size_t first);  // by the candidates from `first` on

  std::vector<PlacedStation> stations_;
  SampledCoverage coverage_;
  AttainableCounts attainable_counts_;
  Estimate attainable_;
  double change_ = 1, spacing_m_ = 0;
  std::string ended_;
};

/// Finds allowed positions (`StationStatus::ok`) at the scanner's height, spread evenly over the ground in square
/// metres. Doubles their number until attainable coverage hardly rises. The first n are spread evenly too, for every n.
/// The last ones are positions that see no other candidate near them, as in small rooms. Uses no random numbers. Throws
/// Error invalid_argument if no position is allowed, or a setting is out of its range.
Candidates find_candidates(Site& site, const CandidateConfig& config = {}, const Progress& progress = {});

/// Settings of `greedy_network()`.
struct GreedyConfig {
  std::size_t stations = 4;                        ///< Number of stations to choose.
  std::size_t candidates = 300;                    ///< Positions to choose from, spread evenly over the ground.
  std::uint64_t sample_voxels = 20'000;            ///< May be `every_voxel`.
  std::vector<Vec3> existing = {};                 ///< Heads of existing stations; neither counted nor returned.
  std::vector<StationSetup> existing_setups = {};  ///< As `SurveyProblem::existing_setups`.
};

/// Result of greedy_network().
struct GreedyResult {
  std::vector<PlacedStation> stations;  ///< In the order of choice: the first k are the choice for k.
  std::vector<double> coverage;         ///< After each, on the sample.
  bool cancelled = false;               ///< It was stopped before it was done.
};

/// A first network for `PlanConfig::start`, and a baseline: greedy() over candidates (vantage/cover.hpp). Once no
/// candidate adds anything, the rest are the most evenly spread ones. Throws Error invalid_argument for more stations
/// than candidates, and if no candidate can stand.
GreedyResult greedy_network(Site& site, const GreedyConfig& config = {}, const Progress& progress = {});

/// Settings of `exact_network()`.
struct ExactConfig {
  std::size_t stations = 4;              ///< Number of stations to choose.
  std::size_t candidates = 256;          ///< Positions to choose from, spread evenly over the ground.
  std::uint64_t sample_voxels = 20'000;  ///< May be `every_voxel`.
  double link = 0;          ///< Least scan overlap of the links that connect the network; 0: it need not be connected.
  double apart_m = 0;       ///< Least distance between heads.
  double max_seconds = 60;  ///< Time for branch and bound. If it ends first, the result depends on the machine.
  std::vector<Vec3> existing = {};                 ///< Heads of existing stations; neither counted nor returned.
  std::vector<StationSetup> existing_setups = {};  ///< As `SurveyProblem::existing_setups`.
};

/// Result of exact_network().
struct ExactResult {
  std::vector<PlacedStation> stations;  ///< Empty if no connected network was found.
  CoverSolution choice;                 ///< The choice among candidates, and a bound on the coverage of any.
  bool cancelled = false;               ///< It was stopped before it was done.
};

/// The best network among candidates, by max_cover() with branch and bound; proven best among them if its gap is 0. A
/// baseline, and a first network for `PlanConfig::start`. Throws Error invalid_argument if no candidate can stand.
ExactResult exact_network(Site& site, const ExactConfig& config = {}, const Progress& progress = {});

/// Targets that a network wants, and what they bring.
struct TargetProposal {
  std::vector<Target> targets;                ///< The given ones, then the proposed ones, the most useful first.
  RegistrationError without = {}, with = {};  ///< Predicted without any target, and with all.
  double reach_m = 0;                         ///< `target_reach_m()` of the first scanner.
};

/// Proposes as few targets as bring the predicted error to what `options` allow: each time the one of some 400 places
/// on reached ground that lowers the mean square error over the covered surface most, at last without those that the
/// others make needless. It ends early where another one would gain less than a fifth of a station's share of that
/// error, unless `TargetOptions::least` asks for more. No place is in a passage, where the leaf of a door swings, by a
/// station or on glass; no station measures three that are nearly on a line. `given`: targets and control points that
/// are there. No random numbers. Returns nothing if it was stopped. Throws Error invalid_argument, and what the
/// simulator throws.
std::optional<TargetProposal> propose_targets(Site& site, std::span<const PlacedStation> stations,
                                              const RegistrationOptions& registration = {},
                                              const TargetOptions& options = {}, std::vector<Target> given = {},
                                              const Progress& progress = {});

}  // namespace vantage
