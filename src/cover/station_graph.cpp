// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/parse.hpp"
#include "cover/partial_cover.hpp"
#include "vantage/cover.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Counts the elements of a new candidate that each candidate before it has too.
class CommonElements {
 public:
  CommonElements(const CoverageMatrix& seen, std::size_t known)
      : seen_(seen), columns_(seen), words_((seen.elements() + 63) / 64), bits_(known * words_, 0) {
    parallel::for_all(std::size_t{0}, known, [&](std::size_t k) {
      for (const CoverageMatrix::Entry& one : seen_.column(k))
        bits_[k * words_ + one.element / 64] |= std::uint64_t{1} << (one.element % 64);
    });
  }

  // Calls found(j, number of common elements) for each j < i that has some, rising.
  template <class Found>
  void of(std::size_t i, const Found& found) const {
    std::size_t entries = 0;
    for (const CoverageMatrix::Entry& one : seen_.column(i)) entries += columns_.of(one.element).size();
    if (entries > i * words_) {
      for (std::size_t j = 0; j < i; ++j) {
        std::uint32_t both = 0;
        for (std::size_t w = 0; w < words_; ++w)
          both += static_cast<std::uint32_t>(std::popcount(bits_[i * words_ + w] & bits_[j * words_ + w]));
        if (both > 0) found(j, both);
      }
      return;
    }
    // On a large site, most candidates have nothing in common.
    std::vector<std::uint32_t> both(i, 0);
    for (const CoverageMatrix::Entry& one : seen_.column(i))
      for (const ColumnIndex::Column& other : columns_.of(one.element)) {
        if (other.candidate >= i) break;
        ++both[other.candidate];
      }
    for (std::size_t j = 0; j < i; ++j)
      if (both[j] > 0) found(j, both[j]);
  }

 private:
  const CoverageMatrix& seen_;
  ColumnIndex columns_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;  // by candidate: its elements
};

// Calls near(i, j) for pairs j < i, i >= first, that are nearer in x than the distance of i.
template <class Reach, class Near>
void for_near_pairs(std::span<const Vec3> positions, std::size_t first, std::size_t size, const Reach& reach_of,
                    const Near& near) {
  std::vector<std::size_t> by_x(size), place(size);
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::ranges::stable_sort(by_x, {}, [&](std::size_t k) { return positions[k].x; });
  for (std::size_t at = 0; at < size; ++at) place[by_x[at]] = at;
  parallel::for_all(first, size, [&](std::size_t i) {
    const double x = positions[i].x, reach = reach_of(i);
    for (std::size_t at = place[i]; at-- > 0 && x - positions[by_x[at]].x < reach;)
      if (by_x[at] < i) near(i, by_x[at]);
    for (std::size_t at = place[i] + 1; at < size && positions[by_x[at]].x - x < reach; ++at)
      if (by_x[at] < i) near(i, by_x[at]);
  });
}

}  // namespace

StationGraph::StationGraph(std::size_t size, std::span<const float> overlaps) : StationGraph(size) {
  if (overlaps.size() != size * size)
    throw Error(Errc::invalid_argument, "station graph: " + std::to_string(overlaps.size()) + " overlaps of " +
                                            std::to_string(size) + " candidates; give one for each pair of them");
  for (const float overlap : overlaps) check_number(overlap, "station graph: an overlap", kAnyShare);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      if (i != j && overlaps[i * size + j] != 0)
        overlaps_[i].push_back({static_cast<std::uint32_t>(j), overlaps[i * size + j]});
}

StationGraph::StationGraph(const CoverageMatrix& seen, std::size_t size) { extend(seen, size); }

void StationGraph::extend(const CoverageMatrix& seen, std::size_t size) {
  const std::size_t before = overlaps_.size(), known = std::min(size, seen.candidates());
  overlaps_.resize(size);
  excluded_.resize(size);
  if (before >= known) return;
  const CommonElements common(seen, known);
  parallel::for_all(before, known, [&](std::size_t i) {
    common.of(i, [&](std::size_t j, std::uint32_t both) {
      const auto fewer = static_cast<float>(std::min(seen.column(i).size(), seen.column(j).size()));
      overlaps_[i].push_back({static_cast<std::uint32_t>(j), static_cast<float>(both) / fewer});
    });
  });
  for (std::size_t i = before; i < known; ++i)
    for (const Overlap& other : overlaps_[i])  // all below i: later ones come with their own turn
      overlaps_[other.candidate].push_back({static_cast<std::uint32_t>(i), other.share});
}

float StationGraph::overlap(std::size_t i, std::size_t j) const {
  const auto found = std::ranges::lower_bound(overlaps_[i], j, {}, &Overlap::candidate);
  return found != overlaps_[i].end() && found->candidate == j ? found->share : 0;
}

bool StationGraph::excluded(std::size_t i, std::size_t j) const { return std::ranges::binary_search(excluded_[i], j); }

void StationGraph::set_overlap(std::size_t i, std::size_t j, float overlap) {
  for (const auto& [a, b] : {std::pair{i, j}, std::pair{j, i}}) {
    const auto at = std::ranges::lower_bound(overlaps_[a], b, {}, &Overlap::candidate);
    if (at != overlaps_[a].end() && at->candidate == b)
      at->share = overlap;
    else
      overlaps_[a].insert(at, {static_cast<std::uint32_t>(b), overlap});
  }
}

void StationGraph::exclude(std::size_t i, std::size_t j) {
  for (const auto& [a, b] : {std::pair{i, j}, std::pair{j, i}}) {
    const auto at = std::ranges::lower_bound(excluded_[a], b);
    if (at == excluded_[a].end() || *at != b) excluded_[a].insert(at, static_cast<std::uint32_t>(b));
  }
}

void StationGraph::exclude_nearer(std::span<const Vec3> positions, double least_m, std::size_t first) {
  const std::vector<double> least(size(), least_m);
  exclude_nearer(
      positions, least, [](std::size_t, std::size_t) { return false; }, first);
}

void StationGraph::exclude_nearer(std::span<const Vec3> positions, std::span<const double> least_m,
                                  const std::function<bool(std::size_t, std::size_t)>& parted, std::size_t first) {
  std::vector<std::vector<std::size_t>> nearer(size());  // by later candidate
  for_near_pairs(
      positions, first, size(), [&](std::size_t i) { return least_m[i]; },
      [&](std::size_t i, std::size_t j) {
        const Vec3 apart = positions[i] - positions[j];
        const double least = std::min(least_m[i], least_m[j]);
        if (dot(apart, apart) < least * least && !excluded(i, j) && !parted(i, j)) nearer[i].push_back(j);
      });
  for (std::size_t i = first; i < size(); ++i)
    for (const std::size_t j : nearer[i]) exclude(i, j);
}

}  // namespace vantage
