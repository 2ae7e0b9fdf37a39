// SPDX-License-Identifier: Apache-2.0
/// Positions to choose stations among, and what a station on each covers alone. Points of several stations in a voxel
/// add up, so one pass over single stations answers all questions of which to take (vantage/cover.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "vantage/cover.hpp"
#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// What stations cover one by one of a sample of voxels: a coverage matrix, its elements the sampled voxels.
///
/// An amount is a station's points in a voxel. Where the goals of voxels differ, points count by
/// `Simulator::point_weight`, up to the goal. A column is counted with its station as the only one of a network. Noise
/// is keyed by a station's place in its network, so elsewhere in a network the same station draws other noise: without
/// noise sums of columns are exactly what `Simulator::evaluate_sampled` counts, with noise they are another draw of the
/// same distribution.
class SampledCoverage {
 public:
  SampledCoverage() = default;
  /// Of no stations yet.
  SampledCoverage(const Simulator& simulator, std::uint64_t sample_voxels);

  const CoverageMatrix& matrix() const noexcept { return matrix_; }
  std::size_t size() const noexcept { return matrix_.candidates(); }             ///< Number of stations.
  const std::vector<std::uint32_t>& voxels() const noexcept { return voxels_; }  ///< Voxel of each element, ascending.
  std::uint64_t population() const noexcept { return population_; }              ///< Number of surveyed voxels.
  std::uint64_t sample_voxels() const noexcept { return sample_voxels_; }        ///< As asked for.
  bool cancelled() const noexcept { return cancelled_; }                         ///< The last stations are missing.

  /// Appends the first `most` stations of another one over the same sample. Throws Error invalid_argument where the
  /// sample is another.
  void append(const SampledCoverage& other, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Equation 8 of a network of these stations, with the standard error of the sample.
  Estimate coverage(std::span<const std::size_t> stations) const;
  /// Of all stations.
  Estimate coverage() const;

 private:
  friend SampledCoverage sample_coverage(Simulator&, std::span<const PlacedStation>, std::uint64_t, const Progress&);
  Estimate coverage_of(std::span<const std::uint32_t> amounts) const;
  std::uint32_t amount(std::uint32_t element, std::uint32_t points) const;

  CoverageMatrix matrix_;
  std::vector<std::uint32_t> voxels_;
  std::vector<std::uint32_t> point_weights_;  // by element; empty: 1
  std::uint64_t population_ = 0, sample_voxels_ = 0;
  bool cancelled_ = false;
};

/// Traces stations one by one on a sample of `sample_voxels`. A station that is not `StationStatus::ok` covers nothing.
/// A cancelled call holds the first stations and says so.
SampledCoverage sample_coverage(Simulator& simulator, std::span<const PlacedStation> stations,
                                std::uint64_t sample_voxels, const Progress& progress = {});

/// Scan overlap of each pair (the share of the smaller scan that the other sees too), on a sample of `sample_voxels` of
/// `surroundings`, which is a simulator of all surfaces (`surroundings_of()`). A stopped call knows overlaps of the
/// first stations.
StationGraph overlap_graph(Simulator& surroundings, std::span<const PlacedStation> stations,
                           std::uint64_t sample_voxels = 10'000, const Progress& progress = {});

/// Allowed positions (`StationStatus::ok`) at the scanner's height, `most` of them at most, spread evenly over the
/// ground in square metres; so are the first n of them, for every n. Where most of it is forbidden there may be fewer.
/// No random numbers. Throws Error invalid_argument where no position is allowed.
std::vector<PlacedStation> candidate_positions(const SearchArea& area, const ClashChecker& clash,
                                               const Scanner& scanner, std::size_t most);

/// How candidates are found.
struct CandidateConfig {
  std::size_t first = 128;  ///< How many to begin with; then twice as many, and so on.
  std::size_t most = 2048;  ///< And no more than this.
  double change = 0.005;    ///< Enough once doubling them changes what all capture together by less, as a share of it.
  std::uint64_t sample_voxels = 20'000;  ///< 0: every voxel.
  std::uint32_t scanner = 0;             ///< Which of the simulator's scanners stands on each.
  double max_seconds = 0;  ///< Stop growing after so long; 0: no limit. What is found then depends on the machine.
};

Settings settings(const CandidateConfig& config);

/// Evenly spread allowed positions, and what stations on them cover.
class Candidates {
 public:
  const std::vector<PlacedStation>& stations() const noexcept { return stations_; }  ///< All are ok.
  const SampledCoverage& coverage() const noexcept { return coverage_; }             ///< Of these stations, in order.
  /// What can be seen: coverage (equation 8) if every candidate had a station, with the standard error of the sample.
  const Estimate& visible() const noexcept { return visible_; }
  /// By what share the last doubling changed it; 1 where there was none.
  double change() const noexcept { return change_; }
  /// Why there are no more: "enough" (the change is below the wanted one), "all" (no further allowed position was
  /// found), "most", "time", "cancelled".
  const std::string& ended() const noexcept { return ended_; }
  /// Typical distance between neighbours: the largest, over the allowed positions tried, to the nearest candidate.
  double spacing_m() const noexcept { return spacing_m_; }

 private:
  friend Candidates find_candidates(Simulator&, const SearchArea&, const ClashChecker&, const CandidateConfig&,
                                    const Progress&);
  std::vector<PlacedStation> stations_;
  SampledCoverage coverage_;
  Estimate visible_;
  double change_ = 1, spacing_m_ = 0;
  std::string ended_;
};

/// Allowed positions (`StationStatus::ok`), spread evenly over the ground in square metres, at the scanner's height,
/// doubled in number until what all of them capture together hardly changes. The first n of them are spread evenly too,
/// for every n; no random numbers. Throws Error invalid_argument where no position is allowed.
Candidates find_candidates(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                           const CandidateConfig& config = {}, const Progress& progress = {});

}  // namespace vantage
