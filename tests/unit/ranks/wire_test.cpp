// SPDX-License-Identifier: Apache-2.0
#include "ranks/wire.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ranks/messages.hpp"

namespace vantage::ranks {
namespace {

TEST(Wire, BringsBackWhatWasWritten) {
  const std::vector<std::uint64_t> wholes{0, 1, 127, 128, 300, 1u << 31, std::numeric_limits<std::uint64_t>::max()};
  Writer writer;
  for (const std::uint64_t value : wholes) writer.whole(value);
  writer.wholes(wholes);
  writer.raw(-0.5);
  writer.array(std::vector<float>{1.5f, -2});
  writer.text("two\nlines");
  const Message message = writer.take();
  Reader reader(message);
  for (const std::uint64_t value : wholes) EXPECT_EQ(reader.whole(), value);
  std::vector<std::uint64_t> read;
  reader.wholes(read);
  EXPECT_EQ(read, wholes);
  EXPECT_EQ(reader.raw<double>(), -0.5);
  std::vector<float> floats;
  reader.array(floats);
  EXPECT_EQ(floats, (std::vector<float>{1.5f, -2}));
  EXPECT_EQ(reader.text(), "two\nlines");
  EXPECT_THROW(reader.whole(), Error);  // nothing is left
}

TEST(Wire, SmallNumbersAreOneByte) {
  Writer writer;
  writer.wholes(std::vector<std::uint64_t>(100, 90));
  EXPECT_EQ(writer.take().size(), 101u);
}

// A message cut anywhere is an error; nothing is invented, and no memory is allocated for missing content.
TEST(Wire, ACutLetterIsRefused) {
  NetworkCounts counts;
  counts.voxels = 1000, counts.stations = 3, counts.points_on_surveyed = {5, 600, 70000};
  counts.groups = {counts, counts};
  Writer writer;
  write_counts(writer, {&counts, 1});
  const Message message = writer.take();
  for (std::size_t bytes = 0; bytes < message.size(); ++bytes) {
    Reader reader(std::string_view(message).substr(0, bytes));
    EXPECT_THROW(read_counts(reader), Error) << bytes;
  }
  Reader reader(message);
  EXPECT_EQ(read_counts(reader).at(0).groups.at(1).points_on_surveyed, counts.points_on_surveyed);
  Writer huge;
  huge.whole(std::uint64_t{1} << 62);
  const Message lie = huge.take();
  Reader liar(lie);
  std::vector<double> values;
  EXPECT_THROW(liar.array(values), Error);
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
