// SPDX-License-Identifier: Apache-2.0
#include "edit/scan_watcher.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

TEST(ScanFolder, ReturnsEachFileOnceItIsWhole) {
  const test::TemporaryFolder folder;
  const fs::path root = folder.path();
  const auto append = [&](const char* name, const char* text) {
    std::ofstream(root / name, std::ios::app) << text;
    fs::last_write_time(root / name, fs::file_time_type::clock::now());
  };
  using Files = std::vector<fs::path>;
  ScanFolder scans(root);
  EXPECT_EQ(scans.fresh(), Files());
  append("b.e57", "half");
  append("a.PTX", "whole");
  append("notes.txt", "no scan");
  EXPECT_EQ(scans.fresh(), Files()) << "they may still be written";
  append("b.e57", " and more");
  EXPECT_EQ(scans.fresh(), Files{root / "a.PTX"});
  EXPECT_EQ(scans.fresh(), Files{root / "b.e57"});
  EXPECT_EQ(scans.fresh(), Files());
  append("a.PTX", ", registered anew");
  EXPECT_EQ(scans.fresh(), Files());
  EXPECT_EQ(scans.fresh(), Files{root / "a.PTX"});
}

TEST(ScanFolder, HasNoneIfItIsNotThere) { EXPECT_TRUE(ScanFolder("/nowhere/at all").fresh().empty()); }

}  // namespace
}  // namespace vantage
