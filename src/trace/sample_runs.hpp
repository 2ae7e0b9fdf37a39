// SPDX-License-Identifier: Apache-2.0
// A sample in runs of voxels that follow one another and so lie close together, one run after the other from all over
// the site: the rays to a run share what they visit, and any number of runs has its part of what is near and what is
// far.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/golden_step.hpp"

namespace vantage {

class SampleRuns {
 public:
  static constexpr std::size_t length = 32;  // voxels; the sample's last may have fewer

  explicit SampleRuns(std::size_t voxels) : runs_((voxels + length - 1) / length), step_(golden_step(runs_)) {}
  std::size_t size() const { return runs_; }

  // The k-th run of `sample`. REQUIRES: it is as long as was said.
  template <class T>
  std::span<const T> run(std::span<const T> sample, std::size_t k) const {
    return of(sample, k * step_ % runs_);
  }
  // The voxels of runs [first, end), in the order of the sample.
  template <class T>
  std::vector<T> runs(std::span<const T> sample, std::size_t first, std::size_t end) const {
    std::vector<std::size_t> places;
    for (std::size_t k = first; k < end; ++k) places.push_back(k * step_ % runs_);
    std::sort(places.begin(), places.end());
    std::vector<T> voxels;
    voxels.reserve(places.size() * length);
    for (const std::size_t place : places) {
      const std::span<const T> run = of(sample, place);
      voxels.insert(voxels.end(), run.begin(), run.end());
    }
    return voxels;
  }

 private:
  template <class T>
  static std::span<const T> of(std::span<const T> sample, std::size_t place) {
    const auto from = sample.subspan(place * length);
    return from.first(std::min(length, from.size()));
  }

  std::size_t runs_;
  std::uint64_t step_;
};

}  // namespace vantage
