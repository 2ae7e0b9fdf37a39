// SPDX-License-Identifier: Apache-2.0
// What a search remembers of its samples: how far first looks are off, and what the networks that it keeps were
// measured with, so that values become means over all samples that saw them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "vantage/optimiser.hpp"

namespace vantage {

// What the whole sample says of a measure less what a first look says: over the networks that are kept.
struct LookError {
  double mean = 0, deviation = 0;
};
// Of each measure; rows are networks, in the same order.
std::vector<LookError> look_errors(std::span<const std::vector<double>> looked,
                                   std::span<const std::vector<double>> measured);

class SampleMemory {
 public:
  // Measurements of a network, by one sample after the other.
  struct Measurements {
    std::vector<double> sum;  // by measure
    std::uint64_t count = 0;
  };
  // As a checkpoint keeps it.
  struct State {
    std::vector<std::vector<LookError>> looks;          // of each first look, by measure; empty: not known yet
    std::map<std::vector<double>, Measurements> known;  // by x
    std::vector<double> shift;                          // by measure
  };

  explicit SampleMemory(std::size_t measures) { state_.shift.resize(measures); }
  const State& state() const { return state_; }
  // `from`: where the sample begins that all is measured with now.
  void restore(State state, std::uint64_t from) { state_ = std::move(state), from_ = from; }

  bool knows_looks() const { return !state_.looks.empty(); }
  void learn_looks(std::vector<std::vector<LookError>> errors) { state_.looks = std::move(errors); }
  std::span<const LookError> look(std::size_t number) const { return state_.looks[number]; }

  // What a newcomer is told with, of what the present sample says, or a first look by it.
  void correct(std::vector<double>& values) const;
  void correct(std::vector<double>& values, std::size_t look) const;

  void add(std::span<const double> x, const std::vector<double>& values);
  void keep_only(std::span<const ParetoPoint> population);
  // Puts means over all samples in the place of what the one from `from` on says of the population, rows in its order:
  // so no sample drives out what earlier ones found good. Newcomers, which this one alone has seen, are corrected from
  // now on by as much as it is off for what is known better.
  void average(std::span<const ParetoPoint> population, std::vector<std::vector<double>>& values, std::uint64_t from);

 private:
  State state_;
  std::uint64_t from_ = 0;
};

}  // namespace vantage
