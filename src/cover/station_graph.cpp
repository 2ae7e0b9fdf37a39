// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <string>

#include "vantage/cover.hpp"
#include "vantage/error.hpp"

namespace vantage {

StationGraph::StationGraph(std::size_t size, std::vector<float> overlaps)
    : size_(size), overlaps_(std::move(overlaps)) {
  if (overlaps_.size() != size * size)
    throw Error(Errc::invalid_argument, "station graph: " + std::to_string(overlaps_.size()) + " overlaps of " +
                                            std::to_string(size) + " candidates; give one for each pair of them");
}

StationGraph::StationGraph(const CoverageMatrix& seen, std::size_t size) { extend(seen, size); }

void StationGraph::extend(const CoverageMatrix& seen, std::size_t size) {
  const std::size_t before = size_;
  const auto widened = [&]<class Value>(std::vector<Value>& old) {
    std::vector<Value> wide(size * size);
    for (std::size_t i = 0; i < before; ++i)
      std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(i * before), before,
                  wide.begin() + static_cast<std::ptrdiff_t>(i * size));
    old = std::move(wide);
  };
  widened(overlaps_);
  if (!excluded_.empty()) widened(excluded_);
  size_ = size;

  const std::size_t known = std::min(size, seen.candidates()), words = (seen.elements() + 63) / 64;
  std::vector<std::uint64_t> bits(known * words, 0);
  for (std::size_t k = 0; k < known; ++k)
    for (const CoverageMatrix::Entry& one : seen.column(k))
      bits[k * words + one.element / 64] |= std::uint64_t{1} << (one.element % 64);
  tbb::parallel_for(std::min(before, known), known, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::uint32_t both = 0;
      for (std::size_t w = 0; w < words; ++w)
        both += static_cast<std::uint32_t>(std::popcount(bits[i * words + w] & bits[j * words + w]));
      const auto fewer = static_cast<float>(std::min(seen.column(i).size(), seen.column(j).size()));
      if (both > 0) overlaps_[i * size_ + j] = overlaps_[j * size_ + i] = static_cast<float>(both) / fewer;
    }
  });
}

void StationGraph::set_overlap(std::size_t i, std::size_t j, float overlap) {
  overlaps_[i * size_ + j] = overlaps_[j * size_ + i] = overlap;
}

void StationGraph::exclude(std::size_t i, std::size_t j) {
  if (excluded_.empty()) excluded_.assign(size_ * size_, 0);
  excluded_[i * size_ + j] = excluded_[j * size_ + i] = 1;
}

void StationGraph::exclude_nearer(std::span<const Vec3> positions, double least_m, std::size_t first) {
  for (std::size_t i = first; i < size_; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const Vec3 apart = positions[i] - positions[j]; dot(apart, apart) < least_m * least_m) exclude(i, j);
}

void StationGraph::exclude_nearer(std::span<const Vec3> positions, std::span<const double> least_m,
                                  const std::function<bool(std::size_t, std::size_t)>& parted, std::size_t first) {
  if (excluded_.empty()) excluded_.assign(size_ * size_, 0);
  tbb::parallel_for(first, size_, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 apart = positions[i] - positions[j];
      const double least = std::min(least_m[i], least_m[j]);
      if (dot(apart, apart) < least * least && !excluded(i, j) && !parted(i, j)) exclude(i, j);
    }
  });
}

}  // namespace vantage
