// SPDX-License-Identifier: Apache-2.0
#include "cloud_files.hpp"
#include "import/cloud/lzf.hpp"

namespace vantage::test {
namespace {

using PcdSourceTest = CloudTest;
using importer::open_pcd;

std::string header(const std::string& data, int points = 3) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z pair\n"
         "SIZE 4 8 4 1 4 4 4 2\nTYPE F F F U F F F I\nCOUNT 1 1 1 1 1 1 1 2\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         data + "\n";
}

struct Columns {
  std::string x, y, z, rgb, nx, ny, nz, pair;
};

Columns columns() {
  Columns c;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [x, y, z] : {std::tuple{1.5F, 2.0, -3.0F}, {nan, 0.0, 0.0F}, {4.0F, 5e5, 6.0F}}) {
    put(c.x, x), put(c.y, y), put(c.z, z), put(c.rgb, std::uint8_t{200});
    put(c.nx, 0.0F), put(c.ny, 1.0F), put(c.nz, 0.0F), put(c.pair, std::int16_t{-1}), put(c.pair, std::int16_t{7});
  }
  return c;
}

void check(const std::vector<ReadPoint>& points) {
  ASSERT_EQ(points.size(), 2u);  // the one that is not a number is left out
  expect_at(points[0], 1.5, 2, -3);
  expect_at(points[1], 4, 5e5, 6);
  EXPECT_EQ(points[0].normal, Eigen::Vector3f(0, 1, 0));
}

std::string binary_rows() {
  const Columns c = columns();
  std::string rows;
  for (std::size_t k = 0; k < 3; ++k) {
    rows += c.x.substr(4 * k, 4) + c.y.substr(8 * k, 8) + c.z.substr(4 * k, 4) + c.rgb.substr(k, 1);
    rows += c.nx.substr(4 * k, 4) + c.ny.substr(4 * k, 4) + c.nz.substr(4 * k, 4) + c.pair.substr(4 * k, 4);
  }
  return rows;
}

// As they are, in runs of at most 32 bytes.
std::string pack(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    out += static_cast<char>(run.size() - 1) + run;
  }
  return out;
}

std::string compressed(const std::string& bytes, const std::string& packed) {
  std::string out;
  put(out, static_cast<std::uint32_t>(packed.size())), put(out, static_cast<std::uint32_t>(bytes.size()));
  return out + packed;
}

TEST_F(PcdSourceTest, TextBinaryAndCompressed) {
  check(points_of(*open_pcd(
      write("a.pcd", header("ascii") + "1.5 2 -3 200 0 1 0 -1 7\nnan 0 0 200 0 1 0 -1 7\n4 5e5 6 200 0 1 0 -1 7\n"))));
  check(points_of(*open_pcd(write("b.pcd", header("binary") + binary_rows()))));
  const Columns c = columns();
  const std::string all = c.x + c.y + c.z + c.rgb + c.nx + c.ny + c.nz + c.pair;
  check(points_of(*open_pcd(write("c.pcd", header("binary_compressed") + compressed(all, pack(all))))));
}

TEST_F(PcdSourceTest, AViewpointMovesTheScan) {
  const std::string numbers = "1 2 3 200 0 1 0 -1 7\n";
  std::string with = header("ascii", 1) + numbers;
  const std::string none = "VIEWPOINT 0 0 0 1 0 0 0";
  const auto view = [&](const std::string& text) {
    std::string all = with;
    return open_pcd(write("a.pcd", all.replace(all.find(none), none.size(), "VIEWPOINT " + text)));
  };
  // A quarter turn around x: y goes to z. The quaternion need not be of length 1.
  const auto moved = view("10 20 30 2 2 0 0");
  const auto points = points_of(*moved);
  expect_at(points.at(0), 11, 17, 32);
  EXPECT_LT((points[0].normal - Eigen::Vector3f(0, 0, 1)).norm(), 1e-6F);
  EXPECT_TRUE(moved->scans().at(0).posed);
  EXPECT_EQ(moved->scans()[0].position, Eigen::Vector3d(10, 20, 30));
  const auto still = view("0 0 0 1 0 0 0");
  expect_at(points_of(*still).at(0), 1, 2, 3);
  EXPECT_FALSE(still->scans().at(0).posed);
  EXPECT_FALSE(view("0 0 0 -1 0 0 0")->scans().at(0).posed);
  expect_refused_for("seven numbers", [&] { view("0 0 0 1 0 0"); });
  expect_refused_for("quaternion", [&] { view("0 0 0 0 0 0 0"); });
}

// Drivers that fill PCL's list of points by hand write them so.
TEST_F(PcdSourceTest, PointsCountWithoutAWidth) {
  std::string content = header("binary") + binary_rows();
  content.replace(content.find("WIDTH 3\nHEIGHT 1"), 16, "WIDTH 0\nHEIGHT 0");
  check(points_of(*open_pcd(write("a.pcd", content))));
}

TEST_F(PcdSourceTest, LzfRepeats) {
  using namespace std::string_literals;
  EXPECT_EQ(importer::unpack_lzf("\2abc"s, 3), "abc");
  EXPECT_EQ(importer::unpack_lzf("\1ab\x20\1"s, 5), "ababa");                 // 3 bytes, from 2 before
  EXPECT_EQ(importer::unpack_lzf("\0a\xE0\3\0"s, 13), std::string(13, 'a'));  // 12 bytes, from 1 before
  for (const std::string& damaged : {"\2ab"s, "\0a\x20\5"s, "\0a\xE0"s, "\1ab"s, "\0a\xE0\xFF\0"s})
    EXPECT_THROW(importer::unpack_lzf(damaged, 3), importer::Refused);
}

TEST_F(PcdSourceTest, SaysWhatIsWrong) {
  const auto refused = [&](const std::string& content, const std::string& words) {
    expect_refused_for(words, [&] { points_of(*open_pcd(write("b.pcd", content))); });
  };
  refused(header("ascii") + "1 2 3 4 0 0 1 5 6\n", "truncated");
  refused(header("ascii", 1) + "1 2 three 4 0 0 1 5 6\n", "point 1 has no number");
  refused(header("binary") + binary_rows().substr(1), "truncated");
  refused(header("binary_compressed") + compressed(std::string(10, 'a'), pack(std::string(10, 'a'))), "truncated");
  refused(header("binary", 0), "no point");
  refused(header("zipped"), "no data that PCD knows");
  refused("# .PCD\nFIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n", "no z");
  refused("# .PCD\nFIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n", "a size, type and count");
  refused("# .PCD\nFIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n", "field z has no type");
}

}  // namespace
}  // namespace vantage::test
