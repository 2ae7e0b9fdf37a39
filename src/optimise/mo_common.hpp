// SPDX-License-Identifier: Apache-2.0
// Shared by optimisers of several objectives: the initial population, solutions, selection, and convergence of a
// population.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "optimise/common.hpp"

namespace vantage::optimise {

// A point with its objectives. `fitness`, used by selection, adds a penalty for clipping.
struct Solution {
  std::vector<double> x, f, fitness;
};

class MoCommon : public Common {
 public:
  // Throws Error invalid_argument. Messages begin with `name`.
  MoCommon(std::string name, std::size_t dimension, std::size_t objectives, const OptimiserConfig& config);

  // Point k of the initial population: the given points, then random ones.
  std::vector<double> initial_point(std::size_t k);
  std::vector<double> random_point();

  // Checks and counts the values told, and returns one solution per requested point. Points with a value that is not
  // finite get +infinity.
  std::vector<Solution> take(std::span<const double> values, std::span<const double> penalties = {});

  // Replaces the members' objectives, and keeps their penalties.
  template <typename Members>
  void reassess(Members& members, std::span<const double> values) {
    require_reassessable(values, members.size());
    for (std::size_t k = 0; k < members.size(); ++k)
      set_objectives(members[k], values.subspan(k * objectives, objectives));
    forget_progress();
  }

  // First call after every tell(): judges the population once per iteration. `converged` says whether its steps have
  // become too small.
  template <typename Members, typename Converged>
  void watch(const Members& members, const Converged& converged) {
    if (iterations() == judged_iterations_) return;
    judged_iterations_ = iterations();
    std::vector<double> values;
    for (const auto& member : members) values.insert(values.end(), member.f.begin(), member.f.end());
    own_ = judge_population(values, converged());
  }
  bool at_rest() const { return own_ == StopReason::converged; }
  void run_on() { own_ = StopReason::running; }
  // Last call after every tell() and load().
  template <typename Members>
  void settle(const Members& members) {
    judge(own_, iterations(), [&] { return hypervolume(members); });
  }

  template <typename Members>
  double hypervolume(const Members& members) const {
    std::vector<double> values;
    for (const auto& member : members) values.insert(values.end(), member.f.begin(), member.f.end());
    return vantage::hypervolume(values, objectives, reference);
  }
  std::size_t iterations() const { return evaluations / config.population; }

  void save(StateWriter& w) const;
  void load(StateReader& r);
  static void save(StateWriter& w, const Solution& solution);
  Solution load_solution(StateReader& r) const;

 private:
  static void set_objectives(Solution& solution, std::span<const double> values);
  StopReason judge_population(std::span<const double> values, bool converged);

  StopReason own_ = StopReason::running;
  std::size_t judged_iterations_ = 0;
  std::size_t failed_ = 0;  // consecutive evaluations that were not finite
  std::size_t flat_iterations_ = 0;
  bool varied_ = false;  // two different values were told since the population was last judged
  std::vector<double> last_value_;
};

// Non-dominated members sorted by their objectives, and all members.
std::vector<ParetoPoint> front_of(std::span<const Solution* const> members);
template <typename Members>
std::vector<const Solution*> pointers(const Members& members) {
  std::vector<const Solution*> result;
  for (const auto& member : members) result.push_back(&member);
  return result;
}

template <typename Members>
std::vector<double> fitness_of(const Members& members) {
  std::vector<double> fitness;
  for (const auto& member : members) fitness.insert(fitness.end(), member.fitness.begin(), member.fitness.end());
  return fitness;
}

// The reference point, moved outwards along each objective in which fitness vectors (row-major) lie on or beyond it, by
// a tenth of their range beyond the worst. A front thus spreads before it reaches the reference, and keeps its other
// end once it has reached it at one.
std::vector<double> reach_over(std::span<const double> fitness, std::span<const double> reference);
// Which `count` of a set of mutually non-dominated fitness vectors to drop: the least contributors against
// reach_over().
std::vector<std::size_t> surplus(std::span<const double> fitness, std::span<const double> reference, std::size_t count);

// Marks the `count` points to keep: by rank, with the last front cut by surplus().
std::vector<char> select(std::span<const double> fitness, std::span<const double> reference, std::size_t count);

}  // namespace vantage::optimise
