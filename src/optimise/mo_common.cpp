// SPDX-License-Identifier: Apache-2.0
#include "optimise/mo_common.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "optimise/blocks.hpp"
#include "optimise/hypervolume.hpp"
#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFlatIterations = 10;
constexpr std::size_t kMaxPopulation = std::size_t{1} << 20;
constexpr std::size_t kMaxObjectives = 6;
constexpr double kOverreach = 0.1;

[[noreturn]] void fail(const std::string& message) { throw Error(Errc::invalid_argument, message); }

}  // namespace

MoCommon::MoCommon(std::string n, std::size_t d, std::size_t m, const MoCmaEsConfig& c)
    : name(std::move(n)),
      dimension(d),
      objectives(m),
      config(c),
      box(d, c.bounds),
      reference(c.reference.empty() ? std::vector<double>(m, 1.0) : c.reference),
      random(c.seed) {
  if (m < 1 || m > kMaxObjectives)
    fail(name + ": " + std::to_string(m) + " objectives; it takes 1 to " + std::to_string(kMaxObjectives));
  if (reference.size() != m)
    fail(name + ": the reference point has " + std::to_string(reference.size()) + " coordinates for " +
         std::to_string(m) + " objectives");
  for (const double r : reference)
    if (!std::isfinite(r)) fail(name + ": the reference point holds " + std::to_string(r) + "; it must be finite");
  if (c.population < 1 || c.population > kMaxPopulation)
    fail(name + ": a population of " + std::to_string(c.population) + " is not in 1 to " +
         std::to_string(kMaxPopulation));
  if (c.batch < 1 || c.batch > kMaxPopulation)
    fail(name + ": a batch of " + std::to_string(c.batch) + " is not in 1 to " + std::to_string(kMaxPopulation));
  if (!(c.sigma0 > 0) || !std::isfinite(c.sigma0))
    fail(name + ": sigma0 is " + std::to_string(c.sigma0) + ", it must be positive");
  if (!(c.x_tolerance >= 0) || !(c.stagnation_tolerance >= 0)) fail(name + ": tolerances must not be negative");
  for (const auto& x : c.start) box.require_inside(x);
}

std::vector<double> MoCommon::initial_point(std::size_t k) {
  return k < config.start.size() ? config.start[k] : random_point();
}

std::vector<double> MoCommon::random_point() {
  std::vector<double> x(dimension);
  for (std::size_t i = 0; i < dimension; ++i) {
    const double centre = config.start.empty() ? 0.0 : config.start.front()[i];
    x[i] = box.bounded() ? box.from_unit(random.uniform(), i) : centre + config.sigma0 * random.normal();
  }
  return x;
}

void MoCommon::begin_ask(std::size_t count) {
  points_.resize(count * dimension);
  asked_ = count;
}

void MoCommon::require_asked(const char* what) const {
  if (asked_ == 0) fail(name + ": " + what + "() needs points from ask() first");
}

void MoCommon::require_not_asked(const char* what) const {
  if (asked_ != 0) fail(name + ": " + what + "() between ask() and tell(); tell first");
}

void MoCommon::require_index(std::size_t index) const {
  if (index >= asked_)
    fail(name + ": point " + std::to_string(index) + " of " + std::to_string(asked_) + " does not exist");
}

void MoCommon::require_coordinates(std::span<const std::size_t> coordinates) const {
  for (const std::size_t c : coordinates)
    if (c >= dimension)
      fail(name + ": coordinate " + std::to_string(c) + " of " + std::to_string(dimension) + " does not exist");
}

std::vector<Solution> MoCommon::take(std::span<const double> values, std::span<const double> penalties) {
  require_asked("tell");
  if (values.size() != asked_ * objectives)
    fail(name + ": " + std::to_string(values.size()) + " values for " + std::to_string(asked_) + " points of " +
         std::to_string(objectives) + " objectives; give all objectives of each");
  std::vector<Solution> result(asked_);
  for (std::size_t k = 0; k < asked_; ++k) {
    Solution& s = result[k];
    const auto x = point(k);
    s.x.assign(x.begin(), x.end());
    const auto f = values.subspan(k * objectives, objectives);
    s.f.assign(f.begin(), f.end());
    if (std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); })) {
      progress_.failed = 0;
    } else {
      ++progress_.failed;
      s.f.assign(objectives, kInfinity);
    }
    s.fitness = s.f;
    for (double& v : s.fitness) v += penalties.empty() ? 0.0 : penalties[k];
    progress_.varied |= !progress_.last_value.empty() && progress_.last_value != s.f;
    progress_.last_value = s.f;
  }
  evaluations += asked_;
  asked_ = 0;
  return result;
}

StopReason MoCommon::limit() const {
  if (config.max_evaluations != 0 && evaluations >= config.max_evaluations) return StopReason::max_evaluations;
  if (config.max_iterations != 0 && evaluations / config.population >= config.max_iterations)
    return StopReason::max_iterations;
  return StopReason::running;
}

bool MoCommon::due() {
  progress_.reason = limit();
  if (evaluations / config.population == progress_.judged_iterations) return false;
  progress_.judged_iterations = evaluations / config.population;
  return true;
}

void MoCommon::judge(std::span<const double> values, bool converged) {
  const auto first = values.first(objectives);
  bool equal = !progress_.varied && std::ranges::equal(first, progress_.last_value);
  for (std::size_t i = objectives; i < values.size() && equal; i += objectives)
    equal = std::ranges::equal(values.subspan(i, objectives), first);
  progress_.flat_iterations = equal ? progress_.flat_iterations + 1 : 0;
  progress_.varied = false;

  StopReason reason = StopReason::running;
  if (config.target_hypervolume || config.stagnation_iterations != 0) {
    const double now = vantage::hypervolume(values, objectives, reference);
    if (config.target_hypervolume && now >= *config.target_hypervolume) reason = StopReason::target_reached;
    if (config.stagnation_iterations != 0) {
      progress_.hypervolumes.push_back(now);
      const std::size_t size = progress_.hypervolumes.size();
      if (size > config.stagnation_iterations + 1)
        progress_.hypervolumes.erase(
            progress_.hypervolumes.begin(),
            progress_.hypervolumes.end() - static_cast<std::ptrdiff_t>(config.stagnation_iterations + 1));
      if (size > config.stagnation_iterations && reason == StopReason::running &&
          now - progress_.hypervolumes.front() <= config.stagnation_tolerance * std::abs(now))
        reason = StopReason::stagnated;
    }
  }
  if (progress_.failed >= config.population) {
    reason = StopReason::invalid_objective;
  } else if (reason == StopReason::running && progress_.flat_iterations >= kFlatIterations) {
    reason = StopReason::flat;
  } else if (reason == StopReason::running && converged) {
    reason = StopReason::converged;
  }
  if (reason != StopReason::running) progress_.reason = reason;
}

void MoCommon::save(StateWriter& w) const {
  w.put(std::uint64_t{dimension});
  w.put(std::uint64_t{objectives});
  w.put(std::uint64_t{config.population});
  w.put(std::uint64_t{config.batch});
  w.put(static_cast<std::uint64_t>(config.scheme));
  for (const double v : {config.sigma0, config.guided, config.spread, config.recombined, config.swapped}) w.put(v);
  save_blocks(w, config.blocks);
  w.put(box.lower());
  w.put(box.upper());
  w.put(reference);
  w.put(random.seed());
  w.put(random.block());
  w.put(std::uint64_t{evaluations});
  w.put(static_cast<std::uint64_t>(progress_.reason));
  w.put(std::uint64_t{progress_.judged_iterations});
  w.put(std::uint64_t{progress_.failed});
  w.put(std::uint64_t{progress_.flat_iterations});
  w.put(progress_.varied);
  w.put(progress_.last_value);
  w.put(progress_.hypervolumes);
}

MoCommon::Progress MoCommon::read(StateReader& r) const {
  r.expect(std::uint64_t{dimension}, "dimension");
  r.expect(std::uint64_t{objectives}, "number of objectives");
  r.expect(std::uint64_t{config.population}, "population");
  r.expect(std::uint64_t{config.batch}, "batch");
  r.expect(static_cast<std::uint64_t>(config.scheme), "scheme");
  r.expect(config.sigma0, "sigma0");
  r.expect(config.guided, "guided share");
  r.expect(config.spread, "spread share");
  r.expect(config.recombined, "recombined share");
  r.expect(config.swapped, "swapped share");
  expect_blocks(r, config.blocks);
  r.expect(box.lower(), "lower bound");
  r.expect(box.upper(), "upper bound");
  r.expect(reference, "reference");
  Progress p;
  p.seed = r.integer();
  p.block = r.integer();
  constexpr std::size_t kMany = std::size_t{1} << 62;
  p.evaluations = r.size(kMany);
  p.reason = static_cast<StopReason>(r.size(static_cast<std::size_t>(StopReason::cancelled) + 1));
  p.judged_iterations = r.size(kMany);
  p.failed = r.size(kMany);
  p.flat_iterations = r.size(kMany);
  p.varied = r.flag();
  p.last_value = r.reals();
  p.hypervolumes = r.reals();
  return p;
}

void MoCommon::restore(Progress progress) {
  progress_ = std::move(progress);
  random.seek(progress_.seed, progress_.block);
  evaluations = progress_.evaluations;
  asked_ = 0;
  // The limits may have been raised or set meanwhile.
  const StopReason saved = progress_.reason, now = limit();
  const bool limited = saved == StopReason::max_evaluations || saved == StopReason::max_iterations ||
                       saved == StopReason::target_reached || saved == StopReason::stagnated;
  if (now != StopReason::running || limited) progress_.reason = now;
}

void MoCommon::save(StateWriter& w, const Solution& solution) {
  w.put(solution.x);
  w.put(solution.f);
  w.put(solution.fitness);
}

Solution MoCommon::load_solution(StateReader& r) const {
  Solution s{r.finite_reals(dimension), r.reals(objectives), r.reals(objectives)};
  if (!box.contains(s.x)) throw Error(Errc::malformed_file, name + " state: a point lies outside the bounds");
  return s;
}

std::vector<ParetoPoint> front_of(std::span<const Solution* const> members) {
  std::vector<ParetoPoint> result;
  if (members.empty()) return result;
  std::vector<double> values;
  for (const Solution* member : members) values.insert(values.end(), member->f.begin(), member->f.end());
  const auto rank = ranks({values, members.front()->f.size()});
  for (std::size_t i = 0; i < members.size(); ++i)
    if (rank[i] == 0 && std::isfinite(members[i]->f.front())) result.push_back({members[i]->x, members[i]->f});
  std::stable_sort(result.begin(), result.end(), [](const ParetoPoint& a, const ParetoPoint& b) { return a.f < b.f; });
  return result;
}

std::vector<double> reach_over(std::span<const double> fitness, std::span<const double> reference) {
  const std::size_t m = reference.size();
  std::vector<double> low(m, kInfinity), high(m, -kInfinity), result(reference.begin(), reference.end());
  for (std::size_t i = 0; i < fitness.size(); ++i) {
    if (!std::isfinite(fitness[i])) continue;
    low[i % m] = std::min(low[i % m], fitness[i]);
    high[i % m] = std::max(high[i % m], fitness[i]);
  }
  for (std::size_t j = 0; j < m; ++j) {
    if (high[j] < reference[j]) continue;
    const double range = high[j] > low[j] ? high[j] - low[j] : std::max(1.0, std::abs(high[j]));
    result[j] = high[j] + kOverreach * range;
  }
  return result;
}

std::vector<std::size_t> surplus(std::span<const double> fitness, std::span<const double> reference,
                                 std::size_t count) {
  if (count == 0) return {};
  return least_contributors({fitness, reference.size()}, reach_over(fitness, reference), count);
}

std::vector<char> select(std::span<const double> fitness, std::span<const double> reference, std::size_t count) {
  const std::size_t m = reference.size(), k = fitness.size() / m;
  const auto rank = ranks({fitness, m});
  std::vector<std::size_t> order(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
  std::vector<char> selected(k, 0);
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < k && rank[order[end]] == rank[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) selected[order[i]] = 1;
    if (end > count) {
      std::vector<double> last;
      for (std::size_t i = begin; i < end; ++i) {
        const auto f = fitness.subspan(order[i] * m, m);
        last.insert(last.end(), f.begin(), f.end());
      }
      for (const std::size_t i : surplus(last, reference, end - count)) selected[order[begin + i]] = 0;
    }
    begin = end;
  }
  return selected;
}

}  // namespace vantage::optimise
