// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/sample_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/philox.hpp"
#include "trace/vulkan/groups.hpp"

namespace vantage::vulkan {
namespace {

TEST(SampleChunk, HalvesAreTheWholeAndShareNothing) {
  const SampleChunk slots{2, 9, 5, 8, 0, 100}, voxels{2, 3, 5, 8, 0, 100}, rows{2, 3, 5, 6, 40, 43};
  EXPECT_EQ(slots.halves(), (std::array<SampleChunk, 2>{{{2, 5, 5, 8, 0, 100}, {5, 9, 5, 8, 0, 100}}}));
  EXPECT_EQ(voxels.halves(), (std::array<SampleChunk, 2>{{{2, 3, 5, 6, 0, 100}, {2, 3, 6, 8, 0, 100}}}));
  EXPECT_EQ(rows.halves(), (std::array<SampleChunk, 2>{{{2, 3, 5, 6, 40, 41}, {2, 3, 5, 6, 41, 43}}}));
}

TEST(SampleRoom, KeepsToADispatchAndHoldsARow) {
  for (const bool software : {false, true}) {
    const SampleList usual = sample_room(10'000, software, 0);
    EXPECT_EQ(sample_room(10'000, software, 50'000).rays, 50'000u);
    EXPECT_EQ(sample_room(10'000, software, std::uint64_t{1} << 40).rays, usual.rays);
    EXPECT_EQ(sample_room(10'000, software, 1).rays, 20'000u) << "a row of one pair always fits";
    EXPECT_GE(sample_room(1u << 30, software, 0).rays, 1u << 30);
    EXPECT_GE(sample_room(1u << 30, software, 0).items, (1u << 30) / sample_part);
  }
}

TEST(SamplePlan, NothingToDoIsDone) {
  for (const auto& [slots, voxels] : {std::pair{0u, 5u}, {5u, 0u}}) {
    SamplePlan plan(slots, voxels, 10, {100, 100});
    EXPECT_TRUE(plan.finished());
    EXPECT_TRUE(plan.next(1e9, 8, 1e9).empty());
    EXPECT_EQ(plan.done(), 1);
  }
}

TEST(SamplePlan, NoDispatchHasTooManyGroups) {
  SamplePlan plan(200'000, 20'000'000, 10, {1u << 30, 1u << 30});
  for (int k = 0; k < 5; ++k) {
    const std::vector<SampleChunk> chunks = plan.next(0, 1e-12, 1e9);
    ASSERT_EQ(chunks.size(), 1u);
    EXPECT_LE(chunks[0].end_slot - chunks[0].first_slot, most_groups);
    EXPECT_LE(groups_of(chunks[0].end_voxel - chunks[0].first_voxel), most_groups);
  }
}

TEST(SamplePlan, WhatOverflowsComesAgainInHalvesAndFirst) {
  SamplePlan plan(4, 10, 8, {100, 10});
  const std::vector<SampleChunk> chunks =
      plan.next(1e9, 4, 1e9);  // 20 pairs a chunk: 80 rays, and half as many to be safe
  ASSERT_EQ(chunks.size(), 4u);
  EXPECT_TRUE(plan.finished());
  // The first fits; the second has too many rays, the last too many items.
  EXPECT_EQ(plan.settle(chunks, std::vector<SampleList>{{100, 10}, {101, 0}, {7, 0}, {0, 11}}), 107);
  EXPECT_FALSE(plan.finished());
  EXPECT_DOUBLE_EQ(plan.done(), 0.5);
  const std::vector<SampleChunk> again = plan.next(1e9, 0.1, 1e9);
  const auto second = chunks[1].halves(), last = chunks[3].halves();
  EXPECT_EQ(again, (std::vector<SampleChunk>{second[0], second[1], last[0], last[1]}));
}

TEST(SamplePlan, AChunkIsNoMoreThanTheDeviceDoesInTime) {
  SamplePlan plan(4, 1000, 8, {1u << 20, 1u << 20});
  for (const SampleChunk& chunk : plan.next(1e9, 8, 800)) EXPECT_LE(chunk.pairs() * 8, 800u);
  EXPECT_TRUE(plan.finished());
}

// Pairs whose numbers of rays nobody foresees: every row of every pair is traced once, whatever is guessed.
TEST(SamplePlan, EveryRowOfEveryPairIsTracedOnce) {
  constexpr std::uint32_t slots = 7, voxels = 23, rows = 16, columns = 30;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomStream random(seed);
    std::vector<std::uint32_t> rays(slots * voxels * rows);
    for (std::uint32_t& each : rays) each = static_cast<std::uint32_t>(columns * std::pow(random.uniform(), 8));
    const SampleList room{2 * columns, 4};
    SamplePlan plan(slots, voxels, rows, room);
    std::vector<int> traced(rays.size());
    double total = 0, done = 0;
    for (int submissions = 0; !plan.finished(); ++submissions) {
      ASSERT_LT(submissions, 10'000) << "it comes to no end";
      const std::vector<SampleChunk> chunks =
          plan.next(200 * random.uniform(), 40 * random.uniform(), 100 * random.uniform());
      ASSERT_FALSE(chunks.empty());
      std::vector<SampleList> wanted;
      for (const SampleChunk& chunk : chunks) {
        std::vector<std::size_t> inside;
        SampleList list{0, 0};
        for (std::uint32_t s = chunk.first_slot; s < chunk.end_slot; ++s)
          for (std::uint32_t v = chunk.first_voxel; v < chunk.end_voxel; ++v)
            for (std::uint32_t r = chunk.first_row; r < chunk.end_row; ++r)
              inside.push_back((std::size_t{s} * voxels + v) * rows + r);
        for (const std::size_t k : inside) list.rays += rays[k];
        list.items = chunk.pairs() > 3 ? static_cast<std::uint32_t>(random.bits() % 7) : 0;
        wanted.push_back(list);
        if (list.rays > room.rays || list.items > room.items) continue;  // as the kernels do
        for (const std::size_t k : inside) ++traced[k];
      }
      total += plan.settle(chunks, wanted);
      EXPECT_GE(plan.done(), done);
      done = plan.done();
    }
    EXPECT_EQ(traced, std::vector<int>(rays.size(), 1));
    EXPECT_EQ(total, std::accumulate(rays.begin(), rays.end(), 0.0));
    EXPECT_NEAR(plan.done(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace vantage::vulkan
