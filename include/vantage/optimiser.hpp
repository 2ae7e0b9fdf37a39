// SPDX-License-Identifier: Apache-2.0
/// CMA-ES and MO-CMA-ES by ask/tell, and exact hypervolumes. Knows nothing of scanners.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace vantage {

/// Why an optimiser stopped, or `running`.
enum class StopReason {
  running,
  max_evaluations,
  max_iterations,
  target_reached,
  converged,        ///< Steps or differences fell below what numbers can tell apart.
  stagnated,        ///< No improvement for long.
  flat,             ///< The objective does not change over a whole population.
  invalid_objective,///< Every value of an iteration was NaN.
  max_time,
  cancelled,
};
std::string to_string(StopReason);

/// Box constraints, one pair per coordinate.
struct Bounds {
  std::vector<double> lower, upper;
  static Bounds uniform(std::size_t dimension, double lower, double upper);
};

/// One point with its objective values, all minimised.
struct ParetoPoint {
  std::vector<double> x, f;
};

// ---- single objective ------------------------------------------------------------------------------------------------

struct CmaEsConfig {
  std::size_t population = 0;             ///< λ; 0: 4 + floor(3 ln n).
  double sigma0 = 0.2;                    ///< Initial step; a share of the range where there are bounds, else absolute.
  std::vector<double> start = {};         ///< Initial mean; empty: random inside the bounds, else 0.
  std::optional<Bounds> bounds = std::nullopt;
  bool active = true;                     ///< Negative weights for the worst half (active CMA).
  std::size_t restarts = 0;               ///< Restarts with doubled population after a stall (IPOP).
  std::size_t max_iterations = 0;         ///< 0: no limit.
  std::size_t max_evaluations = 0;        ///< 0: no limit.
  std::optional<double> target = std::nullopt;  ///< Stop at f <= target.
  double f_tolerance = 1e-12;             ///< Stop when the best values of recent iterations differ by less. 0: never.
  double x_tolerance = 1e-12;             ///< Stop when all steps are below this share of sigma0. 0: never.
  std::uint64_t seed = 1;
};

/// CMA-ES (Hansen: The CMA Evolution Strategy, A Tutorial, 2016). ask() gives λ points, tell() takes their values in order.
class CmaEs {
 public:
  /// Throws Error invalid_argument.
  CmaEs(std::size_t dimension, const CmaEsConfig& config = {});
  CmaEs(CmaEs&&) noexcept;
  CmaEs& operator=(CmaEs&&) noexcept;
  ~CmaEs();
  /// λ points, row-major, inside the bounds. Valid until the next call of a non-const member.
  std::span<const double> ask();
  /// REQUIRES: one value per asked point. NaN counts as worst.
  void tell(std::span<const double> values);
  StopReason stop_reason() const noexcept;
  const ParetoPoint& best() const noexcept;
  std::size_t population() const noexcept;
  std::size_t evaluations() const noexcept;
  std::size_t iterations() const noexcept;
  double sigma() const noexcept;
  void save(std::ostream&) const;   ///< Complete state, binary, versioned. Only between tell() and ask().
  void load(std::istream&);         ///< Throws Error malformed_file.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- several objectives ----------------------------------------------------------------------------------------------

struct MoCmaEsConfig {
  /// generational: μ parents, μ offspring each iteration. steady_state: one at a time, or `batch` at a time.
  enum class Scheme { generational, steady_state };
  Scheme scheme = Scheme::steady_state;
  std::size_t population = 100;           ///< μ.
  std::size_t batch = 1;                  ///< Offspring asked for at once in the steady state, so that a GPU is kept full.
  double sigma0 = 0.2;                    ///< Share of the range where there are bounds, else absolute.
  std::optional<Bounds> bounds = std::nullopt;
  std::vector<double> reference = {};     ///< Reference point of the hypervolume; empty: (1, …, 1).
  std::vector<std::vector<double>> start = {};  ///< First points of the initial population; the rest is uniform in the bounds.
  std::size_t max_iterations = 0;         ///< Of μ evaluations each. 0: no limit.
  std::size_t max_evaluations = 0;        ///< 0: no limit.
  std::optional<double> target_hypervolume = std::nullopt;
  std::size_t stagnation_iterations = 0;  ///< Stop when the hypervolume has not grown for so many. 0: never.
  std::uint64_t seed = 1;
};

/// MO-CMA-ES (Igel, Hansen, Roth: Covariance Matrix Adaptation for Multi-objective Optimization, 2007; Voß, Hansen, Igel: Improved
/// Step Size Adaptation for the MO-CMA-ES, 2010) with hypervolume indicator selection.
class MoCmaEs {
 public:
  /// Throws Error invalid_argument.
  MoCmaEs(std::size_t dimension, std::size_t objectives, const MoCmaEsConfig& config = {});
  MoCmaEs(MoCmaEs&&) noexcept;
  MoCmaEs& operator=(MoCmaEs&&) noexcept;
  ~MoCmaEs();
  /// Points to evaluate, row-major: the initial population first, then offspring. Valid until the next call of a non-const member.
  std::span<const double> ask();
  /// REQUIRES: objectives values per asked point, row-major, in order. A point with a NaN counts as dominated by all.
  void tell(std::span<const double> values);
  StopReason stop_reason() const noexcept;
  std::vector<ParetoPoint> front() const;       ///< Non-dominated members of the population, sorted by f[0].
  std::vector<ParetoPoint> population() const;
  double hypervolume() const;                   ///< Of the population against the reference point.
  std::size_t evaluations() const noexcept;
  std::size_t iterations() const noexcept;      ///< evaluations / μ.
  void save(std::ostream&) const;
  void load(std::istream&);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- hypervolume -----------------------------------------------------------------------------------------------------

/// Volume dominated by `points` (k × objectives, row-major, minimised) and bounded by `reference`. Points outside add nothing.
/// Exact; O(k log k) for 2 and 3 objectives, WFG above, up to 6. Throws Error invalid_argument.
double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference);
/// What each point alone contributes.
std::vector<double> hypervolume_contributions(std::span<const double> points, std::size_t objectives,
                                              std::span<const double> reference);
/// Rank of each point: 0 non-dominated, 1 non-dominated without rank 0, …
std::vector<std::size_t> non_dominated_ranks(std::span<const double> points, std::size_t objectives);

}  // namespace vantage
