// SPDX-License-Identifier: Apache-2.0
// Splits a sample into runs of consecutive, hence neighbouring, voxels, and orders the runs so that they jump across
// the site. Rays to one run share the nodes that they visit; any range of runs holds a fair share of near and far
// voxels.
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
  static constexpr std::size_t kLength = 32;  // voxels; the sample's last run may have fewer

  explicit SampleRuns(std::size_t voxels) : runs_((voxels + kLength - 1) / kLength), step_(golden_step(runs_)) {}
  std::size_t size() const { return runs_; }

  // Returns the k-th run of `sample`. REQUIRES: the size passed to the constructor.
  template <class T>
  std::span<const T> run(std::span<const T> sample, std::size_t k) const {
    return of(sample, k * step_ % runs_);
  }
  // Returns the voxels of runs [first, end), in the order of the sample.
  template <class T>
  std::vector<T> runs(std::span<const T> sample, std::size_t first, std::size_t end) const {
    std::vector<std::size_t> places;
    for (std::size_t k = first; k < end; ++k) places.push_back(k * step_ % runs_);
    std::sort(places.begin(), places.end());
    std::vector<T> voxels;
    voxels.reserve(places.size() * kLength);
    for (const std::size_t place : places) {
      const std::span<const T> run = of(sample, place);
      voxels.insert(voxels.end(), run.begin(), run.end());
    }
    return voxels;
  }

 private:
  template <class T>
  static std::span<const T> of(std::span<const T> sample, std::size_t place) {
    const auto from = sample.subspan(place * kLength);
    return from.first(std::min(kLength, from.size()));
  }

  std::size_t runs_;
  std::uint64_t step_;
};

}  // namespace vantage
