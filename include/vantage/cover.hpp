// SPDX-License-Identifier: Apache-2.0
/// Chooses stations from a finite set of candidates: covering problems on plain arrays.
///
/// A candidate is a column of a sparse matrix. Its entries are the amounts that it adds to elements, each of which is
/// covered once it has the goal. With a_ke the amount of candidate k in element e and w_e its weight, a set S has the
/// coverage F(S) = Σ_e w_e min(Σ_{k ∈ S} a_ke / goal, 1) / Σ_e w_e. F grows with S and its gains shrink: it is monotone
/// and submodular. Two questions are asked of it, as in the literature on facility location: the most coverage of N
/// candidates (maximal covering: Church, ReVelle: The Maximal Covering Location Problem, 1974) and the fewest
/// candidates of some coverage (partial set cover). Candidates may have to form one connected network, and some may not
/// stand together. In a survey a candidate is an allowed position, an element a voxel, and an amount the points in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// Sparse matrix of what each candidate adds to each element: 8 bytes an entry.
class CoverageMatrix {
 public:
  struct Entry {
    std::uint32_t element = 0;
    std::uint32_t amount = 0;  ///< At least 1.
  };

  CoverageMatrix() = default;
  /// Without candidates. `weights`: one for each element. REQUIRES: goal > 0.
  CoverageMatrix(std::vector<std::uint32_t> weights, double goal);

  std::size_t candidates() const noexcept { return offsets_.size() - 1; }
  std::size_t elements() const noexcept { return weights_.size(); }
  /// Entries of a candidate, by rising element. REQUIRES: candidate < candidates().
  std::span<const Entry> column(std::size_t candidate) const {
    return std::span(entries_).subspan(offsets_[candidate], offsets_[candidate + 1] - offsets_[candidate]);
  }
  const std::vector<std::uint32_t>& weights() const noexcept { return weights_; }
  double total_weight() const noexcept { return total_weight_; }
  double goal() const noexcept { return goal_; }  ///< The amount that covers an element.

  /// Appends a candidate by its amount in each element. REQUIRES: amounts.size() == elements().
  void add(std::span<const std::uint32_t> amounts);
  /// Appends a candidate by its entries. REQUIRES: rising elements, amounts above 0.
  void add(std::span<const Entry> column);
  /// Appends the first `most` candidates of another matrix. Throws Error invalid_argument unless its weights and goal
  /// are the same.
  void append(const CoverageMatrix& other, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// F of a set of candidates, in [0, 1]. A candidate that is given twice counts twice.
  double coverage(std::span<const std::size_t> chosen) const;

 private:
  std::vector<std::uint32_t> weights_;
  double total_weight_ = 0, goal_ = 1;
  std::vector<std::size_t> offsets_{0};
  std::vector<Entry> entries_;
};

/// What pairs of candidates mean for a network: how much they overlap, and whether both may be chosen. Dense: 5 bytes a
/// pair at most.
class StationGraph {
 public:
  StationGraph() = default;
  /// So many candidates that do not overlap and may all be chosen.
  explicit StationGraph(std::size_t size) : size_(size), overlaps_(size * size, 0) {}
  /// `overlaps`: size × size, row-major, symmetric; the diagonal is not read. Throws Error invalid_argument for another
  /// number of values.
  StationGraph(std::size_t size, std::vector<float> overlaps);
  /// Overlap of two candidates: the elements that both cover in part, as a share of the fewer that one of them does.
  /// Candidates from `seen.candidates()` to `size` overlap with none.
  StationGraph(const CoverageMatrix& seen, std::size_t size);

  std::size_t size() const noexcept { return size_; }
  float overlap(std::size_t i, std::size_t j) const { return overlaps_[i * size_ + j]; }
  std::span<const float> overlaps() const noexcept { return overlaps_; }  ///< Row-major.
  /// Whether two candidates are linked, by an overlap of at least `least`. REQUIRES: least > 0.
  bool linked(std::size_t i, std::size_t j, double least) const {
    return i != j && static_cast<double>(overlap(i, j)) >= least;
  }
  /// Whether no network has both.
  bool excluded(std::size_t i, std::size_t j) const { return !excluded_.empty() && excluded_[i * size_ + j] != 0; }

  /// Both set i, j and j, i. REQUIRES: i, j < size().
  void set_overlap(std::size_t i, std::size_t j, float overlap);
  void exclude(std::size_t i, std::size_t j);
  /// Excludes all pairs whose positions are less than `least_m` apart. REQUIRES: a position for each candidate.
  void exclude_nearer(std::span<const Vec3> positions, double least_m);

 private:
  std::size_t size_ = 0;
  std::vector<float> overlaps_;
  std::vector<char> excluded_;  // empty: no pair
};

/// What is asked. Borrows the matrix and the graph.
struct CoverProblem {
  const CoverageMatrix& matrix;
  const StationGraph* graph = nullptr;     ///< Null: candidates do not overlap and may all be chosen.
  std::vector<std::size_t> existing = {};  ///< Candidates of every network, first in every solution.
  std::size_t fewest = 1;                  ///< At least so many further candidates.
  std::size_t most = std::numeric_limits<std::size_t>::max();  ///< At most so many further candidates.
  double coverage = 1;                                         ///< Coverage that is wanted.
  double link = 0;  ///< Least overlap of links, by which a network is connected; 0: it need not be.
};

/// A network, and what is known of others.
struct CoverSolution {
  std::vector<std::size_t> chosen = {};  ///< Existing candidates, then those chosen. Empty: none was found.
  double coverage = 0;                   ///< F(chosen).
  double link = 1;       ///< The weakest link of the strongest spanning tree; 1 for fewer than two candidates.
  double violation = 0;  ///< How far it is from what is wanted: the share of the coverage that is short, and 0.2 for
                         ///< each missing link. 0: it is what is wanted.
  /// By max_cover(): no network of as many candidates has more coverage. Proven.
  double bound = 1;
  double relaxation = 0;  ///< Coverage of fractions of candidates: a relaxation's bound is never lower.
  bool complete = false;  ///< The relaxation came to its tolerance in time.
  /// The relaxation's bound of the first half of the candidates, and by how much that of all of them is higher. Where
  /// candidates are spread as evenly by halves, this measures what positions between them can add; it proves nothing.
  double half_bound = 1, spacing_term = 0;

  /// How much more coverage a network may have, as a share of this one's.
  double gap() const { return relative_gap(bound, coverage); }
  static double relative_gap(double bound, double reached) {
    return bound > reached && reached > 0 ? bound / reached - 1 : 0;
  }
};

/// A network of given candidates: its coverage, link and violation. Throws Error invalid_argument as all calls below
/// where a candidate of the problem does not exist, or its graph has another size than its matrix.
CoverSolution evaluate_cover(const CoverProblem& problem, std::vector<std::size_t> chosen);

/// Greedy with lazy evaluation (Minoux: Accelerated Greedy Algorithms for Maximizing Submodular Set Functions, 1978):
/// again and again the candidate that adds most, the lower number of equals, as far as it may join. Stops at
/// `problem.most`, at the wanted coverage if that is below 1, or where none adds anything. Without a graph it is within
/// 1 − 1/e of the best (Nemhauser, Wolsey, Fisher, 1978). Returns existing and chosen candidates in order.
std::vector<std::size_t> greedy(const CoverProblem& problem);

/// Local search: replaces one chosen candidate by another for as long as coverage grows, the best replacement of each
/// in turn; existing ones stay. Never loses coverage, breaks no exclusion and, where the problem has a `link`, no
/// connection. Deterministic unless stopped. REQUIRES: `chosen` begins with the existing candidates.
std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                          std::stop_token stop = {});

/// What min_connected_cover() found.
struct ConnectedCover {
  CoverSolution best;
  /// The best network of one candidate fewer, which does not do; empty where none was looked for.
  std::optional<CoverSolution> one_fewer = std::nullopt;
};

/// A network of few candidates with the wanted coverage and links. From `start`, or from one that grows along links, it
/// goes on to one candidate fewer for as long as that succeeds, by a tabu search over swaps (Glover: Tabu Search, Part
/// I, 1989). Where no network of at most `problem.most` does, it is the one of least violation that was met.
/// Deterministic unless stopped; a stopped call returns what it has, a network that grew at least.
ConnectedCover min_connected_cover(const CoverProblem& problem, std::stop_token stop = {},
                                   std::optional<CoverSolution> start = {});

/// At the same number of candidates, swaps first until nothing is violated, then for a stronger weakest link for as
/// long as that succeeds. Never worse than `from`. Deterministic unless stopped.
CoverSolution improve_weakest_link(const CoverProblem& problem, CoverSolution from, std::stop_token stop = {});

/// How bounds are computed.
struct BoundConfig {
  double tolerance = 0.001;  ///< How exactly the linear relaxation is solved, in coverage.
  double max_seconds = 120;  ///< For each relaxation; one that is cut short still bounds, less tightly. 0: no limit.
  double exact_seconds = 0;  ///< For branch and bound; 0: a choice by greedy and swaps alone.
};

Settings settings(const BoundConfig& config);

/// The most coverage of `problem.most` further candidates: a good network, and a bound that none of as many exceeds.
///
/// The bound is that of the linear relaxation max Σ w_e z_e, z_e <= b_e + Σ_k y_k min(a_ke / goal, 1), Σ y <= N,
/// 0 <= y, z <= 1, by Benders cuts; b_e is what existing candidates give. Branch and bound lowers it where it is given
/// time. Only then do exclusions and links enter it, links as a flow (Dehbi, Leonhardt, Oehrlein, Haunert: Optimal scan
/// planning with enforced network connectivity, 2021). The wanted coverage is not looked at. A stopped call returns
/// what is known by then. Throws Error invalid_argument for no candidates, or `problem.most` of none or without a
/// limit.
CoverSolution max_cover(const CoverProblem& problem, const BoundConfig& config = {}, const Progress& progress = {});

/// How many further candidates a wanted coverage takes.
struct StationsBound {
  bool possible = false;                 ///< False: all candidates together do not have the coverage.
  std::size_t at_least = 0;              ///< No fewer candidates have it. Proven.
  double relaxation = 0;                 ///< The bound before it is rounded up.
  bool complete = false;                 ///< The relaxation came to its tolerance in time.
  std::vector<std::size_t> chosen = {};  ///< A network that has it, existing candidates first. Empty if not possible.
};

/// Bounds the number of candidates from below for `problem.coverage`. Links and exclusions are not looked at. Throws
/// Error invalid_argument for no candidates, or unless 0 < coverage <= 1.
StationsBound min_cover(const CoverProblem& problem, const BoundConfig& config = {}, const Progress& progress = {});

}  // namespace vantage
