// SPDX-License-Identifier: Apache-2.0
// Generational: Voß, Hansen, Igel: Improved Step Size Adaptation for the MO-CMA-ES, 2010.
// Steady state: Igel, Suttorp, Hansen: Steady-State Selection and Efficient Covariance Matrix Update in the
// Multi-objective CMA-ES, 2007. Guided parents and spread steps: Krause, Glasmachers, Hansen, Igel: Unbounded
// Population MO-CMA-ES for the Bi-objective BBOB Test Suite, 2016, here with a bounded population and any number of
// objectives.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "optimise/as_span.hpp"
#include "optimise/blocks.hpp"
#include "optimise/conditional.hpp"
#include "optimise/hypervolume.hpp"
#include "optimise/mo_common.hpp"
#include "optimise/steady_front.hpp"
#include "optimise/step_strategy.hpp"
#include "optimise/variation.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using optimise::Group;
using optimise::MoCommon;
using optimise::Shape;
using optimise::Solution;
using optimise::SteadyFront;
using optimise::StepStrategy;
using Scheme = MoScheme;

constexpr double kPenalty = 1e-6;  // per squared unit by which a point was clipped
constexpr int kRedraws = 1;        // of a whole point, before coordinates outside the box are clipped
// More for chosen coordinates, which are few and seldom all at a bound.
constexpr int kPartialRedraws = 16;
constexpr double kExtremes = 0.2;        // share of guided parents that are best in one objective
constexpr double kNeighbourShare = 0.4;  // of a spread step's variance
constexpr std::string_view kMoCmaEs = "MO-CMA-ES";

struct Member : Solution {
  VectorXd genotype;  // unit coordinates; may lie outside the box, whereas x is clipped
  StepStrategy strategy;
  std::uint64_t id = 0;
  bool reassessed = false;
};

struct Offspring {
  std::uint64_t parent = 0;
  StepStrategy strategy;  // of the parent
  VectorXd origin;        // the parent's genotype
  VectorXd genotype;
  double penalty = 0;
  bool recombined = false;  // not from a step of the strategy
  bool mixed = false;       // not from the strategy's normal distribution alone
  bool anywhere = false;    // a block was drawn from the whole box; a redraw does the same
};

// The front of the population, for choosing parents.
struct Front {
  std::vector<std::size_t> members;
  std::vector<double> weight_sums;    // by contribution; empty if parents are not guided
  std::vector<std::size_t> extremes;  // the best member in each objective
  std::vector<double> low, high;      // bounds of the fitness
};

}  // namespace

struct MoCmaEs::Impl {
  Impl(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config);

  VectorXd to_unit(std::span<const double> x) const;
  bool within(double t) const { return !common.box.bounded() || (t >= 0 && t <= 1); }
  bool within(const VectorXd& t) const {
    return std::all_of(t.begin(), t.end(), [&](double v) { return within(v); });
  }

  Front front() const;
  std::size_t choose_parent(const Front& front);
  void begin_offspring(const Member& parent, std::size_t k);
  void draw_step(const Member& parent, const Front* front, std::size_t k);
  void recombine(const Member& parent, std::size_t k);
  // Takes one of the parent's blocks from elsewhere: anywhere in the box, beside another of its blocks, or from a
  // member of the front.
  void swap_block(const Member& parent, const Front& front, std::size_t k);
  std::size_t blocks_in_use(const Member& member) const;
  VectorXd neighbour_step(const Member& parent, const Front& front);
  // Writes unit coordinates, clipped to the box, to point k, with the penalty for clipping.
  void express(std::size_t k, VectorXd genotype);

  void tell_initial(std::vector<Solution> solutions);
  void tell_generation(std::vector<Solution> solutions);
  void tell_one(Solution solution, const Offspring& offspring);
  Member make_member(Solution solution, const Offspring& offspring, bool succeeded);
  bool converged() const;
  void restart_if_at_rest();

  MoCommon common;
  std::shared_ptr<const Shape> initial_shape;
  std::vector<Member> members;
  SteadyFront population;          // in the steady state
  std::vector<Member> recallable;  // members removed since values were last reassessed
  std::uint64_t next_id = 0;
  std::size_t restarts = 0;
  std::vector<Offspring> pending;
};

MoCmaEs::Impl::Impl(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config)
    : common("MO-CMA-ES", dimension, objectives, config), population(objectives, common.reference) {
  for (const double share : {config.mo.guided, config.mo.spread, config.mo.recombined, config.mo.swapped})
    if (!(share >= 0 && share <= 1))
      throw Error(Errc::invalid_argument, "MO-CMA-ES: a share of " + std::to_string(share) + " is not in 0 to 1");
  optimise::require_blocks(config.blocks, common.box, dimension);
  initial_shape = Shape::identity(optimise::groups_of(dimension, config.blocks, config.mo.full_covariance));
}

VectorXd MoCmaEs::Impl::to_unit(std::span<const double> x) const {
  VectorXd t(static_cast<Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) t[static_cast<Index>(i)] = common.box.to_unit(x[i], i);
  return t;
}

// Offspring.

Front MoCmaEs::Impl::front() const {
  const std::size_t m = common.objectives;
  Front front;
  front.members.reserve(members.size());
  for (std::size_t i = 0; i < members.size(); ++i)
    if (population.rank(i) == 0) front.members.push_back(i);
  for (std::size_t j = 0; j < m; ++j) {
    const auto [low, high] = std::minmax_element(
        front.members.begin(), front.members.end(),
        [&](std::size_t a, std::size_t b) { return population.fitness(a)[j] < population.fitness(b)[j]; });
    front.extremes.push_back(*low);
    front.low.push_back(population.fitness(*low)[j]);
    front.high.push_back(population.fitness(*high)[j]);
  }
  if (common.config.mo.guided == 0) return front;
  front.weight_sums.reserve(front.members.size());
  double sum = 0;
  for (const std::size_t i : front.members) {
    const double contribution = population.contributions()[i];
    front.weight_sums.push_back(sum += contribution * contribution);
  }
  return front;
}

std::size_t MoCmaEs::Impl::choose_parent(const Front& front) {
  optimise::NormalStream& random = common.random;
  if (common.config.mo.guided > 0 && random.uniform() < common.config.mo.guided) {
    if (random.uniform() < kExtremes) return front.extremes[random.index(common.objectives)];
    const double sum = front.weight_sums.back();
    if (sum > 0) {
      const auto chosen =
          std::upper_bound(front.weight_sums.begin(), front.weight_sums.end() - 1, random.uniform() * sum);
      return front.members[static_cast<std::size_t>(chosen - front.weight_sums.begin())];
    }
  }
  return front.members[random.index(front.members.size())];
}

void MoCmaEs::Impl::begin_offspring(const Member& parent, std::size_t k) {
  pending[k] = {.parent = parent.id, .strategy = parent.strategy, .origin = parent.genotype, .genotype = {}};
}

void MoCmaEs::Impl::express(std::size_t k, VectorXd genotype) {
  Offspring& o = pending[k];
  const auto point = common.point(k);
  o.penalty = 0;
  for (std::size_t i = 0; i < common.dimension; ++i) {
    double t = genotype[static_cast<Index>(i)];
    if (!within(t)) {
      const double clipped = std::clamp(t, 0.0, 1.0);
      o.penalty += kPenalty * (t - clipped) * (t - clipped);
      t = clipped;
    }
    point[i] = common.box.from_unit(t, i);
  }
  // The genotype stays unclipped: truncated steps would teach the path to lead away from the bound.
  o.genotype = std::move(genotype);
}

void MoCmaEs::Impl::draw_step(const Member& parent, const Front* front, std::size_t k) {
  begin_offspring(parent, k);
  VectorXd centre = parent.genotype, genotype, normals(static_cast<Index>(common.dimension));
  double scale = parent.strategy.sigma;
  if (front != nullptr && common.config.mo.spread > 0 && common.random.uniform() < common.config.mo.spread) {
    centre += std::sqrt(kNeighbourShare) * neighbour_step(parent, *front);
    scale *= std::sqrt(1 - kNeighbourShare);
    pending[k].mixed = true;
  }
  for (int redraw = 0; redraw <= kRedraws; ++redraw) {
    common.random.fill_normal({normals.data(), common.dimension});
    genotype = centre;
    parent.strategy.shape->add_step(genotype, scale, normals);
    if (within(genotype)) break;
  }
  express(k, std::move(genotype));
}

// A normal step in the plane of the differences to the two nearest members on the front.
VectorXd MoCmaEs::Impl::neighbour_step(const Member& parent, const Front& front) {
  const Member* nearest[2] = {nullptr, nullptr};
  double distance[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const std::size_t i : front.members) {
    if (members[i].id == parent.id) continue;
    double d = 0;
    for (std::size_t j = 0; j < common.objectives; ++j) {
      const double range = front.high[j] - front.low[j];
      const double difference = range > 0 ? (members[i].fitness[j] - parent.fitness[j]) / range : 0.0;
      d += difference * difference;
    }
    if (d < distance[0]) {
      distance[1] = std::exchange(distance[0], d);
      nearest[1] = std::exchange(nearest[0], &members[i]);
    } else if (d < distance[1]) {
      distance[1] = d;
      nearest[1] = &members[i];
    }
  }
  VectorXd step = VectorXd::Zero(parent.genotype.size());
  for (const Member* neighbour : nearest)
    if (neighbour != nullptr) step += std::sqrt(0.5) * common.random.normal() * (neighbour->genotype - parent.genotype);
  return step;
}

void MoCmaEs::Impl::recombine(const Member& parent, std::size_t k) {
  begin_offspring(parent, k);
  const Member& other = members[common.random.index(members.size())];
  const VectorXd first = to_unit(parent.x);
  VectorXd second = to_unit(other.x), beyond = other.genotype;
  optimise::align_blocks(as_span(first), {second.data(), common.dimension}, {beyond.data(), common.dimension},
                         common.config.blocks);
  const optimise::VariationConfig variation;
  auto child = optimise::make_child(as_span(first), as_span(second), variation, common.random);
  if (std::ranges::equal(child, as_span(first)) || std::ranges::equal(child, as_span(second))) {  // a known point
    double& t = child[common.random.index(child.size())];
    t = optimise::mutate(t, variation.mutation_index, common.random);
  }
  VectorXd genotype = Eigen::Map<const VectorXd>(child.data(), first.size());
  // A coordinate inherited unchanged keeps its place beyond the bound, so the child's offspring stay there, too.
  for (Index i = 0; i < genotype.size(); ++i) {
    if (genotype[i] == first[i]) {
      genotype[i] = parent.genotype[i];
    } else if (genotype[i] == second[i]) {
      genotype[i] = beyond[i];
    }
  }
  pending[k].recombined = pending[k].mixed = true;
  express(k, std::move(genotype));
}

std::size_t MoCmaEs::Impl::blocks_in_use(const Member& member) const {
  const auto& config = common.config;
  return config.blocks_in_use ? std::clamp<std::size_t>(config.blocks_in_use(member.x), 1, config.blocks.size())
                              : config.blocks.size();
}

void MoCmaEs::Impl::swap_block(const Member& parent, const Front& front, std::size_t k) {
  begin_offspring(parent, k);
  Offspring& o = pending[k];
  o.recombined = o.mixed = true;
  optimise::NormalStream& random = common.random;
  const auto& blocks = common.config.blocks;
  const std::size_t in_use = blocks_in_use(parent);
  VectorXd genotype = parent.genotype;
  const std::size_t own = random.index(in_use), way = random.index(3);
  if (way == 0) {
    o.anywhere = true;
    for (const std::size_t i : blocks[own]) genotype[static_cast<Index>(i)] = random.uniform();
    express(k, std::move(genotype));
    return;
  }
  const Member& source = way == 1 ? parent : members[front.members[random.index(front.members.size())]];
  const bool beside = source.id == parent.id && in_use > 1;
  const VectorXd deviations = beside ? parent.strategy.shape->deviations() : VectorXd();
  const std::size_t taken =
      beside ? (own + 1 + random.index(in_use - 1)) % in_use : random.index(blocks_in_use(source));
  for (std::size_t d = 0; d < blocks[own].size(); ++d) {
    const auto from = static_cast<Index>(blocks[taken][d]), to = static_cast<Index>(blocks[own][d]);
    o.origin[to] = genotype[to] = source.genotype[from];
    if (beside) genotype[to] += parent.strategy.sigma * deviations[from] * random.normal();
  }
  express(k, std::move(genotype));
}

// Selection.

Member MoCmaEs::Impl::make_member(Solution solution, const Offspring& o, bool succeeded) {
  Member member;
  static_cast<Solution&>(member) = std::move(solution);
  member.genotype = o.genotype;
  member.strategy = o.strategy;
  member.id = next_id++;
  if (o.recombined) return member;
  member.strategy.adapt_sigma(succeeded);
  member.strategy.adapt_shape((o.genotype - o.origin) / o.strategy.sigma);
  return member;
}

void MoCmaEs::Impl::tell_initial(std::vector<Solution> solutions) {
  for (Solution& solution : solutions) {
    Member member;
    static_cast<Solution&>(member) = std::move(solution);
    member.genotype = to_unit(member.x);
    member.strategy.sigma = common.config.sigma0;
    member.strategy.shape = initial_shape;
    member.id = next_id++;
    members.push_back(std::move(member));
  }
}

// (μ + μ): an offspring succeeds when it is selected.
void MoCmaEs::Impl::tell_generation(std::vector<Solution> solutions) {
  const std::size_t mu = members.size();
  auto fitness = optimise::fitness_of(members);
  for (const Solution& s : solutions) fitness.insert(fitness.end(), s.fitness.begin(), s.fitness.end());
  const auto selected = optimise::select(fitness, common.reference, mu);
  std::vector<Member> next;
  next.reserve(mu);
  for (std::size_t k = 0; k < mu; ++k) {
    if (selected[mu + k]) next.push_back(make_member(std::move(solutions[k]), pending[k], true));
    members[k].strategy.adapt_sigma(selected[mu + k]);
  }
  for (std::size_t i = 0; i < mu; ++i)
    if (selected[i]) next.push_back(std::move(members[i]));
  members = std::move(next);
}

// (μ + 1): an offspring succeeds when it is selected and its rank among the μ + 1 is not worse than its parent's.
void MoCmaEs::Impl::tell_one(Solution solution, const Offspring& offspring) {
  const std::size_t mu = members.size();
  // Another offspring of the same batch may have replaced the parent.
  const auto parent =
      std::find_if(members.begin(), members.end(), [&](const Member& p) { return p.id == offspring.parent; });
  const bool orphan = parent == members.end();
  const auto [removed, rank, parent_rank] =
      population.offer(solution.fitness, static_cast<std::size_t>(parent - members.begin()));
  const bool succeeded = removed != mu && rank <= parent_rank;
  if (!orphan && !offspring.recombined) parent->strategy.adapt_sigma(succeeded);
  if (removed == mu) return;
  Member newcomer = make_member(std::move(solution), offspring, succeeded);
  if (members[removed].reassessed) recallable.push_back(std::move(members[removed]));
  members[removed] = std::move(newcomer);
}

bool MoCmaEs::Impl::converged() const {
  const double least = common.config.x_tolerance * common.config.sigma0;
  return std::all_of(members.begin(), members.end(),
                     [&](const Member& member) { return member.strategy.reach() < least; });
}

void MoCmaEs::Impl::restart_if_at_rest() {
  if (!common.at_rest() || restarts >= common.config.restarts) return;
  for (Member& member : members)
    member.strategy = {.sigma = common.config.sigma0, .success = StepStrategy::kTargetSuccess, .shape = initial_shape};
  ++restarts;
  common.run_on();
}

// Interface.

MoCmaEs::MoCmaEs(std::size_t dimension, std::size_t objectives, const OptimiserConfig& config)
    : impl_(std::make_unique<Impl>(dimension, objectives, config)) {}
MoCmaEs::MoCmaEs(MoCmaEs&&) noexcept = default;
MoCmaEs& MoCmaEs::operator=(MoCmaEs&&) noexcept = default;
MoCmaEs::~MoCmaEs() = default;

std::size_t MoCmaEs::dimension() const noexcept { return impl_->common.dimension; }
std::size_t MoCmaEs::objectives() const noexcept { return impl_->common.objectives; }

std::span<const double> MoCmaEs::ask() {
  Impl& s = *impl_;
  MoCommon& c = s.common;
  if (c.asked() != 0) return c.points();
  const bool steady = c.config.mo.scheme == Scheme::steady_state && !s.members.empty();
  const std::size_t count = steady ? c.config.mo.batch : c.config.population;
  c.begin_ask(count);
  s.pending.assign(count, {});
  if (s.members.empty()) {
    for (std::size_t k = 0; k < count; ++k) std::ranges::copy(c.initial_point(k), c.point(k).begin());
  } else if (steady) {
    const Front front = s.front();
    const double recombined = c.box.bounded() ? c.config.mo.recombined : 0.0;
    const double swapped = c.box.bounded() && !c.config.blocks.empty() ? c.config.mo.swapped : 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const Member& parent = s.members[s.choose_parent(front)];
      if (swapped > 0 && c.random.uniform() < swapped) {
        s.swap_block(parent, front, k);
      } else if (recombined > 0 && c.random.uniform() < recombined) {
        s.recombine(parent, k);
      } else {
        s.draw_step(parent, &front, k);
      }
    }
  } else {
    for (std::size_t k = 0; k < count; ++k) s.draw_step(s.members[k], nullptr, k);
  }
  return c.points();
}

void MoCmaEs::replace(std::size_t index, std::span<const double> x) {
  Impl& s = *impl_;
  s.common.require_point("replace", index);
  s.common.box.require_inside(x);
  std::ranges::copy(x, s.common.point(index).begin());
  Offspring& o = s.pending[index];
  o.penalty = 0;
  o.genotype = s.to_unit(x);
}

std::span<const double> MoCmaEs::resample(std::size_t index, std::span<const std::size_t> coordinates) {
  Impl& s = *impl_;
  MoCommon& c = s.common;
  c.require_point("resample", index);
  c.require_coordinates(coordinates);
  if (coordinates.empty()) return c.point(index);
  if (s.members.empty()) {
    const auto x = c.random_point();
    for (const std::size_t i : coordinates) c.point(index)[i] = x[i];
    return c.point(index);
  }
  const Offspring& o = s.pending[index];
  if (o.anywhere) {
    VectorXd genotype = o.genotype;
    for (const std::size_t i : coordinates) genotype[static_cast<Index>(i)] = c.random.uniform();
    s.express(index, std::move(genotype));
    return c.point(index);
  }
  const auto n = static_cast<Index>(c.dimension), k = static_cast<Index>(coordinates.size());
  MatrixXd columns = MatrixXd::Zero(n, k);
  VectorXd step = (o.genotype - o.origin) / o.strategy.sigma;
  // The other coordinates of a mixed offspring say nothing about these.
  if (o.mixed) step.setZero();
  for (Index j = 0; j < k; ++j) {
    const auto axis = static_cast<Index>(coordinates[static_cast<std::size_t>(j)]);
    columns(axis, j) = 1;
    step[axis] = 0;
  }
  columns = o.strategy.shape->whitened(columns);
  const VectorXd rest = o.strategy.shape->whitened(step);
  VectorXd genotype = o.genotype;
  for (int redraw = 0; redraw <= kPartialRedraws; ++redraw) {
    const VectorXd drawn = optimise::draw_conditional(columns, rest, c.random);
    bool fits = true;
    for (Index j = 0; j < k; ++j) {
      const auto axis = static_cast<Index>(coordinates[static_cast<std::size_t>(j)]);
      genotype[axis] = o.origin[axis] + o.strategy.sigma * drawn[j];
      fits &= s.within(genotype[axis]);
    }
    if (fits) break;
  }
  s.express(index, std::move(genotype));
  return c.point(index);
}

void MoCmaEs::tell(std::span<const double> values) {
  Impl& s = *impl_;
  std::vector<double> penalties;
  for (const Offspring& o : s.pending) penalties.push_back(o.penalty);
  auto solutions = s.common.take(values, penalties);
  if (s.members.empty()) {
    s.tell_initial(std::move(solutions));
    s.population.assign(optimise::fitness_of(s.members));
  } else if (s.common.config.mo.scheme == Scheme::generational) {
    s.tell_generation(std::move(solutions));
  } else {
    const std::size_t iteration = (s.common.evaluations - solutions.size()) / s.common.config.population;
    for (std::size_t k = 0; k < solutions.size(); ++k) s.tell_one(std::move(solutions[k]), s.pending[k]);
    if (iterations() != iteration) s.population.recount();
  }
  s.pending.clear();
  s.common.watch(s.members, [&] { return s.converged(); });
  s.restart_if_at_rest();
  s.common.settle(s.members);
}

void MoCmaEs::reassess(std::span<const double> values) {
  Impl& s = *impl_;
  const std::size_t mu = s.members.size();
  s.common.require_reassessable(values, mu + s.recallable.size());
  std::ranges::move(s.recallable, std::back_inserter(s.members));
  s.recallable.clear();
  s.common.reassess(s.members, values);
  if (s.members.size() > mu) {
    const auto selected = optimise::select(optimise::fitness_of(s.members), s.common.reference, mu);
    std::vector<Member> kept;
    kept.reserve(mu);
    for (std::size_t i = 0; i < s.members.size(); ++i)
      if (selected[i]) kept.push_back(std::move(s.members[i]));
    s.members = std::move(kept);
  }
  for (Member& member : s.members) member.reassessed = s.common.config.mo.recalls;
  s.population.assign(optimise::fitness_of(s.members));
  s.common.settle(s.members);
}

StopReason MoCmaEs::stop_reason() const noexcept { return impl_->common.stop_reason(); }
std::vector<ParetoPoint> MoCmaEs::front() const { return optimise::front_of(optimise::pointers(impl_->members)); }
std::vector<ParetoPoint> MoCmaEs::population() const {
  std::vector<ParetoPoint> result;
  for (const auto* members : {&impl_->members, &impl_->recallable})
    for (const Member& member : *members) result.push_back({member.x, member.f});
  return result;
}
double MoCmaEs::hypervolume() const { return impl_->common.hypervolume(impl_->members); }
std::size_t MoCmaEs::evaluations() const noexcept { return impl_->common.evaluations; }
std::size_t MoCmaEs::restarts() const noexcept { return impl_->restarts; }
std::size_t MoCmaEs::iterations() const noexcept { return impl_->common.iterations(); }

namespace {

void save_member(optimise::StateWriter& w, const Member& member) {
  MoCommon::save(w, member);
  const Shape& shape = *member.strategy.shape;
  w.put(member.id);
  w.put(std::uint64_t{member.reassessed});
  w.put(as_span(member.genotype));
  w.put(member.strategy.sigma);
  w.put(member.strategy.success);
  w.put(as_span(shape.path));
  for (const Group& group : *shape.groups) {
    const auto factor = shape.factor(group);
    for (Index j = 0; j < group.size(); ++j)
      w.put(std::span(factor.col(j).data() + j, static_cast<std::size_t>(group.size() - j)));
  }
}

// `initial`: a shape with the same groups.
Member load_member(optimise::StateReader& r, const MoCommon& common, const Shape& initial) {
  const std::size_t n = common.dimension;
  Member member;
  static_cast<Solution&>(member) = common.load_solution(r);
  member.id = r.integer();
  member.reassessed = r.size(2) == 1;
  member.genotype.resize(static_cast<Index>(n));
  std::ranges::copy(r.moderate_reals(n), member.genotype.data());
  member.strategy.sigma = r.positive();
  member.strategy.success = r.finite();
  Shape shape = initial;
  std::ranges::copy(r.moderate_reals(n), shape.path.data());
  for (const Group& group : *shape.groups) {
    auto factor = shape.factor(group);
    for (Index j = 0; j < group.size(); ++j)
      std::ranges::copy(r.moderate_reals(static_cast<std::size_t>(group.size() - j)), factor.col(j).data() + j);
  }
  member.strategy.shape = std::make_shared<const Shape>(std::move(shape));
  return member;
}

}  // namespace

void MoCmaEs::save(std::ostream& out) const {
  const Impl& s = *impl_;
  s.common.require_not_asked("save");
  optimise::StateWriter w;
  s.common.save(w);
  w.put(std::uint64_t{s.initial_shape->groups->size()});
  w.put(s.next_id);
  w.put(std::uint64_t{s.restarts});
  for (const auto* members : {&s.members, &s.recallable}) {
    w.put(std::uint64_t{members->size()});
    for (const Member& member : *members) save_member(w, member);
  }
  w.put(s.population.contributions());
  w.write(out, kMoCmaEs);
}

void MoCmaEs::load(std::istream& in) {
  optimise::StateReader r(in, kMoCmaEs);
  const MoCommon& mine = impl_->common;
  const std::size_t n = mine.dimension;
  auto next = std::make_unique<Impl>(n, mine.objectives, mine.config);
  next->common.load(r);
  r.expect(std::uint64_t{next->initial_shape->groups->size()}, "number of covariances");
  next->next_id = r.integer();
  next->restarts = r.size(std::size_t{1} << 62);
  const std::size_t count = r.size(mine.config.population + 1);
  for (std::size_t i = 0; i < count; ++i) next->members.push_back(load_member(r, next->common, *next->initial_shape));
  for (std::size_t left = r.size(mine.config.population + 1); left > 0; --left)
    next->recallable.push_back(load_member(r, next->common, *next->initial_shape));
  const std::vector<double> contributions = r.finite_reals(count);
  if (count != 0) next->population.assign(optimise::fitness_of(next->members), contributions);
  r.end();
  next->restart_if_at_rest();  // the limit of restarts may be higher than when it was saved
  next->common.settle(next->members);
  impl_ = std::move(next);
}

}  // namespace vantage
