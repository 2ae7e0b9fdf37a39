// SPDX-License-Identifier: Apache-2.0
#include "ranks/wire.hpp"

#include <gtest/gtest.h>

#include "ranks/messages.hpp"

namespace vantage::ranks {
namespace {

// A message cut anywhere is an error, and nothing is invented.
TEST(Wire, ACutMessageIsRefused) {
  NetworkCounts counts;
  counts.voxels = 1000, counts.stations = 3, counts.points_on_surveyed = {5, 600, 70000};
  counts.groups = {counts, counts};
  Writer writer;
  write_counts(writer, {&counts, 1});
  const Message message = writer.take();
  for (std::size_t bytes = 0; bytes < message.size(); ++bytes) {
    Reader reader(std::string_view(message).substr(0, bytes));
    try {
      read_counts(reader);
      ADD_FAILURE() << bytes;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::device_failure);
    }
  }
  Reader reader(message);
  EXPECT_EQ(read_counts(reader).at(0).groups.at(1).points_on_surveyed, counts.points_on_surveyed);
}

TEST(Identity, SaysWhatDiffers) {
  const Identity here{.version = "1", .fingerprint = 2, .voxels = 3, .scanners = 4};
  Identity there = here;
  EXPECT_EQ(difference(here, there), "");
  there.scanners = 5;
  EXPECT_NE(difference(here, there).find("scanner"), std::string::npos);
  there.voxels = 5;
  EXPECT_NE(difference(here, there).find("voxels"), std::string::npos);
  there.fingerprint = 0xAB;
  EXPECT_NE(difference(here, there).find("00000000000000ab"), std::string::npos);
  there.version = "0";
  EXPECT_NE(difference(here, there).find("vantage 0"), std::string::npos);
}

}  // namespace
}  // namespace vantage::ranks
