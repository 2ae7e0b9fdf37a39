// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"

namespace vantage {
namespace {

using test::content;
using test::take;

const Vec3 kOrigin{500'123.25, 4'500'321.5, 101.75};

// Three rays: a hit, a miss, a hit.
ScanChunk chunk_of(std::uint32_t outputs) {
  constexpr float nowhere = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  ScanChunk c;
  c.first_ray = 10, c.ray_count = 3;
  if (outputs & scan_position)
    c.position = {{1.5f, -2.25f, 0.125f}, {nowhere, nowhere, nowhere}, {-40.0f, 30.0f, 2.0f}};
  if (outputs & scan_range) c.range_m = {2.5f, far, 50.0f};
  if (outputs & scan_normal) c.normal = {{0, 0, 1}, {0, 0, 0}, {-1, 0, 0}};
  if (outputs & scan_reflectivity) c.reflectivity = {0.25f, 0, 1};
  if (outputs & scan_ids) c.mesh = {3, -1, 5}, c.primitive = {77, 0xFFFFFFFFu, 88};
  if (outputs & scan_colour) c.colour = {0xFF030201u, 0, 0xFF80C0FFu};
  if (outputs & scan_voxel) c.voxel = {9, 0xFFFFFFFFu, 0xFFFFFFFFu};
  return c;
}

constexpr std::uint32_t kOfLas = scan_position | scan_reflectivity | scan_colour;
constexpr std::uint32_t kAll =
    scan_range | scan_position | scan_normal | scan_reflectivity | scan_ids | scan_colour | scan_voxel;

TEST(PointCloudWriter, PlyHoldsJustWhatWasAskedFor) {
  const test::TemporaryFolder folder;
  for (const auto& [outputs, record] :
       {std::pair<std::uint32_t, std::size_t>{scan_position, 14}, {kAll, 14 + 12 + 3 + 4 + 4 + 8 + 4}}) {
    PointCloudWriter writer(folder / "a.ply", kOrigin, outputs);
    writer.write(chunk_of(outputs), 2);
    writer.write(chunk_of(outputs), 7);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
    writer.close();
    EXPECT_EQ(writer.points(), 4u);
    const std::string bytes = content(folder / "a.ply");
    const std::size_t end = bytes.find("end_header\n");
    ASSERT_NE(end, std::string::npos);
    EXPECT_NE(bytes.substr(0, end).find("\nelement vertex 4\n"), std::string::npos);
    EXPECT_EQ(bytes.size() - end - 11, 4 * record);
    std::filesystem::remove(folder / "a.ply");
  }
}

// Viewers read floats, which hold no national coordinates: those are about an origin of whole kilometres.
TEST(PointCloudWriter, PlyIsAboutAnOriginThatItTells) {
  const test::TemporaryFolder folder;
  for (const auto& [site, told] : {std::pair{kOrigin, "500000 4500000 0"},
                                   {{-412'678.9, 1'499.5, 1'712.4}, "-413000 1000 2000"},
                                   {{499.75, -499.75, 3}, "0 0 0"}}) {
    PointCloudWriter writer(folder / "a.ply", site, scan_position);
    writer.write(chunk_of(scan_position), 7);
    writer.close();
    const std::string bytes = content(folder / "a.ply");
    std::size_t at = bytes.find("end_header\n") + 11;
    const std::string header = bytes.substr(0, at);
    EXPECT_NE(header.find(std::string("\ncomment origin ") + told + "\n"), std::string::npos) << header;
    EXPECT_NE(header.find("\nproperty float x\nproperty float y\nproperty float z\n"), std::string::npos) << header;
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(told, "%lf %lf %lf", &x, &y, &z), 3);
    EXPECT_NEAR(x + double{take<float>(bytes, at)}, site.x + 1.5, 3.1e-5);
    EXPECT_NEAR(y + double{take<float>(bytes, at)}, site.y - 2.25, 3.1e-5);
    EXPECT_NEAR(z + double{take<float>(bytes, at)}, site.z + 0.125, 3.1e-5);
    std::filesystem::remove(folder / "a.ply");
  }
}

TEST(PointCloudWriter, PlyOfDoublesReadsBack) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.ply", kOrigin, kAll, {}, PlyCoordinates::doubles);
  writer.write(chunk_of(kAll), 7);
  writer.close();
  const std::string bytes = content(folder / "a.ply");
  const std::size_t end = bytes.find("end_header\n");
  EXPECT_EQ(bytes.substr(0, end).find("origin"), std::string::npos);
  std::string names;
  for (std::size_t at = bytes.find("property "); at < end; at = bytes.find("property ", at + 1))
    names += bytes.substr(at + 9, bytes.find('\n', at) - at - 9) + ",";
  EXPECT_EQ(names,
            "double x,double y,double z,float nx,float ny,float nz,uchar red,uchar green,uchar blue,float "
            "reflectivity,float range,"
            "int mesh,uint primitive,uint voxel,ushort station,");
  std::size_t at = end + 11;
  EXPECT_EQ(take<double>(bytes, at), 500'124.75);  // exact: a float would be off by 16 mm
  EXPECT_EQ(take<double>(bytes, at), 4'500'319.25);
  EXPECT_EQ(take<double>(bytes, at), 101.875);
  at += 8;
  EXPECT_EQ(take<float>(bytes, at), 1.0f);
  EXPECT_EQ(take<std::uint8_t>(bytes, at), 1);
  EXPECT_EQ(take<std::uint8_t>(bytes, at), 2);
  EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
  EXPECT_EQ(take<float>(bytes, at), 0.25f);
  EXPECT_EQ(take<float>(bytes, at), 2.5f);
  EXPECT_EQ(take<std::int32_t>(bytes, at), 3);
  EXPECT_EQ(take<std::uint32_t>(bytes, at), 77u);
  EXPECT_EQ(take<std::uint32_t>(bytes, at), 9u);
  EXPECT_EQ(take<std::uint16_t>(bytes, at), 7);
  EXPECT_EQ(take<double>(bytes, at), 500'083.25);
}

TEST(PointCloudWriter, LasIsFormat7Of14) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.las", kOrigin, kOfLas);
  writer.write(chunk_of(kOfLas), 7);
  writer.close();
  const std::string bytes = content(folder / "a.las");
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  const auto get = [&](auto value, std::size_t at) { return take<decltype(value)>(bytes, at); };
  EXPECT_EQ(get(std::uint16_t{}, 6), 16);  // formats from 6 on have a system as text: here a local one
  const std::size_t points = 375 + 54 + get(std::uint16_t{}, 375 + 20);
  ASSERT_EQ(bytes.size(), points + 2 * 36);
  EXPECT_EQ(bytes.substr(375 + 54, 24), "LOCAL_CS[\"survey frame\",");
  EXPECT_EQ(get(std::uint8_t{}, 24), 1);
  EXPECT_EQ(get(std::uint8_t{}, 25), 4);
  EXPECT_EQ(get(std::uint16_t{}, 94), 375);  // header size
  EXPECT_EQ(get(std::uint32_t{}, 96), points);
  EXPECT_EQ(get(std::uint32_t{}, 100), 1u);  // variable length records
  EXPECT_EQ(get(std::uint8_t{}, 104), 7);
  EXPECT_EQ(get(std::uint16_t{}, 105), 36);
  EXPECT_EQ(get(std::uint32_t{}, 107), 0u);  // legacy count
  EXPECT_EQ(get(double{}, 131), 1e-4);
  const double offset_x = get(double{}, 155), offset_y = get(double{}, 163), offset_z = get(double{}, 171);
  EXPECT_EQ(offset_x, 500'123.0);
  EXPECT_NEAR(get(double{}, 179), 500'124.75, 1e-9);  // max x
  EXPECT_NEAR(get(double{}, 187), 500'083.25, 1e-9);  // min x
  EXPECT_NEAR(get(double{}, 195), 4'500'351.5, 1e-9);
  EXPECT_NEAR(get(double{}, 219), 101.875, 1e-9);  // min z
  EXPECT_EQ(get(std::uint64_t{}, 247), 2u);
  EXPECT_EQ(get(std::uint64_t{}, 255), 2u);
  EXPECT_NEAR(get(std::int32_t{}, points) * 1e-4 + offset_x, 500'124.75, 5.1e-5);
  EXPECT_NEAR(get(std::int32_t{}, points + 4) * 1e-4 + offset_y, 4'500'319.25, 5.1e-5);
  EXPECT_NEAR(get(std::int32_t{}, points + 8) * 1e-4 + offset_z, 101.875, 5.1e-5);
  EXPECT_EQ(get(std::uint16_t{}, points + 12), 16384);  // intensity .25
  EXPECT_EQ(get(std::uint8_t{}, points + 14), 0x11);
  EXPECT_EQ(get(std::uint16_t{}, points + 20), 7);  // point source id
  EXPECT_EQ(get(std::uint16_t{}, points + 30), 257);
  EXPECT_EQ(get(std::uint16_t{}, points + 36 + 30), 65535);
}

TEST(PointCloudWriter, LasWithoutPointsIsValid) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.las", {}, scan_position);
  writer.close();
  const std::string bytes = content(folder / "a.las");
  std::size_t at = 96;
  ASSERT_EQ(bytes.size(), take<std::uint32_t>(bytes, at));
  at = 179;
  EXPECT_EQ(take<double>(bytes, at), 0);
}

TEST(PointCloudWriter, LasRefusesWhatItCannotHold) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.las", {}, scan_position);
  ScanChunk far;
  far.ray_count = 1;
  far.position = {{300'000.0f, 0, 0}};
  EXPECT_THROW(writer.write(far, 0), Error);
}

TEST(PointCloudWriter, LasCarriesItsCoordinateSystem) {
  const test::TemporaryFolder folder;
  const std::string crs = coordinate_system("EPSG:25832");
  PointCloudWriter writer(folder / "a.las", kOrigin, scan_position, crs);
  writer.write(chunk_of(scan_position), 1);
  writer.close();
  const std::string bytes = content(folder / "a.las");
  const auto get = [&](auto value, std::size_t at) { return take<decltype(value)>(bytes, at); };
  EXPECT_EQ(get(std::uint16_t{}, 6), 16);  // the WKT bit
  EXPECT_EQ(get(std::uint32_t{}, 100), 1u);
  EXPECT_EQ(bytes.substr(375 + 2, 16), std::string("LASF_Projection") + '\0');
  EXPECT_EQ(get(std::uint16_t{}, 375 + 18), 2112);
  const std::size_t length = get(std::uint16_t{}, 375 + 20);
  EXPECT_EQ(bytes.substr(375 + 54, length), crs + '\0');
  const std::size_t points = get(std::uint32_t{}, 96);
  EXPECT_EQ(points, 375 + 54 + length);
  ASSERT_EQ(bytes.size(), points + 2 * 36);
  EXPECT_NEAR(get(std::int32_t{}, points) * 1e-4 + get(double{}, 155), 500'124.75, 5.1e-5);
}

TEST(PointCloudWriter, LasRefusesOutputsThatItHasNoPlaceFor) {
  const test::TemporaryFolder folder;
  try {
    PointCloudWriter writer(folder / "a.las", kOrigin, scan_position | scan_normal | scan_colour | scan_range);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("but no range, normal"), std::string::npos) << error.what();
  }
  EXPECT_EQ(test::entries(folder.path()), 0u);
}

TEST(PointCloudWriter, LasAndE57AlwaysHaveAnIntensity) {
  EXPECT_EQ(point_cloud_outputs("a.las", scan_position), scan_position | scan_reflectivity);
  EXPECT_EQ(point_cloud_outputs("a.e57", scan_position | scan_colour), scan_position | scan_reflectivity | scan_colour);
  EXPECT_EQ(point_cloud_outputs("a.ply", scan_position), scan_position);
}

TEST(PointCloudWriter, PlySaysItsCoordinateSystemInAComment) {
  const test::TemporaryFolder folder;
  PointCloudWriter writer(folder / "a.ply", {}, scan_position, coordinate_system("EPSG:32719"));
  writer.write(chunk_of(scan_position), 1);
  writer.close();
  EXPECT_NE(content(folder / "a.ply").find("\ncomment crs PROJCS[\"WGS 84 / UTM zone 19S\","), std::string::npos);
}

TEST(PointCloudWriter, LeavesNothingUnlessClosed) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.las", "a.e57"}) {
    PointCloudWriter writer(folder / name, kOrigin, scan_position);
    writer.begin_station({"S1", kOrigin, Scanner{}});
    writer.write(chunk_of(scan_position), 0);
  }
  EXPECT_EQ(test::entries(folder.path()), 0u);
}

TEST(PointCloudWriter, TellsHitsByWhatThereIs) {
  const test::TemporaryFolder folder;
  for (const std::uint32_t outputs :
       {std::uint32_t{scan_position}, scan_position | scan_range, scan_position | scan_ids}) {
    PointCloudWriter writer(folder / "a.ply", {}, outputs);
    ScanChunk chunk = chunk_of(outputs);
    if (outputs != scan_position) chunk.position[1] = {0, 0, 0};  // a miss need not say so in its position
    writer.write(chunk, 0);
    EXPECT_EQ(writer.points(), 2u) << outputs;
  }
}

TEST(PointCloudWriter, RefusesWrongUse) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(PointCloudWriter(folder / "a.xyz", {}, scan_position), Error);
  EXPECT_THROW(PointCloudWriter(folder / "a.ply", {}, scan_range), Error);
  EXPECT_THROW(PointCloudWriter(folder.path() / "none" / "a.ply", {}, scan_position), Error);
  PointCloudWriter writer(folder / "a.ply", {}, scan_position | scan_normal);
  EXPECT_THROW(writer.write(chunk_of(scan_position), 0), Error);
  writer.close();
  EXPECT_THROW(writer.write(chunk_of(scan_position | scan_normal), 0), Error);
}

// An evaluation predicts the size of the files, for scanners of short and of long range.
TEST(PointCloudWriter, FilesAreAsLargeAsAnEvaluationTells) {
  const test::TemporaryFolder folder;
  for (const double range_m : {130.0, 800.0}) {
    Scanner scanner = test::coarse_scanner(0.25);
    scanner.max_range_m = range_m;
    Simulator simulator(test::wall_and_floor().scene(), scanner,
                        {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1});
    const std::vector<PlacedStation> stations{{.position = {1, 1, 0.5}}, {.position = {2, 0, 1.5}}};
    const Evaluation found = evaluate_stations({.simulator = simulator}, stations, {.skip = false});
    ASSERT_TRUE(found.data);
    for (const auto& [name, bytes] : {std::pair{"a.e57", found.data->e57_bytes}, {"a.las", found.data->las_bytes}}) {
      const std::uint32_t outputs = scan_position | scan_reflectivity;
      PointCloudWriter writer(folder / name, simulator.origin(), outputs);
      std::uint16_t station = 0;
      for (const PlacedStation& one : stations) {
        writer.begin_station({.name = "S", .head = one.position, .scanner = scanner});
        ++station;
        simulator.scan(to_network({&one, 1}).front(), {.outputs = outputs},
                       [&](const ScanChunk& chunk) { writer.write(chunk, station); });
      }
      writer.close();
      EXPECT_EQ(static_cast<double>(writer.points()), found.data->points);
      EXPECT_NEAR(static_cast<double>(std::filesystem::file_size(folder / name)) / bytes, 1, 0.005) << name;
      std::filesystem::remove(folder / name);
    }
  }
}

}  // namespace
}  // namespace vantage
