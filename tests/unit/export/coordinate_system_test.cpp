// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"
#include "unit/export/files.hpp"
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
  EXPECT_NE(refusal("PROJCRS[\"x\"]").find("version 1"), std::string::npos);
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

}  // namespace
}  // namespace vantage
