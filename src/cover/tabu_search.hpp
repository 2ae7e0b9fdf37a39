// SPDX-License-Identifier: Apache-2.0
// Tabu search over swaps (Glover: Tabu Search, Part I, 1989).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {

// Swaps that all searches of the calling thread have made: a measure of their work.
std::uint64_t swaps_made() noexcept;

class TabuSearch {
 public:
  // Swaps without a decrease of the violation before a search gives up, and swaps before a candidate that left may
  // return. A candidate that joined may leave after half as many.
  static constexpr std::size_t kPatience = 40, kTabu = 7;

  // Keeps references. `columns`: index of the problem's matrix.
  TabuSearch(const CoverProblem& problem, const ColumnIndex& columns, std::stop_token stop = {});

  // Makes the best swap each time, even to a worse network, and returns the best network found. Ends once nothing is
  // violated. `link` replaces the problem's.
  std::vector<std::size_t> run(const std::vector<std::size_t>& start, double link) const;
  // The same from several starts in parallel: one network for each.
  std::vector<std::vector<std::size_t>> run(std::span<const std::vector<std::size_t>> starts, double link) const;

 private:
  // Replacement of the chosen candidate at a place by another one, and the resulting network.
  struct Swap;
  struct State;
  class BestSwap;
  struct Found {
    std::vector<std::size_t> network;
    std::uint64_t swaps = 0;
  };
  Found search(const std::vector<std::size_t>& start, double link) const;

  const CoverProblem& problem_;
  const ColumnIndex& columns_;
  std::stop_token stop_;
};

}  // namespace vantage
