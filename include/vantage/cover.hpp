// SPDX-License-Identifier: Apache-2.0
/// Chooses stations from a finite set of candidates: covering problems on plain arrays.
///
/// A candidate is a column of a sparse matrix. Its entries are the amounts that it adds to elements, each of which is
/// covered once it has its goal g_e. With a_ke the amount of candidate k in element e and w_e its weight, a set S has
/// the coverage F(S) = Σ_e w_e min(Σ_{k ∈ S} a_ke, g_e) / Σ_e w_e g_e. F grows with S and its gains shrink: it is
/// monotone and submodular.
/// Two problems of the literature on facility location are solved: the most coverage of N candidates (maximal covering:
/// Church, ReVelle: The Maximal Covering Location Problem, 1974) and the fewest candidates of some coverage (partial
/// set cover). Candidates may have to form one connected network, and pairs may be excluded. In a survey a candidate is
/// an allowed position, an element a voxel, and an amount the points in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Sparse matrix of the amount that each candidate adds to each element: 8 bytes an entry.
class CoverageMatrix {
 public:
  /// Amount that a candidate adds to one element.
  struct Entry {
    std::uint32_t element = 0;  ///< Its number, from 0.
    std::uint32_t amount = 0;   ///< At least 1.
  };

  CoverageMatrix() = default;
  /// Makes one without candidates. `weights`: one for each element. REQUIRES: goal > 0.
  CoverageMatrix(std::vector<std::uint32_t> weights, double goal);

  std::size_t candidates() const noexcept { return offsets_.size() - 1; }  ///< Number of candidates: columns.
  std::size_t elements() const noexcept { return weights_.size(); }        ///< Number of elements: rows.
  /// Entries of a candidate, by rising element. REQUIRES: candidate < candidates().
  std::span<const Entry> column(std::size_t candidate) const {
    return std::span(entries_).subspan(offsets_[candidate], offsets_[candidate + 1] - offsets_[candidate]);
  }
  const std::vector<std::uint32_t>& weights() const noexcept { return weights_; }  ///< w_e of each element.
  double goal() const noexcept { return goal_; }  ///< The amount that covers an element where all have one goal.
  /// The amount that covers an element. REQUIRES: element < elements().
  double goal(std::size_t element) const { return goals_.empty() ? goal_ : goals_[element]; }
  /// w_e g_e, as a multiple of the common goal: what covering an element adds to F, times total_weight().
  double weight(std::size_t element) const { return goals_.empty() ? weights_[element] : shares_[element]; }
  double total_weight() const noexcept { return total_weight_; }  ///< Σ_e weight(e).

  /// Gives each element a goal of its own. An element whose goal is 0 no longer counts. Throws Error invalid_argument
  /// unless there is one for each, none below 0.
  void set_goals(std::span<const double> goals);

  /// Appends a candidate by its amount in each element. REQUIRES: amounts.size() == elements().
  void add(std::span<const std::uint32_t> amounts);
  /// Appends a candidate by its entries. REQUIRES: rising elements, amounts above 0.
  void add(std::span<const Entry> column);
  /// Appends the first `most` candidates of another matrix. Throws Error invalid_argument unless its weights and goals
  /// are the same.
  void append(const CoverageMatrix& other, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// F of a set of candidates, in [0, 1]. A candidate given twice counts twice.
  double coverage(std::span<const std::size_t> chosen) const;

 private:
  std::vector<std::uint32_t> weights_;
  double total_weight_ = 0, goal_ = 1;
  std::vector<double> goals_, shares_;  // by element; empty: the common goal
  std::vector<std::size_t> offsets_{0};
  std::vector<Entry> entries_;
};

/// Pairs of candidates: how much they overlap, and whether both may be chosen. Sparse: 16 bytes for each pair that
/// overlaps, 8 for each excluded one.
class StationGraph {
 public:
  /// Another candidate, and how much it overlaps with one.
  struct Overlap {
    std::uint32_t candidate = 0;  ///< Its number, from 0.
    float share = 0;              ///< Overlap of the two, in [0, 1].
  };

  StationGraph() = default;
  /// Makes a graph of `size` candidates without overlaps or exclusions.
  explicit StationGraph(std::size_t size) : overlaps_(size), excluded_(size) {}
  /// `overlaps`: size × size, row-major, symmetric; the diagonal is not read. Throws Error invalid_argument for any
  /// other number of values.
  StationGraph(std::size_t size, std::span<const float> overlaps);
  /// Overlap of two candidates: the elements that both cover in part, as a share of those of the candidate with fewer.
  /// Candidates from `seen.candidates()` to `size` overlap with none.
  StationGraph(const CoverageMatrix& seen, std::size_t size);
  /// Adds candidates up to `size`, with their overlaps among each other and with those before. REQUIRES: `seen` begins
  /// with the candidates before; size >= size().
  void extend(const CoverageMatrix& seen, std::size_t size);

  std::size_t size() const noexcept { return overlaps_.size(); }  ///< Number of candidates.
  /// 0 for candidates without a common element. REQUIRES: i, j < size(), as below.
  float overlap(std::size_t i, std::size_t j) const;
  /// Candidates that overlap with `i`, rising.
  std::span<const Overlap> overlaps(std::size_t i) const { return overlaps_[i]; }
  /// Returns true if an overlap of at least `least` links two candidates. REQUIRES: least > 0.
  bool linked(std::size_t i, std::size_t j, double least) const {
    return i != j && static_cast<double>(overlap(i, j)) >= least;
  }
  /// Returns true if no network may have both.
  bool excluded(std::size_t i, std::size_t j) const;
  /// Candidates that no network may have together with `i`, rising.
  std::span<const std::uint32_t> excluded(std::size_t i) const { return excluded_[i]; }

  /// Sets i, j and j, i. REQUIRES: i != j.
  void set_overlap(std::size_t i, std::size_t j, float overlap);
  /// No network may have both. REQUIRES: i != j.
  void exclude(std::size_t i, std::size_t j);
  /// Excludes all pairs whose positions are less than `least_m` apart, of which one is candidate `first` or a later
  /// one. REQUIRES: a position for each candidate.
  void exclude_nearer(std::span<const Vec3> positions, double least_m, std::size_t first = 0);
  /// Excludes the pairs that are nearer than the smaller of their two distances, and between which nothing stands.
  /// `parted`: whether something stands between two candidates; called from several threads. REQUIRES: a position and a
  /// distance for each candidate.
  void exclude_nearer(std::span<const Vec3> positions, std::span<const double> least_m,
                      const std::function<bool(std::size_t, std::size_t)>& parted, std::size_t first = 0);

 private:
  std::vector<std::vector<Overlap>> overlaps_;        // by candidate, each rising
  std::vector<std::vector<std::uint32_t>> excluded_;  // the same
};

/// A covering problem. Borrows the matrix and the graph.
struct CoverProblem {
  const CoverageMatrix& matrix;            ///< Amount that each candidate adds to each element.
  const StationGraph* graph = nullptr;     ///< Null: no overlaps and no exclusions.
  std::vector<std::size_t> existing = {};  ///< Candidates of every network, first in every solution.
  std::size_t fewest = 1;                  ///< Least number of further candidates.
  std::size_t most = std::numeric_limits<std::size_t>::max();  ///< Largest number of further candidates.
  double coverage = 1;                                         ///< Wanted coverage.
  double link = 0;  ///< Least overlap of the links that connect the network; 0: it need not be connected.
  /// Violation that min_connected_cover() has a further candidate make up for where no network is feasible. 0: any that
  /// helps is taken, however little.
  double least_help = 0;
};

/// A network, and bounds on others.
struct CoverSolution {
  std::vector<std::size_t> chosen = {};  ///< Existing candidates, then the others. Empty: none was found.
  double coverage = 0;                   ///< F(chosen).
  double link = 1;  ///< Weakest link of the maximum spanning tree; 1 for fewer than two candidates.
  /// Missing share of the wanted coverage, and 0.2 for each missing link. 0: the solution is feasible.
  double violation = 0;
  /// From max_cover(): a proven upper bound on the coverage of as many candidates.
  double bound = 1;
  double relaxation = 0;  ///< Coverage of a fractional choice, which no bound of the relaxation goes below.
  bool complete = false;  ///< The relaxation reached its tolerance in time.
  /// Bound for the first half of the candidates, and its growth with all of them. If candidates are spread evenly by
  /// halves, the growth measures what positions between them can add; it proves nothing.
  double half_bound = 1, spacing_term = 0;

  /// Possible gain in coverage, as a share of this network's.
  double gap() const { return relative_gap(bound, coverage); }
  /// The same of a bound and of what was reached; 0 if nothing was.
  static double relative_gap(double bound, double reached) {
    return bound > reached && reached > 0 ? bound / reached - 1 : 0;
  }
};

/// Returns a network of given candidates with its coverage, link and violation. Throws Error invalid_argument, as all
/// calls below, if a candidate does not exist, or if the graph and the matrix differ in size.
CoverSolution evaluate_cover(const CoverProblem& problem, std::vector<std::size_t> chosen);

/// Greedy with lazy evaluation (Minoux: Accelerated Greedy Algorithms for Maximizing Submodular Set Functions, 1978).
/// Each step takes the allowed candidate with the largest gain, the lower number among equals; if the problem has a
/// `link`, none that leaves the network in more parts than before. It stops at
/// `problem.most`, at the wanted coverage if that is below 1, or if no candidate adds anything. Without a graph the
/// result is within 1 − 1/e of the best (Nemhauser, Wolsey, Fisher, 1978). Returns existing candidates, then the chosen
/// ones in order.
std::vector<std::size_t> greedy(const CoverProblem& problem);

/// Local search: replaces one chosen candidate by another while coverage grows, with the best replacement of each in
/// turn. Existing ones stay. Keeps coverage, exclusions and, if the problem has a `link`, the number of parts or less.
/// Takes another 8 bytes for each entry of the matrix. Deterministic unless stopped. REQUIRES: `chosen` begins with the
/// existing candidates.
std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                          std::stop_token stop = {});

/// Result of min_connected_cover().
struct ConnectedCover {
  CoverSolution best;  ///< The best network found.
  /// The best network of one candidate fewer, which is not feasible; empty if none was searched.
  std::optional<CoverSolution> one_fewer = std::nullopt;
};

/// Finds a connected network of few candidates with the wanted coverage. It begins with `start`, or with a network that
/// grows along links. A tabu search over swaps (Glover: Tabu Search, Part I, 1989) then tries one candidate fewer,
/// while that succeeds. If no network of at most `problem.most` is feasible, the result has the least violation found.
/// Deterministic unless stopped; a stopped call returns at least a grown network.
ConnectedCover min_connected_cover(const CoverProblem& problem, std::stop_token stop = {},
                                   std::optional<CoverSolution> start = {});

/// Swaps at the same number of candidates, first until nothing is violated, then while the weakest link grows and is
/// below `enough`. The result is never worse than `from`. Deterministic unless stopped.
CoverSolution improve_weakest_link(const CoverProblem& problem, CoverSolution from, double enough = 1,
                                   std::stop_token stop = {});

/// Settings of bounds.
struct BoundConfig {
  double tolerance = 0.001;  ///< Accuracy of the linear relaxation, in coverage.
  double max_seconds = 120;  ///< Time limit of each relaxation; one that is cut short gives a weaker bound. 0: none.
  double exact_seconds = 0;  ///< Time for branch and bound; 0: greedy and swaps alone choose.
};

/// Its members as named values, for results.
Settings settings(const BoundConfig& config);

/// The most coverage of `problem.most` further candidates: a good network, and a bound for all networks of as many.
///
/// The bound is that of the linear relaxation max Σ w_e z_e, z_e <= b_e + Σ_k y_k min(a_ke / goal, 1), Σ y <= N, 0 <=
/// y, z <= 1, by Benders cuts; b_e is the share from existing candidates. Branch and bound lowers it if it has time.
/// Only then do exclusions and links enter it, links by separators around each root (Álvarez-Miranda, Ljubić, Mutzel:
/// The Maximum Weight Connected Subgraph Problem, 2013). The wanted coverage is ignored. A stopped call returns its
/// results so far. Throws Error invalid_argument without candidates, or if `problem.most` is 0 or has no limit.
CoverSolution max_cover(const CoverProblem& problem, const BoundConfig& config = {}, const Progress& progress = {});

/// Bound on the number of further candidates for a wanted coverage.
struct StationsBound {
  bool possible = false;     ///< False: all candidates together do not reach the coverage.
  std::size_t at_least = 0;  ///< Proven lower bound.
  double relaxation = 0;     ///< The bound before it is rounded up.
  bool complete = false;     ///< The relaxation reached its tolerance in time.
  /// A network that reaches it, existing candidates first. Empty if not possible.
  std::vector<std::size_t> chosen = {};
};

/// Bounds the number of candidates for `problem.coverage` from below. Links and exclusions are ignored. Throws Error
/// invalid_argument without candidates, or unless 0 < coverage <= 1.
StationsBound min_cover(const CoverProblem& problem, const BoundConfig& config = {}, const Progress& progress = {});

}  // namespace vantage
