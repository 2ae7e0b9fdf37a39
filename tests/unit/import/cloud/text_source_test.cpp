// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

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

// A text of points (k, 10 + k / 8, 20 - k / 4), with what a writer puts into each line.
template <class Line>
std::string text_of(Line&& line, int points = 40, const std::string& head = {}) {
  std::string text = head;
  for (int k = 0; k < points; ++k) text += line(k, k + 0.125, 10 + k / 8.0, 20 - k / 4.0) + "\n";
  return text;
}

std::string fixed_text(double value, char decimal = '.', int digits = 3) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  std::string out = text;
  if (const auto mark = out.find('.'); mark < out.size()) out[mark] = decimal;
  return out;
}

class TextColumnsTest : public CloudTest {
 protected:
  void expect_points(const std::string& text, const std::string& columns = {}) const {
    const auto source = open_text(write("a.txt", text), {.columns = columns});
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), 40u) << text.substr(0, 200);
    for (int k = 0; k < 40; ++k)
      expect_at(points[static_cast<std::size_t>(k)], k + 0.125, 10 + k / 8.0, 20 - k / 4.0, 1e-9);
  }
  void expect_question(const std::string& text, const std::string& words) const {
    expect_refused_for(words, [&] { open_text(write("a.txt", text)); });
    expect_refused_for("its first lines are \"", [&] { open_text(write("a.txt", text)); });
  }
};

TEST_F(TextColumnsTest, DecimalCommas) {
  for (const char* between : {";", "; ", " ", "\t", "   "})
    expect_points(text_of([&](int, double x, double y, double z) {
      return fixed_text(x, ',') + between + fixed_text(y, ',') + between + fixed_text(z, ',');
    }));
  expect_points(text_of([](int k, double x, double y, double z) {
    return fixed_text(x, ',', 4) + " " + fixed_text(y, ',', 4) + " " + fixed_text(z, ',', 4) + " " + std::to_string(k);
  }));
}

TEST_F(TextColumnsTest, Thousands) {
  const auto points = [&](const std::string& line) {
    const auto source = open_text(write("a.csv", line + "\n" + line + "\n"));
    return points_of(*source).at(1);
  };
  expect_at(points("512,345.250;5,401,234.500;312.125"), 512345.25, 5401234.5, 312.125);
  expect_at(points("512.345,250;5.401.234,500;312,125"), 512345.25, 5401234.5, 312.125);
  expect_at(points("512 345,250;5 401 234,500;312,125"), 512345.25, 5401234.5, 312.125);
  expect_at(points("512'345.250 5'401'234.500 -312.125"), 512345.25, 5401234.5, -312.125);
  expect_at(points("512,345.250 5,401,234.500 +1e2"), 512345.25, 5401234.5, 100);
}

TEST_F(TextColumnsTest, CommasThatAreNotClearAreAsked) {
  expect_question("1,234;5,678;9,012\n3,234;4,678;1,012\n", "before decimals or between thousands");
  expect_question("1,05,2,00,3,10\n11,15,12,07,3,10\n", "between its numbers or in them");
}

TEST_F(TextColumnsTest, Titles) {
  const auto shuffled = [](const char* between) {
    return [between](int k, double x, double y, double z) {
      return std::to_string(k) + between + fixed_text(z) + between + fixed_text(y) + between + fixed_text(x);
    };
  };
  for (const char* head : {"intensity;Height;North;East\n", "I;Z;Y;X\r\n", "# i; z; y; x\n",
                           "\"no\";\"H\";\"Hochwert\";\"Rechtswert\"\n", "\xEF\xBB\xBFid;z [m];y [m];x [m]\n",
                           "Made by hand with x, y and z in columns\nID;Points:2;Points:1;Points:0\n"})
    expect_points(text_of(shuffled(";"), 40, head));
  expect_points(text_of(shuffled(" "), 40, "//I Z Y X\n"));
  expect_points(text_of(shuffled(","), 40, "i,elevation,northing,easting\n"));
  expect_points(text_of(shuffled(";")), "-,z,y,x");
  // A unit that titles tell counts.
  const auto source = open_text(write("a.csv", "x_mm;y_mm;z_mm\n1000;2000;500\n1;2;3\n"));
  EXPECT_TRUE(source->metric());
  expect_at(points_of(*source).at(0), 1, 2, 0.5);
  EXPECT_FALSE(open_text(write("a.csv", "x;y;z\n1;2;3\n1;2;3\n"))->metric());
  expect_refused_for("degrees", [&] { open_text(write("a.csv", "lat,lon,height\n48.1,9.2,300\n48.2,9.2,300\n")); });
  expect_question("x;y;intensity\n1.5;2.5;3\n1.5;2.5;3\n", "height");
}

TEST_F(TextColumnsTest, NumbersNamesAndIntensitiesBeforePoints) {
  const auto point = [](double x, double y, double z) {
    return fixed_text(x) + " " + fixed_text(y) + " " + fixed_text(z);
  };
  expect_points(
      text_of([&](int k, double x, double y, double z) { return std::to_string(k + 7) + " " + point(x, y, z); }));
  expect_points(
      text_of([&](int k, double x, double y, double z) { return "P" + std::to_string(k) + " " + point(x, y, z); }));
  expect_points(text_of(
      [&](int k, double x, double y, double z) { return std::to_string(900 - 31 * k % 500) + " " + point(x, y, z); }));
  expect_points(text_of(
      [&](int k, double x, double y, double z) { return std::to_string(k % 7) + " 12 255 " + point(x, y, z); }));
  // Whole coordinates stay what they are.
  const auto whole = open_text(write("a.xyz", text_of([](int k, double, double, double) {
                                       return std::to_string(k % 9) + " " + std::to_string(k % 7) + " " +
                                              std::to_string(k % 5) + " 0.5";
                                     })));
  expect_at(points_of(*whole).at(8), 8, 1, 3);
}

TEST_F(TextColumnsTest, WhatIsNotClearIsAsked) {
  expect_question(text_of([](int k, double x, double y, double z) {
                    return fixed_text(k % 10 / 10.0) + " " + fixed_text(x) + " " + fixed_text(y) + " " + fixed_text(z);
                  }),
                  "could be an intensity");
  expect_question(text_of([](int, double x, double y, double z) {
                    return fixed_text(5.4e6 + y) + " " + fixed_text(512'000 + x) + " " + fixed_text(z);
                  }),
                  "could be northings");
  expect_question(text_of([](int, double x, double y, double z) {  // of Gauss-Krueger
                    return fixed_text(5.4e6 + y) + " " + fixed_text(3'512'000 + x) + " " + fixed_text(z);
                  }),
                  "could be northings");
  const auto told =
      open_text(write("a.xyz", text_of([](int, double x, double y, double z) {
                        return fixed_text(5.4e6 + y) + " " + fixed_text(512'000 + x) + " " + fixed_text(z);
                      })),
                {.columns = "y,x,z"});
  expect_at(points_of(*told).at(0), 512'000.125, 5'400'010, 20, 1e-6);
  expect_refused_for("does not name", [&] { open_text(write("a.xyz", "1 2 3\n4 5 6\n"), {.columns = "x,y"}); });
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

// Two scans of a room by a scanner that turns, with its place before a matrix that moves nothing.
// `grid`: columns are told.
std::string ptx_without_matrix(bool moved, const std::vector<Eigen::Vector3d>& heads, bool grid = true) {
  std::string text;
  for (const Eigen::Vector3d& head : heads) {
    constexpr int kColumns = 12, kRows = 9;
    const auto line = [&](std::initializer_list<double> values) {
      for (const double value : values) text += fixed_text(value, '.', 6) + " ";
      text += "\n";
    };
    text += std::to_string(grid ? kColumns : kColumns * kRows) + "\n" + std::to_string(grid ? kRows : 1) + "\n";
    line({head.x(), head.y(), head.z()});
    line({0, 1, 0}), line({-1, 0, 0}), line({0, 0, 1});  // x of the scanner points north
    line({1, 0, 0, 0}), line({0, 1, 0, 0}), line({0, 0, 1, 0}), line({0, 0, 0, 1});
    for (int c = 0; c < kColumns; ++c)
      for (int r = 0; r < kRows; ++r) {
        const double a = 0.5 * c, e = 0.25 * r - 1, range = 3 + 0.1 * ((c + r) % 4);
        const Eigen::Vector3d p(range * std::cos(a) * std::cos(e), range * std::sin(a) * std::cos(e),
                                range * std::sin(e));
        const Eigen::Vector3d q = moved ? Eigen::Vector3d(head + Eigen::Vector3d(-p.y(), p.x(), p.z())) : p;
        line({q.x(), q.y(), q.z(), 0.5});
      }
  }
  return text;
}

TEST_F(TextSourceTest, PtxMayTellItsPlaceBeforeTheMatrixAlone) {
  using Heads = std::vector<Eigen::Vector3d>;
  for (const Heads& heads :
       {Heads{{10, 20, 2}, {14, 21, 2}}, Heads{{500'010, 5'400'020, 302}, {500'014, 5'400'021, 302}},
        Heads{{2'600'004, 1'200'003, 500}, {2'600'000, 1'200'003, 500}}})
    for (const bool grid : {true, false}) {
      const auto as_scanned = open_text(write("a.ptx", ptx_without_matrix(false, heads, grid))),
                 as_moved = open_text(write("b.ptx", ptx_without_matrix(true, heads, grid)));
      const auto a = points_of(*as_scanned), b = points_of(*as_moved);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_LT((a[k].position - b[k].position).norm(), 1e-4) << k;
        EXPECT_LT((a[k].position - heads[a[k].scan]).norm(), 4) << k;
      }
      for (const auto& source : {as_scanned.get(), as_moved.get()}) {
        EXPECT_EQ(source->scans().at(1).position, heads[1]);
        EXPECT_EQ(source->notes().size(), 1u);
      }
      EXPECT_EQ(points_of(*as_scanned).size(), a.size());
    }
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
