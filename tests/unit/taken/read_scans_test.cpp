// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "rooms.hpp"
#include "unit/import/import_fixture.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using ReadScans = ImportTest;

std::uint64_t points_of(const TakenScan& scan) {
  return std::accumulate(scan.thinned.begin(), scan.thinned.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const TakenPoint& point) { return sum + point.points; });
}

void write_scan(const std::filesystem::path& file, Site& site, const std::vector<Vec3>& heads) {
  PointCloudWriter writer(file, site.simulator().origin(), scan_position | scan_reflectivity);
  for (std::size_t k = 0; k < heads.size(); ++k) {
    writer.begin_station({.name = "S" + std::to_string(k + 1), .head = heads[k], .scanner = site.scanner()});
    site.simulator().scan({.position = heads[k]}, {.outputs = scan_position | scan_reflectivity},
                          [&](const ScanChunk& chunk) { writer.write(chunk, 1); });
  }
  writer.close();
}

TEST_F(ReadScans, ThinPointsStandForAllPoints) {
  Site site = site_of(Rooms{.step_deg = 1});
  const auto file = folder_ / "day.e57";
  write_scan(file, site, {kInFirst, kInSecond});
  const TakenScan truth = scan_at(site, kInFirst);
  const auto fine = read_taken_scans(file, 0.001), coarse = read_taken_scans(file, 0.2);
  ASSERT_EQ(fine.size(), 2u);
  EXPECT_EQ(fine[0].name, "S1");
  EXPECT_EQ(fine[1].name, "S2");
  EXPECT_EQ(fine[0].head, kInFirst);
  EXPECT_EQ(fine[0].points, truth.points);
  EXPECT_EQ(points_of(fine[0]), truth.points);
  EXPECT_EQ(points_of(coarse[0]), truth.points);
  EXPECT_LT(coarse[0].thinned.size(), fine[0].thinned.size() / 4);
  // Their mean is that of all points.
  for (const auto& scan : {fine[0], coarse[0]})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto mean = [axis](const TakenScan& one) {
        double sum = 0, count = 0;
        for (const TakenPoint& p : one.thinned)
          sum += static_cast<double>(p.offset[axis]) * p.points, count += p.points;
        return sum / count;
      };
      EXPECT_NEAR(mean(scan), mean(truth), 1e-4);
    }
}

TEST_F(ReadScans, AFolderIsItsFilesByName) {
  Site site = site_of(Rooms{.step_deg = 5});
  write_scan(folder_ / "b.e57", site, {kInSecond});
  write_scan(folder_ / "c.e57", site, {kInFirst});
  std::filesystem::rename(folder_ / "c.e57", folder_ / "A.E57");
  write("notes.txt", "not a scan");
  const auto scans = read_taken_scans(folder_.path());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].head, kInFirst);
  EXPECT_EQ(scans[1].head, kInSecond);
}

TEST_F(ReadScans, AFolderOfScansIsASite) {
  Site site = site_of(Rooms{.step_deg = 1});
  write_scan(folder_ / "a.e57", site, {kInFirst, kAcross});
  write_scan(folder_ / "b.e57", site, {{5.4, 2.4, 1.85}});
  const Scene scene = Scene::load(folder_.path());
  const Box box = scene.bounds();
  EXPECT_NEAR(box.min.x, 0, 0.06);
  EXPECT_GT(box.max.x, 8) << "the second room, as far as the doorway shows it";
  bool told = false;
  for (const std::string& note : scene.notes()) told |= note.find("of 3 scans") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST_F(ReadScans, TellsHowFarItIsAndCanBeStopped) {
  Site site = site_of(Rooms{.step_deg = 0.2});
  write_scan(folder_ / "a.e57", site, {kInFirst, kAcross});
  write_scan(folder_ / "b.e57", site, {kInSecond});
  std::vector<double> told;
  EXPECT_EQ(read_taken_scans(folder_.path(), 0.02, {[&](double done) { told.push_back(done); }, {}}).size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_GE(told.size(), 2u);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(read_taken_scans(folder_.path(), 0.01, {{}, stop.get_token()}).empty());
}

TEST_F(ReadScans, PtxHasPoses) {
  write("a.ptx", "2\n1\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n4 5 6\n0 0 0\n");
  const auto scans = read_taken_scans(folder_ / "a.ptx");
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].head, (Vec3{1, 2, 3}));
  EXPECT_EQ(scans[0].points, 1u);
  ASSERT_EQ(scans[0].thinned.size(), 1u);
  EXPECT_NEAR(scans[0].thinned[0].offset[2], 6, 1e-4);
}

TEST_F(ReadScans, OtherFilesAreRefused) {
  expect_error(Errc::malformed_file, "no scan", [&] { read_taken_scans(folder_.path()); });
  expect_error(Errc::malformed_file, "from where its scans were taken",
               [&] { read_taken_scans(write("a.xyz", "1 2 3\n4 5 6\n")); });
  expect_error(Errc::malformed_file, "read from E57 and PTX", [&] { read_taken_scans(write("a.obj", "v 0 0 0\n")); });
}

}  // namespace
}  // namespace vantage::test
