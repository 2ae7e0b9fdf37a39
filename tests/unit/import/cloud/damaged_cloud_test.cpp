// SPDX-License-Identifier: Apache-2.0
// Damaged clouds give surfaces or one sentence, and never end the program, through the importer as it is run.
#include <random>

#include "cloud_files.hpp"
#include "import/cloud/convert.hpp"
#include "import/scans.hpp"
#include "unit/import/import_fixture.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

// Points of a floor, as a file of the format.
std::string sample(const std::string& format, const std::filesystem::path& folder) {
  constexpr int kSide = 40;
  std::string text;
  if (format == "xyz" || format == "pcd" || format == "ptx") {
    const std::string count = std::to_string(kSide * kSide);
    if (format == "pcd")
      text = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + count +
             "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n";
    if (format == "ptx")
      text = std::to_string(kSide) + "\n" + std::to_string(kSide) +
             "\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    for (int a = 0; a < kSide; ++a)
      for (int b = 0; b < kSide; ++b) text += std::to_string(0.01 * a) + " " + std::to_string(0.01 * b) + " -1.5\n";
    return text;
  }
  const auto file = folder / ("sample." + format);
  PointCloudWriter writer(file, {}, scan_position | scan_reflectivity);
  writer.begin_station({.name = "S1", .head = {0.2, 0.2, 1.5}, .scanner = {}});
  ScanChunk chunk;
  chunk.ray_count = kSide * kSide;
  for (int a = 0; a < kSide; ++a)
    for (int b = 0; b < kSide; ++b) {
      chunk.position.push_back({0.01F * static_cast<float>(a), 0.01F * static_cast<float>(b), 0});
      chunk.reflectivity.push_back(0.5F);
    }
  writer.write(chunk, 1);
  writer.close();
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class DamagedCloud : public ImportTest, public testing::WithParamInterface<const char*> {};

TEST_P(DamagedCloud, GivesASceneOrOneError) {
  constexpr int kTries = 20;
  const std::string format = GetParam(), content = sample(format, folder_.path());
  EXPECT_GT(load_within(write("sound." + format, content), 20).triangle_count(), 0u);
  std::mt19937 random(20'26);
  int refused = 0;
  for (int k = 0; k < kTries; ++k) {
    std::string damaged = content;
    if (random() % 3 == 0) damaged.resize(1 + random() % (content.size() - 1));
    // Heads are small; half of the flips are there.
    for (std::uint32_t flips = 1 + random() % 8; flips > 0; --flips) {
      const std::size_t within = random() % 2 == 0 ? std::min<std::size_t>(damaged.size(), 400) : damaged.size();
      damaged[random() % within] ^= static_cast<char>(1U << (random() % 8));
    }
    const auto file = write(std::to_string(k) + "." + format, damaged);
    try {
      if (k % 2 == 0 && (format == "e57" || format == "ptx")) importers::thin_scans(file, 0.02);
      load_within(file, 5);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find(file.string()), 0u) << error.what();
      EXPECT_EQ(std::string(error.what()).find("crashed"), std::string::npos) << error.what();
      EXPECT_TRUE(error.code() == Errc::malformed_file || error.code() == Errc::out_of_memory) << error.what();
    }
  }
  EXPECT_TRUE(refused > 0 || format == "xyz");  // whose lines that are no points are passed over, and told
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedCloud, testing::Values("e57", "las", "ply", "xyz", "ptx", "pcd"),
                         [](const auto& format) { return std::string(format.param); });

}  // namespace
}  // namespace vantage::test
