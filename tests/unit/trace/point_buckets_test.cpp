// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/point_buckets.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(PointBuckets, CountsSaturateAndMasksAdd) {
  PassField field;
  field.count = {0, 0xFFFFFFFDu, 5, 7};
  field.stations = {0, 0, 1, 0};
  PointBuckets buckets(4);
  for (int k = 0; k < 10; ++k) {
    buckets.local().add(1, buckets.shift());
    buckets.local().add(2, buckets.shift());
  }
  buckets.flush(field, 4);
  EXPECT_EQ(field.count, (std::vector<std::uint32_t>{0, 0xFFFFFFFFu, 15, 7}));
  EXPECT_EQ(field.stations, (std::vector<std::uint64_t>{0, 4, 5, 0}));
  buckets.flush(field, 8);  // the buckets are empty now
  EXPECT_EQ(field.stations, (std::vector<std::uint64_t>{0, 4, 5, 0}));
}

TEST(PointBuckets, EveryRankHasABucket) {
  for (const std::uint64_t voxels :
       {std::uint64_t{1}, std::uint64_t{256}, std::uint64_t{257}, std::uint64_t{4'000'000'000}}) {
    const PointBuckets buckets(voxels);
    EXPECT_LT((voxels - 1) >> buckets.shift(), PointBuckets::kBuckets) << voxels;
  }
}

}  // namespace
}  // namespace vantage
