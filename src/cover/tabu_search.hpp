// SPDX-License-Identifier: Apache-2.0
// Tabu search over swaps (Glover: Tabu Search, Part I, 1989).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {

class TabuSearch {
 public:
  struct Found {
    std::vector<std::size_t> network = {};  // the one with the least violation, then the most coverage
    double violation = 0;
    std::vector<std::size_t> joined = {};  // candidates that any network on the way had, besides those of its start
  };

  // Keeps a reference to the problem. `patience`: swaps tried without a network of less violation, besides one of each
  // member, before a search gives up.
  TabuSearch(const CoverProblem& problem, std::size_t patience, std::stop_token stop = {});

  // Swaps members of a network, first for candidates that leave it nearly as good as the best one so far, until its
  // violation is at most `enough`. `link` replaces that of the problem.
  Found run(std::vector<std::size_t> start, double link, double enough = 0) const;
  // The same from several starts at once. Returns the results up to the first one that is good enough: all, if none is.
  // They are the same for any number of threads.
  std::vector<Found> run(std::span<const std::vector<std::size_t>> starts, double link, double enough) const;

 private:
  struct Swap;
  struct State;
  Found run(std::vector<std::size_t> start, double link, double enough, std::uint64_t seed,
            const std::function<bool()>& stopped) const;
  Swap best_swap_at(State& state, std::size_t at) const;

  const CoverProblem& problem_;
  std::size_t patience_;
  std::stop_token stop_;
  std::vector<std::size_t> free_;
  ColumnIndex columns_;
};

}  // namespace vantage
