// SPDX-License-Identifier: Apache-2.0
#include "formats/station_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/xml_text.hpp"
#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

using test::content;

const std::string kUtm32 = "EPSG:25832";

std::vector<PlacedStation> sample() {
  const auto at = [](double x, double y, StationStatus status, bool kept) {
    PlacedStation s{.uv = {}, .position = {x, y, 101.85}, .status = status};
    s.ground = {x, y, 100}, s.existing = kept;
    return s;
  };
  std::vector<PlacedStation> stations{at(500'000, 5'300'000, StationStatus::ok, true),
                                      at(500'010.5, 5'300'004.25, StationStatus::ok, false),
                                      at(500'020, 5'300'000, StationStatus::clash, false), PlacedStation{}};
  stations.back().status = StationStatus::hole;
  return stations;
}
const std::vector<std::string> kNames{"K1", "S1 <north> & Tür", "S2", "S3"};

SearchArea area() {
  SearchMesh mesh;
  mesh.positions = {
      {499'990, 5'299'990, 100}, {500'030, 5'299'990, 100}, {500'030, 5'300'010, 100}, {499'990, 5'300'010, 100}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return SearchArea::from_mesh(mesh);
}

// A floor of 20 m × 20 m; only its coordinates matter.
Site floor_at(const Vec3& origin, const std::string& crs, std::vector<std::string>* warnings = nullptr) {
  SiteOptions options{.engine = Engine::embree, .crs = crs};
  if (warnings) options.warn = [warnings](const std::string& line) { warnings->push_back(line); };
  return Site(test::wall_and_floor(origin).scene(), options);
}
constexpr Vec3 kBavaria{500'000, 5'300'000, 100};

// One entity of a DXF: its groups in order.
using Groups = std::vector<std::pair<int, std::string>>;
std::vector<Groups> entities_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<Groups> entities;
  bool within = false;
  std::string code, value;
  while (std::getline(in, code) && std::getline(in, value)) {
    if (code == "2" && value == "ENTITIES") within = true;
    if (!within) continue;
    if (code == "0") entities.emplace_back();
    if (!entities.empty()) entities.back().emplace_back(std::stoi(code), value);
  }
  return entities;
}
std::string group(const Groups& entity, int code) {
  for (const auto& [c, value] : entity)
    if (c == code) return value;
  return "";
}

TEST(StationFiles, DxfHasStationsNamesLinksAndArea) {
  const test::TemporaryFolder folder;
  const auto stations = sample();
  OverlapMatrix overlap(4);
  overlap.set(0, 1, 0.25);
  write_stations_dxf(folder / "a.dxf", {stations, kNames}, {.least = 0.1, .values = overlap}, area());
  const std::string text = content(folder / "a.dxf");
  EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c < 0x7F); }));
  EXPECT_TRUE(text.ends_with("0\nEOF\n"));
  std::map<std::string, std::vector<Groups>> by_type;
  for (const Groups& e : entities_of(text)) by_type[group(e, 0)].push_back(e);

  ASSERT_EQ(by_type["POINT"].size(), 3u);  // the one in a hole has no place
  EXPECT_EQ(group(by_type["POINT"][0], 8), "STATIONS_EXISTING");
  EXPECT_EQ(group(by_type["POINT"][1], 8), "STATIONS");
  EXPECT_EQ(group(by_type["POINT"][2], 8), "STATIONS_LEFT_OUT");
  EXPECT_EQ(group(by_type["POINT"][1], 10), "500010.50000");
  EXPECT_EQ(group(by_type["POINT"][1], 20), "5300004.25000");
  EXPECT_EQ(group(by_type["POINT"][1], 30), "100.00000");
  ASSERT_EQ(by_type["TEXT"].size(), 3u);
  EXPECT_EQ(group(by_type["TEXT"][1], 1), "S1 <north> & T\\U+00FCr");
  ASSERT_EQ(by_type["LINE"].size(), 1u);
  EXPECT_EQ(group(by_type["LINE"][0], 11), "500010.50000");
  EXPECT_EQ(by_type["POLYLINE"].size(), 1u);
  EXPECT_EQ(by_type["VERTEX"].size(), 4u);
  EXPECT_EQ(by_type["SEQEND"].size(), 1u);

  // Weaker links than asked for are not drawn; without a matrix there are none.
  for (const auto& [matrix, least] : {std::pair{overlap, 0.3}, {OverlapMatrix(), 0.0}}) {
    write_stations_dxf(folder / "a.dxf", {stations, kNames}, {.least = least, .values = matrix}, area());
    EXPECT_EQ(content(folder / "a.dxf").find("\nLINE\n"), std::string::npos);
  }
}

TEST(StationFiles, GeoJsonAndKmlNeedACoordinateSystem) {
  const test::TemporaryFolder folder;
  const auto stations = sample();
  EXPECT_THROW(write_stations_geojson(folder / "a.geojson", {stations, kNames}, ""), Error);
  EXPECT_THROW(write_stations_kml(folder / "a.kml", {stations, kNames}, ""), Error);
  EXPECT_THROW(write_stations_kml(folder / "a.kml", {stations, kNames}, "EPSG:99999999"), Error);
  EXPECT_EQ(test::entries(folder.path()), 0u);
  std::vector<std::string> warnings;
  Site nowhere = floor_at(kBavaria, ""), off_the_map = floor_at({1e30, 0, 0}, kUtm32, &warnings),
       site = floor_at(kBavaria, kUtm32);
  write_station_files(folder.path(), {stations, kNames}, {}, nowhere);
  EXPECT_EQ(test::entries(folder.path()), 1u);  // the drawing
  write_station_files(folder.path(), {stations, kNames}, {}, off_the_map);
  EXPECT_EQ(test::entries(folder.path()), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("no stations.geojson and stations.kml: ")) << warnings[0];
  write_station_files(folder.path(), {stations, kNames}, {}, site);
  EXPECT_EQ(test::entries(folder.path()), 3u);
}

// The middle meridian of zone 32 is 9° east, and the equator's northing 0; along it a degree of longitude is
// 0.9996 · a · π / 180 at the meridian.
TEST(StationFiles, FindsLongitudeAndLatitude) {
  const std::vector<Vec3> points{{500'000, 0, 5}, {500'001, 0, 6}, {500'000, 5'300'000, 7}};
  const auto at = to_wgs84(kUtm32, points);
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(at[0].longitude_deg, 9, 1e-10);
  EXPECT_NEAR(at[0].latitude_deg, 0, 1e-10);
  EXPECT_EQ(at[0].height_m, 5);
  EXPECT_NEAR(at[1].longitude_deg - 9, 180 / (3.141592653589793 * 0.9996 * 6'378'137), 1e-12);
  EXPECT_NEAR(at[2].longitude_deg, 9, 1e-10);
  EXPECT_NEAR(at[2].latitude_deg, 47.85, 0.01);
  EXPECT_THROW(to_wgs84(kUtm32, std::vector<Vec3>{{1e30, 1e30, 0}}), Error);
}

TEST(StationFiles, GeoJsonFollowsTheRfc) {
  const test::TemporaryFolder folder;
  const auto stations = sample();
  write_stations_geojson(folder / "a.geojson", {stations, kNames}, kUtm32);
  const auto json = nlohmann::json::parse(content(folder / "a.geojson"));
  EXPECT_EQ(json["type"], "FeatureCollection");
  ASSERT_EQ(json["features"].size(), 4u);
  const auto& feature = json["features"][1];
  EXPECT_EQ(feature["type"], "Feature");
  EXPECT_EQ(feature["geometry"]["type"], "Point");
  ASSERT_EQ(feature["geometry"]["coordinates"].size(), 3u);
  EXPECT_GT(feature["geometry"]["coordinates"][0], 9.0);  // longitude first
  EXPECT_EQ(feature["geometry"]["coordinates"][2], 100);
  EXPECT_EQ(feature["properties"]["name"], kNames[1]);
  EXPECT_EQ(feature["properties"]["existing"], false);
  EXPECT_EQ(feature["properties"]["head_height_m"], 1.85);
  EXPECT_EQ(feature["properties"]["x"], 500'010.5);
  EXPECT_EQ(feature["properties"]["ground_z"], 100);
  EXPECT_EQ(json["features"][0]["properties"]["existing"], true);
  EXPECT_EQ(json["features"][2]["properties"]["status"], "clash");
  EXPECT_TRUE(json["features"][3]["geometry"].is_null());
}

TEST(StationFiles, KmlEscapesNamesAndLeavesOutWhatHasNoPlace) {
  const test::TemporaryFolder folder;
  const auto stations = sample();
  write_stations_kml(folder / "a.kml", {stations, kNames}, kUtm32);
  const std::string kml = content(folder / "a.kml");
  EXPECT_NE(kml.find("<name>S1 &lt;north&gt; &amp; Tür</name>"), std::string::npos);
  EXPECT_EQ(kml.find("S3"), std::string::npos);
  EXPECT_NE(kml.find("#left_out"), std::string::npos);
  EXPECT_NE(kml.find("#existing"), std::string::npos);
}

TEST(StationFiles, RefusesWrongUse) {
  const test::TemporaryFolder folder;
  const auto stations = sample();
  const std::vector<std::string> few{"S1"};
  EXPECT_THROW(write_stations_dxf(folder / "a.dxf", {stations, few}, {}, area()), Error);
  EXPECT_THROW(write_stations_dxf(folder / "a.dxf", {stations, kNames}, {.values = OverlapMatrix(2)}, area()), Error);
  Site site = floor_at(kBavaria, kUtm32);
  EXPECT_THROW(write_stations(folder / "a.shp", stations, kNames, {}, site), Error);
  EXPECT_THROW(write_stations_dxf(folder.path() / "none" / "a.dxf", {stations, kNames}, {}, area()), Error);
  EXPECT_EQ(test::entries(folder.path()), 0u);
}

// XML 1.0 has neither control characters nor U+FFFE and U+FFFF, and no text has what is no UTF-8.
TEST(XmlText, HasNothingThatXmlRefuses) {
  EXPECT_EQ(xml_text("a<b>&\x01\x1F\tc"), "a&lt;b&gt;&amp;c");
  EXPECT_EQ(xml_text("\xEF\xBF\xBE|\xEF\xBF\xBF|\xEF\xBF\xBD"), "\xEF\xBF\xBD|\xEF\xBF\xBD|\xEF\xBF\xBD");
  EXPECT_EQ(xml_text("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD") << "an unpaired surrogate";
  EXPECT_EQ(xml_text("T\xFCr T\xC3\xBCr \xF0\x9F\x9A\xAA"), "T\xEF\xBF\xBDr T\xC3\xBCr \xF0\x9F\x9A\xAA");
}

}  // namespace
}  // namespace vantage
