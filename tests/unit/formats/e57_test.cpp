// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <regex>

#include "formats/e57_paged_file.hpp"
#include "formats/e57_points.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/e57_reader.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::content;
using test::read_e57;

constexpr std::uint32_t kHeld = scan_position | scan_normal | scan_reflectivity | scan_colour;
const Vec3 kSurveyOrigin{500'123.25, 4'500'321.5, 101.75};

Scanner scanner_of(double step_deg, double heading_deg, double max_range_m = 130) {
  Scanner scanner;
  scanner.name = "Maker <One> & Co @fine";
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_deg);
  scanner.heading = Angle::degrees(heading_deg);
  scanner.max_range_m = max_range_m;
  return scanner;
}

// Rays first … first + count − 1, of which every third misses; values follow from the ray's number.
ScanChunk chunk_of(std::uint64_t first, std::size_t count) {
  ScanChunk c;
  c.first_ray = first, c.ray_count = count;
  for (std::size_t k = 0; k < count; ++k) {
    const auto ray = static_cast<double>(first + k);
    const bool miss = (first + k) % 3 == 2;
    const float none = std::numeric_limits<float>::quiet_NaN();
    const auto f = [&](double value) { return miss ? none : static_cast<float>(value); };
    c.position.push_back({f(100 * std::sin(ray)), f(100 * std::cos(1.7 * ray)), f(5 * std::sin(0.3 * ray))});
    c.normal.push_back({static_cast<float>(std::sin(ray)), static_cast<float>(std::cos(ray)), 0});
    c.reflectivity.push_back(static_cast<float>(0.5 + 0.5 * std::sin(ray)));
    c.colour.push_back(0xFF000000u | static_cast<std::uint32_t>((first + k) * 2'654'435'761u) >> 8);
  }
  return c;
}

std::size_t hits_of(const ScanChunk& chunk) {
  std::size_t hits = 0;
  for (const auto& p : chunk.position) hits += std::isfinite(p[0]) ? 1 : 0;
  return hits;
}

// The pose's rotation, by the general formula for unit quaternions.
Vec3 rotated(const test::E57ReadScan& scan, const Vec3& p) {
  const double w = scan.number("pose/rotation/w");
  const Vec3 q{scan.number("pose/rotation/x"), scan.number("pose/rotation/y"), scan.number("pose/rotation/z")};
  EXPECT_NEAR(w * w + dot(q, q), 1, 1e-15);
  const Vec3 t = cross(q, p) * 2;
  return p + t * w + cross(q, t);
}

void expect_same_points(const test::E57ReadScan& scan, const ScanChunk& chunk, const Scanner& scanner,
                        double tolerance_m) {
  ASSERT_EQ(scan.records, hits_of(chunk));
  const Vec3 translation{scan.number("pose/translation/x"), scan.number("pose/translation/y"),
                         scan.number("pose/translation/z")};
  const auto field = [&](const char* name, std::size_t r) { return scan.fields.at(name).at(r); };
  std::size_t r = 0;
  for (std::size_t k = 0; k < chunk.ray_count; ++k) {
    const auto& p = chunk.position[k];
    if (!std::isfinite(p[0])) continue;
    const Vec3 survey = kSurveyOrigin + Vec3{p[0], p[1], p[2]};
    const Vec3 read = rotated(scan, {field("cartesianX", r), field("cartesianY", r), field("cartesianZ", r)});
    EXPECT_NEAR(read.x + translation.x, survey.x, tolerance_m);
    EXPECT_NEAR(read.y + translation.y, survey.y, tolerance_m);
    EXPECT_NEAR(read.z + translation.z, survey.z, tolerance_m);
    const auto& n = chunk.normal[k];
    const Vec3 normal = rotated(scan, {field("nor:normalX", r), field("nor:normalY", r), field("nor:normalZ", r)});
    EXPECT_NEAR(normal.x, n[0], 2e-7);
    EXPECT_NEAR(normal.y, n[1], 2e-7);
    EXPECT_NEAR(normal.z, n[2], 2e-7);
    EXPECT_EQ(field("intensity", r), double{chunk.reflectivity[k]});
    EXPECT_EQ(field("colorRed", r), chunk.colour[k] & 255);
    EXPECT_EQ(field("colorGreen", r), chunk.colour[k] >> 8 & 255);
    EXPECT_EQ(field("colorBlue", r), chunk.colour[k] >> 16 & 255);
    EXPECT_EQ(field("rowIndex", r) * scanner.columns() + field("columnIndex", r),
              static_cast<double>(chunk.first_ray + k));
    ++r;
  }
}

TEST(E57, KeepsEachStationInItsScannersFrame) {
  const test::TemporaryFolder folder;
  const Scanner scanner = scanner_of(1, 30);
  const Vec3 heads[] = {kSurveyOrigin + Vec3{3, -4, 1.5}, kSurveyOrigin + Vec3{-20, 11, 2}};
  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
  ScanChunk first = chunk_of(0, 10'000);
  writer.begin_station({"S1", heads[0], scanner});
  writer.write(chunk_of(0, 7'200), 1);
  writer.write(chunk_of(7'200, 2'800), 1);
  writer.begin_station({"Gate <K1>", heads[1], scanner});
  writer.write(chunk_of(360, 500), 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.e57"));
  writer.close();
  EXPECT_EQ(test::entries(folder.path()), 1u);
  EXPECT_EQ(writer.points(), hits_of(first) + hits_of(chunk_of(360, 500)));

  const auto file = read_e57(content(folder / "a.e57"));
  EXPECT_EQ(file.texts.at("formatName"), "ASTM E57 3D Imaging Data File");
  EXPECT_EQ(file.texts.at("versionMajor"), "1");
  EXPECT_EQ(file.texts.count("coordinateMetadata"), 0u);
  EXPECT_EQ(file.texts.count("creationDateTime"), 0u);
  ASSERT_EQ(file.scans.size(), 2u);
  EXPECT_EQ(file.scans[0].order, (std::vector<std::string>{"cartesianX", "cartesianY", "cartesianZ", "rowIndex",
                                                           "columnIndex", "intensity", "colorRed", "colorGreen",
                                                           "colorBlue", "nor:normalX", "nor:normalY", "nor:normalZ"}));
  EXPECT_GT(file.scans[0].packets, 2u);
  expect_same_points(file.scans[0], first, scanner, 1e-5);
  expect_same_points(file.scans[1], chunk_of(360, 500), scanner, 1e-5);
  EXPECT_EQ(file.scans[0].texts.at("name"), "S1");
  EXPECT_EQ(file.scans[1].texts.at("name"), "Gate <K1>");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(file.scans[k].texts.at("sensorModel"), scanner.name);
    EXPECT_EQ(file.scans[k].number("pose/translation/x"), heads[k].x);
    EXPECT_EQ(file.scans[k].number("pose/translation/y"), heads[k].y);
    EXPECT_EQ(file.scans[k].number("pose/translation/z"), heads[k].z);
    EXPECT_NEAR(file.scans[k].number("pose/rotation/w"), std::cos(Angle::degrees(15).in_radians()), 1e-15);
    EXPECT_NEAR(file.scans[k].number("pose/rotation/z"), std::sin(Angle::degrees(15).in_radians()), 1e-15);
  }
  // The sweep's middle lies along the scanner's own x axis: a point straight ahead of the heading.
  EXPECT_NEAR(rotated(file.scans[0], {1, 0, 0}).x, std::cos(Angle::degrees(30).in_radians()), 1e-15);
  EXPECT_NEAR(rotated(file.scans[0], {1, 0, 0}).y, std::sin(Angle::degrees(30).in_radians()), 1e-15);
}

TEST(E57, PosesOfTurnedHeadsLeadBackToTheSurvey) {
  const test::TemporaryFolder folder;
  for (const double own : {0.0, 25.0}) {
    const Scanner scanner = scanner_of(1, own);
    const StationSetup setups[] = {{.tilt = Angle::degrees(90)},
                                   {.heading = Angle::degrees(110)},
                                   {.heading = Angle::degrees(-70), .tilt = Angle::degrees(33)}};
    PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
    for (const StationSetup& setup : setups) {
      writer.begin_station({"S", kSurveyOrigin, scanner, setup});
      writer.write(chunk_of(0, 500), 1);
    }
    writer.close();
    const auto file = read_e57(content(folder / "a.e57"));
    ASSERT_EQ(file.scans.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      expect_same_points(file.scans[k], chunk_of(0, 500), scanner, 1e-5);
      const auto rows = setups[k].survey_from_scanner();  // the axis does not feel the scanner's own heading
      EXPECT_NEAR(rotated(file.scans[k], {0, 0, 1}).x, rows[0].z, 1e-15);
      EXPECT_NEAR(rotated(file.scans[k], {0, 0, 1}).y, rows[1].z, 1e-15);
      EXPECT_NEAR(rotated(file.scans[k], {0, 0, 1}).z, rows[2].z, 1e-15);
    }
  }
}

// As stored, and so in the scanner's frame however that is turned.
TEST(E57, BoundsAreThoseOfThePoints) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
  writer.begin_station({"S1", kSurveyOrigin, scanner_of(1, 77)});
  writer.write(chunk_of(720, 4'000), 1);
  writer.begin_station({"S2", kSurveyOrigin + Vec3{4, 5, 6}, scanner_of(1, 77),
                        StationSetup{.heading = Angle::degrees(200), .tilt = Angle::degrees(64)}});
  writer.write(chunk_of(720, 4'000), 2);
  writer.close();
  for (const auto& scan : read_e57(content(folder / "a.e57")).scans) {
    const auto extremes = [&](const char* field) {
      const auto& values = scan.fields.at(field);
      return std::pair(*std::min_element(values.begin(), values.end()),
                       *std::max_element(values.begin(), values.end()));
    };
    for (const auto& [field, bound] : {std::pair{"cartesianX", "cartesianBounds/x"},
                                       {"cartesianY", "cartesianBounds/y"},
                                       {"cartesianZ", "cartesianBounds/z"},
                                       {"rowIndex", "indexBounds/row"},
                                       {"columnIndex", "indexBounds/column"}}) {
      EXPECT_EQ(scan.number(std::string(bound) + "Minimum"), extremes(field).first) << field;
      EXPECT_EQ(scan.number(std::string(bound) + "Maximum"), extremes(field).second) << field;
    }
    EXPECT_EQ(scan.number("intensityLimits/intensityMinimum"), 0);
    EXPECT_EQ(scan.number("intensityLimits/intensityMaximum"), 1);
    for (const char* colour : {"Red", "Green", "Blue"}) {
      EXPECT_EQ(scan.number("colorLimits/color" + std::string(colour) + "Minimum"), 0);
      EXPECT_EQ(scan.number("colorLimits/color" + std::string(colour) + "Maximum"), 255);
    }
  }
}

TEST(E57, HoldsJustWhatWasAskedFor) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, scan_position);
  writer.begin_station({"S1", kSurveyOrigin, scanner_of(1, 0)});
  writer.write(chunk_of(0, 3), 1);
  writer.close();
  const auto scan = read_e57(content(folder / "a.e57")).scans.at(0);
  EXPECT_EQ(scan.order,
            (std::vector<std::string>{"cartesianX", "cartesianY", "cartesianZ", "rowIndex", "columnIndex"}));
  EXPECT_EQ(scan.texts.count("intensityLimits/intensityMinimum"), 0u);
  EXPECT_EQ(scan.texts.count("colorLimits/colorRedMinimum"), 0u);
}

TEST(E57, IsDoubleWhereSinglesAreTooCoarse) {
  const test::TemporaryFolder folder;
  for (const auto& [range, tolerance] : {std::pair{256.0, 1e-5}, {1000.0, 1e-9}}) {
    const Scanner scanner = scanner_of(1, 123, range);
    PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
    writer.begin_station({"S1", kSurveyOrigin, scanner});
    writer.write(chunk_of(0, 100), 1);
    writer.close();
    expect_same_points(read_e57(content(folder / "a.e57")).scans.at(0), chunk_of(0, 100), scanner, tolerance);
  }
}

TEST(E57, HasRoomForEveryColumn) {
  const test::TemporaryFolder folder;
  const Scanner scanner = scanner_of(360.0 / 70'000, 0);
  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
  writer.begin_station({"S1", kSurveyOrigin, scanner});
  const ScanChunk chunk = chunk_of(69'990, 20);
  writer.write(chunk, 1);
  writer.close();
  expect_same_points(read_e57(content(folder / "a.e57")).scans.at(0), chunk, scanner, 1e-5);
}

TEST(E57, MayHoldNothing) {
  const test::TemporaryFolder folder;
  PointCloudWriter none(folder / "none.e57", kSurveyOrigin, kHeld);
  none.close();
  EXPECT_TRUE(read_e57(content(folder / "none.e57")).scans.empty());

  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
  const Scanner scanner = scanner_of(1, 0);
  ScanChunk misses = chunk_of(2, 1);
  for (const char* name : {"S1", "S2", "S3"}) {
    writer.begin_station({name, kSurveyOrigin, scanner});
    writer.write(name == std::string("S2") ? chunk_of(0, 2) : misses, 1);
  }
  writer.close();
  const auto file = read_e57(content(folder / "a.e57"));
  ASSERT_EQ(file.scans.size(), 3u);
  EXPECT_EQ(file.scans[0].records, 0u);
  EXPECT_EQ(file.scans[1].records, 2u);
  EXPECT_EQ(file.scans[2].records, 0u);
  EXPECT_EQ(file.scans[0].texts.count("cartesianBounds/xMinimum"), 0u);
  EXPECT_NE(file.scans[0].texts.at("guid"), file.scans[2].texts.at("guid"));
}

TEST(E57, EqualScansGiveEqualFilesAndOthersOtherGuids) {
  const test::TemporaryFolder folder;
  const auto written = [&](double heading, std::size_t rays) {
    PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
    writer.begin_station({"S1", kSurveyOrigin, scanner_of(1, heading)});
    writer.write(chunk_of(0, rays), 1);
    writer.close();
    return content(folder / "a.e57");
  };
  const std::string one = written(10, 999);
  EXPECT_EQ(written(10, 999), one);
  const std::regex form("\\{[0-9A-F]{8}-[0-9A-F]{4}-8[0-9A-F]{3}-[89AB][0-9A-F]{3}-[0-9A-F]{12}\\}");
  const auto first = read_e57(one), turned = read_e57(written(11, 999)), longer = read_e57(written(10, 1000));
  for (const auto* file : {&first, &turned, &longer}) {
    EXPECT_TRUE(std::regex_match(file->texts.at("guid"), form)) << file->texts.at("guid");
    EXPECT_TRUE(std::regex_match(file->scans[0].texts.at("guid"), form));
    EXPECT_NE(file->texts.at("guid"), file->scans[0].texts.at("guid"));
  }
  for (const auto* other : {&turned, &longer}) {
    EXPECT_NE(other->texts.at("guid"), first.texts.at("guid"));
    EXPECT_NE(other->scans[0].texts.at("guid"), first.scans[0].texts.at("guid"));
  }
}

TEST(E57, ChecksumsCoverEveryByte) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
  writer.begin_station({"S1", kSurveyOrigin, scanner_of(1, 0)});
  writer.write(chunk_of(0, 200), 1);
  writer.close();
  const std::string bytes = content(folder / "a.e57");
  ASSERT_GT(bytes.size(), 5 * 1024u);
  for (std::size_t at = 0; at < bytes.size(); at += 509) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    EXPECT_THROW(read_e57(damaged), std::runtime_error) << at;
  }
}

TEST(E57, IndexNamesPacketsEvenlyHoweverManyThereAre) {
  const test::TemporaryFolder folder;
  for (const std::size_t packets : {std::size_t{1}, std::size_t{4}, std::size_t{5}, std::size_t{8}, std::size_t{37}}) {
    // Writes sections alone: with the 2048 entries of real files the smallest cloud to thin takes 128 MiB.
    E57PagedFile file(folder / "a.e57");
    E57Points points(file, {8, 8, 8, 8, 8, 8, 8, 8}, 4);
    constexpr std::uint64_t a_packet = (65'536 - 22 - 3) / 64;
    for (std::uint64_t k = 0; k < (packets - 1) * a_packet + 1; ++k) {
      for (std::size_t field = 0; field < 8; ++field) points.put(field, static_cast<double>(k * 8 + field));
      points.next();
    }
    points.close();
    const std::uint64_t address = file.physical();
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root "
        "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\"><data3D><vectorChild><points type=\"CompressedVector\" "
        "fileOffset=\"" +
        std::to_string(points.section()) + "\" recordCount=\"" + std::to_string(points.records()) +
        "\"><prototype type=\"Structure\">";
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h"})
      xml += "<" + std::string(name) + " type=\"Float\"/>";
    xml += "</prototype></points></vectorChild></data3D></e57Root>";
    file.write(xml);
    std::string header = "ASTM-E57";
    append(header, std::uint32_t{1}), append(header, std::uint32_t{0});
    append(header, file.physical_length()), append(header, address);
    append(header, std::uint64_t{xml.size()}), append(header, std::uint64_t{1024});
    file.close(header);

    const auto scan = read_e57(content(folder / "a.e57")).scans.at(0);
    EXPECT_EQ(scan.packets, packets);
    ASSERT_FALSE(scan.index.empty());
    EXPECT_LE(scan.index.size(), 4u);
    EXPECT_GE(scan.index.size(), std::min<std::size_t>(packets, 2));
    for (std::size_t k = 0; k < scan.index.size(); ++k) {
      EXPECT_EQ(scan.index[k].first, scan.index[k].second);
      EXPECT_EQ(scan.index[k].first, k * (scan.index.size() > 1 ? scan.index[1].first : 0));
    }
    for (std::uint64_t k = 0; k < scan.records; ++k) ASSERT_EQ(scan.fields.at("h")[k], static_cast<double>(k * 8 + 7));
  }
}

TEST(E57, RefusesWhatItCannotHoldAndWrongUse) {
  const test::TemporaryFolder folder;
  for (const ScanOutput output : {scan_range, scan_ids, scan_voxel})
    EXPECT_THROW(PointCloudWriter(folder / "a.e57", {}, scan_position | output), Error);
  EXPECT_THROW(PointCloudWriter(folder.path() / "none" / "a.e57", {}, scan_position), Error);
  PointCloudWriter writer(folder / "a.e57", {}, scan_position);
  EXPECT_THROW(writer.write(chunk_of(0, 3), 1), Error);
  writer.close();
  EXPECT_THROW(writer.begin_station({"S1", {}, scanner_of(1, 0)}), Error);
}

TEST(E57, LeavesNothingWhereTheDiskIsFull) {
  const test::TemporaryFolder folder;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit little{1 << 20, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
  try {
    PointCloudWriter writer(folder / "a.e57", kSurveyOrigin, kHeld);
    writer.begin_station({"S1", kSurveyOrigin, scanner_of(1, 0)});
    for (std::uint64_t first = 0; first < 200'000; first += 10'000) writer.write(chunk_of(first, 10'000), 1);
    writer.close();
    ADD_FAILURE() << "wrote more than there is room for";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::io);
    EXPECT_NE(std::string(error.what()).find("a.e57"), std::string::npos);
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(test::entries(folder.path()), 0u);
}

}  // namespace
}  // namespace vantage
