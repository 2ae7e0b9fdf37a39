// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/rectangles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace vantage::test {
namespace {

using importer::close_gaps;
using importer::Outlines;
using importer::rectangles;
using importer::Square;

TEST(Rectangles, CoverTheirSquaresExactlyOnce) {
  std::mt19937 random(4);
  for (int round = 0; round < 50; ++round) {
    std::vector<Square> squares;
    for (int k = 0; k < 300; ++k)
      squares.push_back({static_cast<int>(random() % 20) - 10, static_cast<int>(random() % 20) - 10});
    const auto sorted = close_gaps(squares, 0);
    EXPECT_EQ(std::set<Square>(sorted.begin(), sorted.end()), std::set<Square>(squares.begin(), squares.end()));
    std::vector<Square> covered;
    for (const auto& rectangle : rectangles(sorted))
      for (int u = rectangle.low[0]; u < rectangle.high[0]; ++u)
        for (int v = rectangle.low[1]; v < rectangle.high[1]; ++v) covered.push_back({u, v});
    EXPECT_EQ(covered.size(), sorted.size());
    EXPECT_EQ(std::set<Square>(covered.begin(), covered.end()), std::set<Square>(sorted.begin(), sorted.end()));
  }
}

TEST(Rectangles, OutlinesMeetCornerToCorner) {
  std::mt19937 random(6);
  for (int round = 0; round < 20; ++round) {
    std::vector<Square> squares;
    for (int k = 0; k < 100; ++k) squares.push_back({static_cast<int>(random() % 12), static_cast<int>(random() % 12)});
    const auto all = rectangles(close_gaps(squares, 0));
    const Outlines outlines(all);
    std::set<std::pair<Square, Square>> edges;
    for (const auto& rectangle : all) {
      const auto outline = outlines.of(rectangle);
      EXPECT_EQ(outline.front(), rectangle.low);
      std::int64_t twice = 0;  // its area
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Square a = outline[k], b = outline[(k + 1) % outline.size()];
        twice += std::int64_t{a[0]} * b[1] - std::int64_t{a[1]} * b[0];
        EXPECT_TRUE(edges.insert({a, b}).second);
        for (const auto& other : all)  // no corner lies within the edge
          for (const Square& c :
               {other.low, other.high, Square{other.low[0], other.high[1]}, Square{other.high[0], other.low[1]}}) {
            const bool on = (a[0] == b[0] && c[0] == a[0]) || (a[1] == b[1] && c[1] == a[1]);
            const int axis = a[0] == b[0] ? 1 : 0;
            const bool within = c[axis] > std::min(a[axis], b[axis]) && c[axis] < std::max(a[axis], b[axis]);
            EXPECT_FALSE(on && within);
          }
      }
      EXPECT_EQ(twice, 2 * (rectangle.high[0] - rectangle.low[0]) * (rectangle.high[1] - rectangle.low[1]));
    }
  }
}

TEST(Rectangles, AWallIsOne) {
  std::vector<Square> squares;
  for (int u = -5; u < 95; ++u)
    for (int v = 3; v < 83; ++v) squares.push_back({u, v});
  const auto found = rectangles(close_gaps(squares, 3));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].low, (Square{-5, 3}));
  EXPECT_EQ(found[0].high, (Square{95, 83}));
}

TEST(Rectangles, OnlySmallGapsAreFilled) {
  const std::vector<Square> row{{0, 0}, {4, 0}, {9, 0}};  // 3 and 4 squares between them
  std::vector<Square> column = row;
  for (Square& square : column) std::swap(square[0], square[1]);
  EXPECT_EQ(close_gaps(row, 3).size(), 6u);
  EXPECT_EQ(close_gaps(column, 3).size(), 6u);
}

}  // namespace
}  // namespace vantage::test
