// SPDX-License-Identifier: Apache-2.0
// Messages that no rank of this program sends.
#include "ranks/messages.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "vantage/error.hpp"

namespace vantage::ranks {
namespace {

std::string message_of(const std::vector<NetworkCounts>& counts) {
  Writer writer;
  write_counts(writer, counts);
  return writer.take();
}

TEST(Messages, GroupsTravelAndGroupsOfGroupsAreRefused) {
  std::vector<NetworkCounts> counts(2);
  counts[1].groups.resize(3);
  counts[1].groups[2].voxels = 7;
  const std::string whole = message_of(counts);
  Reader reader(whole);
  const auto back = read_counts(reader);
  ASSERT_EQ(back.size(), 2u);
  ASSERT_EQ(back[1].groups.size(), 3u);
  EXPECT_EQ(back[1].groups[2].voxels, 7u);
  counts[1].groups[2].groups.resize(1);
  const std::string deep = message_of(counts);
  Reader of_deep(deep);
  EXPECT_THROW(read_counts(of_deep), Error);
}

// Messages cut to every length, and messages that claim more than they have.
TEST(Messages, ThatAreCutShortOrClaimMoreAreRefused) {
  const std::string whole = message_of(std::vector<NetworkCounts>(2));
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    const std::string cut = whole.substr(0, bytes);
    Reader reader(cut);
    EXPECT_THROW(read_counts(reader), Error) << bytes;
  }
  for (const std::uint64_t many : {std::uint64_t{1} << 20, ~std::uint64_t{0}}) {
    Writer writer;
    writer.whole(many);
    const std::string claims = writer.take() + std::string(1 << 20, '\0');
    Reader of_counts(claims), of_networks(claims);
    EXPECT_THROW(read_counts(of_counts), Error);
    EXPECT_THROW(read_networks(of_networks), Error);
  }
}

// Lists ask for as many bytes as their shortest elements take, so that a message takes memory in proportion to it.
TEST(Messages, TheShortestElementsFitIntoTheirLists) {
  for (const std::size_t many : {1u, 1000u}) {
    const std::string whole = message_of(std::vector<NetworkCounts>(many));
    Reader reader(whole);
    EXPECT_EQ(read_counts(reader).size(), many);
    EXPECT_TRUE(reader.at_end());
    RegistrationJob job{.patches = std::make_shared<const Patches>(), .scanners = {}};
    for (std::size_t k = 0; k < many; ++k) job.scanners.push_back({.noise = std::make_shared<const NoiseModel>()});
    Writer writer;
    pass(writer, job);
    Reader of_job(writer.bytes());
    pass(of_job, job);
    EXPECT_EQ(job.scanners.size(), many);
  }
}

}  // namespace
}  // namespace vantage::ranks
