// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include "cloud_files.hpp"
#include "e57_file.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using E57SourceTest = CloudTest;
using importer::open_e57;

std::string bytes_of(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) put(bytes, value);
  return bytes;
}

std::string pose_of(const std::string& x, const std::string& w = "1", const std::string& z = "0") {
  return "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">" + w +
         "</w><x type=\"Float\">0</x><y "
         "type=\"Float\">0</y><z type=\"Float\">" +
         z +
         "</z></rotation><translation type=\"Structure\"><x "
         "type=\"Float\">" +
         x + "</x><y type=\"Float\">20</y><z type=\"Float\">1.5</z></translation></pose>";
}

constexpr const char* kCartesian =
    "<cartesianX type=\"Float\"/><cartesianY type=\"Float\"/><cartesianZ type=\"Float\"/>";

E57TestScan scan_of(const std::vector<Eigen::Vector3d>& points, const std::string& head) {
  E57TestScan scan{.head = head, .prototype = kCartesian, .count = points.size()};
  std::vector<std::string> streams(3);
  for (const auto& p : points)
    for (int axis = 0; axis < 3; ++axis) put(streams[static_cast<std::size_t>(axis)], p[axis]);
  scan.packets.push_back(streams);
  return scan;
}

TEST_F(E57SourceTest, ReadsWhatVantageWrites) {
  const Vec3 origin{500'100, 4'500'300, 100};
  const auto file = folder_.path() / "own.e57";
  PointCloudWriter writer(file, origin, scan_position | scan_normal);
  std::vector<Vec3> written;
  for (int station = 0; station < 2; ++station) {
    StationScan scan{
        .name = "S" + std::to_string(station + 1), .head = origin + Vec3{1.0 + station, 2, 1.5}, .scanner = {}};
    scan.setup.heading = Angle::degrees(30), scan.setup.tilt = Angle::degrees(90);
    writer.begin_station(scan);
    ScanChunk chunk;
    chunk.ray_count = 5000;
    for (int k = 0; k < 5000; ++k) {
      const Vec3 p{3 * std::sin(k), 4 * std::cos(1.3 * k), 0.001 * k + station};
      chunk.position.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      chunk.normal.push_back({0, 0, 1});
      chunk.reflectivity.push_back(0.5F);
      written.push_back(origin + p);
    }
    writer.write(chunk, static_cast<std::uint16_t>(station + 1));
  }
  writer.close();
  const auto source = open_e57(file);
  const auto points = points_of(*source);
  ASSERT_EQ(points.size(), written.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    expect_at(points[k], written[k].x, written[k].y, written[k].z, 2e-6);
    EXPECT_LE((points[k].normal - Eigen::Vector3f::UnitZ()).norm(), 1e-6F);
    EXPECT_EQ(points[k].scan, k / 5000);
  }
  ASSERT_EQ(source->scans().size(), 2u);
  EXPECT_EQ(source->scans()[1].name, "S2");
  EXPECT_TRUE(source->scans()[1].posed);
  EXPECT_LE((source->scans()[1].position - Eigen::Vector3d(500'102, 4'500'302, 101.5)).norm(), 1e-9);
  EXPECT_EQ(points_of(*source).size(), points.size()) << "a second time";
}

TEST_F(E57SourceTest, SphericalPointsAndInvalidOnes) {
  E57TestScan scan{.head = pose_of("10", "0.70710678118654757", "0.70710678118654757"),
                   .prototype =
                       "<sphericalRange type=\"Float\" precision=\"single\"/>"
                       "<sphericalAzimuth type=\"Float\"/><sphericalElevation type=\"Float\"/>"
                       "<sphericalInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>",
                   .count = 3};
  std::string range;
  for (const float value : {2.0F, 3.0F, 4.0F}) put(range, value);
  scan.packets = {{range, bytes_of({0, 0, M_PI / 2}), bytes_of({0, 0, M_PI / 6}), packed_bits({0, 2, 0}, 2)}};
  write_e57(folder_.path() / "a.e57", {scan});
  const auto source = open_e57(folder_.path() / "a.e57");
  const auto points = points_of(*source);
  ASSERT_EQ(points.size(), 2u);  // turned by 90° about z
  expect_at(points[0], 10, 22, 1.5, 1e-9);
  expect_at(points[1], 10 - 4 * std::cos(M_PI / 6), 20, 3.5, 1e-9);
  EXPECT_TRUE(source->scans()[0].posed);
}

TEST_F(E57SourceTest, IntegersOfEveryWidthInStreamsOutOfStep) {
  std::mt19937_64 random(7);
  for (unsigned bits = 1; bits <= 53; ++bits) {
    // x is scaled, y always 4, z counts; a text and a colour stand between.
    const std::uint64_t most = (std::uint64_t{1} << bits) - 1;
    E57TestScan scan{.head = {},
                     .prototype = "<cartesianX type=\"ScaledInteger\" minimum=\"-100\" maximum=\"" +
                                  std::to_string(static_cast<std::int64_t>(most) - 100) +
                                  "\" scale=\"0.5\" offset=\"7\"/><label type=\"String\"/>"
                                  "<cartesianY type=\"Integer\" minimum=\"4\" maximum=\"4\"/>"
                                  "<colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/>"
                                  "<cartesianZ type=\"Integer\" minimum=\"0\" maximum=\"1023\"/>",
                     .count = 100};
    std::vector<std::uint64_t> x, z;
    for (std::uint64_t k = 0; k < 100; ++k) x.push_back(random() & most), z.push_back(k);
    const std::string xs = packed_bits(x, bits), zs = packed_bits(z, 10);
    // The first packet has half of x and all of z; bytes need not end with values.
    scan.packets = {{xs.substr(0, xs.size() / 2), "any", "", "12", zs}, {xs.substr(xs.size() / 2), "", "", "3", ""}};
    write_e57(folder_.path() / "a.e57", {scan});
    const auto source = open_e57(folder_.path() / "a.e57");
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), 100u);
    for (std::size_t k = 0; k < 100; ++k)
      expect_at(points[k], (static_cast<double>(x[k]) - 100) * 0.5 + 7, 4, static_cast<double>(k));
    EXPECT_FALSE(source->scans()[0].posed);  // nothing says from where
  }
}

TEST_F(E57SourceTest, ScansFromOnePlaceWereMergedBefore) {
  const auto a = scan_of({{1, 0, 0}}, pose_of("10")), b = scan_of({{2, 0, 0}}, pose_of("11"));
  write_e57(folder_.path() / "apart.e57", {a, b});
  const auto apart = open_e57(folder_.path() / "apart.e57");
  EXPECT_TRUE(apart->scans()[0].posed && apart->scans()[1].posed);
  EXPECT_EQ(apart->scans()[0].name, "scan 1");
  const auto points = points_of(*apart);
  expect_at(points[0], 11, 20, 1.5);
  expect_at(points[1], 13, 20, 1.5);
  write_e57(folder_.path() / "merged.e57", {a, a});
  const auto merged = open_e57(folder_.path() / "merged.e57");
  EXPECT_FALSE(merged->scans()[0].posed || merged->scans()[1].posed);
}

TEST_F(E57SourceTest, TruncationsAndFlippedBitsAreRefused) {
  const auto file = folder_.path() / "a.e57";
  write_e57(file, {scan_of({{1, 2, 3}, {4, 5, 6}}, pose_of("10"))});
  const std::string bytes = read(file);
  for (std::size_t at = 0; at < bytes.size(); at += 5) {
    std::string flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << at % 8));
    const auto damaged = write("b.e57", flipped);
    EXPECT_THROW(points_of(*open_e57(damaged)), importer::Refused) << "byte " << at;
  }
  for (std::size_t length = 0; length < bytes.size(); length += 37)
    EXPECT_THROW(points_of(*open_e57(write("c.e57", bytes.substr(0, length)))), importer::Refused) << length;
}

TEST_F(E57SourceTest, SaysWhatIsWrong) {
  const auto file = folder_.path() / "a.e57";
  const auto refused = [&](const E57TestScan& scan, const std::string& words) {
    write_e57(file, {scan});
    expect_refused_for(words, [&] { points_of(*open_e57(file)); });
  };
  E57TestScan scan = scan_of({{1, 2, 3}}, {});
  scan.count = 2;
  refused(scan, "points end after 1 of 2");
  scan.prototype = "<cartesianX type=\"Float\"/>";
  refused(scan, "has no cartesianY");
  scan.prototype = "<cartesianX type=\"Blob\"/>";
  refused(scan, "type \"Blob\"");
  scan.prototype = "<cartesianX type=\"Integer\" minimum=\"2\" maximum=\"1\"/>";
  refused(scan, "reversed");
  scan.prototype =
      "<cartesianX type=\"Integer\" minimum=\"1\" maximum=\"1\"/><cartesianY type=\"Integer\" minimum=\"1\" "
      "maximum=\"1\"/><cartesianZ type=\"Integer\" minimum=\"1\" maximum=\"1\"/>";
  refused(scan, "the same place");
  scan = scan_of({{1, 2, 3}}, pose_of("ten"));
  refused(scan, "pose/translation/x is no number");
  scan = scan_of({{1, 2, 3}}, {});
  scan.packets[0].pop_back();
  refused(scan, "not the fields of their description");
  std::string deep;
  for (int k = 0; k < 1000; ++k) deep += "<a>";
  refused(scan_of({{1, 2, 3}}, deep), "nested too deeply");
  refused(scan_of({{1, 2, 3}}, "<a>"), "cannot be read at line");
  write_e57(file, {});
  expect_refused_for("holds no scan", [&] { open_e57(file); });
}

}  // namespace
}  // namespace vantage::test
