// SPDX-License-Identifier: Apache-2.0
// What a search remembers of its samples: how far first looks are off, and what the networks that it keeps were
// measured with, so that values become means over all samples that saw them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "vantage/measure.hpp"
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

  void keep_only(std::span<const ParetoPoint> population);
  // Puts means over samples in the place of what the one from `from` on says of the population, rows in its order: so
  // no sample drives out what earlier ones found good. The sample that a network was taken in by does not count for it:
  // of many it was the one that it flattered. Newcomers are corrected from now on by as much as the present sample is
  // off for what is known better.
  void average(std::span<const ParetoPoint> population, std::vector<std::vector<double>>& values, std::uint64_t from);
  // What all samples together say: a last one, by which nothing was chosen, so many times as large, and those that a
  // network was measured by before. As much as these are off from it on average is taken off, so the level is that of
  // the last one, and so are its standard errors; how networks compare is known by all.
  std::vector<std::vector<Estimate>> pooled(std::span<const ParetoPoint> population,
                                            std::vector<std::vector<Estimate>> last, double times_as_large) const;

 private:
  State state_;
  std::uint64_t from_ = 0;
};

}  // namespace vantage
