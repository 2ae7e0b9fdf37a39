// SPDX-License-Identifier: Apache-2.0
/// How good a network can be at best: bounds on what any choice of candidates captures, and good choices.
///
/// What is bounded is coverage (equation 8) on a sample of voxels, over a finite set of positions. A station between
/// candidates may add to it, the sample may be kinder than the site: both are told beside the bound, measured, and
/// neither is proven.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/candidates.hpp"
#include "vantage/measure.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"

namespace vantage {

struct BoundConfig {
  double tolerance = 0.001;  ///< How exactly the linear relaxation is solved, in coverage.
  double max_seconds = 120;  ///< For each relaxation; one that is cut short still bounds, less tightly. 0: no limit.
  double exact_seconds = 0;  ///< For branch and bound, towards the best choice itself; 0: greedy and swaps only.
  /// Rows of which a choice has one of the two at most: positions too near to each other, say. Like links they enter
  /// the branch and bound; without time for it `bound` is that of any choice. `bound_stations` passes over them.
  std::vector<RowLink> exclude = {};
};

Settings settings(const BoundConfig& config);

/// What any number of stations captures at most.
struct CaptureBound {
  std::size_t stations = 0;  ///< Without those that are fixed.
  /// No `stations` candidates (and the fixed rows) have more coverage on the sample: proven, by the duals of the
  /// relaxation, or of branch and bound where that is lower.
  double bound = 1;
  double relaxation = 0;  ///< What fractions of candidates reach: no relaxation's bound is lower than this.
  bool complete = false;  ///< The relaxation came to its tolerance in time.
  /// By how much the bound of all candidates exceeds that of the first half of them, which are as evenly spread: what a
  /// position between candidates can add, measured, not proven: the next doubling has mostly as much or less. Never
  /// below 0.
  double spacing_term = 0;
  double half_bound = 1;                 ///< That bound, of the first half.
  std::vector<std::size_t> chosen = {};  ///< The best rows found, the fixed ones first.
  Estimate reached;                      ///< Their coverage, with the sample's standard error.
  /// How much better than `reached` any choice of candidates can be, as a share of it.
  double gap() const { return bound > reached.value && reached.value > 0 ? bound / reached.value - 1 : 0; }
};

/// Σ y <= stations over the linear relaxation of coverage: max Σ w_v z_v, z_v <= b_v + Σ_k y_k min(points_kv / goal,
/// 1), 0 <= y, z <= 1, by cutting planes; the choice by greedy, swaps, and branch and bound where there is time for it.
/// `fixed` are rows that every network has. A stopped call returns what is known by then. Throws Error
/// invalid_argument for no stations or a row that is not there.
CaptureBound bound_capture(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed = {},
                           const BoundConfig& config = {}, const Progress& progress = {});

/// The same of networks that hang together: along some of `links` each station is reached from each other, the fixed
/// ones included. `chosen` is such a network, empty where none was found; at most `max_stations` in all. Links enter
/// the branch and bound, where the spanning tree is asked for as a flow (Dehbi, Leonhardt, Oehrlein, Haunert: Optimal
/// scan planning with enforced network connectivity, 2021); without time for it `bound` is that of any network. Throws
/// Error invalid_argument for a link of rows that are not there, too.
CaptureBound bound_linked_capture(const CaptureRows& rows, std::size_t stations, std::span<const RowLink> links,
                                  std::span<const std::size_t> fixed = {}, const BoundConfig& config = {},
                                  const Progress& progress = {});

/// How many stations a wanted coverage takes.
struct StationsBound {
  bool possible = false;     ///< False: all candidates together do not capture as much.
  std::size_t at_least = 0;  ///< No fewer candidates have it: proven likewise. Without those that are fixed.
  double relaxation = 0;     ///< The bound before it is rounded up.
  bool complete = false;
  std::vector<std::size_t> chosen = {};  ///< A choice that has it, found: the fixed rows first. Empty if not possible.
};
/// Throws Error invalid_argument unless 0 < capture <= 1.
StationsBound bound_stations(const CaptureRows& rows, double capture, std::span<const std::size_t> fixed = {},
                             const BoundConfig& config = {}, const Progress& progress = {});

/// The best choice found of `stations` rows besides the fixed ones, by greedy with lazy evaluation and then swaps:
/// `CaptureBound::chosen` without a bound. For any number of stations. Returns fixed and chosen rows.
std::vector<std::size_t> choose_rows(const CaptureRows& rows, std::size_t stations,
                                     std::span<const std::size_t> fixed = {}, const Progress& progress = {});

}  // namespace vantage
