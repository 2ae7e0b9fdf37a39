// SPDX-License-Identifier: Apache-2.0
#include "search/checkpoint.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/archive.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

Checkpoint sample() {
  Checkpoint c{
      .identity = "scene = 1\nseed = 2\n", .snapshot = {}, .since = {}, .seconds = 12.5, .trace_seconds = 3.25};
  c.snapshot.optimiser = std::string("bits \0 and bytes", 16);
  c.snapshot.evaluator = std::string("a sample \0", 10);
  c.snapshot.drawn = 100, c.snapshot.redrawn = 7;
  c.snapshot.history = {
      {.iteration = 1, .evaluations = 20, .hypervolume = 0.1, .front = {{0.5, 0.25}, {0.25, 0.5}}, .seconds = 1},
      {.iteration = 2, .evaluations = 40, .hypervolume = 0.2, .front = {}, .seconds = 2}};
  c.since = {{0.125, 0.75, 2}, {1.0 / 3}};
  return c;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Checkpoint, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(read_checkpoint(folder / "none"));
  const Checkpoint c = sample();
  write_checkpoint(folder / "c", c);
  const auto back = read_checkpoint(folder / "c");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->identity, c.identity);
  EXPECT_EQ(back->snapshot.optimiser, c.snapshot.optimiser);
  EXPECT_EQ(back->snapshot.evaluator, c.snapshot.evaluator);
  EXPECT_EQ(back->snapshot.drawn, 100u);
  EXPECT_EQ(back->snapshot.redrawn, 7u);
  EXPECT_EQ(back->seconds, 12.5);
  EXPECT_EQ(back->trace_seconds, 3.25);
  ASSERT_EQ(back->snapshot.history.size(), 2u);
  EXPECT_EQ(back->snapshot.history[0].front, c.snapshot.history[0].front);
  EXPECT_EQ(back->snapshot.history[1].evaluations, 40u);
  ASSERT_EQ(back->since.size(), 2u);
  EXPECT_EQ(back->since, c.since);
  write_checkpoint(folder / "again", *back);
  EXPECT_EQ(content(folder / "again"), content(folder / "c"));
}

TEST(Checkpoint, NoticesEveryFlippedBitAndEveryTruncation) {
  const test::TemporaryFolder folder;
  write_checkpoint(folder / "c", sample());
  const std::string whole = content(folder / "c");
  EXPECT_NO_THROW(parse_checkpoint(whole, "c"));
  const auto refused = [](const std::string& bytes) {
    try {
      parse_checkpoint(bytes, "c");
      return false;
    } catch (const Error& e) {
      return e.code() == Errc::malformed_file;
    }
  };
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_TRUE(refused(whole.substr(0, size))) << size;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    EXPECT_TRUE(refused(flipped)) << bit;
  }
  EXPECT_TRUE(refused(whole + "x"));
}

// With a valid checksum, from somebody who means harm: a megabyte of lengths would be so many vectors of nothing.
TEST(Checkpoint, TakesMemoryInProportionToItsBytes) {
  const ArchiveFormat format{"vantage checkpoint\n", 5};
  const auto forged = [&](std::uint64_t lines, std::uint64_t vectors) {
    ArchiveWriter writer;
    writer.text(""), writer.raw(1.0), writer.raw(1.0);
    writer.text(""), writer.text(""), writer.whole(0), writer.whole(0);
    writer.whole(lines), writer.whole(vectors);
    return sealed(format, writer.take() + std::string(1 << 20, '\0'));
  };
  for (const auto& [lines, vectors] : {std::pair<std::uint64_t, std::uint64_t>{std::uint64_t{1} << 40, 0},
                                       {0, ~std::uint64_t{0}},
                                       {0, 1 << 20},
                                       {0, (1 << 20) / 9 + 1}}) {
    try {
      parse_checkpoint(forged(lines, vectors), "c");
      ADD_FAILURE() << lines << " " << vectors;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::malformed_file);
    }
  }
}

TEST(Checkpoint, NamesTheFormatOfAnotherVersion) {
  const std::string old = sealed({"vantage checkpoint\n", 4}, "whatever");
  try {
    parse_checkpoint(old, "c");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::malformed_file);
    EXPECT_STREQ(e.what(),
                 "checkpoint c has format 4, this is 5; resume with the vantage that wrote it, or start again");
  }
}

TEST(Checkpoint, KeepsTheOneBefore) {
  const test::TemporaryFolder folder;
  const auto file = folder / "c", before = checkpoint_before(file);
  EXPECT_FALSE(newest_checkpoint(file));
  Checkpoint checkpoint = sample();
  for (const double seconds : {1, 2, 3}) {
    checkpoint.seconds = seconds;
    write_checkpoint(file, checkpoint, seconds > 1);
  }
  EXPECT_EQ(read_checkpoint(before)->seconds, 2);
  EXPECT_EQ(newest_checkpoint(file)->checkpoint.seconds, 3);
  EXPECT_FALSE(newest_checkpoint(file)->is_before);
  std::ofstream(file) << "x";
  EXPECT_EQ(newest_checkpoint(file)->checkpoint.seconds, 2);
  EXPECT_TRUE(newest_checkpoint(file)->is_before);
  std::filesystem::remove(file);
  EXPECT_EQ(newest_checkpoint(file)->checkpoint.seconds, 2);
  std::ofstream(before) << "x";
  EXPECT_THROW(newest_checkpoint(file), Error);
}

TEST(Checkpoint, NamesWhatDiffers) {
  EXPECT_NO_THROW(require_same_run("c", "a = 1\nb = 2\n", "a = 1\nb = 2\n"));
  try {
    require_same_run("c", "a = 1\nb = 2\nc = 3\n", "a = 1\nb = 5\n");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(e.what()).find("b = 2, this run b = 5"), std::string::npos) << e.what();
    EXPECT_EQ(e.details().size(), 2u);
  }
}

}  // namespace
}  // namespace vantage
