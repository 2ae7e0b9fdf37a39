// SPDX-License-Identifier: Apache-2.0
// Hansen: The CMA Evolution Strategy, A Tutorial, 2016: weights (49)–(53), paths (43), (45), covariance (47), step
// (44), and the stopping rules of its appendix B.3. Returned share of the negative update: Hansen, Ros: Benchmarking a
// Weighted Negative Covariance Matrix Update on the BBOB-2010 Noiseless Testbed, 2010. Restarts: Auger, Hansen: A
// Restart CMA Evolution Strategy With Increasing Population Size, 2005.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/first_numbers.hpp"
#include "optimise/as_span.hpp"
#include "optimise/blocks.hpp"
#include "optimise/common.hpp"
#include "optimise/conditional.hpp"
#include "optimise/hypervolume.hpp"
#include "optimise/infinity.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using optimise::Common;
using optimise::kInfinity;
using optimise::kMaxPopulation;

constexpr double kMaxCondition = 1e14;
constexpr double kMaxGrowth = 1e4;  // of the step along the longest axis, times its share of sigma0
// Share of the worse half's negative update that the better half returns to the covariance; the old covariance keeps
// the rest.
constexpr double kReturned = 0.5;
constexpr std::size_t kFlatIterations = 20;  // the step grows a thousandfold meanwhile
constexpr std::size_t kMaxHistory = 20000;
// Share of an iteration's points with a swapped block, at least one; none if too few points would be left to rank. More
// if the number of blocks is searched, too, since local optima are then many.
constexpr double kSwapped = 0.1, kSwappedOfMany = 0.25;
constexpr std::size_t kSwapsFrom = 5;
// For a run that begins at the best point so far: its step as a share of sigma0, and the step by which it must have
// caught up.
constexpr double kNextStep = 0.5, kLateStep = 0.1;
constexpr std::string_view kCmaEs = "CMA-ES";

// Learning rates and weights, which depend only on n and λ.
struct Strategy {
  Strategy() = default;
  Strategy(double n, std::size_t lambda, bool active);

  VectorXd weights;   // of the best μ in the mean
  VectorXd learning;  // of all λ in the covariance, negative ones last
  std::size_t mu = 0;
  double mu_eff = 0, c_sigma = 0, d_sigma = 0, c_c = 0, c_1 = 0, c_mu = 0, expected_norm = 0;
};

Strategy::Strategy(double n, std::size_t lambda, bool active) : learning(static_cast<Eigen::Index>(lambda)) {
  for (std::size_t i = 0; i < lambda; ++i)
    learning[static_cast<Eigen::Index>(i)] =
        std::log((static_cast<double>(lambda) + 1) / 2) - std::log(static_cast<double>(i) + 1);
  mu = lambda / 2;
  const auto split = static_cast<Eigen::Index>(mu);
  auto positive = learning.head(split), negative = learning.tail(learning.size() - split);
  mu_eff = positive.sum() * positive.sum() / positive.squaredNorm();
  const double mu_eff_negative = negative.sum() * negative.sum() / negative.squaredNorm();
  c_sigma = (mu_eff + 2) / (n + mu_eff + 5);
  d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (n + 1)) - 1) + c_sigma;
  c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n);
  c_1 = 2 / ((n + 1.3) * (n + 1.3) + mu_eff);
  c_mu = std::min(1 - c_1, 2 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((n + 2) * (n + 2) + mu_eff));
  expected_norm = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  positive /= positive.sum();
  weights = positive;
  if (!active) {
    negative.setZero();
    return;
  }
  const double limit =
      std::min({1 + c_1 / c_mu, 1 + 2 * mu_eff_negative / (mu_eff + 2), (1 - c_1 - c_mu) / (n * c_mu)});
  negative *= limit / negative.cwiseAbs().sum();
  positive *= 1 + kReturned * limit;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::size_t default_population(std::size_t dimension) {
  return 4 + static_cast<std::size_t>(3 * std::log(static_cast<double>(std::max<std::size_t>(dimension, 1))));
}

bool is_stall(StopReason reason) {
  return reason == StopReason::converged || reason == StopReason::stagnated || reason == StopReason::flat ||
         reason == StopReason::ill_conditioned || reason == StopReason::diverged;
}

}  // namespace

struct CmaEs::Impl : Common {
  Impl(std::size_t dimension, const OptimiserConfig& c);

  void begin_run();  // a fresh distribution with the current λ
  void draw();
  double phenotype(double g, std::size_t axis) const {
    return box.bounded() ? box.from_unit(optimise::squeeze(g), axis) : g;
  }
  double genotype(double x, std::size_t axis) const {
    return box.bounded() ? optimise::unsqueeze(box.to_unit(x, axis)) : x;
  }
  // Writes the genotype mean + sigma · steps.col(k) to the points.
  void express(std::size_t k);
  std::vector<double> first_mean() const { return config.start.empty() ? std::vector<double>() : config.start.front(); }
  bool swaps() const { return box.bounded() && !config.blocks.empty(); }
  std::size_t swaps_of(std::size_t count) const {
    if (!swaps() || count < kSwapsFrom) return 0;
    const double share = config.blocks_in_use ? kSwappedOfMany : kSwapped;
    return std::max(std::size_t{1}, static_cast<std::size_t>(share * static_cast<double>(count)));
  }
  std::size_t blocks_in_use(std::span<const double> x) const {
    const std::size_t all = config.blocks.size();
    return config.blocks_in_use ? std::clamp<std::size_t>(config.blocks_in_use(x), 1, all) : all;
  }
  // Moves the mean to the best point, with three quarters of its blocks at random places.
  void begin_beside_best();
  // Restricts the search to the first blocks, and discards what the distribution learnt of the others.
  void use_blocks(std::size_t count);
  // Leaves out the blocks that no point of the iteration uses.
  void leave_unused();
  // Makes a coordinate independent of all others.
  void forget(Eigen::Index axis, double variance);
  // Sets point λ + s to the mean with one block at a random place.
  void swap_block(std::size_t s);
  // Moves the mean's block to its place in point λ + s, and discards what the distribution learnt of that block.
  void adopt_swap(std::size_t s);
  void update(const std::vector<std::size_t>& order);
  void decompose(bool now);
  StopReason stall(const std::vector<double>& sorted) const;
  void restart_if_at_rest();
  double hypervolume() const { return optimise::volume({best.f, 1}, reference); }
  // After every tell() and load(). Precedence: the target for f, the run's own reason, the common rules.
  void settle();

  const std::size_t n;       // dimension
  std::size_t asked_points;  // λ, and those with swapped blocks
  std::size_t lambda = 0;
  std::size_t used_blocks = 0;  // most blocks that any point of the iteration uses
  std::size_t used = 0;         // coordinates except those of unused blocks
  Strategy strategy;

  VectorXd mean, path_c, path_sigma, axis_lengths;
  MatrixXd covariance, axes;
  double sigma = 0;
  std::size_t decomposed_at = 0;  // evaluations of the run
  std::size_t iterations = 0, restarts = 0, run_iterations = 0, run_evaluations = 0, flat_iterations = 0;
  std::vector<double> best_history, median_history;  // of the run
  double run_best = kInfinity;
  ParetoPoint best;
  StopReason own = StopReason::running;  // the run's own reason to stop

  MatrixXd steps;                    // one column for each of λ points, (genotype − mean) / sigma
  std::vector<std::size_t> swapped;  // block of each further point
};

CmaEs::Impl::Impl(std::size_t d, const OptimiserConfig& c)
    : Common(std::string(kCmaEs), d, 1, c, default_population(d)), n(d), asked_points(config.population) {
  if (config.population < 2)
    throw Error(Errc::invalid_argument, name + ": a population of " + std::to_string(config.population) +
                                            " cannot be ranked; give 0 or at least 2");
  optimise::require_blocks(config.blocks, box, n);
  best.f = {kInfinity};
  begin_run();
}

void CmaEs::Impl::begin_run() {
  const auto size = static_cast<Eigen::Index>(n);
  lambda = asked_points - swaps_of(asked_points);
  use_blocks(config.blocks.size());
  sigma = config.sigma0;
  mean = VectorXd::Zero(size);
  const bool first = restarts == 0;
  for (std::size_t i = 0; i < n; ++i) {
    double& m = mean[static_cast<Eigen::Index>(i)];
    if (first && !config.start.empty()) {
      m = genotype(config.start.front()[i], i);
    } else if (box.bounded()) {
      m = random.uniform();
    } else {
      m = (config.start.empty() ? 0.0 : config.start.front()[i]) + (first ? 0.0 : sigma * random.normal());
    }
  }
  if (!first && swaps() && !best.x.empty()) begin_beside_best();
  path_c = path_sigma = VectorXd::Zero(size);
  axis_lengths = VectorXd::Ones(size);
  covariance = axes = MatrixXd::Identity(size, size);
  decomposed_at = run_iterations = run_evaluations = flat_iterations = 0;
  run_best = kInfinity;
  best_history.clear();
  median_history.clear();
}

void CmaEs::Impl::begin_beside_best() {
  for (std::size_t i = 0; i < n; ++i) mean[static_cast<Eigen::Index>(i)] = genotype(best.x[i], i);
  std::vector<std::size_t> order = first_numbers(blocks_in_use(best.x));
  for (std::size_t k = 0; k < (3 * order.size() + 3) / 4; ++k) {
    std::swap(order[k], order[k + random.index(order.size() - k)]);
    for (const std::size_t i : config.blocks[order[k]]) mean[static_cast<Eigen::Index>(i)] = random.uniform();
  }
  sigma *= kNextStep;
}

void CmaEs::Impl::use_blocks(std::size_t count) {
  used_blocks = count;
  used = n;
  for (std::size_t b = count; b < config.blocks.size(); ++b) used -= config.blocks[b].size();
  strategy = Strategy(static_cast<double>(used), lambda, config.cma.active);
}

void CmaEs::Impl::forget(Eigen::Index axis, double variance) {
  path_c[axis] = path_sigma[axis] = 0;
  covariance.row(axis).setZero();
  covariance.col(axis).setZero();
  covariance(axis, axis) = variance;
}

void CmaEs::Impl::leave_unused() {
  if (!swaps() || !config.blocks_in_use) return;
  std::size_t most = 1;
  for (std::size_t k = 0; k < lambda; ++k) most = std::max(most, blocks_in_use(point(k)));
  const bool changes = most != used_blocks;
  if (changes) use_blocks(most);
  const auto unused = std::span(config.blocks).subspan(most);
  double variance = covariance.trace();
  for (const auto& block : unused)
    for (const std::size_t i : block)
      variance -= covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
  variance /= static_cast<double>(used);
  for (const auto& block : unused) {
    for (const std::size_t i : block) {
      forget(static_cast<Eigen::Index>(i), variance);
      steps.row(static_cast<Eigen::Index>(i)).setZero();
    }
  }
  if (changes) decompose(true);
}

void CmaEs::Impl::express(std::size_t k) {
  const auto column = steps.col(static_cast<Eigen::Index>(k));
  const auto x = point(k);
  for (std::size_t i = 0; i < n; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    x[i] = phenotype(mean[axis] + sigma * column[axis], i);
  }
}

void CmaEs::Impl::draw() {
  steps.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(lambda));
  begin_ask(asked_points);
  VectorXd normals(static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < lambda; ++k) {
    random.fill_normal(as_span(normals));
    steps.col(static_cast<Eigen::Index>(k)).noalias() = axes * axis_lengths.cwiseProduct(normals);
    express(k);
  }
  swapped.resize(asked_points - lambda);
  for (std::size_t s = 0; s < swapped.size(); ++s) swap_block(s);
}

void CmaEs::Impl::swap_block(std::size_t s) {
  const auto x = point(lambda + s);
  for (std::size_t i = 0; i < n; ++i) x[i] = phenotype(mean[static_cast<Eigen::Index>(i)], i);
  swapped[s] = random.index(blocks_in_use(x));
  for (const std::size_t i : config.blocks[swapped[s]]) x[i] = box.from_unit(random.uniform(), i);
}

void CmaEs::Impl::adopt_swap(std::size_t s) {
  const double variance = covariance.diagonal().mean();
  for (const std::size_t i : config.blocks[swapped[s]]) {
    const auto axis = static_cast<Eigen::Index>(i);
    mean[axis] = genotype(point(lambda + s)[i], i);
    forget(axis, variance);
  }
}

void CmaEs::Impl::update(const std::vector<std::size_t>& order) {
  leave_unused();
  const Strategy& s = strategy;
  const double searched = static_cast<double>(used);
  VectorXd step = VectorXd::Zero(mean.size());
  for (std::size_t i = 0; i < s.mu; ++i)
    step += s.weights[static_cast<Eigen::Index>(i)] * steps.col(static_cast<Eigen::Index>(order[i]));
  mean += sigma * step;

  const auto whitened = [&](const VectorXd& y) -> VectorXd {
    return (axes.transpose() * y).cwiseQuotient(axis_lengths);
  };
  path_sigma *= 1 - s.c_sigma;
  path_sigma += std::sqrt(s.c_sigma * (2 - s.c_sigma) * s.mu_eff) * (axes * whitened(step));
  const double norm = path_sigma.norm();
  const double settled = std::sqrt(1 - std::pow(1 - s.c_sigma, 2.0 * static_cast<double>(run_iterations + 1)));
  const bool moving = norm / settled >= (1.4 + 2 / (searched + 1)) * s.expected_norm;  // if so, hold path_c back
  path_c *= 1 - s.c_c;
  if (!moving) path_c += std::sqrt(s.c_c * (2 - s.c_c) * s.mu_eff) * step;

  const double lost = moving ? s.c_1 * s.c_c * (2 - s.c_c) : 0.0;
  covariance *= 1 + lost - s.c_1 - s.c_mu * s.learning.sum();
  MatrixXd scaled(steps.rows(), steps.cols());
  VectorXd weights = s.learning;
  for (std::size_t i = 0; i < lambda; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    scaled.col(column) = steps.col(static_cast<Eigen::Index>(order[i]));
    // A long bad step must not take more than its length in the current metric, or C would lose its definiteness.
    if (weights[column] < 0) weights[column] *= searched / std::max(whitened(scaled.col(column)).squaredNorm(), 1e-300);
  }
  covariance.noalias() += s.c_1 * path_c * path_c.transpose();
  covariance.noalias() += s.c_mu * scaled * weights.asDiagonal() * scaled.transpose();
  sigma *= std::exp(std::min(1.0, s.c_sigma / s.d_sigma * (norm / s.expected_norm - 1)));
  sigma = std::max(sigma, 1e-300);  // stall() stops it long before
}

void CmaEs::Impl::decompose(bool now) {
  const double wait = 1 / ((strategy.c_1 + strategy.c_mu) * static_cast<double>(used) * 10);
  if (!now && static_cast<double>(run_evaluations - decomposed_at) < wait * static_cast<double>(lambda)) return;
  decomposed_at = run_evaluations;
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance);
  axes = solver.eigenvectors();
  // Rounding can make the smallest value negative at a condition number near 1e16; stall() sees that value.
  axis_lengths = solver.eigenvalues().cwiseMax(solver.eigenvalues().maxCoeff() * 1e-18).cwiseSqrt();
}

StopReason CmaEs::Impl::stall(const std::vector<double>& sorted) const {
  const auto moderate = [](const auto& a) { return a.allFinite() && a.cwiseAbs().maxCoeff() <= optimise::kModerate; };
  if (!moderate(mean) || !moderate(path_c) || !moderate(path_sigma) || !moderate(covariance) ||
      !moderate(axis_lengths) || !(sigma <= optimise::kModerate))
    return StopReason::diverged;
  if (flat_iterations >= kFlatIterations) return StopReason::flat;
  const double longest = axis_lengths.maxCoeff(), shortest = axis_lengths.minCoeff();
  if (sigma * longest > kMaxGrowth * config.sigma0 * std::max(1.0, std::sqrt(longest))) return StopReason::diverged;
  if (longest * longest > kMaxCondition * shortest * shortest) return StopReason::ill_conditioned;

  const double length = std::max(path_c.cwiseAbs().maxCoeff(), std::sqrt(covariance.diagonal().maxCoeff()));
  if (sigma * length < config.x_tolerance * config.sigma0) return StopReason::converged;
  if (swaps() && run_best > best.f[0] + config.cma.f_tolerance && sigma * length < kLateStep * config.sigma0)
    return StopReason::stagnated;
  const std::size_t recent = 10 + (30 * used + lambda - 1) / lambda;
  if (config.cma.f_tolerance > 0 && flat_iterations == 0 && best_history.size() > recent) {
    const auto [low, high] =
        std::minmax_element(best_history.end() - static_cast<std::ptrdiff_t>(recent), best_history.end());
    if (std::max(*high, sorted.back()) - std::min(*low, sorted.front()) < config.cma.f_tolerance)
      return StopReason::converged;
  }
  // Steps too small to change the mean, along an axis (one per iteration, in turn) or a coordinate.
  const auto axis = static_cast<Eigen::Index>(run_iterations % n);
  if (mean == mean + 0.1 * sigma * axis_lengths[axis] * axes.col(axis)) return StopReason::converged;
  for (Eigen::Index i = 0; i < mean.size(); ++i)
    if (mean[i] == mean[i] + 0.2 * sigma * std::sqrt(covariance(i, i))) return StopReason::converged;

  const std::size_t window = std::clamp<std::size_t>(run_iterations / 5, 120 + 30 * used / lambda, kMaxHistory);
  if (best_history.size() >= window && config.cma.f_tolerance > 0) {
    const auto no_better = [&](const std::vector<double>& history) {
      const auto third = static_cast<std::ptrdiff_t>(3 * window / 10);
      const auto begin = history.end() - static_cast<std::ptrdiff_t>(window);
      return median({history.end() - third, history.end()}) >= median({begin, begin + third});
    };
    if (no_better(best_history) && no_better(median_history)) return StopReason::stagnated;
  }
  return StopReason::running;
}

void CmaEs::Impl::restart_if_at_rest() {
  if (!is_stall(own) || restarts >= config.restarts || asked_points > kMaxPopulation / 2) return;
  ++restarts;
  if (!swaps()) asked_points *= 2;
  begin_run();
  own = StopReason::running;
}

void CmaEs::Impl::settle() {
  const bool reached = config.cma.target && best.f[0] <= *config.cma.target;
  judge(reached ? StopReason::target_reached : own, iterations, [this] { return hypervolume(); });
}

CmaEs::CmaEs(std::size_t dimension, const OptimiserConfig& config) : impl_(std::make_unique<Impl>(dimension, config)) {}
CmaEs::CmaEs(CmaEs&&) noexcept = default;
CmaEs& CmaEs::operator=(CmaEs&&) noexcept = default;
CmaEs::~CmaEs() = default;

std::size_t CmaEs::dimension() const noexcept { return impl_->dimension; }

std::span<const double> CmaEs::ask() {
  if (impl_->asked() == 0) impl_->draw();
  return impl_->points();
}

void CmaEs::replace(std::size_t index, std::span<const double> x) {
  Impl& s = *impl_;
  s.require_point("replace", index);
  s.box.require_inside(x);
  const auto whole = s.point(index);
  if (index >= s.lambda) {
    std::ranges::copy(x, whole.begin());
    return;
  }
  auto column = s.steps.col(static_cast<Eigen::Index>(index));
  for (std::size_t i = 0; i < s.n; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    if (whole[i] == x[i]) continue;  // unchanged; its genotype may lie beyond a bound and stays as drawn
    whole[i] = x[i];
    column[axis] = (s.genotype(x[i], i) - s.mean[axis]) / s.sigma;
  }
}

std::span<const double> CmaEs::resample(std::size_t index, std::span<const std::size_t> coordinates) {
  Impl& s = *impl_;
  s.require_point("resample", index);
  s.require_coordinates(coordinates);
  const auto whole = s.point(index);
  if (index >= s.lambda) {
    for (const std::size_t i : coordinates) whole[i] = s.box.from_unit(s.random.uniform(), i);
    return whole;
  }
  MatrixXd columns(static_cast<Eigen::Index>(s.n), static_cast<Eigen::Index>(coordinates.size()));
  VectorXd step = s.steps.col(static_cast<Eigen::Index>(index));
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const auto axis = static_cast<Eigen::Index>(coordinates[k]);
    columns.col(static_cast<Eigen::Index>(k)) = s.axes.row(axis).transpose().cwiseQuotient(s.axis_lengths);
    step[axis] = 0;
  }
  if (!coordinates.empty()) {
    const VectorXd rest = (s.axes.transpose() * step).cwiseQuotient(s.axis_lengths);
    const VectorXd drawn = optimise::draw_conditional(columns, rest, s.random);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const auto axis = static_cast<Eigen::Index>(coordinates[k]);
      s.steps(axis, static_cast<Eigen::Index>(index)) = drawn[static_cast<Eigen::Index>(k)];
    }
    s.express(index);
  }
  return whole;
}

void CmaEs::tell(std::span<const double> values) {
  Impl& s = *impl_;
  s.take(values);
  const auto split = values.begin() + static_cast<std::ptrdiff_t>(s.lambda);
  std::vector<double> f(values.begin(), split);
  std::size_t best_swap = 0;
  double best_swapped = kInfinity;
  for (auto v = split; v != values.end(); ++v) {
    if (!std::isfinite(*v) || *v >= best_swapped) continue;
    best_swapped = *v;
    best_swap = static_cast<std::size_t>(v - split);
  }
  for (double& v : f)
    if (!std::isfinite(v)) v = kInfinity;
  std::vector<std::size_t> order = first_numbers(s.lambda);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return f[a] < f[b]; });
  std::sort(f.begin(), f.end());
  s.run_evaluations += s.lambda;
  ++s.iterations;
  if (f.front() == kInfinity) {
    s.own = StopReason::invalid_objective;
    s.settle();
    return;
  }
  const bool adopts = best_swapped < f.front();
  if (std::min(f.front(), best_swapped) < s.best.f[0]) {
    const std::size_t best = adopts ? s.lambda + best_swap : order[0];
    const auto x = s.point(best);
    s.best = {{x.begin(), x.end()}, {std::min(f.front(), best_swapped)}};
  }
  s.run_best = std::min({s.run_best, f.front(), best_swapped});
  s.best_history.push_back(f.front());
  s.median_history.push_back(f[s.lambda / 2]);
  if (s.best_history.size() > 2 * kMaxHistory) {
    const auto surplus = static_cast<std::ptrdiff_t>(s.best_history.size() - kMaxHistory);
    s.best_history.erase(s.best_history.begin(), s.best_history.begin() + surplus);
    s.median_history.erase(s.median_history.begin(), s.median_history.begin() + surplus);
  }
  if (f.front() == f.back()) {
    // A plateau says nothing about shape: only widen the search.
    ++s.flat_iterations;
    s.sigma *= std::exp(0.2 + s.strategy.c_sigma / s.strategy.d_sigma);
  } else {
    s.flat_iterations = 0;
    s.update(order);
  }
  if (adopts) s.adopt_swap(best_swap);
  ++s.run_iterations;
  if (s.covariance.allFinite()) s.decompose(adopts);
  s.own = s.stall(f);
  s.restart_if_at_rest();
  if (s.own == StopReason::diverged) s.begin_run();  // later points must be finite, too
  s.settle();
}

void CmaEs::reassess(std::span<const double> values) {
  Impl& s = *impl_;
  s.require_reassessable(values, s.best.x.empty() ? 0 : 1);
  if (!values.empty()) s.best.f[0] = s.run_best = std::isfinite(values[0]) ? values[0] : kInfinity;
  // Convergence is judged by differences of values, and these were measured differently.
  s.best_history.clear();
  s.median_history.clear();
  s.forget_progress();
  s.settle();
}

StopReason CmaEs::stop_reason() const noexcept { return impl_->stop_reason(); }
const ParetoPoint& CmaEs::best() const noexcept { return impl_->best; }
std::vector<ParetoPoint> CmaEs::front() const {
  if (impl_->best.x.empty()) return {};
  return {impl_->best};
}
double CmaEs::hypervolume() const { return impl_->hypervolume(); }
std::size_t CmaEs::lambda() const noexcept { return impl_->asked_points; }
std::size_t CmaEs::evaluations() const noexcept { return impl_->evaluations; }
std::size_t CmaEs::iterations() const noexcept { return impl_->iterations; }
std::size_t CmaEs::restarts() const noexcept { return impl_->restarts; }
double CmaEs::sigma() const noexcept { return impl_->sigma; }

void CmaEs::save(std::ostream& out) const {
  const Impl& s = *impl_;
  s.require_not_asked("save");
  optimise::StateWriter w;
  s.Common::save(w);
  w.put(s.config.cma.active);
  w.put(s.first_mean());
  optimise::save_blocks(w, s.config.blocks);
  for (const std::size_t v : {s.asked_points, s.decomposed_at, s.iterations, s.restarts, s.run_iterations,
                              s.run_evaluations, s.flat_iterations, s.used_blocks, static_cast<std::size_t>(s.own)})
    w.put(std::uint64_t{v});
  w.put(s.sigma);
  w.put(s.run_best);
  for (const VectorXd* v : {&s.mean, &s.path_c, &s.path_sigma, &s.axis_lengths}) w.put(as_span(*v));
  for (const MatrixXd* a : {&s.covariance, &s.axes}) w.put(as_span(*a));
  w.put(s.best_history);
  w.put(s.median_history);
  w.put(s.best.x);
  w.put(s.best.f[0]);
  w.write(out, kCmaEs);
}

void CmaEs::load(std::istream& in) {
  optimise::StateReader r(in, kCmaEs);
  auto next = std::make_unique<Impl>(impl_->n, impl_->config);
  Impl& s = *next;
  s.Common::load(r);
  r.expect(std::uint64_t{s.config.cma.active}, "active flag");
  r.expect(s.first_mean(), "start");
  optimise::expect_blocks(r, s.config.blocks);
  s.asked_points = std::max<std::size_t>(2, r.size(kMaxPopulation + 1));
  s.lambda = s.asked_points - s.swaps_of(s.asked_points);
  constexpr std::size_t kMany = std::size_t{1} << 62;
  for (std::size_t* v :
       {&s.decomposed_at, &s.iterations, &s.restarts, &s.run_iterations, &s.run_evaluations, &s.flat_iterations})
    *v = r.size(kMany);
  s.use_blocks(r.size(s.config.blocks.size() + 1));
  s.own = r.stop_reason();
  s.sigma = r.positive();
  s.run_best = r.real();
  const auto fill = [&](double* out, std::size_t count) {
    for (const double v : r.moderate_reals(count)) *out++ = v;
  };
  for (VectorXd* v : {&s.mean, &s.path_c, &s.path_sigma, &s.axis_lengths}) fill(v->data(), s.n);
  for (MatrixXd* a : {&s.covariance, &s.axes}) fill(a->data(), s.n * s.n);
  s.best_history = r.reals();
  s.median_history = r.reals(s.best_history.size());
  s.best.x = r.reals();
  s.best.f[0] = r.real();
  r.end();
  s.restart_if_at_rest();  // the limit of restarts may be higher than when it was saved
  s.settle();
  impl_ = std::move(next);
}

}  // namespace vantage
