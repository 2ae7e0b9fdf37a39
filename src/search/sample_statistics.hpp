// SPDX-License-Identifier: Apache-2.0
// Means over all samples on which a search evaluated the networks of its archive.
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
  // State in a checkpoint.
  struct State {
    std::map<std::vector<double>, Sums> known;  // by x
    std::vector<double> shift;                  // by measure: added by correct()
  };

  explicit SampleStatistics(std::size_t measures) { state_.shift.resize(measures); }
  const State& state() const { return state_; }
  void restore(State state) { state_ = std::move(state); }

  // Subtracts the average error of the present sample, so that newcomers compare with the archive's means.
  void correct(std::vector<double>& values) const;

  void keep_only(std::span<const ParetoPoint> archive);
  // Adds the archive's values on a new sample, rows in its order, and replaces them by means over samples, so that no
  // sample drives out networks that earlier ones found good. The sample on which a network entered does not count for
  // it: it favoured that network among many.
  void average(std::span<const ParetoPoint> archive, std::vector<std::vector<double>>& values);
  // Pools a last sample, on which no choice depended and which is `times_as_large`, with the earlier ones. First the
  // earlier means are moved by their average difference from the last sample. Level and standard errors are thus the
  // last sample's, while all samples decide how networks compare.
  std::vector<std::vector<Estimate>> pooled(std::span<const ParetoPoint> archive,
                                            std::vector<std::vector<Estimate>> last, double times_as_large) const;

 private:
  State state_;
};

}  // namespace vantage
