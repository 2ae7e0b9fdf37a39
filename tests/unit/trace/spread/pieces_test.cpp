// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/pieces.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "trace/spread/rate.hpp"

namespace vantage {
namespace {

// Takes all pieces, in turns, and returns how often each item was taken.
std::vector<int> taken(Pieces& pieces, std::size_t items, const std::vector<double>& shares, bool known) {
  std::vector<int> times(items);
  for (std::size_t k = 0; !pieces.empty(); ++k) {
    const Piece piece = pieces.take(shares[k % shares.size()], known);
    EXPECT_GT(piece.size(), 0u);
    for (std::size_t i = piece.first; i < piece.end; ++i) ++times[i];
  }
  return times;
}

TEST(Pieces, AreAllItemsOnce) {
  for (const std::size_t items : {1u, 2u, 3u, 17u, 250u, 1000u})
    for (const std::vector<double>& shares : {std::vector{0.5, 0.5}, {0.999, 0.001}, {0.25, 0.25, 0.25, 0.25}})
      for (const bool known : {false, true}) {
        for (const double of_rest : {Pieces::factored, 1.0}) {
          Pieces pieces(items, of_rest);
          EXPECT_EQ(taken(pieces, items, shares, known), std::vector<int>(items, 1)) << items;
        }
      }
}

TEST(Pieces, FollowTheShare) {
  Pieces pieces(1000);
  EXPECT_EQ(pieces.take(0.75, true).size(), 675u);       // nine tenths of the fair share
  EXPECT_EQ(pieces.take(0.25, true).size(), 225u);       // whoever comes first
  EXPECT_EQ(pieces.take(0.75, true).size(), 68u);        // of the items left by then
  EXPECT_EQ(Pieces(1000).take(0.5, false).size(), 32u);  // a sixteenth of its half, to measure its speed
}

TEST(Pieces, SharesFollowRatesButNotEachOfTheirSteps) {
  std::vector<double> shares;
  follow_rates(shares, std::vector{3.0, 1.0});
  EXPECT_EQ(shares, (std::vector{0.75, 0.25}));
  follow_rates(shares, std::vector{3.04, 1.0});
  EXPECT_EQ(shares, (std::vector{0.75, 0.25})) << "as good as right";
  follow_rates(shares, std::vector{2.0, 2.0});
  EXPECT_EQ(shares, (std::vector{0.5, 0.5}));
  follow_rates(shares, std::vector{2.0, 0.0});  // the other was dropped
  EXPECT_EQ(shares, (std::vector{1.0, 0.0}));
}

TEST(Rate, IsThatOfTheLargePieces) {
  Rate rate;
  EXPECT_EQ(rate.items_a_second(), 0);
  rate.learn(20, 0);  // too short to be timed
  EXPECT_EQ(rate.items_a_second(), 0);
  rate.learn(20, 0.2);  // while the device still warms up
  EXPECT_EQ(rate.items_a_second(), 100);
  rate.learn(300, 0.03);
  EXPECT_EQ(rate.items_a_second(), 10'000) << "a small piece says nothing beside a large one";
  rate.learn(300, 0.025);
  EXPECT_EQ(rate.items_a_second(), 11'000);
  rate.learn(3, 0.003);
  EXPECT_NEAR(rate.items_a_second(), 10'950, 1);
  for (int k = 0; k < 2000; ++k) rate.learn(3, 0.001);
  EXPECT_NEAR(rate.items_a_second(), 3000, 1) << "where no large ones come any more";
}

TEST(Pieces, AreFewForThoseWhoAreEquallyFast) {
  Pieces pieces(250);
  std::size_t handed_out = 0;
  for (; !pieces.empty(); ++handed_out) pieces.take(0.5, true);
  EXPECT_EQ(handed_out, 5u);  // 113, 112, 12, 11 and the rest
}

TEST(Pieces, AreAPieceForEachWhereAllIsHandedOutAtOnce) {
  Pieces pieces(157, 1);
  EXPECT_EQ(pieces.take(0.501, true).size(), 79u);
  EXPECT_EQ(pieces.take(0.499, true).size(), 78u);
  EXPECT_TRUE(pieces.empty());
}

TEST(Pieces, WhatIsGivenBackIsTakenAgain) {
  Pieces pieces(10);
  const Piece lost = pieces.take(1, true);
  pieces.give_back(lost);
  const Piece again = pieces.take(0.1, true);
  EXPECT_EQ(again.first, lost.first);
  EXPECT_EQ(again.end, lost.end);
}

}  // namespace
}  // namespace vantage
