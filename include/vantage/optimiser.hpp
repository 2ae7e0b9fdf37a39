// SPDX-License-Identifier: Apache-2.0
/// CMA-ES and MO-CMA-ES by ask/tell, and exact hypervolumes. Independent of scanners.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/search_types.hpp"

namespace vantage {

/// Box constraints, one pair per coordinate.
struct Bounds {
  std::vector<double> lower, upper;  ///< One value for each coordinate.
  /// The same bounds for every coordinate.
  static Bounds uniform(std::size_t dimension, double lower, double upper);
};

/// Settings of CMA-ES alone.
struct CmaEsConfig {
  bool active = true;  ///< Negative weights for the worst half (active CMA).
  /// Stops at f <= target. Like OptimiserConfig::target_hypervolume, but to any number of digits.
  std::optional<double> target = std::nullopt;
  double f_tolerance = 1e-12;  ///< Converged once the best values of recent iterations differ by less. 0: never.
};

/// Settings of MO-CMA-ES alone.
struct MoCmaEsConfig {
  MoScheme scheme = MoScheme::steady_state;  ///< Competition among offspring.
  std::size_t batch = 1;                     ///< Offspring asked for at once in the steady state, to keep a GPU busy.
  /// The next four apply to the steady state; all 0 gives the published algorithm. With them it needs a fraction of the
  /// evaluations on planning problems and leaves local fronts (measured in docs/evidence/optimisers.md).
  double guided = 0.5;   ///< Share of parents drawn by hypervolume contribution instead of uniformly from the front.
  double spread = 0.25;  ///< Share of steps that also follow the differences to the parent's neighbours on the front.
  double recombined = 0.15;  ///< Share of offspring by crossover and mutation, as in NSGA-II. Needs bounds.
  double swapped = 0.4;  ///< Share of offspring with one of the parent's `blocks` taken from elsewhere. Needs bounds.
  /// Number of coordinates above which each of `blocks` has its own covariance; coordinates outside of blocks have a
  /// variance each. Otherwise one covariance serves all, which takes n² doubles a member.
  std::size_t full_covariance = 160;
  /// For noisy values that reassess() changes from time to time, in the steady state. Members removed since the last
  /// call stay in population(), behind the current ones; reassess() chooses the members among all of them. A merely
  /// lucky point thus cannot replace a better one for good.
  bool recalls = false;
};

/// Settings of every optimiser; each ignores what it does not use.
struct OptimiserConfig {
  std::size_t population = 0;  ///< λ of CMA-ES, 0: 4 + floor(3 ln n). μ of the others, 0: 100.
  double sigma0 = 0.2;         ///< Initial step: a share of the range if there are bounds, else absolute.
  std::optional<Bounds> bounds = std::nullopt;  ///< Empty: none.
  /// First points of the initial population; the rest is uniform in the bounds, or, without bounds, normal around the
  /// first point (or 0). CMA-ES takes the first as its initial mean; without one it is random inside the bounds, else
  /// 0.
  std::vector<std::vector<double>> start = {};
  std::vector<double> reference = {};  ///< Reference point of the hypervolume; empty: (1, …, 1).
  /// Interchangeable groups of coordinates, such as the stations of a network. All have one length, share no
  /// coordinate, and the k-th coordinates of all have the same bounds. Empty: none.
  /// CMA-ES and MO-CMA-ES make some of their points by moving one block of a known point elsewhere (docs/method.md).
  /// CMA-ES leaves blocks out of the search if no point of an iteration uses them.
  std::vector<std::vector<std::size_t>> blocks = {};
  /// Number of blocks that count in x, the first ones. Empty: all. Must return the same for the same x.
  std::function<std::size_t(std::span<const double> x)> blocks_in_use = {};
  /// Number of restarts of a converged search. CMA-ES without blocks restarts at a new random mean with twice the
  /// population (IPOP). With blocks it keeps its population and restarts at its best point, with three quarters of the
  /// blocks moved to random places. MO-CMA-ES keeps its population; all steps restart at sigma0.
  std::size_t restarts = 0;
  double x_tolerance = 1e-12;  ///< Converged once all steps are below this share of sigma0. 0: never.

  // Rules that end a search whatever its restarts, checked after every tell().
  std::size_t max_iterations = 0;                           ///< 0: no limit.
  std::size_t max_evaluations = 0;                          ///< 0: no limit.
  std::optional<double> target_hypervolume = std::nullopt;  ///< Stops at hypervolume() >= target_hypervolume.
  /// Stops as `stagnated` when the hypervolume has not grown for this many iterations. 0: never.
  std::size_t stagnation_iterations = 0;
  /// Growth over those iterations, as a share of the hypervolume, that counts as no growth.
  double stagnation_tolerance = 1e-6;

  std::uint64_t seed = 1;  ///< Seed of all random numbers.
  CmaEsConfig cma = {};    ///< For CMA-ES.
  MoCmaEsConfig mo = {};   ///< For MO-CMA-ES.
};

/// Interface of all optimisers: ask() for points, evaluate them, tell() their objectives. All objectives are minimised.
/// Not thread-safe; several can coexist. The same seed and values give the same bits.
class Optimiser {
 public:
  virtual ~Optimiser() = default;
  virtual std::size_t dimension() const noexcept = 0;   ///< Number of coordinates.
  virtual std::size_t objectives() const noexcept = 0;  ///< Number of objectives.
  /// Points to evaluate, row-major, inside the bounds. Valid until the next tell() or load(). Another ask() before
  /// tell() returns the same points.
  virtual std::span<const double> ask() = 0;
  /// Between ask() and tell(): replaces point `index` by x, as if it had been drawn. Throws Error invalid_argument
  /// outside the bounds.
  virtual void replace(std::size_t index, std::span<const double> x) = 0;
  /// Between ask() and tell(): redraws `coordinates` of point `index`, given its others, and returns the point.
  virtual std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) = 0;
  /// REQUIRES: objectives() values per asked point, row-major, in order. A point with a value that is not finite is
  /// dominated by all points with finite values.
  virtual void tell(std::span<const double> values) = 0;
  /// Between tell() and ask(): replaces the objectives of the points of population(), row-major, in its order, e.g. by
  /// more accurate values. The search keeps what it learnt from the old ones; stagnation counts anew. Afterwards
  /// population() may be in another order, and smaller (`MoCmaEsConfig::recalls`).
  virtual void reassess(std::span<const double> values) = 0;
  /// Precedence among several: the search's own reason, then the limits, the target, stagnation.
  virtual StopReason stop_reason() const noexcept = 0;
  /// Non-dominated points of the population, sorted by f[0].
  virtual std::vector<ParetoPoint> front() const = 0;
  /// Points kept from iteration to iteration.
  virtual std::vector<ParetoPoint> population() const = 0;
  /// Hypervolume of the population against the reference point. With one objective: reference minus the best value, at
  /// least 0.
  virtual double hypervolume() const = 0;
  virtual std::size_t evaluations() const noexcept = 0;  ///< Points told so far.
  /// Complete iterations: evaluations / μ; for CMA-ES the calls of tell().
  virtual std::size_t iterations() const noexcept = 0;
  /// Saves the complete state, binary, versioned. Only between tell() and ask(). Throws Error io.
  virtual void save(std::ostream&) const = 0;
  /// Continues from a saved state to the same bits. Dimension, objectives and settings must be those of the saved
  /// optimiser. Stopping rules (max_*, targets, stagnation, tolerances, restarts) may differ; this object's apply.
  /// Throws Error malformed_file and is unchanged then.
  virtual void load(std::istream&) = 0;
};

/// CMA-ES (Hansen: The CMA Evolution Strategy, A Tutorial, 2016) for one objective, with IPOP restarts (Auger, Hansen
/// 2005). ask() gives λ points. A smooth transform of the coordinates keeps bounds. Its population and its front are
/// the best point; otherwise it keeps only a distribution.
class CmaEs final : public Optimiser {
 public:
  /// Throws Error invalid_argument.
  explicit CmaEs(std::size_t dimension, const OptimiserConfig& config = {});
  CmaEs(CmaEs&&) noexcept;
  CmaEs& operator=(CmaEs&&) noexcept;
  ~CmaEs() override;
  std::size_t dimension() const noexcept override;
  std::size_t objectives() const noexcept override { return 1; }
  std::span<const double> ask() override;
  void replace(std::size_t index, std::span<const double> x) override;
  std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) override;
  void tell(std::span<const double> values) override;
  void reassess(std::span<const double> values) override;
  StopReason stop_reason() const noexcept override;
  /// Best point of all restarts. Its f is +infinity until a finite value was told.
  const ParetoPoint& best() const noexcept;
  std::vector<ParetoPoint> front() const override;  ///< best(), or none until a finite value was told.
  std::vector<ParetoPoint> population() const override { return front(); }
  double hypervolume() const override;
  std::size_t lambda() const noexcept;  ///< Points of an iteration now; without blocks they double at a restart.
  std::size_t evaluations() const noexcept override;
  std::size_t iterations() const noexcept override;
  std::size_t restarts() const noexcept;  ///< Restarts so far.
  double sigma() const noexcept;          ///< Step size now.
  void save(std::ostream&) const override;
  void load(std::istream&) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// MO-CMA-ES (Igel, Hansen, Roth: Covariance Matrix Adaptation for Multi-objective Optimization, 2007; Voß, Hansen,
/// Igel: Improved Step Size Adaptation for the MO-CMA-ES, 2010) with hypervolume indicator selection. ask() gives the
/// initial population first, then offspring.
class MoCmaEs final : public Optimiser {
 public:
  /// Throws Error invalid_argument.
  MoCmaEs(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config = {});
  MoCmaEs(MoCmaEs&&) noexcept;
  MoCmaEs& operator=(MoCmaEs&&) noexcept;
  ~MoCmaEs() override;
  std::size_t dimension() const noexcept override;
  std::size_t objectives() const noexcept override;
  std::span<const double> ask() override;
  void replace(std::size_t index, std::span<const double> x) override;
  std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) override;
  void tell(std::span<const double> values) override;
  void reassess(std::span<const double> values) override;
  StopReason stop_reason() const noexcept override;
  std::vector<ParetoPoint> front() const override;
  std::vector<ParetoPoint> population() const override;
  double hypervolume() const override;
  std::size_t evaluations() const noexcept override;
  std::size_t iterations() const noexcept override;
  std::size_t restarts() const noexcept;  ///< Restarts so far.
  void save(std::ostream&) const override;
  void load(std::istream&) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Hypervolume.

/// Volume dominated by `points` (k × objectives, row-major, minimised) and bounded by `reference`. Points outside add
/// nothing. Exact; O(k log k) for 2 and 3 objectives, WFG above, up to 6. Throws Error invalid_argument.
double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference);
/// Volume that each point alone contributes.
std::vector<double> hypervolume_contributions(std::span<const double> points, std::size_t objectives,
                                              std::span<const double> reference);
/// Rank of each point: 0 non-dominated, 1 non-dominated without rank 0, …
std::vector<std::size_t> non_dominated_ranks(std::span<const double> points, std::size_t objectives);

}  // namespace vantage
