// SPDX-License-Identifier: Apache-2.0
/// Positions that stations are chosen among, and what each captures alone: points of several stations in a voxel add
/// up, so one pass over single stations answers every question of which of them to take.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Points of one station in one sampled voxel; where the goals of voxels differ, what those are worth
/// (`Simulator::point_worth`), and no more than what fills the voxel.
struct CapturedVoxel {
  std::uint32_t voxel = 0;   ///< Its place in the sample, from 0.
  std::uint32_t points = 0;  ///< At least 1.
};

/// What stations capture one by one of a sample of voxels: sparse rows, 8 bytes for each voxel that a station sees.
///
/// A row holds the counts of its station as the first and only one of a network. Noise is keyed by a station's place in
/// its network, so elsewhere in a network the same station draws other noise: without noise sums of rows are exactly
/// what `Simulator::evaluate_sampled` counts, with noise they are another draw of the same distribution.
class CaptureRows {
 public:
  CaptureRows() = default;
  /// No rows yet, of so many voxels of the simulator.
  CaptureRows(const Simulator& simulator, std::uint64_t sample_voxels);
  /// For sites made of numbers: a sample of all voxels, with a weight each. REQUIRES: goal_density > 0.
  CaptureRows(std::vector<std::uint32_t> weights, double goal_density);

  std::size_t size() const noexcept { return offsets_.size() - 1; }  ///< Number of rows.
  /// Voxels that station k sees, ascending. REQUIRES: k < size().
  std::span<const CapturedVoxel> row(std::size_t k) const {
    return std::span(entries_).subspan(offsets_[k], offsets_[k + 1] - offsets_[k]);
  }
  const std::vector<std::uint32_t>& voxels() const noexcept { return voxels_; }  ///< Ranks of the sample, ascending.
  /// What each sampled voxel counts in coverage.
  const std::vector<std::uint32_t>& weights() const noexcept { return weights_; }
  double total_weight() const noexcept { return total_weight_; }           ///< Of the sample.
  double goal_density() const noexcept { return goal_density_; }           ///< Points, or worth, wanted in a voxel.
  std::uint64_t population() const noexcept { return population_; }        ///< Number of surveyed voxels.
  std::uint64_t sample_voxels() const noexcept { return sample_voxels_; }  ///< As asked for.
  bool cancelled() const noexcept { return cancelled_; }                   ///< The last stations have no rows.

  /// Appends a row from the points of each sampled voxel. REQUIRES: points.size() == voxels().size().
  void add(std::span<const std::uint32_t> points);
  /// Appends the rows of another table over the same sample, or the first `most` of them. Throws Error invalid_argument
  /// where it is not the same.
  void append(const CaptureRows& rows, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Equation 8 of a network of these rows, with its standard error.
  Estimate coverage(std::span<const std::size_t> rows) const;
  /// Of a network of all rows.
  Estimate coverage() const;

 private:
  friend CaptureRows capture_rows(Simulator&, std::span<const PlacedStation>, std::uint64_t, const Progress&);
  Estimate coverage_of(std::span<const std::uint32_t> points) const;
  CapturedVoxel captured(std::uint32_t voxel, std::uint32_t points) const;

  std::vector<std::uint32_t> voxels_, weights_;
  std::vector<std::uint32_t> worths_;  // of a point in each voxel; empty: 1
  double total_weight_ = 0, goal_density_ = 1;
  std::uint64_t population_ = 0, sample_voxels_ = 0;
  std::vector<std::size_t> offsets_{0};
  std::vector<CapturedVoxel> entries_;
  bool cancelled_ = false;
};

/// A row for each station, on a sample of `sample_voxels`; a station that is not `StationStatus::ok` has an empty one.
/// A cancelled call holds the rows of the first stations and says so.
CaptureRows capture_rows(Simulator& simulator, std::span<const PlacedStation> stations, std::uint64_t sample_voxels,
                         const Progress& progress = {});

/// Two rows, the first below the second.
using RowLink = std::array<std::size_t, 2>;

/// Pairs of `stations` whose scans overlap by at least `least` (the share of the smaller that the other sees too), on a
/// sample of `sample_voxels` of `surroundings`, which is a simulator of all surfaces (`surroundings_of()`). A stopped
/// call knows the first stations' only.
std::vector<RowLink> links_between(Simulator& surroundings, std::span<const PlacedStation> stations, double least,
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

/// Evenly spread allowed positions, and what they capture.
class Candidates {
 public:
  const std::vector<PlacedStation>& stations() const noexcept { return stations_; }  ///< All are ok.
  const CaptureRows& rows() const noexcept { return rows_; }                         ///< One for each, in order.
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
  CaptureRows rows_;
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
