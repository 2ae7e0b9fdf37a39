// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/summary.hpp"

namespace vantage {
namespace {

using Names = std::vector<std::string>;

TEST(StationNames, CountFromOneAndKeptOnesApart) {
  PlacedStation placed, kept;
  kept.existing = true;
  EXPECT_EQ(station_names(std::vector<PlacedStation>{}), Names{});
  EXPECT_EQ(station_names(std::vector{kept, kept, placed, placed}), (Names{"K1", "K2", "S1", "S2"}));
}

TEST(StationNames, TheirOwnersNamesGoBeforeAndStayApart) {
  const std::vector<PlacedStation> four(4);
  EXPECT_EQ(station_names(four, Names{"P1", "", "P1", "S2"}), (Names{"P1", "S3", "P1 (3)", "S2"}));
}

}  // namespace
}  // namespace vantage
