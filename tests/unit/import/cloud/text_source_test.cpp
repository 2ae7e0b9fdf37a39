// SPDX-License-Identifier: Apache-2.0
#include "cloud_files.hpp"

namespace vantage::test {
namespace {

using TextSourceTest = CloudTest;
using importer::open_text;

TEST_F(TextSourceTest, XyzWithTitlesCountsAndAnySeparator) {
  for (const char* content :
       {"1 2 3\n4 5 6\n", "//X Y Z R G B\n1.0\t2.0\t3.0\t255 0 0\r\n4 5 6 1 2 3\r\n", "x,y,z\n1,2,3\n4,5,6",
        "2\n1 2 3 -1200 10 20 30\n4 5 6 -1200 1 2 3\n", "# made by hand\n\n1; 2; 3\n\n+4; 5.0e0; 6\n"}) {
    const auto source = open_text(write("a.xyz", content));
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), 2u) << content;
    expect_at(points[0], 1, 2, 3);
    expect_at(points[1], 4, 5, 6);
    EXPECT_EQ(points_of(*source).size(), 2u);
  }
}

constexpr const char* kPtx =
    "2\n1\n100 200 10\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n100 200 10 1\n1 2 3 0.5\n0 0 0 0.5\n"
    "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n1 1 1 0.5 10 20 30\n";

TEST_F(TextSourceTest, PtxPlacesEachScan) {
  const auto source = open_text(write("a.ptx", kPtx));
  const auto points = points_of(*source);
  ASSERT_EQ(points.size(), 2u);       // the one without a return is left out
  expect_at(points[0], 98, 201, 13);  // x goes to y
  expect_at(points[1], 6, 7, 8);
  EXPECT_EQ(points[1].scan, 1u);
  ASSERT_EQ(source->scans().size(), 2u);
  EXPECT_TRUE(source->scans()[0].posed);
  EXPECT_EQ(source->scans()[0].position, Eigen::Vector3d(100, 200, 10));
}

TEST_F(TextSourceTest, SaysWhatIsWrongAndWhere) {
  const std::string sound = kPtx;
  const auto refused = [&](const std::string& content, const std::string& words) {
    expect_refused_for(words, [&] { points_of(*open_text(write("b.ptx", content))); });
  };
  refused(sound.substr(0, sound.find("1 2 3 0.5")), "line 11 is missing");
  refused("2\n1\n100 200 10\n0 1\n", "line 4 has not three numbers");
  refused("2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0\n", "line 7 has not four numbers");
  std::string prose;
  for (int k = 0; k < 200; ++k) prose += "a line of prose\n";
  refused(prose, "no points");
  refused("1 2 3\n" + std::string(100'000, '1'), "longer than");
}

}  // namespace
}  // namespace vantage::test
