// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

std::vector<StationRow> read(const std::string& text) {
  const test::TemporaryFolder folder;
  write_text(folder / "s.csv", text);
  return read_stations_csv(folder / "s.csv");
}

std::string why_refused(const std::string& text) {
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
      {.uv = {1.0 / 3, 2.0 / 7},
       .position = {500'000.1, 4'500'000.0 / 3, 1e-300},
       .ground = {500'000.1, 4'500'000.0 / 3, -1.0 / 3}},
      {.uv = {0.1 + 0.2, 5e-324}, .position = {}, .status = StationStatus::hole},
      {.uv = {1, 0}, .position = {-0.1, 1e20, 3}, .status = StationStatus::clash, .existing = true}};
  write_stations_csv(folder / "s.csv", stations);
  EXPECT_EQ(test::content(folder / "s.csv").substr(0, 62),
            "station,name,x,y,z,ground_z,u,v,status,existing\n1,S1,500000.1,");
  const auto rows = read_stations_csv(folder / "s.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].position, stations[0].position);
  EXPECT_EQ(rows[0].uv, stations[0].uv);
  EXPECT_FALSE(rows[1].position);  // a hole is nowhere, not at the origin
  EXPECT_EQ(rows[1].uv, stations[1].uv);
  EXPECT_EQ(rows[2].position, stations[2].position);
  EXPECT_EQ(rows[0].ground, stations[0].ground);
  EXPECT_EQ(rows[1].name, "S2");
  EXPECT_EQ(rows[2].name, "K1");
}

TEST(StationsCsv, TellsHowStationsAreSetUpWhereItMatters) {
  const test::TemporaryFolder folder;
  std::vector<Scanner> scanners(2);
  scanners[1] = load_scanner("rtc360@3mm");
  std::vector<PlacedStation> stations(3);
  for (PlacedStation& s : stations) s.position = {1, 2, 3};
  stations[0].setup = {.heading = Angle::degrees(30), .tilt = Angle::degrees(90)};
  stations[1].setup.scanner = 1;
  write_stations_csv(folder / "s.csv", stations, scanners);
  const std::string text = test::content(folder / "s.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "station,name,x,y,z,ground_z,u,v,status,existing,heading,tilt,scanner,step");
  const auto rows = read_stations_csv(folder / "s.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].setup.heading.in_degrees(), 30, 1e-12);
  EXPECT_NEAR(rows[0].setup.tilt.in_degrees(), 90, 1e-12);
  EXPECT_EQ(rows[0].scanner, "custom");
  EXPECT_EQ(rows[1].scanner, scanners[1].name);
  EXPECT_EQ(load_scanner(rows[1].scanner).azimuth_step, scanners[1].azimuth_step);
  ASSERT_TRUE(rows[1].step);
  EXPECT_NEAR(rows[1].step->in_degrees(), scanners[1].azimuth_step.in_degrees(), 1e-12);
  EXPECT_EQ(rows[2].setup, StationSetup());
}

TEST(StationsCsv, ReadsHeadingTiltScannerAndStep) {
  const auto rows = read("x;y;z;Heading [deg];tilt (°);scanner;step\n1;2;3;30,5;-90;rtc360;0,2\n1;2;3;;;;\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].setup.heading, Angle::degrees(30.5));
  EXPECT_EQ(rows[0].setup.tilt, Angle::degrees(-90));
  EXPECT_EQ(rows[0].scanner, "rtc360");
  EXPECT_EQ(rows[0].step, Angle::degrees(0.2));
  EXPECT_EQ(rows[1].setup, StationSetup());
  EXPECT_EQ(rows[1].scanner, "");
  EXPECT_FALSE(rows[1].step);
  EXPECT_NE(why_refused("x,y,z,tilt [rad]\n1,2,3,1\n").find("vantage takes degrees"), std::string::npos);
  EXPECT_NE(why_refused("x,y,z,tilt,tilt\n1,2,3,1,1\n").find("both may be the tilt"), std::string::npos);
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

TEST(StationsCsv, ReadsSurveyorsColumns) {
  const Vec3 head{500'123.5, 4'500'321.25, 101.75};
  for (const char* text :
       {"Easting,Northing,Height\n500123.5,4500321.25,101.75\n",
        "Name;Easting [m];Northing [m];Height [m]\r\nP1;500123,5;4500321,25;101,75\r\n",
        "\xEF\xBB\xBFN\tE\tZ\n4500321.25\t500123.5\t101.75\n", "point x y z\nP1   500123.5 4500321.25  101.75\n",
        "\"Easting\";\"Northing\";\"head z\"\n\"500123,5\";\"4500321,25\";\"101,75\"\n"}) {
    SCOPED_TRACE(text);
    const auto rows = read(text);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].position, head);
    EXPECT_FALSE(rows[0].ground);
    EXPECT_FALSE(rows[0].xy);
  }
  const auto named = read("Name;E;N;ground_z\nS1;1,5;-2,25;0\n\"Tür; links\";3;4;0,125\n");
  ASSERT_EQ(named.size(), 2u);
  EXPECT_EQ(named[0].ground, (Vec3{1.5, -2.25, 0}));
  EXPECT_FALSE(named[0].position);
  EXPECT_EQ(named[0].name, "S1");
  EXPECT_EQ(named[1].name, "Tür; links");
  EXPECT_EQ(named[1].ground, (Vec3{3, 4, 0.125}));
  const auto both = read("x,y,z,ground_z\n1,2,3,1.15\n");
  EXPECT_EQ(both[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(both[0].ground, (Vec3{1, 2, 1.15}));
  const auto flat = read("x,y\n1,2\n");
  ASSERT_TRUE(flat[0].xy);
  EXPECT_EQ(*flat[0].xy, (std::array<double, 2>{1, 2}));
}

TEST(StationsCsv, RefusesWhatCanBeReadInTwoWays) {
  EXPECT_NE(why_refused("x,Easting,y,z\n").find(":1: \"x\" and \"Easting\" both may be the easting"),
            std::string::npos);
  EXPECT_NE(why_refused("E,N,Z,Height\n")
                .find("\"Z\" and \"Height\" both may be the height of the scanner's head: call "
                      "it head_z, and that of the ground ground_z"),
            std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,5,2,5,3,0\n")
                .find(":2: the line has 6 cells, the header 3; numbers with decimal commas "
                      "need ; between the cells"),
            std::string::npos);
  EXPECT_NE(why_refused("x;y;z\n1.234,5;2;3\n").find("\"1.234,5\" is no number for x"), std::string::npos);
  EXPECT_NE(why_refused("x;y;z\n1,234,567;2;3\n").find("marks between the thousands"), std::string::npos);
  EXPECT_NE(why_refused("Easting [mm],Northing [mm],Height\n").find("is in mm"), std::string::npos);
  EXPECT_NE(why_refused("lat,lon,z\n").find("\"lat\" is an angle"), std::string::npos);
  EXPECT_NE(why_refused("1,2,3\n4,5,6\n").find("the first line holds numbers"), std::string::npos);
  EXPECT_NE(why_refused("E,N,Heigth\n1,2,3\n").find("is \"Heigth\" height?"), std::string::npos)
      << "else it would be passed over";
  EXPECT_NE(why_refused(std::string("glTF\2\0\0\0x,y,z\n", 14)).find("no table"), std::string::npos);
  EXPECT_EQ(read("Punkt;Rechtswert;Hochwert;H\xC3\xB6he\nP1;5,0;3,6;1,85\n")[0].position, (Vec3{5, 3.6, 1.85}));
  EXPECT_NE(why_refused("Eastng,Northing,Height\n").find("is \"Eastng\" easting?"), std::string::npos);
  EXPECT_NE(why_refused(std::string("\xFF\xFEx\0,\0", 7)).find("UTF-16"), std::string::npos);
}

TEST(StationsCsv, NamesTheLineThatIsWrong) {
  EXPECT_NE(why_refused("x,y,z\n1,2,3\n1,2\n").find("s.csv:3: the line has 2 cells"), std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,two,3\n").find(":2: \"two\" is no number for y"), std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,2,nan\n").find("\"nan\""), std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,2,inf\n").find("\"inf\""), std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,2,3m\n").find("\"3m\""), std::string::npos);
  EXPECT_NE(why_refused("x,y,z\n1,,3\n").find("some are empty"), std::string::npos);
  EXPECT_NE(why_refused("x,y,z,u,v\n,,,,\n").find("neither"), std::string::npos);
  EXPECT_NE(why_refused("x,z\n1,2\n").find(":1: the header is \"x,z\"; it must name x,y,z"), std::string::npos);
  EXPECT_NE(why_refused("u,v,x\n1,2,3\n").find("the header"), std::string::npos);
  EXPECT_NE(why_refused("u,u,v\n").find("twice"), std::string::npos);
  EXPECT_NE(why_refused("").find("is empty"), std::string::npos);
  EXPECT_THROW(read_stations_csv("/nonexistent/stations.csv"), Error);
}

// Names come from other people's scenes, and a spreadsheet runs a cell that begins like this.
TEST(StationsCsv, NoCellIsAFormulaAndTextsAreReadBackAsTheyWere) {
  const test::TemporaryFolder folder;
  for (const std::string text : {"=1+2", "+wall", "-5", "@SUM(A1)", "'=1", "''-x", "'plain", "plain", "a=b",
                                 "=a,\"b\";c", "say \"x\"", "\"\"", "Tür; links"}) {
    std::vector<Scanner> scanners(2);
    scanners[1].name = text;
    std::vector<PlacedStation> stations(1);
    stations[0].setup.scanner = 1;
    write_stations_csv(folder / "s.csv", stations, scanners);
    EXPECT_EQ(read_stations_csv(folder / "s.csv")[0].scanner, text);
    std::vector<MissedShare> shares(2);
    shares[1].node = text;
    write_missed_csv(folder / "missed.csv", shares);
    for (const char* name : {"s.csv", "missed.csv"}) {
      const std::string table = test::content(folder / name);
      for (const std::string begins : {"\n", ",", "\""})
        for (const std::string runs : {"=", "+", "@", "-5"})
          EXPECT_EQ(table.find(begins + runs), std::string::npos) << table;
    }
  }
}

}  // namespace
}  // namespace vantage
