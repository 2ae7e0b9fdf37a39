// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "vantage/objective.hpp"

namespace vantage::test {

// Compares every input of an objective, but not rays, points or times.
inline void expect_equal_counts(const NetworkCounts& got, const NetworkCounts& expected) {
  EXPECT_EQ(got.voxels, expected.voxels);
  EXPECT_EQ(got.weight, expected.weight);
  EXPECT_EQ(got.stations, expected.stations);
  EXPECT_EQ(got.saturated, expected.saturated);
  EXPECT_EQ(got.partial_points, expected.partial_points);
  EXPECT_EQ(got.point_weight, expected.point_weight);
  EXPECT_EQ(got.seen, expected.seen);
  EXPECT_EQ(got.shared, expected.shared);
}

}  // namespace vantage::test
