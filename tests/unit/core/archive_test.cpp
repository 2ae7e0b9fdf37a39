// SPDX-License-Identifier: Apache-2.0
#include "core/archive.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace vantage {
namespace {

using State = Unsealed::State;

ArchiveReader reader_of(std::string_view bytes) { return {bytes, Errc::malformed_file, "too short"}; }

TEST(Archive, BringsBackWhatWasWritten) {
  const std::vector<std::uint64_t> wholes{0, 1, 127, 128, 300, 1u << 31, std::numeric_limits<std::uint64_t>::max()};
  ArchiveWriter writer;
  for (const std::uint64_t value : wholes) writer.whole(value);
  writer.wholes(wholes);
  writer.raw(-0.5), writer.raw(true);
  writer.array(std::vector<float>{1.5f, -2});
  writer.text("two\nlines");
  writer.list(std::vector<std::string>{"a", ""}, 1, [&](const std::string& one) { writer.text(one); });
  const std::string bytes = writer.take();
  EXPECT_TRUE(writer.bytes().empty());
  ArchiveReader reader = reader_of(bytes);
  for (const std::uint64_t value : wholes) EXPECT_EQ(reader.whole(), value);
  std::vector<std::uint64_t> read;
  reader.wholes(read);
  EXPECT_EQ(read, wholes);
  EXPECT_EQ(reader.raw<double>(), -0.5);
  EXPECT_TRUE(reader.raw<bool>());
  std::vector<float> floats;
  reader.array(floats);
  EXPECT_EQ(floats, (std::vector<float>{1.5f, -2}));
  EXPECT_EQ(reader.text(), "two\nlines");
  std::vector<std::string> texts;
  reader.list(texts, 1, [&](std::string& one) { reader.text(one); });
  EXPECT_EQ(texts, (std::vector<std::string>{"a", ""}));
  EXPECT_TRUE(reader.at_end());
  EXPECT_THROW(reader.whole(), Error);
}

TEST(Archive, SmallNumbersAreOneByte) {
  ArchiveWriter writer;
  writer.wholes(std::vector<std::uint64_t>(100, 90));
  EXPECT_EQ(writer.take().size(), 101u);
}

// The reader allocates nothing for content that cannot be there, and invents nothing.
TEST(Archive, RefusesWhatCannotBe) {
  ArchiveWriter huge;
  huge.whole(std::uint64_t{1} << 62);
  std::vector<double> values;
  ArchiveReader liar = reader_of(huge.bytes());
  try {
    liar.array(values);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::malformed_file);
    EXPECT_STREQ(error.what(), "too short");
  }
  EXPECT_THROW(reader_of(huge.bytes()).text(), Error);
  EXPECT_THROW(reader_of("\x02").raw<bool>(), Error);
  EXPECT_THROW(reader_of(std::string(11, '\xff')).whole(), Error);  // longer than any number
  EXPECT_THROW(reader_of("abc").raw<double>(), Error);
}

Unsealed opened(const std::string& bytes, std::uint32_t version = 3) {
  std::istringstream in(bytes);
  return unseal(in, {"magic\n", version});
}

TEST(Archive, ASealIsBrokenByEveryBitAndEveryCut) {
  const std::string payload("bits \0 and bytes", 16), whole = sealed({"magic\n", 3}, payload);
  EXPECT_EQ(opened(whole).state, State::whole);
  EXPECT_EQ(opened(whole).payload, payload);
  EXPECT_EQ(opened(whole, 4).state, State::other_version);
  EXPECT_EQ(opened(whole, 4).version, 3u);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(opened(whole.substr(0, size)).state, size < 6 ? State::foreign : State::damaged) << size;
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    EXPECT_NE(opened(flipped).state, State::whole) << bit;
  }
}

TEST(Archive, ASealEndsWhereItEnds) {
  std::istringstream in(sealed({"m", 1}, "one") + sealed({"m", 1}, "") + "x");
  EXPECT_EQ(unseal(in, {"m", 1}).payload, "one");
  EXPECT_EQ(unseal(in, {"m", 1}).state, State::whole);
  EXPECT_EQ(in.get(), 'x');
}

}  // namespace
}  // namespace vantage
