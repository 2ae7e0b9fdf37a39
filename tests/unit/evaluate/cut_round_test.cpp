// SPDX-License-Identifier: Apache-2.0
#include "evaluate/cut_round.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <tuple>

namespace vantage {
namespace {

struct Cost {
  std::size_t pieces = 0, parts = 0, unlinked = 0;
  double longest = 0, walk = 0;
  bool better_than(const Cost& other) const {
    constexpr double kSame = 1e-9;
    const auto numbers = [](const Cost& c) { return std::tie(c.pieces, c.parts, c.unlinked); };
    if (numbers(*this) != numbers(other)) return numbers(*this) < numbers(other);
    if (std::abs(longest - other.longest) > kSame) return longest < other.longest;
    return walk < other.walk - kSame;
  }
};

// The definition itself, with no part of the programme's bookkeeping.
std::optional<Cost> cost_of(const RoundTimes& times, const std::vector<std::size_t>& starts, double most_min) {
  const std::size_t n = times.stay_min.size();
  Cost cost{.pieces = starts.size()};
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const std::size_t first = starts[s], end = s + 1 < starts.size() ? starts[s + 1] : n;
    double walk = times.out_min[first] + times.out_min[end - 1], minutes = 0;
    for (std::size_t k = first; k < end; ++k) minutes += times.stay_min[k];
    for (std::size_t k = first; k + 1 < end; ++k) walk += times.step_min[k];
    minutes += walk;
    if (minutes > most_min) return std::nullopt;
    // Flood from each stop that no other reached.
    std::vector<bool> reached(n, false);
    std::size_t parts = 0;
    for (std::size_t from = first; from < end; ++from) {
      if (reached[from]) continue;
      ++parts;
      std::vector<std::size_t> open{from};
      reached[from] = true;
      while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        for (std::size_t to = first; to < end; ++to)
          if (!reached[to] && times.linked(at, to)) reached[to] = true, open.push_back(to);
      }
    }
    bool outside = first == 0 && end == n;
    for (std::size_t k = first; k < end; ++k)
      for (std::size_t other = 0; other < n; ++other)
        if (other < first || other >= end) outside = outside || times.linked(k, other);
    cost.parts += parts, cost.unlinked += outside ? 0 : 1;
    cost.longest = std::max(cost.longest, minutes);
    cost.walk += walk;
  }
  return cost;
}

TEST(CutRound, IsTheBestOfAllCutsOfSmallRounds) {
  std::mt19937 random(5);
  const auto number = [&](double most) { return most * static_cast<double>(random()) / 4294967296.0; };
  int cut = 0, refused = 0, unlinked = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t n = 1 + random() % 9;
    RoundTimes times;
    std::vector<std::vector<char>> links(n, std::vector<char>(n, 0));
    const double density = number(0.8);
    // Whole minutes, so that cuts often tie in one criterion and differ in the next.
    for (std::size_t k = 0; k < n; ++k) {
      times.stay_min.push_back(std::ceil(number(4)));
      times.out_min.push_back(std::floor(number(4)));
      if (k > 0) times.step_min.push_back(std::floor(number(4)));
      for (std::size_t other = 0; other < k; ++other) links[k][other] = links[other][k] = number(1) < density;
    }
    times.linked = [&](std::size_t a, std::size_t b) { return links[a][b] != 0; };
    const double most_min = 4 + std::floor(number(20));
    std::optional<Cost> best;
    for (std::size_t mask = 0; mask < std::size_t{1} << (n - 1); ++mask) {
      std::vector<std::size_t> starts{0};
      for (std::size_t k = 1; k < n; ++k)
        if (mask >> (k - 1) & 1) starts.push_back(k);
      if (const auto cost = cost_of(times, starts, most_min); cost && (!best || cost->better_than(*best))) best = cost;
    }
    const std::vector<RoundPiece> found = cut_round(times, most_min);
    ASSERT_EQ(found.empty(), !best) << trial;
    if (!best) {
      ++refused;
      continue;
    }
    std::vector<std::size_t> starts;
    std::size_t end = 0, parts = 0, alone = 0;
    for (const RoundPiece& piece : found) {
      EXPECT_EQ(piece.first, end) << "pieces follow each other";
      end = piece.end;
      starts.push_back(piece.first);
      parts += piece.parts, alone += piece.linked ? 0 : 1;
    }
    EXPECT_EQ(end, n);
    const auto cost = cost_of(times, starts, most_min);
    ASSERT_TRUE(cost) << trial;
    EXPECT_FALSE(best->better_than(*cost))
        << trial << ": " << best->pieces << " " << best->parts << " " << best->longest << " " << best->walk;
    EXPECT_EQ(parts, cost->parts) << trial;
    EXPECT_EQ(alone, cost->unlinked) << trial;
    cut += best->pieces > 1, unlinked += best->unlinked > 0;
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(refused, 5);
  EXPECT_GT(unlinked, 20);
}

TEST(CutRound, OfTwoCutsTheOneThatKeepsLinksIsTaken) {
  // Five stops at one place, three a day at most; the second is not linked to the third.
  RoundTimes times{.stay_min = std::vector<double>(5, 1),
                   .step_min = std::vector<double>(4, 0),
                   .out_min = std::vector<double>(5, 0)};
  times.linked = [](std::size_t a, std::size_t b) {
    return std::max(a, b) == std::min(a, b) + 1 && std::min(a, b) != 1;
  };
  const auto found = cut_round(times, 3);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].end, 2u) << "before the gap, though three and two would be as even";
  EXPECT_FALSE(found[0].linked);
  times.linked = {};
  EXPECT_EQ(cut_round(times, 5).size(), 1u);
  EXPECT_TRUE(cut_round(times, 0.5).empty());
}

}  // namespace
}  // namespace vantage
