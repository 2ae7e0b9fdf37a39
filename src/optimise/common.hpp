// SPDX-License-Identifier: Apache-2.0
// Common parts of all optimisers: checked settings, requested points, and stopping.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "optimise/box_constraints.hpp"
#include "optimise/normal_stream.hpp"
#include "optimise/state_file.hpp"
#include "optimise/stop_rules.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::optimise {

inline constexpr std::size_t kMaxPopulation = std::size_t{1} << 20;

class Common {
 public:
  // Throws Error invalid_argument. Messages begin with `name`; `population` replaces 0.
  Common(std::string name, std::size_t dimension, std::size_t objectives, const OptimiserConfig& config,
         std::size_t population);

  void begin_ask(std::size_t count);  // makes room for the points
  std::span<double> point(std::size_t k) { return std::span(points_).subspan(k * dimension, dimension); }
  std::span<const double> points() const { return points_; }
  std::size_t asked() const { return asked_; }
  void require_not_asked(const char* what) const;
  // Checks of replace() and resample().
  void require_point(const char* what, std::size_t index) const;
  void require_coordinates(std::span<const std::size_t> coordinates) const;
  // Checks the number of values told and counts them; then no points are requested any more.
  void take(std::span<const double> values);
  // For reassess(): checks that no points are requested and that there is a row for each of `points`.
  void require_reassessable(std::span<const double> values, std::size_t points) const;
  void forget_progress() { rules_.begin_anew(); }

  // The algorithm's own reason to stop, or that of a rule.
  StopReason stop_reason() const { return reason_; }
  // After every tell() and load(). `own`: the algorithm's own reason.
  void judge(StopReason own, std::size_t iterations, const std::function<double()>& hypervolume);

  // Settings and progress, as part of a saved state. load() throws Error malformed_file if the settings differ.
  void save(StateWriter& w) const;
  void load(StateReader& r);

  std::string name;
  std::size_t dimension, objectives;
  OptimiserConfig config;  // with its population
  BoxConstraints box;
  std::vector<double> reference;
  NormalStream random;
  std::size_t evaluations = 0;

 private:
  std::vector<double> points_;
  std::size_t asked_ = 0;
  StopRules rules_;
  StopReason reason_ = StopReason::running;
};

}  // namespace vantage::optimise
