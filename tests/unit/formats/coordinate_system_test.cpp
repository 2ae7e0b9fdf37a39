// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

std::string refusal(const std::string& text) {
  try {
    coordinate_system(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    return error.what();
  }
  return "accepted";
}

// The registry's own text of one code, and what changes from zone to zone of the others.
TEST(CoordinateSystem, HasTheTextOfItsCode) {
  EXPECT_EQ(coordinate_system("EPSG:25832"),
            R"(PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_1989",)"
            R"(SPHEROID["GRS 1980",6378137,298.257222101,AUTHORITY["EPSG","7019"]],AUTHORITY["EPSG","6258"]],)"
            R"(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,)"
            R"(AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4258"]],PROJECTION["Transverse_Mercator"],)"
            R"(PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],)"
            R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1,)"
            R"(AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","25832"]])");
  struct Case {
    const char *code, *name;
    int meridian, north;
  };
  for (const Case& c : {Case{"EPSG:32601", "WGS 84 / UTM zone 1N", -177, 0},
                        {"epsg:32633", "WGS 84 / UTM zone 33N", 15, 0},
                        {"EPSG:32760", "WGS 84 / UTM zone 60S", 177, 10'000'000},
                        {"EPSG:25828", "ETRS89 / UTM zone 28N", -15, 0},
                        {"EPSG:26917", "NAD83 / UTM zone 17N", -81, 0},
                        {"EPSG:28355", "GDA94 / MGA zone 55", 147, 10'000'000},
                        {"EPSG:7855", "GDA2020 / MGA zone 55", 147, 10'000'000}}) {
    const std::string text = coordinate_system(c.code);
    EXPECT_TRUE(text.starts_with(std::string("PROJCS[\"") + c.name + "\",")) << text;
    EXPECT_NE(text.find("\"central_meridian\"," + std::to_string(c.meridian) + "]"), std::string::npos) << text;
    EXPECT_NE(text.find("\"false_northing\"," + std::to_string(c.north) + "]"), std::string::npos) << text;
    EXPECT_EQ(coordinate_system(text), text);
  }
}

TEST(CoordinateSystem, MayComeAsText) {
  const test::TemporaryFolder folder;
  write_text(folder / "site.prj",
             "PROJCS[\"Site grid\",\r\n  GEOGCS[\"x y\", UNIT[\"degree\", 0.017]],\n  "
             "UNIT[\"Meter\", 1.0],\n  AXIS[\"E\", EAST]]\n");
  EXPECT_EQ(coordinate_system(folder / "site.prj"),
            "PROJCS[\"Site grid\",GEOGCS[\"x y\",UNIT[\"degree\",0.017]],UNIT[\"Meter\",1.0],AXIS[\"E\",EAST]]");
  EXPECT_THROW(coordinate_system(folder / "none.prj"), Error);
  EXPECT_NE(refusal("EPSG:999999").find("PROJ knows no coordinate system EPSG:999999"), std::string::npos);
  EXPECT_NE(refusal("EPSG:").find("no coordinate system"), std::string::npos);
  EXPECT_NE(refusal("EPSG:25832x").find("as EPSG:25832"), std::string::npos);
  EXPECT_NE(refusal("25832").find("EPSG:25832"), std::string::npos);
  EXPECT_NE(refusal("GEOGCS[\"WGS 84\"]").find("angles"), std::string::npos);
  EXPECT_NE(refusal("PROJCRS[\"x\"]").find("no well-known text"), std::string::npos);
  EXPECT_NE(refusal("PROJCS[\"x\",UNIT[\"foot\",0.3048]]").find("its unit is 0.3048 m"), std::string::npos);
  EXPECT_NE(refusal("PROJCS[\"x\",UNIT[\"metre\",1]").find("brackets"), std::string::npos);
  EXPECT_NE(refusal("FOO[\"x\"]").find("PROJCS["), std::string::npos);
}

TEST(CoordinateSystem, IsOneInMetres) {
  const std::string text = coordinate_system("EPSG:31467");
  EXPECT_TRUE(text.starts_with("PROJCS[")) << text;
  EXPECT_NE(text.find("AUTHORITY[\"EPSG\",\"31467\"]"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(refusal("EPSG:4326").find("angles"), std::string::npos);
  EXPECT_NE(refusal("EPSG:2263").find("unit"), std::string::npos) << "feet";
}

// Version 2 becomes version 1, which LAS needs; plan and heights may be two codes.
TEST(CoordinateSystem, MayBeOfVersionTwoAndHaveHeights) {
  const std::string text = coordinate_system(
      "PROJCRS[\"Own / UTM 32\",BASEGEOGCRS[\"ETRS89\",DATUM[\"European Terrestrial Reference System 1989\","
      "ELLIPSOID[\"GRS 1980\",6378137,298.257222101,LENGTHUNIT[\"metre\",1]]]],CONVERSION[\"UTM zone 32N\","
      "METHOD[\"Transverse Mercator\",ID[\"EPSG\",9807]],PARAMETER[\"Longitude of natural origin\",9],"
      "PARAMETER[\"Scale factor at natural origin\",0.9996],PARAMETER[\"False easting\",500000]],CS[Cartesian,2],"
      "AXIS[\"easting\",east],AXIS[\"northing\",north],LENGTHUNIT[\"metre\",1]]");
  EXPECT_TRUE(text.starts_with("PROJCS[\"Own / UTM 32\",")) << text;
  EXPECT_NE(text.find("\"central_meridian\",9]"), std::string::npos) << text;
  const std::string heights = coordinate_system("EPSG:26918+5703");
  EXPECT_TRUE(heights.starts_with("COMPD_CS[")) << heights;
  EXPECT_NE(heights.find("VERT_CS[\"NAVD88 height\""), std::string::npos) << heights;
  EXPECT_NE(refusal("EPSG:26918+").find("no coordinate system"), std::string::npos);
}

// The frame of a survey is metres east, north and up.
TEST(CoordinateSystem, HasTheAxesOfTheSurvey) {
  for (const char* code : {"EPSG:5513", "EPSG:2065", "EPSG:8352", "EPSG:8044", "EPSG:8045", "EPSG:2048"})
    EXPECT_NE(refusal(code).find("its axes point"), std::string::npos) << code << ": " << refusal(code);
  EXPECT_NE(refusal("EPSG:4978").find("middle of the earth"), std::string::npos);
  EXPECT_NE(refusal("EPSG:26918+6360").find("unit of its heights is 0.3048"), std::string::npos)
      << refusal("EPSG:26918+6360");
  EXPECT_NE(refusal("EPSG:5705").find("no projected system"), std::string::npos) << "heights alone";
  EXPECT_NE(refusal("EPSG:9518").find("angles"), std::string::npos) << "with heights";
  for (const char* code : {"EPSG:5514", "EPSG:31467", "EPSG:3031", "EPSG:32661"})
    EXPECT_EQ(refusal(code), "accepted") << code;
  // Text of version 1 has no axes of Krovak's; its code tells them.
  EXPECT_NE(
      refusal("PROJCS[\"S-JTSK / Krovak\",GEOGCS[\"S-JTSK\",DATUM[\"S_JTSK\",SPHEROID[\"Bessel 1841\",6377397.155,"
              "299.1528128]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Krovak\"],"
              "PARAMETER[\"latitude_of_center\",49.5],PARAMETER[\"longitude_of_center\",24.8333333333333],"
              "PARAMETER[\"azimuth\",30.2881397527778],PARAMETER[\"pseudo_standard_parallel_1\",78.5],"
              "PARAMETER[\"scale_factor\",0.9999],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],"
              "UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"5513\"]]")
          .find("its axes point"),
      std::string::npos);
}

}  // namespace
}  // namespace vantage
