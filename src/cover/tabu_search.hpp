// SPDX-License-Identifier: Apache-2.0
// Tabu search over swaps (Glover: Tabu Search, Part I, 1989).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {

// Swaps that all searches of the calling thread have made: a measure of their work.
std::uint64_t swaps_made() noexcept;

class TabuSearch {
 public:
  // Swaps without a network of less violation before a search gives up, and swaps before a candidate that left may
  // return. A candidate that came may leave again after half as many.
  static constexpr std::size_t kPatience = 40, kTabu = 7;

  // Keeps a reference to the problem.
  explicit TabuSearch(const CoverProblem& problem, std::stop_token stop = {});

  // Makes the best swap each time, even to a worse network, and returns the best network found. Ends once nothing is
  // violated. `link` replaces that of the problem.
  std::vector<std::size_t> run(std::vector<std::size_t> start, double link);

 private:
  // A chosen candidate, by its place, that another one replaces; and the resulting network.
  struct Swap;
  struct State;
  struct Leaving;
  struct Round;
  struct Scratch;
  class Ranking;
  Swap best_swap(State& state) const;
  Swap best_swap_at(State& state, const Round& round, std::size_t at, Scratch& scratch) const;
  void replace(State& state, std::size_t at, std::size_t joining) const;

  const CoverProblem& problem_;
  std::stop_token stop_;
  std::vector<std::size_t> free_;
  std::optional<ColumnIndex> columns_;  // made when first needed
};

}  // namespace vantage
