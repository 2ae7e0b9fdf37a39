// SPDX-License-Identifier: Apache-2.0
#include "optimise/mo_common.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/first_numbers.hpp"
#include "optimise/blocks.hpp"
#include "optimise/hypervolume.hpp"
#include "optimise/infinity.hpp"
#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr std::size_t kFlatIterations = 10;
constexpr std::size_t kPopulation = 100;
constexpr double kOverreach = 0.1;

}  // namespace

MoCommon::MoCommon(std::string n, std::size_t d, std::size_t m, const OptimiserConfig& c)
    : Common(std::move(n), d, m, c, kPopulation) {
  if (c.mo.batch < 1 || c.mo.batch > kMaxPopulation)
    throw Error(Errc::invalid_argument, name + ": a batch of " + std::to_string(c.mo.batch) + " is not in 1 to " +
                                            std::to_string(kMaxPopulation));
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

std::vector<Solution> MoCommon::take(std::span<const double> values, std::span<const double> penalties) {
  std::vector<Solution> result(asked());
  Common::take(values);
  for (std::size_t k = 0; k < result.size(); ++k) {
    Solution& s = result[k];
    const auto x = point(k);
    s.x.assign(x.begin(), x.end());
    const auto f = values.subspan(k * objectives, objectives);
    s.f.assign(f.begin(), f.end());
    if (std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); })) {
      failed_ = 0;
    } else {
      ++failed_;
      s.f.assign(objectives, kInfinity);
    }
    s.fitness = s.f;
    for (double& v : s.fitness) v += penalties.empty() ? 0.0 : penalties[k];
    varied_ |= !last_value_.empty() && last_value_ != s.f;
    last_value_ = s.f;
  }
  return result;
}

void MoCommon::set_objectives(Solution& solution, std::span<const double> values) {
  const bool known = std::isfinite(solution.f.front());
  const double penalty = known ? solution.fitness.front() - solution.f.front() : 0;
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  for (std::size_t j = 0; j < values.size(); ++j) {
    solution.f[j] = finite ? values[j] : kInfinity;
    solution.fitness[j] = solution.f[j] + penalty;
  }
}

StopReason MoCommon::judge_population(std::span<const double> values, bool converged) {
  const auto first = values.first(objectives);
  bool equal = !varied_ && std::ranges::equal(first, last_value_);
  for (std::size_t i = objectives; i < values.size() && equal; i += objectives)
    equal = std::ranges::equal(values.subspan(i, objectives), first);
  flat_iterations_ = equal ? flat_iterations_ + 1 : 0;
  varied_ = false;
  if (failed_ >= config.population) return StopReason::invalid_objective;
  if (flat_iterations_ >= kFlatIterations) return StopReason::flat;
  return converged ? StopReason::converged : StopReason::running;
}

void MoCommon::save(StateWriter& w) const {
  Common::save(w);
  const MoCmaEsConfig& mo = config.mo;
  w.put(std::uint64_t{mo.batch});
  w.put(static_cast<std::uint64_t>(mo.scheme));
  for (const double v : {mo.guided, mo.spread, mo.recombined, mo.swapped}) w.put(v);
  save_blocks(w, config.blocks);
  w.put(static_cast<std::uint64_t>(own_));
  w.put(std::uint64_t{judged_iterations_});
  w.put(std::uint64_t{failed_});
  w.put(std::uint64_t{flat_iterations_});
  w.put(varied_);
  w.put(last_value_);
}

void MoCommon::load(StateReader& r) {
  Common::load(r);
  const MoCmaEsConfig& mo = config.mo;
  r.expect(std::uint64_t{mo.batch}, "batch");
  r.expect(static_cast<std::uint64_t>(mo.scheme), "scheme");
  r.expect(mo.guided, "guided share");
  r.expect(mo.spread, "spread share");
  r.expect(mo.recombined, "recombined share");
  r.expect(mo.swapped, "swapped share");
  expect_blocks(r, config.blocks);
  own_ = r.stop_reason();
  constexpr std::size_t kMany = std::size_t{1} << 62;
  judged_iterations_ = r.size(kMany);
  failed_ = r.size(kMany);
  flat_iterations_ = r.size(kMany);
  varied_ = r.flag();
  last_value_ = r.reals();
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
  std::vector<std::size_t> order = first_numbers(k);
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
