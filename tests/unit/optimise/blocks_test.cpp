// SPDX-License-Identifier: Apache-2.0
#include "optimise/blocks.hpp"

#include <gtest/gtest.h>

namespace vantage::optimise {
namespace {

const Blocks kBlocks{{0, 1}, {2, 3}, {4, 5}};

TEST(Blocks, MatchesWhatIsNearest) {
  const std::vector<double> first{0.1, 0.1, 0.9, 0.9, 0.5, 0.5};
  const std::vector<double> second{0.52, 0.5, 0.1, 0.13, 0.9, 0.88};
  EXPECT_EQ(match_blocks(first, second, kBlocks), (std::vector<std::size_t>{1, 2, 0}));
}

TEST(Blocks, GivesEachBlockOnce) {
  // Two blocks are nearest to the same one: the nearer gets it.
  const std::vector<double> first{0.2, 0.2, 0.21, 0.2, 0.9, 0.9};
  const std::vector<double> second{0.22, 0.2, 0.6, 0.6, 0.95, 0.9};
  EXPECT_EQ(match_blocks(first, second, kBlocks), (std::vector<std::size_t>{1, 0, 2}));
}

TEST(Blocks, AlignsBothVectors) {
  const std::vector<double> first{0.1, 0.1, 0.9, 0.9, 0.5, 0.5, 7};
  std::vector<double> second{0.52, 0.5, 0.1, 0.13, 0.9, 0.88, 8}, along{1, 2, 3, 4, 5, 6, 9};
  align_blocks(first, second, along, kBlocks);
  EXPECT_EQ(second, (std::vector<double>{0.1, 0.13, 0.9, 0.88, 0.52, 0.5, 8}));
  EXPECT_EQ(along, (std::vector<double>{3, 4, 5, 6, 1, 2, 9}));
}

TEST(Blocks, LeavesAPointWithoutBlocksAlone) {
  std::vector<double> second{0.5}, along{1};
  align_blocks(std::vector<double>{0.1}, second, along, {});
  EXPECT_EQ(second, std::vector<double>{0.5});
  EXPECT_EQ(along, std::vector<double>{1});
}

}  // namespace
}  // namespace vantage::optimise
