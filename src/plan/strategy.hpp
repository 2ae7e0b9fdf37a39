// SPDX-License-Identifier: Apache-2.0
// CMA-ES and the multi-objective optimisers behind one face, so that the search is written once.
#pragma once

#include <iosfwd>
#include <memory>
#include <span>
#include <vector>

#include "plan/decision_space.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {

class Strategy {
 public:
  virtual ~Strategy() = default;
  virtual std::span<const double> ask() = 0;
  virtual std::span<const double> resample(std::size_t index, std::span<const std::size_t> coordinates) = 0;
  virtual void tell(std::span<const double> values) = 0;
  virtual std::vector<ParetoPoint> front() const = 0;
  virtual double hypervolume() const = 0;  // for one objective: 1 − the best value, not below 0
  virtual std::size_t evaluations() const = 0;
  virtual StopReason stop_reason() const = 0;
  virtual void save(std::ostream&) const = 0;
  virtual void load(std::istream&) = 0;
};

// The population is never 0 afterwards.
std::size_t population_of(const PlanConfig& config);

// Without limits of its own: the search keeps them. `batch`: see PlanConfig.
std::unique_ptr<Strategy> make_strategy(const DecisionSpace& space, const PlanConfig& config, std::size_t batch);

}  // namespace vantage
