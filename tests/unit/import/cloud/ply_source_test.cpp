// SPDX-License-Identifier: Apache-2.0
#include "cloud_files.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using PlySourceTest = CloudTest;
using importer::open_ply;

TEST_F(PlySourceTest, TextAndBothOrdersOfBytes) {
  const std::string properties =
      "comment by hand\nelement camera 1\nproperty uchar a\nproperty double b\nelement vertex 2\nproperty float x\n"
      "property short y\nproperty uchar red\nproperty double z\nproperty float nx\nproperty float ny\nproperty float "
      "nz\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  const auto check = [&](const std::string& content) {
    const auto points = points_of(*open_ply(write("a.ply", content)));
    ASSERT_EQ(points.size(), 2u);
    expect_at(points[0], 1.5, -2, 0.25);
    expect_at(points[1], 3, 4, 1e6);
    EXPECT_EQ(points[1].normal, Eigen::Vector3f(0, 0, 1));
  };
  check("ply\r\nformat ascii 1.0\n" + properties + "7 8\n1.5 -2 255 0.25 1 0 0\n+3 4 0 1e6 0 0 1\n");
  for (const bool big : {false, true}) {
    std::string body(9, 'c');
    const auto point = [&](float x, std::int16_t y, double z, float nx, float nz) {
      put(body, x, big), put(body, y, big), put(body, std::uint8_t{9}), put(body, z, big);
      put(body, nx, big), put(body, 0.0F, big), put(body, nz, big);
    };
    point(1.5F, -2, 0.25, 1, 0), point(3, 4, 1e6, 0, 1);
    check(std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + properties + body);
  }
}

TEST_F(PlySourceTest, NamesMayBeCapitals) {
  const auto points = points_of(
      *open_ply(write("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float X\nproperty float Y\nproperty float Z\n"
                      "property float NX\nproperty float NY\nproperty float NZ\nend_header\n1.5 -2 0.25 0 0 1\n")));
  ASSERT_EQ(points.size(), 1u);
  expect_at(points[0], 1.5, -2, 0.25);
  EXPECT_EQ(points[0].normal, Eigen::Vector3f(0, 0, 1));
}

TEST_F(PlySourceTest, ReadsWhatVantageWrites) {
  const auto file = folder_.path() / "own.ply";
  const Vec3 site{412'345.678, 5'698'765.432, 1'712.3};
  for (const PlyCoordinates coordinates : {PlyCoordinates::floats, PlyCoordinates::doubles}) {
    PointCloudWriter writer(file, site, scan_position | scan_normal, "PROJCS[\"a b\"]", coordinates);
    ScanChunk chunk;
    chunk.ray_count = 1;
    chunk.position = {{31.4567F, -2, 3}};
    chunk.normal = {{0, 1, 0}};
    writer.write(chunk, 1);
    writer.close();
    const auto source = open_ply(file);
    EXPECT_TRUE(source->metric());
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), 1u);
    // Half a step of a float of less than a kilometre.
    const double within = coordinates == PlyCoordinates::floats ? 3.1e-5 : 1e-9;
    EXPECT_NEAR(points[0].position.x(), site.x + double{31.4567F}, within);
    EXPECT_NEAR(points[0].position.y(), site.y - 2, within);
    EXPECT_NEAR(points[0].position.z(), site.z + 3, within);
    EXPECT_EQ(points[0].normal, Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(source->crs(), "PROJCS[\"a b\"]");
  }
}

// Another program's comment may begin with the same word.
TEST_F(PlySourceTest, OnlyItsOwnCommentMovesPoints) {
  const std::string rest =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
  const std::string head = "ply\nformat ascii 1.0\n";
  const auto read = [&](const std::string& comments) {
    return points_of(*open_ply(write("a.ply", head + comments + rest))).at(0);
  };
  expect_at(read("comment origin 1000 2000 0\n"), 1, 2, 3);
  expect_at(read("comment vantage 1.0.0 ...\ncomment origin 1000 -2000 0\n"), 1001, -1998, 3);
}

TEST_F(PlySourceTest, PointsThatAreNotFiniteAreLeftOut) {
  const auto file = write("a.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                          "z\nend_header\nnan 0 0\n1 2 3\n0 inf 0\n");
  EXPECT_EQ(points_of(*open_ply(file)).size(), 1u);
}

TEST_F(PlySourceTest, SaysWhatIsWrong) {
  const auto refused = [&](const std::string& rest, const std::string& words) {
    expect_refused_for(words, [&] { points_of(*open_ply(write("b.ply", "ply\n" + rest))); });
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  refused("format ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n1 2 3\n", "ends after 1 of 2 points");
  refused("format ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n1 two 3\n", "point 1 has no number");
  refused("format binary_little_endian 1.0\nelement vertex 2\n" + xyz + "end_header\n123456789012", "truncated");
  refused("format ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "no y");
  refused("format ascii 1.0\nelement vertex many\n" + xyz + "end_header\n", "\"many\"");
  refused("format ascii 1.0\nelement vertex 1\nproperty list uchar int k\n" + xyz + "end_header\n", "lists");
  refused("format ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n", "no type");
  refused("format vax 1.0\n", "no format that PLY knows");
  refused("element vertex 1\n" + xyz + "end_header\n1 2 3\n", "names no format");
  refused("format ascii 1.0\nelement vertex 1\n", "does not end");
  refused("format ascii 1.0\nelement face 1\nend_header\n", "no vertices");
  for (const char* origin : {"1000 2000", "1000 east 0", "nan 0 0"})
    refused("format ascii 1.0\ncomment vantage 1.0.0\ncomment origin " + std::string(origin) + "\n", "no place");
  refused("comment " + std::string(100'000, 'a'), "longer than");
}

}  // namespace
}  // namespace vantage::test
