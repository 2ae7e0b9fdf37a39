// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

TEST(Morton, PutsXLowest) {
  EXPECT_EQ(morton_encode(1, 0, 0), 1u);
  EXPECT_EQ(morton_encode(0, 1, 0), 2u);
  EXPECT_EQ(morton_encode(0, 0, 1), 4u);
  EXPECT_EQ(morton_encode(0x3FFFF, 0x3FFFF, 0x3FFFF), (std::uint64_t{1} << 54) - 1);
}

RC_GTEST_PROP(Morton, BitKOfACoordinateIsBitThreeKOfTheKey, ()) {
  std::array<std::uint32_t, 3> c;
  for (auto& v : c) v = *rc::gen::inRange<std::uint32_t>(0, 1u << 21);
  std::uint64_t expected = 0;
  for (int k = 0; k < 21; ++k)
    for (int axis = 0; axis < 3; ++axis) expected |= std::uint64_t{(c[axis] >> k) & 1} << (3 * k + axis);
  const std::uint64_t key = morton_encode(c[0], c[1], c[2]);
  RC_ASSERT(key == expected);
  RC_ASSERT(morton_decode(key) == c);
}

}  // namespace
}  // namespace vantage
