// SPDX-License-Identifier: Apache-2.0
// Igel, Hansen, Roth: Covariance Matrix Adaptation for Multi-objective Optimization, 2007 (the strategy of each member:
// algorithms 1–4); Voß, Hansen, Igel: Improved Step Size Adaptation for the MO-CMA-ES, 2010 (success of the
// generational scheme); Igel, Suttorp, Hansen: Steady-State Selection and Efficient Covariance Matrix Update in the
// Multi-objective CMA-ES, 2007; Krause, Igel: A More Efficient Rank-one Covariance Matrix Update for Evolution
// Strategies, 2015 (triangular factor).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "optimise/conditional.hpp"
#include "optimise/hypervolume.hpp"
#include "optimise/mo_common.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using optimise::MoCommon;
using optimise::Solution;
using Scheme = MoCmaEsConfig::Scheme;

constexpr double kTargetSuccess = 1 / 5.5;
constexpr double kSuccessRate = kTargetSuccess / (2 + kTargetSuccess);
constexpr double kSuccessThreshold = 0.44;
constexpr double kPenalty = 1e-6;
constexpr int kRedraws = 10;       // before what lies outside the box is clipped
constexpr double kMaxSigma = 1e6;  // keeps samples finite where every step succeeds
constexpr std::string_view kKind = "MO-CMA-ES";

// The shape of a member's steps: C = factor · factorᵀ and its evolution path. Never changed once made, so that it can
// be shared.
struct Shape {
  MatrixXd factor;
  VectorXd path;
};

struct Member : Solution {
  VectorXd genotype;  // unit coordinates; may lie outside the box, where x is clipped
  double sigma = 0, success = kTargetSuccess;
  std::shared_ptr<const Shape> shape;
  std::uint64_t id = 0;
};

struct Offspring {
  VectorXd genotype;
  VectorXd step;  // in unit coordinates, divided by the parent's sigma
  double penalty = 0, sigma = 0, success = 0;
  std::shared_ptr<const Shape> shape;  // the parent's
  std::uint64_t parent = 0;
  VectorXd origin;  // the parent's unit coordinates
};

// A ← factor of decay · A Aᵀ + gain · v vᵀ; false if rounding broke it.
bool update_factor(MatrixXd& a, double decay, double gain, VectorXd v) {
  const Index n = a.rows();
  const double scale = std::sqrt(decay);
  double b = 1;
  for (Index j = 0; j < n; ++j) {
    const double old = scale * a(j, j), w = v[j];
    const double now = std::sqrt(old * old + gain / b * w * w);
    const double gamma = old * old * b + gain * w * w;
    if (!(old > 0) || !std::isfinite(now) || !(gamma > 0)) return false;
    const Index rest = n - j - 1;
    auto column = a.col(j).tail(rest);
    auto remaining = v.tail(rest);
    column *= scale;
    remaining -= (w / old) * column;
    column = (now / old) * column + (now * gain * w / gamma) * remaining;
    a(j, j) = now;
    b += gain * w * w / (old * old);
  }
  return true;
}

}  // namespace

struct MoCmaEs::Impl {
  Impl(std::size_t dimension, std::size_t objectives, const MoCmaEsConfig& config)
      : common("MO-CMA-ES", dimension, objectives, config) {
    const auto n = static_cast<Index>(dimension);
    initial_shape = std::make_shared<const Shape>(Shape{MatrixXd::Identity(n, n), VectorXd::Zero(n)});
  }

  VectorXd to_unit(std::span<const double> x) const {
    VectorXd t(static_cast<Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) t[static_cast<Index>(i)] = common.box.to_unit(x[i], i);
    return t;
  }
  bool within(double t) const { return !common.box.bounded() || (t >= 0 && t <= 1); }
  bool within(const VectorXd& t) const {
    return std::all_of(t.begin(), t.end(), [&](double v) { return within(v); });
  }
  // Offspring of a member, into point k.
  void draw(const Member& parent, std::size_t k);
  // Puts unit coordinates, clipped where they lie outside, into point k, with the penalty and the step that belong to
  // it.
  void express(std::size_t k, VectorXd t);
  std::vector<std::size_t> choose_parents(std::size_t count);

  void tell_initial(std::vector<Solution> solutions);
  void tell_generation(std::vector<Solution> solutions);
  void tell_one(Solution solution, const Offspring& offspring);
  Member make_member(Solution solution, const Offspring& offspring, bool success) const;
  void adapt_step(double& sigma, double& success_rate, bool success) const;
  bool converged() const;
  std::size_t find(std::uint64_t id) const;

  MoCommon common;
  std::shared_ptr<const Shape> initial_shape;
  std::vector<Member> members;
  std::uint64_t next_id = 0;
  std::vector<Offspring> pending;
};

void MoCmaEs::Impl::express(std::size_t k, VectorXd t) {
  Offspring& o = pending[k];
  const auto point = common.point(k);
  o.penalty = 0;
  for (std::size_t i = 0; i < common.dimension; ++i) {
    const auto axis = static_cast<Index>(i);
    if (!within(t[axis])) {
      const double clipped = std::clamp(t[axis], 0.0, 1.0);
      o.penalty += kPenalty * (t[axis] - clipped) * (t[axis] - clipped);
      point[i] = common.box.from_unit(clipped, i);
    } else {
      point[i] = common.box.from_unit(t[axis], i);
    }
  }
  o.step = (t - o.origin) / o.sigma;
  o.genotype = std::move(t);
}

// Drawn again a few times while outside the box, then clipped. A step keeps the point where it fell, not where it was
// clipped: the half of a normal that truncation leaves would teach the path to lead away from the bound.
void MoCmaEs::Impl::draw(const Member& parent, std::size_t k) {
  const auto n = static_cast<Index>(common.dimension);
  Offspring& o = pending[k];
  o.sigma = parent.sigma;
  o.success = parent.success;
  o.shape = parent.shape;
  o.parent = parent.id;
  o.origin = parent.genotype;
  VectorXd normals(n), t = o.origin;
  common.random.fill_normal({normals.data(), common.dimension});
  const MatrixXd& factor = o.shape->factor;
  for (int attempt = 0;; ++attempt) {
    for (Index i = 0; i < n; ++i) t.tail(n - i) += (o.sigma * normals[i]) * factor.col(i).tail(n - i);
    if (attempt == kRedraws || within(t)) break;
    common.random.fill_normal({normals.data(), common.dimension});
    t = o.origin;
  }
  express(k, std::move(t));
}

std::vector<std::size_t> MoCmaEs::Impl::choose_parents(std::size_t count) {
  std::vector<std::size_t> result(count);
  if (common.config.scheme == Scheme::generational) {
    std::iota(result.begin(), result.end(), std::size_t{0});
    return result;
  }
  std::vector<double> fitness;
  for (const Member& member : members) fitness.insert(fitness.end(), member.fitness.begin(), member.fitness.end());
  const auto rank = optimise::ranks({fitness, common.objectives});
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (rank[i] == 0) best.push_back(i);
  for (std::size_t& parent : result) parent = best[common.random.index(best.size())];
  return result;
}

void MoCmaEs::Impl::adapt_step(double& sigma, double& success_rate, bool success) const {
  const double damping = 1 + static_cast<double>(common.dimension) / 2;
  success_rate = (1 - kSuccessRate) * success_rate + (success ? kSuccessRate : 0.0);
  sigma *= std::exp((success_rate - kTargetSuccess) / (damping * (1 - kTargetSuccess)));
  sigma = std::clamp(sigma, 1e-300, kMaxSigma);
}

Member MoCmaEs::Impl::make_member(Solution solution, const Offspring& o, bool success) const {
  const double n = static_cast<double>(common.dimension);
  const double c_c = 2 / (n + 2), c_cov = 2 / (n * n + 6);
  Member member;
  static_cast<Solution&>(member) = std::move(solution);
  member.genotype = o.genotype;
  member.sigma = o.sigma;
  member.success = o.success;
  adapt_step(member.sigma, member.success, success);
  Shape shape = *o.shape;
  shape.path *= 1 - c_c;
  double decay = 1 - c_cov;
  if (member.success < kSuccessThreshold) {
    shape.path += std::sqrt(c_c * (2 - c_c)) * o.step;
  } else {
    decay += c_cov * c_c * (2 - c_c);
  }
  const bool sound = update_factor(shape.factor, decay, c_cov, shape.path) && shape.factor.allFinite();
  member.shape = sound ? std::make_shared<const Shape>(std::move(shape)) : initial_shape;
  return member;
}

std::size_t MoCmaEs::Impl::find(std::uint64_t id) const {
  const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.id == id; });
  return static_cast<std::size_t>(found - members.begin());
}

void MoCmaEs::Impl::tell_initial(std::vector<Solution> solutions) {
  for (Solution& solution : solutions) {
    Member member;
    static_cast<Solution&>(member) = std::move(solution);
    member.genotype = to_unit(member.x);
    member.sigma = common.config.sigma0;
    member.shape = initial_shape;
    member.id = next_id++;
    members.push_back(std::move(member));
  }
}

// (μ + μ): an offspring succeeds when it is selected.
void MoCmaEs::Impl::tell_generation(std::vector<Solution> solutions) {
  const std::size_t mu = members.size(), m = common.objectives, total = mu + solutions.size();
  std::vector<double> fitness;
  fitness.reserve(total * m);
  for (const Member& member : members) fitness.insert(fitness.end(), member.fitness.begin(), member.fitness.end());
  for (const Solution& s : solutions) fitness.insert(fitness.end(), s.fitness.begin(), s.fitness.end());
  std::vector<char> selected = optimise::select(fitness, common.reference, mu);

  std::vector<Member> next;
  next.reserve(mu);
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    if (selected[mu + k]) {
      next.push_back(make_member(std::move(solutions[k]), pending[k], true));
      next.back().id = next_id++;
    }
    adapt_step(members[k].sigma, members[k].success, selected[mu + k]);
  }
  std::vector<Member> survivors;
  survivors.reserve(mu);
  for (std::size_t i = 0; i < mu; ++i)
    if (selected[i]) survivors.push_back(std::move(members[i]));
  std::move(next.begin(), next.end(), std::back_inserter(survivors));
  members = std::move(survivors);
}

// (μ + 1): an offspring succeeds when it is selected and its rank among the μ + 1 is not worse than its parent's.
void MoCmaEs::Impl::tell_one(Solution solution, const Offspring& offspring) {
  const std::size_t mu = members.size(), m = common.objectives;
  std::vector<double> fitness;
  fitness.reserve((mu + 1) * m);
  for (const Member& member : members) fitness.insert(fitness.end(), member.fitness.begin(), member.fitness.end());
  fitness.insert(fitness.end(), solution.fitness.begin(), solution.fitness.end());
  const auto rank = optimise::ranks({fitness, m});
  const std::size_t worst = *std::max_element(rank.begin(), rank.end());
  std::vector<std::size_t> last;
  std::vector<double> last_fitness;
  for (std::size_t i = 0; i <= mu; ++i) {
    if (rank[i] != worst) continue;
    last.push_back(i);
    last_fitness.insert(last_fitness.end(), fitness.begin() + static_cast<std::ptrdiff_t>(i * m),
                        fitness.begin() + static_cast<std::ptrdiff_t>((i + 1) * m));
  }
  const std::size_t removed = last[optimise::surplus(last_fitness, common.reference, 1).front()];
  const std::size_t parent = find(offspring.parent);
  const bool success = removed != mu && (parent == mu || rank[mu] <= rank[parent]);
  if (parent < mu) adapt_step(members[parent].sigma, members[parent].success, success);
  if (removed == mu) return;
  members[removed] = make_member(std::move(solution), offspring, success);
  members[removed].id = next_id++;
}

bool MoCmaEs::Impl::converged() const {
  return std::all_of(members.begin(), members.end(), [&](const Member& member) {
    return member.sigma * member.shape->factor.rowwise().norm().maxCoeff() < common.config.x_tolerance;
  });
}

MoCmaEs::MoCmaEs(std::size_t dimension, std::size_t objectives, const MoCmaEsConfig& config)
    : impl_(std::make_unique<Impl>(dimension, objectives, config)) {}
MoCmaEs::MoCmaEs(MoCmaEs&&) noexcept = default;
MoCmaEs& MoCmaEs::operator=(MoCmaEs&&) noexcept = default;
MoCmaEs::~MoCmaEs() = default;

std::span<const double> MoCmaEs::ask() {
  Impl& s = *impl_;
  MoCommon& c = s.common;
  if (c.asked() != 0) return c.points();
  const std::size_t mu = c.config.population;
  if (s.members.empty()) {
    c.begin_ask(mu);
    s.pending.assign(mu, {});
    for (std::size_t k = 0; k < mu; ++k) std::ranges::copy(c.initial_point(k), c.point(k).begin());
    return c.points();
  }
  const std::size_t count = c.config.scheme == Scheme::generational ? mu : c.config.batch;
  const auto parents = s.choose_parents(count);
  c.begin_ask(count);
  s.pending.assign(count, {});
  for (std::size_t k = 0; k < count; ++k) s.draw(s.members[parents[k]], k);
  return c.points();
}

void MoCmaEs::replace(std::size_t index, std::span<const double> x) {
  Impl& s = *impl_;
  s.common.require_asked("replace");
  s.common.require_index(index);
  s.common.box.require_inside(x);
  std::ranges::copy(x, s.common.point(index).begin());
  if (s.members.empty()) return;
  Offspring& o = s.pending[index];
  o.penalty = 0;
  o.genotype = s.to_unit(x);
  o.step = (o.genotype - o.origin) / o.sigma;
}

std::span<const double> MoCmaEs::resample(std::size_t index, std::span<const std::size_t> coordinates) {
  Impl& s = *impl_;
  MoCommon& c = s.common;
  c.require_asked("resample");
  c.require_index(index);
  c.require_coordinates(coordinates);
  if (coordinates.empty()) return c.point(index);
  if (s.members.empty()) {
    const auto x = c.initial_point(c.config.start.size());
    for (const std::size_t i : coordinates) c.point(index)[i] = x[i];
    return c.point(index);
  }
  const Offspring& o = s.pending[index];
  const auto n = static_cast<Index>(c.dimension), k = static_cast<Index>(coordinates.size());
  const auto lower = o.shape->factor.triangularView<Eigen::Lower>();
  MatrixXd columns = MatrixXd::Zero(n, k);
  VectorXd step = o.step;
  for (Index j = 0; j < k; ++j) {
    const auto axis = static_cast<Index>(coordinates[static_cast<std::size_t>(j)]);
    columns(axis, j) = 1;
    step[axis] = 0;
  }
  lower.solveInPlace(columns);
  const VectorXd rest = lower.solve(step);
  VectorXd t = o.genotype;
  for (int redraw = 0; redraw < kRedraws; ++redraw) {
    const VectorXd drawn = optimise::draw_conditional(columns, rest, c.random);
    bool fits = true;
    for (Index j = 0; j < k; ++j) {
      const auto axis = static_cast<Index>(coordinates[static_cast<std::size_t>(j)]);
      t[axis] = o.origin[axis] + o.sigma * drawn[j];
      fits &= s.within(t[axis]);
    }
    if (fits) break;
  }
  s.express(index, std::move(t));
  return c.point(index);
}

void MoCmaEs::tell(std::span<const double> values) {
  Impl& s = *impl_;
  std::vector<double> penalties;
  for (const Offspring& o : s.pending) penalties.push_back(o.penalty);
  auto solutions = s.common.take(values, penalties);
  if (s.members.empty()) {
    s.tell_initial(std::move(solutions));
  } else if (s.common.config.scheme == Scheme::generational) {
    s.tell_generation(std::move(solutions));
  } else {
    for (std::size_t k = 0; k < solutions.size(); ++k) s.tell_one(std::move(solutions[k]), s.pending[k]);
  }
  s.pending.clear();
  s.common.watch(s.members, s.converged());
}

StopReason MoCmaEs::stop_reason() const noexcept { return impl_->common.stop_reason(); }
std::vector<ParetoPoint> MoCmaEs::front() const { return optimise::front_of(optimise::pointers(impl_->members)); }
std::vector<ParetoPoint> MoCmaEs::population() const {
  std::vector<ParetoPoint> result;
  for (const Member& member : impl_->members) result.push_back({member.x, member.f});
  return result;
}
double MoCmaEs::hypervolume() const { return impl_->common.hypervolume(impl_->members); }
std::size_t MoCmaEs::evaluations() const noexcept { return impl_->common.evaluations; }
std::size_t MoCmaEs::iterations() const noexcept { return evaluations() / impl_->common.config.population; }

void MoCmaEs::save(std::ostream& out) const {
  const Impl& s = *impl_;
  s.common.require_not_asked("save");
  optimise::StateWriter w;
  s.common.save(w);
  w.put(s.next_id);
  w.put(std::uint64_t{s.members.size()});
  for (const Member& member : s.members) {
    MoCommon::save(w, member);
    w.put(member.id);
    w.put(std::span(member.genotype.data(), s.common.dimension));
    w.put(member.sigma);
    w.put(member.success);
    w.put(std::span(member.shape->path.data(), static_cast<std::size_t>(member.shape->path.size())));
    for (Index j = 0; j < member.shape->factor.cols(); ++j)
      w.put(std::span(member.shape->factor.col(j).data() + j, s.common.dimension - static_cast<std::size_t>(j)));
  }
  w.write(out, kKind);
}

void MoCmaEs::load(std::istream& in) {
  optimise::StateReader r(in, kKind);
  const MoCommon& mine = impl_->common;
  auto next = std::make_unique<Impl>(mine.dimension, mine.objectives, mine.config);
  next->common.restore(mine.read(r));
  next->next_id = r.integer();
  const std::size_t count = r.size(mine.config.population + 1), n = mine.dimension;
  for (std::size_t i = 0; i < count; ++i) {
    Member member;
    static_cast<Solution&>(member) = next->common.load_solution(r);
    member.id = r.integer();
    member.genotype.resize(static_cast<Index>(n));
    std::ranges::copy(r.finite_reals(n), member.genotype.data());
    member.sigma = r.positive();
    member.success = r.finite();
    Shape shape = *next->initial_shape;
    std::ranges::copy(r.finite_reals(n), shape.path.data());
    for (std::size_t j = 0; j < n; ++j) {
      const auto column = r.finite_reals(n - j);
      std::ranges::copy(column, shape.factor.col(static_cast<Index>(j)).data() + j);
    }
    member.shape = std::make_shared<const Shape>(std::move(shape));
    next->members.push_back(std::move(member));
  }
  r.end();
  impl_ = std::move(next);
}

}  // namespace vantage
