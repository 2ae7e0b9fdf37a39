// SPDX-License-Identifier: Apache-2.0
#include "bench/baselines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "optimise/hypervolume.hpp"
#include "optimise/variation.hpp"
#include "vantage/error.hpp"

namespace vantage::bench {
namespace {

using optimise::MoCommon;
using optimise::Solution;
using optimise::StateReader;
using optimise::StateWriter;

// Crowding distance within each rank; the ends of a front are infinitely far from their neighbours.
std::vector<double> crowding_distances(std::span<const double> fitness, std::size_t m,
                                       std::span<const std::size_t> rank) {
  const std::size_t k = rank.size();
  std::vector<double> distance(k, 0.0);
  std::vector<std::size_t> order(k);
  for (std::size_t j = 0; j < m; ++j) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return rank[a] != rank[b] ? rank[a] < rank[b] : fitness[a * m + j] < fitness[b * m + j];
    });
    for (std::size_t begin = 0, end = 0; begin < k; begin = end) {
      while (end < k && rank[order[end]] == rank[order[begin]]) ++end;
      const double low = fitness[order[begin] * m + j], range = fitness[order[end - 1] * m + j] - low;
      distance[order[begin]] = distance[order[end - 1]] = std::numeric_limits<double>::infinity();
      if (!(range > 0) || !std::isfinite(range)) continue;
      const std::span<const std::size_t> front(order.data() + begin, end - begin);
      for (auto before = front.begin(); front.end() - before > 2; ++before)
        distance[before[1]] += (fitness[before[2] * m + j] - fitness[before[0] * m + j]) / range;
    }
  }
  return distance;
}

constexpr std::array kAlgorithms{Algorithm::cma_es, Algorithm::mo_cma_es, Algorithm::nsga2, Algorithm::random_search};

}  // namespace

std::string to_string(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::cma_es: return "cma_es";
    case Algorithm::mo_cma_es: return "mo_cma_es";
    case Algorithm::nsga2: return "nsga2";
    case Algorithm::random_search: return "random_search";
  }
  return "unknown";
}

Algorithm algorithm_from_string(const std::string& name) {
  for (const Algorithm algorithm : kAlgorithms)
    if (name == to_string(algorithm)) return algorithm;
  throw Error(Errc::invalid_argument,
              "there is no optimiser \"" + name + "\"; take cma_es, mo_cma_es, nsga2 or random_search");
}

std::unique_ptr<Optimiser> make_optimiser(Algorithm algorithm, std::size_t dimension, std::size_t objectives,
                                          const OptimiserConfig& config) {
  switch (algorithm) {
    case Algorithm::cma_es:
      if (objectives != 1) throw Error(Errc::invalid_argument, "cma_es takes one objective");
      return std::make_unique<CmaEs>(dimension, config);
    case Algorithm::nsga2: return std::make_unique<Nsga2>(dimension, objectives, config);
    case Algorithm::random_search: return std::make_unique<RandomSearch>(dimension, objectives, config);
    case Algorithm::mo_cma_es: break;
  }
  return std::make_unique<MoCmaEs>(dimension, objectives, config);
}

Baseline::Baseline(std::string name, std::size_t dimension, std::size_t objectives, const OptimiserConfig& config)
    : common_(std::move(name), dimension, objectives, config) {
  if (!common_.box.bounded())
    throw Error(Errc::invalid_argument, common_.name + " needs bounds; give them, or take MO-CMA-ES");
}

std::span<const double> Baseline::ask() {
  if (common_.asked() != 0) return common_.points();
  const std::size_t mu = common_.config.population;
  common_.begin_ask(mu);
  if (!members_.empty()) before_offspring();
  for (std::size_t k = 0; k < mu; ++k)
    std::ranges::copy(members_.empty() ? common_.initial_point(k) : make_point(), common_.point(k).begin());
  return common_.points();
}

void Baseline::replace(std::size_t index, std::span<const double> x) {
  common_.require_point("replace", index);
  common_.box.require_inside(x);
  std::ranges::copy(x, common_.point(index).begin());
}

std::span<const double> Baseline::resample(std::size_t index, std::span<const std::size_t> coordinates) {
  common_.require_point("resample", index);
  common_.require_coordinates(coordinates);
  if (coordinates.empty()) return common_.point(index);
  const auto x = members_.empty() ? common_.random_point() : make_point();
  for (const std::size_t i : coordinates) common_.point(index)[i] = x[i];
  return common_.point(index);
}

void Baseline::tell(std::span<const double> values) {
  auto solutions = common_.take(values);
  std::move(solutions.begin(), solutions.end(), std::back_inserter(members_));
  if (members_.size() > common_.config.population) {
    const auto keep = choose(optimise::fitness_of(members_));
    std::size_t i = 0;
    std::erase_if(members_, [&](const Solution&) { return !keep[i++]; });
  }
  common_.watch(members_, [] { return false; });
  common_.settle(members_);
}

void Baseline::reassess(std::span<const double> values) {
  common_.reassess(members_, values);
  common_.settle(members_);
}

std::vector<ParetoPoint> Baseline::population() const {
  std::vector<ParetoPoint> result;
  for (const Solution& s : members_) result.push_back({s.x, s.f});
  return result;
}

void Baseline::save(std::ostream& out) const {
  common_.require_not_asked("save");
  StateWriter w;
  common_.save(w);
  w.put(std::uint64_t{members_.size()});
  for (const Solution& s : members_) MoCommon::save(w, s);
  w.write(out, common_.name);
}

void Baseline::load(std::istream& in) {
  StateReader r(in, common_.name);
  MoCommon common = common_;
  common.load(r);
  std::vector<Solution> members(r.size(common_.config.population + 1));
  for (Solution& s : members) s = common.load_solution(r);
  r.end();
  common_ = std::move(common);
  members_ = std::move(members);
  common_.settle(members_);
}

void Nsga2::before_offspring() {
  const auto fitness = optimise::fitness_of(members_);
  rank_ = optimise::ranks({fitness, common_.objectives});
  crowding_ = crowding_distances(fitness, common_.objectives, rank_);
}

std::size_t Nsga2::tournament() {
  const std::size_t a = common_.random.index(members_.size()), b = common_.random.index(members_.size());
  if (rank_[a] != rank_[b]) return rank_[a] < rank_[b] ? a : b;
  return crowding_[a] >= crowding_[b] ? a : b;
}

std::vector<double> Nsga2::make_point() {
  const auto unit = [&](const Solution& s) {
    std::vector<double> t(s.x.size());
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = common_.box.to_unit(s.x[i], i);
    return t;
  };
  const auto first = unit(members_[tournament()]), second = unit(members_[tournament()]);
  auto child = optimise::make_child(first, second, {}, common_.random);
  for (std::size_t i = 0; i < child.size(); ++i) child[i] = common_.box.from_unit(child[i], i);
  return child;
}

std::vector<char> Nsga2::choose(std::span<const double> fitness) const {
  const auto rank = optimise::ranks({fitness, common_.objectives});
  const auto crowding = crowding_distances(fitness, common_.objectives, rank);
  std::vector<std::size_t> order(rank.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return rank[a] != rank[b] ? rank[a] < rank[b] : crowding[a] > crowding[b];
  });
  std::vector<char> keep(rank.size(), 0);
  for (std::size_t i = 0; i < common_.config.population; ++i) keep[order[i]] = 1;
  return keep;
}

}  // namespace vantage::bench
