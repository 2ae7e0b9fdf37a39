// SPDX-License-Identifier: Apache-2.0
// What MO-CMA-ES and its baselines share: settings, the initial population, the points asked for, selection, and when
// to stop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "optimise/box_constraints.hpp"
#include "optimise/normal_stream.hpp"
#include "optimise/state_file.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::optimise {

// A point with its objectives. `fitness` is what selection sees: the objectives plus a penalty for having been clipped.
struct Solution {
  std::vector<double> x, f, fitness;
};

class MoCommon {
 public:
  // Throws Error invalid_argument. `name` begins the messages.
  MoCommon(std::string name, std::size_t dimension, std::size_t objectives, const MoCmaEsConfig& config);

  // Point k of the initial population: as given, then random.
  std::vector<double> initial_point(std::size_t k);
  std::vector<double> random_point();

  void begin_ask(std::size_t count);  // makes room for the points
  std::span<double> point(std::size_t k) { return std::span(points_).subspan(k * dimension, dimension); }
  std::span<const double> points() const { return points_; }
  std::size_t asked() const { return asked_; }
  void require_asked(const char* what) const;
  void require_not_asked(const char* what) const;
  void require_index(std::size_t index) const;
  void require_coordinates(std::span<const std::size_t> coordinates) const;
  // Checks the values told, counts them, and gives one solution per asked point; those with a value that is not finite
  // get +infinity.
  std::vector<Solution> take(std::span<const double> values, std::span<const double> penalties = {});

  // Stop rules, after every tell(). `members` is the population, `converged` tells whether its steps have become too
  // small.
  template <typename Members, typename Converged>
  void watch(const Members& members, const Converged& converged) {
    if (!due()) return;
    std::vector<double> values;
    for (const auto& member : members) values.insert(values.end(), member.f.begin(), member.f.end());
    judge(values, converged());
  }
  StopReason stop_reason() const { return progress_.reason; }
  // Takes back that the search has converged or stagnated.
  void run_on() {
    progress_.reason = StopReason::running;
    progress_.hypervolumes.clear();
  }

  template <typename Members>
  double hypervolume(const Members& members) const {
    std::vector<double> values;
    for (const auto& member : members) values.insert(values.end(), member.f.begin(), member.f.end());
    return vantage::hypervolume(values, objectives, reference);
  }

  // All that changes from tell() to tell(), as one value, so that a state is read whole before any of it counts.
  struct Progress {
    std::uint64_t seed = 0, block = 0;
    std::size_t evaluations = 0;
    StopReason reason = StopReason::running;
    std::size_t judged_iterations = 0;  // iterations for which judge() has run
    std::size_t failed = 0;             // evaluations in a row that were not finite
    std::size_t flat_iterations = 0;
    bool varied = false;  // two different values were told since the last judge()
    std::vector<double> last_value;
    std::vector<double> hypervolumes;  // of the last iterations, where stagnation is watched
  };
  void save(StateWriter& w) const;
  Progress read(StateReader& r) const;
  void restore(Progress progress);
  static void save(StateWriter& w, const Solution& solution);
  Solution load_solution(StateReader& r) const;

  const std::string name;
  const std::size_t dimension, objectives;
  const MoCmaEsConfig config;
  const BoxConstraints box;
  const std::vector<double> reference;
  NormalStream random;
  std::size_t evaluations = 0;

 private:
  bool due();
  void judge(std::span<const double> values, bool converged);
  StopReason limit() const;

  std::vector<double> points_;
  std::size_t asked_ = 0;
  Progress progress_;
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

// The reference point, moved out along each objective in which fitness vectors (row-major) lie on or beyond it, to a
// tenth of their range beyond them. So a front is spread before it has reached the reference, and one that has reached
// it at one end does not lose the other.
std::vector<double> reach_over(std::span<const double> fitness, std::span<const double> reference);
// Which `count` of a set of mutually non-dominated fitness vectors to drop: the least contributors against
// reach_over().
std::vector<std::size_t> surplus(std::span<const double> fitness, std::span<const double> reference, std::size_t count);

// Marks the `count` points to keep: by rank, the last front cut by surplus().
std::vector<char> select(std::span<const double> fitness, std::span<const double> reference, std::size_t count);

}  // namespace vantage::optimise
