// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "unit/report/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

std::vector<StationRow> read(const std::string& text) {
  const test::TemporaryFolder folder;
  write_text(folder / "s.csv", text);
  return read_stations_csv(folder / "s.csv");
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::malformed_file);
    return e.what();
  }
  return "not refused";
}

TEST(StationsCsv, ReadsBackToTheSameBits) {
  const test::TemporaryFolder folder;
  const std::vector<PlacedStation> stations{
      {.uv = {1.0 / 3, 2.0 / 7}, .position = {500'000.1, 4'500'000.0 / 3, 1e-300}, .status = StationStatus::ok},
      {.uv = {0.1 + 0.2, 5e-324}, .position = {}, .status = StationStatus::hole},
      {.uv = {1, 0}, .position = {-0.1, 1e20, 3}, .status = StationStatus::clash}};
  write_stations_csv(folder / "s.csv", stations);
  EXPECT_EQ(test::content(folder / "s.csv").substr(0, 29), "station,x,y,z,u,v,status\n1,50");
  const auto rows = read_stations_csv(folder / "s.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].position, stations[0].position);
  EXPECT_EQ(rows[0].uv, stations[0].uv);
  EXPECT_FALSE(rows[1].position);  // a hole is nowhere, not at the origin
  EXPECT_EQ(rows[1].uv, stations[1].uv);
  EXPECT_EQ(rows[2].position, stations[2].position);
}

TEST(StationsCsv, ReadsWhatOthersWrite) {
  const auto plain = read("x,y,z\n1,2,3\n-4.5e1,+6,7\n");
  ASSERT_EQ(plain.size(), 2u);
  EXPECT_EQ(plain[1].position, (Vec3{-45, 6, 7}));
  EXPECT_FALSE(plain[1].uv);
  // A spreadsheet's: byte order mark, carriage returns, capitals, spaces, quotes, another order, other columns, no last
  // newline.
  const auto sheet = read("\xEF\xBB\xBF\"Name\", V ,U\r\n# first\r\n\r\nA, 0.25, \"0.5\"\r\nB,1,0");
  ASSERT_EQ(sheet.size(), 2u);
  EXPECT_EQ(sheet[0].uv, (Uv{0.5, 0.25}));
  EXPECT_EQ(sheet[1].uv, (Uv{0, 1}));
  EXPECT_TRUE(read("x,y,z\n").empty());
}

TEST(StationsCsv, NamesTheLineThatIsWrong) {
  EXPECT_NE(refusal("x,y,z\n1,2,3\n1,2\n").find("s.csv:3: the line has 2 cells"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,two,3\n").find(":2: \"two\" is no number for y"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,2,nan\n").find("\"nan\""), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,2,inf\n").find("\"inf\""), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,2,3m\n").find("\"3m\""), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,,3\n").find("some are empty"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,u,v\n,,,,\n").find("neither"), std::string::npos);
  EXPECT_NE(refusal("x,y\n1,2\n").find(":1: the header must name x,y,z or u,v"), std::string::npos);
  EXPECT_NE(refusal("u,v,x\n1,2,3\n").find("the header"), std::string::npos);
  EXPECT_NE(refusal("x,x,y,z\n").find("twice"), std::string::npos);
  EXPECT_NE(refusal("").find("is empty"), std::string::npos);
  EXPECT_THROW(read_stations_csv("/nonexistent/stations.csv"), Error);
}

}  // namespace
}  // namespace vantage
