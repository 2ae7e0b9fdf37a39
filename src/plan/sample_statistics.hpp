// SPDX-License-Identifier: Apache-2.0
// Means over all samples that a search evaluated the networks of its archive with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {

class SampleStatistics {
 public:
  // Evaluations of one network, by one sample after the other.
  struct Sums {
    std::vector<double> sum;  // by measure
    std::uint64_t count = 0;
  };
  // As a checkpoint keeps it.
  struct State {
    std::map<std::vector<double>, Sums> known;  // by x
    std::vector<double> shift;                  // by measure: what correct() adds
  };

  explicit SampleStatistics(std::size_t measures) { state_.shift.resize(measures); }
  const State& state() const { return state_; }
  void restore(State state) { state_ = std::move(state); }

  // Takes off what the present sample is off by on average, so that newcomers compare with the archive's means.
  void correct(std::vector<double>& values) const;

  void keep_only(std::span<const ParetoPoint> archive);
  // Adds the values that a new sample gave the archive, rows in its order, and replaces them by means over samples: so
  // no sample drives out what earlier ones found good. The sample that a network was taken in by does not count for it:
  // among many it was the one that flattered the network.
  void average(std::span<const ParetoPoint> archive, std::vector<std::vector<double>>& values);
  // Pools a last sample, by which nothing was chosen and `times_as_large`, with the earlier ones. The earlier means are
  // first moved by their average difference from the last sample. The level and the standard errors are thus the last
  // sample's, while all samples say how networks compare.
  std::vector<std::vector<Estimate>> pooled(std::span<const ParetoPoint> archive,
                                            std::vector<std::vector<Estimate>> last, double times_as_large) const;

 private:
  State state_;
};

}  // namespace vantage
