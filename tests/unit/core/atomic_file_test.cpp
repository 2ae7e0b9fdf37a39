// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, AppearsAtCommitOnly) {
  const test::TemporaryFolder folder;
  {
    AtomicFile out(folder / "a.txt");
    out.write("count 0000 rest");
    out.patch(6, "1234", 4);
    out.write("!");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    out.commit();
  }
  EXPECT_EQ(content(folder / "a.txt"), "count 1234 rest!");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWhenDropped) {
  const test::TemporaryFolder folder;
  write_atomically(folder / "a.txt", "old");
  { AtomicFile(folder / "a.txt").write("new"); }
  EXPECT_EQ(content(folder / "a.txt"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, NamesAFolderThatIsMissing) {
  const test::TemporaryFolder folder;
  try {
    AtomicFile out(folder.path() / "missing" / "a.txt");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::io);
    EXPECT_NE(std::string(e.what()).find("missing/a.txt"), std::string::npos);
  }
}

TEST(AtomicFile, LeavesTemporariesOfOthersAtWork) {
  const test::TemporaryFolder folder;
  AtomicFile out(folder / "a.txt");
  out.write("x");
  std::ofstream(folder / ".b.txt.1-2.partial") << "of a process that was killed";
  AtomicFile::remove_leftovers(folder / "a.txt");
  EXPECT_EQ(entries(folder.path()), 2u);
  AtomicFile::remove_leftovers_in(folder.path());
  EXPECT_EQ(entries(folder.path()), 1u);
  out.commit();
  EXPECT_EQ(content(folder / "a.txt"), "x");
}

// Anyone with write access to the folder chooses the target of a link.
TEST(AtomicFile, TakesTheLinksPlaceAndFollowsNone) {
  const test::TemporaryFolder folder;
  const auto file = folder / "front.json", elsewhere = folder / "elsewhere";
  std::ofstream(elsewhere) << "kept";
  std::filesystem::create_symlink(elsewhere, file);
  std::filesystem::create_symlink(elsewhere, folder / ".front.json.1-0.partial");
  AtomicFile::remove_leftovers(file);
  write_atomically(file, "new");
  EXPECT_FALSE(std::filesystem::is_symlink(file));
  EXPECT_EQ(content(file), "new");
  EXPECT_EQ(content(elsewhere), "kept");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / ".front.json.1-0.partial"));
}

// As root, a file would take the place of /dev/null.
TEST(AtomicFile, TakesTheirPlaceFromNoPipeAndNoOpenFile) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/proc/self/fd/1", folder / "stdout");
  for (const char* name : {"pipe", "stdout"}) {
    try {
      write_atomically(folder / name, "x");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::io);
      EXPECT_NE(std::string(error.what()).find("give a file name"), std::string::npos) << error.what();
    }
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "stdout"));
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(AtomicFile, RemovesOnlyItsOwnLeftovers) {
  const test::TemporaryFolder folder;
  for (const char* name : {".a.ckpt.12-0.partial", ".ab.ckpt.12-0.partial", ".a.ckpt.notes", "a.ckpt"})
    std::ofstream(folder / name) << "x";
  AtomicFile::remove_leftovers(folder / "a.ckpt");
  EXPECT_FALSE(std::filesystem::exists(folder / ".a.ckpt.12-0.partial"));
  EXPECT_EQ(entries(folder.path()), 3u);
}

}  // namespace
}  // namespace vantage
