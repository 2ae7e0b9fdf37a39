// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/byte_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "support/temporary_folder.hpp"

namespace vantage::test {
namespace {

std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator()));
}

// A folder of thousands of scans takes neither a descriptor nor a buffer for each.
TEST(ByteFile, ManyAreReadInTurnsWithFewOpen) {
  const TemporaryFolder folder;
  constexpr std::size_t kFiles = 300;
  std::vector<std::unique_ptr<importer::ByteFile>> files;
  const std::size_t before = open_descriptors();
  for (std::size_t k = 0; k < kFiles; ++k) {
    const auto path = folder.path() / std::to_string(k);
    std::ofstream(path) << "file " << k << "\nsecond\n" << std::string(8, static_cast<char>('a' + k % 26));
    files.push_back(std::make_unique<importer::ByteFile>(path));
    EXPECT_EQ(files.back()->line(), "file " + std::to_string(k));
  }
  EXPECT_LT(open_descriptors(), before + 32);
  for (std::size_t k = 0; k < kFiles; ++k) EXPECT_EQ(files[k]->line(), "second") << k;  // where it was
  for (std::size_t k = kFiles; k-- > 0;) {
    const std::uint64_t place = files[k]->place();
    EXPECT_EQ(std::string(files[k]->take(8), 8), std::string(8, static_cast<char>('a' + k % 26)));
    EXPECT_EQ(files[k]->left(), 0u);
    files[k]->seek(place);
    EXPECT_EQ(*files[k]->take(1), static_cast<char>('a' + k % 26));
  }
  files.erase(files.begin(), files.begin() + 200);
  files.front()->seek(0);
  EXPECT_EQ(files.front()->line(), "file 200");
  EXPECT_LT(open_descriptors(), before + 32);
}

}  // namespace
}  // namespace vantage::test
