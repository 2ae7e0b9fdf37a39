// SPDX-License-Identifier: Apache-2.0
#include "core/read_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

std::string why_refused(const std::filesystem::path& file, Errc code) {
  try {
    read_file(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "not refused";
}

TEST(ReadFile, GivesAllBytes) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0b\n\xff", 5);
  std::ofstream(folder / "a", std::ios::binary) << bytes;
  std::ofstream(folder / "empty");
  std::filesystem::create_symlink("a", folder / "link");
  EXPECT_EQ(read_file(folder / "a"), bytes);
  EXPECT_EQ(read_file(folder / "link"), bytes);
  EXPECT_EQ(read_file(folder / "empty"), "");
}

// Rejected at once: reading a pipe without a writer would block, and a device never ends.
TEST(ReadFile, RefusesWhatIsNoRegularFile) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder / "device");
  for (const std::filesystem::path& file : {folder / "pipe", folder / "device", folder.path()})
    EXPECT_NE(why_refused(file, Errc::io).find("is not a regular file"), std::string::npos) << file;
  EXPECT_NE(why_refused(folder / "none", Errc::io).find("there is no file"), std::string::npos);
  EXPECT_NE(why_refused(folder / "pipe" / "below", Errc::io).find("cannot be opened"), std::string::npos);
}

TEST(ReadFile, RefusesWhatIsLargerThanAnyTable) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "sparse");
  std::filesystem::resize_file(folder / "sparse", (std::uintmax_t{1} << 30) + 1);
  EXPECT_NE(why_refused(folder / "sparse", Errc::malformed_file).find("1.0 GiB"), std::string::npos);
}

}  // namespace
}  // namespace vantage
