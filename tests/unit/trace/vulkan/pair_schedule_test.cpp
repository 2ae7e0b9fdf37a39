// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/pair_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/philox.hpp"
#include "shared/trace_types.h"

namespace vantage::vulkan {
namespace {

TEST(SampleChunk, HalvesAreTheWholeAndShareNothing) {
  const SampleChunk voxels{2, 9, 5, 8, 0, 100}, slots{2, 9, 5, 6, 0, 100}, parts{2, 3, 5, 6, 40, 43};
  EXPECT_EQ(voxels.halves(), (std::array<SampleChunk, 2>{{{2, 9, 5, 6, 0, 100}, {2, 9, 6, 8, 0, 100}}}));
  EXPECT_EQ(slots.halves(), (std::array<SampleChunk, 2>{{{2, 5, 5, 6, 0, 100}, {5, 9, 5, 6, 0, 100}}}));
  EXPECT_EQ(parts.halves(), (std::array<SampleChunk, 2>{{{2, 3, 5, 6, 40, 41}, {2, 3, 5, 6, 41, 43}}}));
}

TEST(SampleChunk, IsCutIntoEvenPiecesByVoxelsThenBySlots) {
  const auto pieces = [](SampleChunk rest, std::uint64_t most) {
    std::vector<SampleChunk> all;
    while (rest.pairs() > most) {
      const auto [piece, other] = rest.cut(most);
      EXPECT_LE(piece.end_voxel - piece.first_voxel == 1 ? 0 : piece.pairs(), most);
      all.push_back(piece);
      rest = other;
    }
    all.push_back(rest);
    return all;
  };
  EXPECT_EQ(pieces({0, 4, 0, 10, 0, 9}, 16),
            (std::vector<SampleChunk>{{0, 4, 0, 4, 0, 9}, {0, 4, 4, 7, 0, 9}, {0, 4, 7, 10, 0, 9}}));
  EXPECT_EQ(pieces({3, 13, 5, 6, 0, 9}, 4),
            (std::vector<SampleChunk>{{3, 7, 5, 6, 0, 9}, {7, 10, 5, 6, 0, 9}, {10, 13, 5, 6, 0, 9}}));
  const auto [voxel, others] = SampleChunk{3, 13, 5, 8, 0, 9}.cut(4);
  EXPECT_EQ(voxel, (SampleChunk{3, 13, 5, 6, 0, 9})) << "more than there is room for, and cut next";
  EXPECT_EQ(others, (SampleChunk{3, 13, 6, 8, 0, 9}));
}

TEST(SampleRoom, KeepsToADispatchAndHoldsAPart) {
  for (const bool software : {false, true}) {
    const SampleRoom usual = sample_room(software, 0);
    EXPECT_EQ(sample_room(software, 50'000).rays, 50'000u);
    EXPECT_LE(sample_room(software, 50'000).pairs, 50'000u) << "each may be probed";
    EXPECT_EQ(sample_room(software, std::uint64_t{1} << 40).rays, usual.rays);
    const SampleRoom least = sample_room(software, 1);
    EXPECT_EQ(least.rays, sample_part) << "a part of one pair always fits";
    EXPECT_GE(least.parts, 1u);
    EXPECT_GE(least.pairs, 1u);
  }
}

TEST(PairSchedule, NothingToDoIsDone) {
  for (const auto& [slots, voxels] : {std::pair{0u, 5u}, {5u, 0u}}) {
    PairSchedule schedule(slots, voxels, 10, {100, 100, 100});
    EXPECT_TRUE(schedule.finished());
    EXPECT_TRUE(schedule.next(1e9, {8, 1}, 1e9).empty());
    EXPECT_EQ(schedule.done(), 1);
  }
}

TEST(PairSchedule, NoChunkHasMorePairsThanThereIsRoomFor) {
  const auto most_pairs = [](const SampleRoom& room, double open) {
    PairSchedule schedule(200'000, 20'000'000, 10, room);
    std::uint64_t most = 0;
    for (int k = 0; k < 5; ++k) {
      const std::vector<SampleChunk> chunks = schedule.next(0, {1e-12, open}, 1e9);
      EXPECT_EQ(chunks.size(), 1u);
      for (const SampleChunk& chunk : chunks) most = std::max(most, chunk.pairs());
    }
    return most;
  };
  EXPECT_EQ(most_pairs({1000, 1u << 30, 1u << 30}, 1), 800u) << "a quarter more to be safe";
  EXPECT_EQ(most_pairs({1000, 1u << 30, 1u << 30}, 0.5), 1600u);
  const std::uint64_t probes = most_pairs({1000, 3000, 1u << 30}, 0);
  EXPECT_GT(probes, 2900u);
  EXPECT_LE(probes, 3000u) << "each may be probed";
}

TEST(PairSchedule, WhatOverflowsComesAgainInHalvesAndFirst) {
  PairSchedule schedule(4, 15, 8, {1000, 100, 10});
  const std::vector<SampleChunk> chunks =
      schedule.next(1e9, {4, 1}, 1e9);  // at most 20 pairs: 80 rays, and a quarter more as reserve
  ASSERT_EQ(chunks.size(), 3u);
  EXPECT_TRUE(schedule.finished());
  // The first fits; the second has too many rays, the last too many parts. Probed rays are traced anyway.
  EXPECT_EQ(schedule.settle(chunks, std::vector<SampleTally>{{20, 20, 100, 10, 3}, {20, 20, 101}, {20, 20, 0, 11}}),
            163);
  EXPECT_FALSE(schedule.finished());
  EXPECT_DOUBLE_EQ(schedule.done(), 1.0 / 3);
  const std::vector<SampleChunk> again = schedule.next(1e9, {0.1, 1}, 1e9);
  std::array<SampleChunk, 2> second = chunks[1].halves(), last = chunks[2].halves();
  for (SampleChunk* half : {&second[0], &second[1], &last[0], &last[1]}) half->probed = true;
  EXPECT_EQ(again, (std::vector<SampleChunk>{second[0], second[1], last[0], last[1]}));
}

TEST(PairSchedule, AChunkIsNoMoreThanTheDeviceDoesInTime) {
  PairSchedule schedule(4, 1000, 8, {1u << 20, 1u << 20, 1u << 20});
  for (const SampleChunk& chunk : schedule.next(1e9, {8, 1}, 800)) EXPECT_LE(chunk.pairs() * 8, 800u);
  EXPECT_TRUE(schedule.finished());
}

TEST(PairSchedule, MoreOpenPairsThanThereIsRoomForComeAgainWithAllTheirRays) {
  PairSchedule schedule(1, 100, 8, {10, 1000, 100});
  const std::vector<SampleChunk> chunks = schedule.next(1e9, {1, 0.1}, 1e9);
  ASSERT_EQ(chunks.size(), 2u);
  EXPECT_EQ(schedule.settle(chunks, std::vector<SampleTally>{{11, 50}, {10, 50, 7}}), 107);
  std::array<SampleChunk, 2> halves = chunks[0].halves();
  for (SampleChunk& half : halves) half.probed = true;
  EXPECT_EQ(schedule.next(1e9, {1, 0.1}, 1e9), (std::vector<SampleChunk>{halves[0], halves[1]}));
}

// Pairs with unpredictable numbers of rays: every part of every pair is traced once, whatever the guess, and every pair
// is probed first exactly once.
TEST(PairSchedule, EveryPartOfEveryPairIsTracedOnce) {
  constexpr std::uint32_t slots = 7, voxels = 23, parts = 16, most = 30;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomStream random(seed);
    std::vector<std::uint32_t> rays(slots * voxels * parts);
    for (std::uint32_t& each : rays) each = static_cast<std::uint32_t>(most * std::pow(random.uniform(), 8));
    const SampleRoom room{5, 2 * most, 4};
    PairSchedule schedule(slots, voxels, parts, room);
    std::vector<int> traced(rays.size()), probed(slots * voxels);
    double total = 0, done = 0;
    for (int submissions = 0; !schedule.finished(); ++submissions) {
      ASSERT_LT(submissions, 10'000) << "it comes to no end";
      const std::vector<SampleChunk> chunks =
          schedule.next(200 * random.uniform(), {40 * random.uniform(), random.uniform()}, 100 * random.uniform());
      ASSERT_FALSE(chunks.empty());
      std::vector<SampleTally> wanted;
      for (const SampleChunk& chunk : chunks) {
        std::vector<std::size_t> inside;
        SampleTally list;
        for (std::uint32_t s = chunk.first_slot; s < chunk.end_slot; ++s)
          for (std::uint32_t v = chunk.first_voxel; v < chunk.end_voxel; ++v) {
            probed[std::size_t{s} * voxels + v] += !chunk.probed;
            for (std::uint32_t p = chunk.first_part; p < chunk.end_part; ++p)
              inside.push_back((std::size_t{s} * voxels + v) * parts + p);
          }
        // As the kernels do: the first part of every fourth pair comes at once, all others later.
        for (const std::size_t k : inside) {
          const bool at_first = k / parts % 4 == 0 && k % parts == 0;
          if (at_first && !chunk.first_traced) list.rays += rays[k];
          if (!at_first) list.rest += rays[k];
        }
        list.pairs = static_cast<std::uint32_t>(chunk.pairs() - random.bits() % (chunk.pairs() / 2 + 1));
        if (list.pairs > room.pairs) {  // nothing more is done
          wanted.push_back({.pairs = list.pairs});
          continue;
        }
        list.parts = chunk.pairs() > 3 ? static_cast<std::uint32_t>(random.bits() % 7) : 0;
        wanted.push_back(list);
        if (list.rays > room.rays || list.parts > room.parts) continue;
        for (const std::size_t k : inside) {
          const bool at_first = k / parts % 4 == 0 && k % parts == 0;
          traced[k] += at_first ? !chunk.first_traced : list.rest <= room.rays;
        }
      }
      total += schedule.settle(chunks, wanted);
      EXPECT_GE(schedule.done(), done);
      done = schedule.done();
    }
    EXPECT_EQ(traced, std::vector<int>(rays.size(), 1));
    EXPECT_EQ(probed, std::vector<int>(probed.size(), 1));
    EXPECT_EQ(total, std::accumulate(rays.begin(), rays.end(), 0.0));
    EXPECT_NEAR(schedule.done(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace vantage::vulkan
