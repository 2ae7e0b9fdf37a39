// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "las_file.hpp"
#include "laz_files.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using LasSourceTest = CloudTest;
using importer::open_las;

TEST_F(LasSourceTest, EveryPointFormat) {
  for (int format = 0; format <= 10; ++format) {
    Las las{.minor = format >= 6 ? 4 : 2, .format = format, .spare = static_cast<std::size_t>(format % 3)};
    las.add(100, -200, 300);
    las.add(1, 1, 1, 7);  // noise
    las.add(1, 1, 1, 2, true);
    las.add(400, 500, -600);
    const auto source = open_las(write("a.las", las.bytes()));
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), 2u) << format;
    expect_at(points[0], 1001, 1998, 3);
    expect_at(points[1], 1004, 2005, -6);
    EXPECT_FALSE(source->scans()[0].posed);
  }
}

TEST_F(LasSourceTest, ReadsWhatVantageWrites) {
  const auto file = folder_.path() / "own.las";
  PointCloudWriter writer(file, {500'000, 5'000'000, 0}, scan_position | scan_reflectivity);
  ScanChunk chunk;
  chunk.ray_count = 2;
  chunk.position = {{1, 2, 3}, {4.25, 5, 6}};
  chunk.reflectivity = {0.5, 0.5};
  writer.write(chunk, 1);
  writer.close();
  const auto points = points_of(*open_las(file));
  ASSERT_EQ(points.size(), 2u);
  expect_at(points[0], 500'001, 5'000'002, 3, 1e-4);
  expect_at(points[1], 500'004.25, 5'000'005, 6, 1e-4);
}

// Keys of GeoTIFF; a pair of a key and a double goes to the record of doubles.
std::string keys(const std::vector<std::pair<std::uint16_t, std::uint16_t>>& values, std::uint16_t doubles = 0) {
  std::string body;
  for (const std::uint16_t word :
       {std::uint16_t{1}, std::uint16_t{1}, std::uint16_t{0}, static_cast<std::uint16_t>(values.size())})
    put(body, word);
  for (const auto& [key, value] : values) {
    const bool size = doubles > 0 && key == doubles;
    for (const std::uint16_t word : {key, static_cast<std::uint16_t>(size ? 34736 : 0), std::uint16_t{1}, value})
      put(body, word);
  }
  return body;
}

std::string projected(const std::string& unit, const std::string& height = {}) {
  const std::string plan =
      "PROJCS[\"Own\",GEOGCS[\"NAD83\",DATUM[\"North_American_Datum_1983\",SPHEROID[\"GRS "
      "1980\",6378137,298.257222101]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
      "PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",-75],PARAMETER[\"scale_factor\",0.9996],"
      "PARAMETER[\"false_easting\",1000],PARAMETER[\"false_northing\",0]," +
      unit + "]";
  if (height.empty()) return plan;
  return "COMPD_CS[\"Both\"," + plan + ",VERT_CS[\"Heights\",VERT_DATUM[\"Own\",2005]," + height + "]]";
}

constexpr const char* kMetre = "UNIT[\"metre\",1]";
constexpr const char* kSurveyFoot = "UNIT[\"US survey foot\",0.304800609601219]";
constexpr double kFoot_m = 1200.0 / 3937;

class LasSystems : public LasSourceTest {
 protected:
  std::unique_ptr<importer::PointSource> with(std::uint16_t id, const std::string& body, bool extended = false) const {
    Las las;
    if (extended) las = {.minor = 4, .format = 6};
    if (extended)
      las.evlr(id, body);
    else
      las.vlr(id, body);
    las.add(0, 0, 100);  // 1000, 2000, 1
    return open_las(write("a.las", las.bytes()));
  }
  void expect(std::uint16_t id, const std::string& body, double plan_m, double height_m, bool extended = false) const {
    const auto source = with(id, body, extended);
    EXPECT_TRUE(source->metric());
    expect_at(points_of(*source).at(0), 1000 * plan_m, 2000 * plan_m, height_m, 1e-5);
  }
};

TEST_F(LasSystems, EachAxisHasItsUnit) {
  expect(2112, projected(kSurveyFoot), kFoot_m, kFoot_m);
  expect(2112, projected(kSurveyFoot, kMetre), kFoot_m, 1);
  expect(2112, projected(kMetre, kSurveyFoot), 1, kFoot_m);
  expect(2112, projected(kMetre, kSurveyFoot), 1, kFoot_m, true);
  expect(2112, projected(kMetre, "UNIT[\"metre\",1],AXIS[\"Depth\",DOWN]"), 1, -1);
  expect(2112, "LOCAL_CS[\"plant\",LOCAL_DATUM[\"local\",0],UNIT[\"millimetre\",0.001]]", 0.001, 0.001);
  expect(34735, keys({{1024, 1}, {3072, 25832}}), 1, 1);
  expect(34735, keys({{1024, 1}, {3072, 2263}}), kFoot_m, kFoot_m);
  expect(34735, keys({{1024, 1}, {3072, 2263}}), kFoot_m, kFoot_m, true);
  expect(34735, keys({{1024, 1}, {3072, 26918}, {3076, 9001}, {4096, 6360}, {4099, 9003}}), 1, kFoot_m);
  expect(34735, keys({{1024, 1}, {3072, 26918}, {4096, 6360}}), 1, kFoot_m);
  expect(34735, keys({{1024, 1}, {3072, 26918}, {4099, 9002}}), 1, 0.3048);
  expect(34735, keys({{1024, 1}, {3072, 2263}, {4096, 5703}}), kFoot_m, 1);
  expect(34735, keys({{1024, 1}, {3072, 32767}, {3076, 9002}}), 0.3048, 0.3048);
}

TEST_F(LasSystems, UnitsMayBeSizes) {
  Las las;
  las.vlr(34735, keys({{1024, 1}, {3072, 32767}, {3076, 32767}, {3077, 1}}, 3077));
  std::string sizes;
  put(sizes, 7.0), put(sizes, 0.5);
  las.vlr(34736, sizes);
  las.add(0, 0, 100);
  expect_at(points_of(*open_las(write("a.las", las.bytes()))).at(0), 500, 1000, 0.5);
}

TEST_F(LasSystems, AreKeptInMetres) {
  EXPECT_EQ(with(34735, keys({{3072, 25832}}))->crs(), "EPSG:25832");
  const std::string metres = projected(kMetre);
  EXPECT_EQ(with(2112, metres)->crs(), metres);
  EXPECT_EQ(with(2112, metres, true)->crs(), metres);
  const auto feet = with(2112, projected(kSurveyFoot));
  EXPECT_EQ(feet->notes().size(), 1u);
  EXPECT_NE(feet->crs().find("\"false_easting\",304.8006"), std::string::npos) << feet->crs();
  EXPECT_NE(feet->crs().find("UNIT[\"metre\",1"), std::string::npos) << feet->crs();
  EXPECT_EQ(feet->crs(), coordinate_system(feet->crs()));
  const auto high = with(34735, keys({{3072, 26918}, {4096, 6360}}));
  EXPECT_EQ(high->crs(), coordinate_system(high->crs()));
  EXPECT_TRUE(with(2112, "LOCAL_CS[\"plant\",UNIT[\"metre\",1]]")->crs().empty());
}

TEST_F(LasSystems, TheHeaderTellsWhichCounts) {
  for (const bool by_text : {false, true}) {
    Las las{.flags = static_cast<std::uint16_t>(by_text ? 16 : 0)};
    las.vlr(2112, projected(kMetre));
    las.vlr(34735, keys({{3072, 2263}}));
    las.add(0, 0, 100);
    expect_at(points_of(*open_las(write("a.las", las.bytes()))).at(0), by_text ? 1000 : 1000 * kFoot_m,
              by_text ? 2000 : 2000 * kFoot_m, by_text ? 1 : kFoot_m, 1e-6);
  }
}

TEST_F(LasSystems, WithoutMetresAreRefused) {
  const char* const wgs84 =
      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
      "UNIT[\"degree\",0.0174532925199433]]";
  expect_refused_for("degrees", [&] { with(34735, keys({{1024, 2}})); });
  expect_refused_for("degrees", [&] { with(2112, wgs84); });
  expect_refused_for("degrees", [&] {
    with(2112, std::string("COMPD_CS[\"a\",") + wgs84 + ",VERT_CS[\"h\",VERT_DATUM[\"h\",2005],UNIT[\"metre\",1]]]",
         true);
  });
  expect_refused_for("middle of the earth", [&] { with(34735, keys({{1024, 3}})); });
  expect_refused_for("point south and west", [&] { with(34735, keys({{1024, 1}, {3072, 5513}})); });
  // The unit stays open if nothing in the file states one.
  EXPECT_FALSE(with(2112, "a note")->metric());
  EXPECT_EQ(with(2112, "a note")->notes().size(), 1u);
  EXPECT_FALSE(with(34735, keys({{1024, 1}}))->metric());
}

TEST_F(LasSourceTest, Version5) {
  Las las{.minor = 5, .format = 7};
  las.add(100, 200, 300);
  las.vlr(2112, projected(kMetre));
  const auto source = open_las(write("a.las", las.bytes()));
  expect_at(points_of(*source).at(0), 1001, 2002, 3);
  EXPECT_TRUE(source->metric());
}

std::string bytes_of_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    if ((have += 6) >= 8) bytes += static_cast<char>(bits >> (have -= 8));
  }
  return bytes;
}

class LazSourceTest : public LasSourceTest {
 protected:
  LazSourceTest() { setenv("VANTAGE_IMPORTERS", VANTAGE_IMPORTERS_FOLDER, 1); }
  ~LazSourceTest() override { unsetenv("VANTAGE_IMPORTERS"); }
};

TEST_F(LazSourceTest, EveryPointFormat) {
  for (const LazFile& laz : kLazFiles) {
    const auto source = open_las(write("a.laz", bytes_of_base64(laz.base64)));
    for (int again = 0; again < 2; ++again) {
      const auto points = points_of(*source);
      std::size_t at = 0;
      for (int k = 0; k < 40; ++k) {
        if (k % 9 == 4 || k == 5) continue;  // noise, withheld
        ASSERT_LT(at, points.size()) << laz.format;
        expect_at(points[at++], 1000 + k, 2000 + 0.01 * (7 * k * k - 200), 0.01 * (k * 37 % 101), 1e-9);
      }
      EXPECT_EQ(at, points.size()) << laz.format;
    }
  }
}

TEST_F(LazSourceTest, DamagedOnesAreRefusedOrRead) {
  const std::string sound = bytes_of_base64(kLazFiles[3].base64);
  std::vector<std::size_t> lengths{400, 797, 1194};
  for (std::size_t lost = 1; lost <= 8; ++lost) lengths.push_back(sound.size() - lost);  // of the table of chunks
  for (const std::size_t length : lengths) {
    SCOPED_TRACE(length);
    expect_refused_for("truncated", [&] { points_of(*open_las(write("b.laz", sound.substr(0, length)))); });
  }
  for (std::size_t at = 375; at < sound.size(); at += 311) {
    std::string bytes = sound;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    try {
      points_of(*open_las(write("c.laz", bytes)));
    } catch (const importer::Refused& why) {
      EXPECT_FALSE(std::string(why.what()).empty());
    }
  }
  // An announced number that the chunks do not hold.
  std::string more = sound;
  more[107] = 41;
  expect_refused_for("truncated", [&] { points_of(*open_las(write("d.laz", more))); });
  std::string late = bytes_of_base64(kLazFiles[4].base64);
  late[247] = 41;
  expect_refused_for("truncated", [&] { points_of(*open_las(write("f.laz", late))); });
  std::string old = sound;
  old[104] = static_cast<char>(0x80 | 4), old[105] = 57;
  expect_refused_for("waveforms", [&] { open_las(write("e.laz", old)); });
}

TEST_F(LazSourceTest, WhatIsMissingIsNamed) {
  setenv("VANTAGE_IMPORTERS", folder_.path().c_str(), 1);
  const auto file = write("a.laz", bytes_of_base64(kLazFiles[0].base64));
  expect_refused_for("setup.sh --laz", [&] { points_of(*open_las(file)); });
}

TEST_F(LasSourceTest, SaysWhatIsWrong) {
  Las las;
  las.add(1, 2, 3);
  const std::string sound = las.bytes();
  const auto refused = [&](std::string bytes, const std::string& words) {
    expect_refused_for(words, [&] { points_of(*open_las(write("b.las", bytes))); });
  };
  const auto changed = [&](std::size_t at, char value) {
    std::string bytes = sound;
    bytes[at] = value;
    return bytes;
  };
  refused(changed(104, static_cast<char>(0x80)), "compressed, and it does not say how");
  refused(changed(104, 11), "format 11");
  refused(changed(105, 19), "too short");
  refused(changed(25, 6), "LAS 1.6");
  refused(changed(107, 9), "truncated");
  refused(changed(107, 0), "no point");
  for (std::size_t length = 0; length < sound.size(); length += 5)
    EXPECT_THROW(points_of(*open_las(write("c.las", sound.substr(0, length)))), importer::Refused) << length;
}

}  // namespace
}  // namespace vantage::test
