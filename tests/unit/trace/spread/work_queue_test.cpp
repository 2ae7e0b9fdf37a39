// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/work_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "trace/spread/rate.hpp"

namespace vantage {
namespace {

// Takes all chunks, in turns, and returns how often each item was taken.
std::vector<int> taken(WorkQueue& queue, std::size_t items, const std::vector<double>& shares, bool known) {
  std::vector<int> times(items);
  for (std::size_t k = 0; !queue.empty(); ++k) {
    const Chunk chunk = queue.take(shares[k % shares.size()], known);
    EXPECT_GT(chunk.size(), 0u);
    for (std::size_t i = chunk.first; i < chunk.end; ++i) ++times[i];
  }
  return times;
}

TEST(WorkQueue, HandsOutAllItemsOnce) {
  for (const std::size_t items : {1u, 2u, 3u, 17u, 250u, 1000u})
    for (const std::vector<double>& shares : {std::vector{0.5, 0.5}, {0.999, 0.001}, {0.25, 0.25, 0.25, 0.25}})
      for (const bool known : {false, true}) {
        for (const double of_rest : {WorkQueue::kFactored, 1.0}) {
          WorkQueue queue(items, of_rest);
          EXPECT_EQ(taken(queue, items, shares, known), std::vector<int>(items, 1)) << items;
        }
      }
}

TEST(WorkQueue, FollowsTheShare) {
  WorkQueue queue(1000);
  EXPECT_EQ(queue.take(0.75, true).size(), 675u);           // nine tenths of the fair share
  EXPECT_EQ(queue.take(0.25, true).size(), 225u);           // whoever comes first
  EXPECT_EQ(queue.take(0.75, true).size(), 68u);            // of the items left by then
  EXPECT_EQ(WorkQueue(1000).take(0.5, false).size(), 32u);  // a sixteenth of its half, to measure its speed
}

TEST(WorkQueue, SharesFollowLargeChangesOfRates) {
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

TEST(Rate, IsThatOfLargeChunks) {
  Rate rate;
  EXPECT_EQ(rate.items_a_second(), 0);
  rate.learn(20, 0);  // too short to be timed
  EXPECT_EQ(rate.items_a_second(), 0);
  rate.learn(20, 0.2);  // while the device still warms up
  EXPECT_EQ(rate.items_a_second(), 100);
  rate.learn(300, 0.03);
  EXPECT_EQ(rate.items_a_second(), 10'000) << "a small chunk says nothing beside a large one";
  rate.learn(300, 0.025);
  EXPECT_EQ(rate.items_a_second(), 11'000);
  rate.learn(3, 0.003);
  EXPECT_NEAR(rate.items_a_second(), 10'950, 1);
  for (int k = 0; k < 2000; ++k) rate.learn(3, 0.001);
  EXPECT_NEAR(rate.items_a_second(), 3000, 1) << "where no large ones come any more";
}

TEST(WorkQueue, HandsOutFewChunksToEqualWorkers) {
  WorkQueue queue(250);
  std::size_t handed_out = 0;
  for (; !queue.empty(); ++handed_out) queue.take(0.5, true);
  EXPECT_EQ(handed_out, 5u);  // 113, 112, 12, 11 and the rest
}

TEST(WorkQueue, HandsOutOneChunkEachInOneRound) {
  WorkQueue queue(157, 1);
  EXPECT_EQ(queue.take(0.501, true).size(), 79u);
  EXPECT_EQ(queue.take(0.499, true).size(), 78u);
  EXPECT_TRUE(queue.empty());
}

TEST(WorkQueue, HandsOutReturnedChunksAgain) {
  WorkQueue queue(10);
  const Chunk lost = queue.take(1, true);
  queue.give_back(lost);
  const Chunk again = queue.take(0.1, true);
  EXPECT_EQ(again.first, lost.first);
  EXPECT_EQ(again.end, lost.end);
}

}  // namespace
}  // namespace vantage
