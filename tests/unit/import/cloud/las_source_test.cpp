// SPDX-License-Identifier: Apache-2.0
#include "cloud_files.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using LasSourceTest = CloudTest;
using importer::open_las;

constexpr std::size_t kRecords[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct Las {
  int minor = 2, format = 0;
  std::size_t spare = 0;  // bytes behind each record, as users may add
  std::string records = {};
  std::uint32_t vlrs = 0;
  std::string vlr_bytes = {};
  std::uint64_t count = 0;

  void add(std::int32_t x, std::int32_t y, std::int32_t z, int kind = 2, bool withheld = false) {
    std::string record;
    put(record, x), put(record, y), put(record, z);
    record.resize(kRecords[format] + spare, '\0');
    if (format >= 6)
      record[15] = withheld ? 4 : 0, record[16] = static_cast<char>(kind);
    else
      record[15] = static_cast<char>(kind | (withheld ? 0x80 : 0));
    records += record;
    ++count;
  }
  void vlr(std::uint16_t id, const std::string& body) {
    vlr_bytes.append(2, '\0');
    std::string user = "LASF_Projection";
    user.resize(16, '\0');
    vlr_bytes += user;
    put(vlr_bytes, id), put(vlr_bytes, static_cast<std::uint16_t>(body.size()));
    vlr_bytes.append(32, '\0');
    vlr_bytes += body;
    ++vlrs;
  }
  std::string bytes() const {
    const std::size_t header = minor >= 4 ? 375 : 227;
    std::string h = "LASF";
    h.resize(24, '\0');
    h += '\1', h += static_cast<char>(minor);
    h.resize(94, '\0');
    put(h, static_cast<std::uint16_t>(header)), put(h, static_cast<std::uint32_t>(header + vlr_bytes.size()));
    put(h, vlrs);
    h += static_cast<char>(format);
    put(h, static_cast<std::uint16_t>(kRecords[format & 0x3F] + spare));
    put(h, minor >= 4 ? 0U : static_cast<std::uint32_t>(count));
    h.resize(131, '\0');
    for (int axis = 0; axis < 3; ++axis) put(h, 0.01);
    for (const double offset : {1000.0, 2000.0, 0.0}) put(h, offset);
    h.resize(header, '\0');
    if (minor >= 4) std::memcpy(h.data() + 247, &count, sizeof count);
    return h + vlr_bytes + records;
  }
};

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

TEST_F(LasSourceTest, UnitsAndSystems) {
  const auto with = [&](std::uint16_t id, const std::string& body) {
    Las las;
    las.vlr(id, body);
    las.add(0, 0, 100);
    return open_las(write("a.las", las.bytes()));
  };
  auto keys = [](std::uint16_t key, std::uint16_t value) {
    std::string body;
    for (const std::uint16_t word : {1, 1, 0, 1}) put(body, word);
    put(body, key), put(body, std::uint16_t{0}), put(body, std::uint16_t{1}), put(body, value);
    return body;
  };
  expect_at(points_of(*with(34735, keys(3076, 9002)))[0], 304.8, 609.6, 0.3048);
  EXPECT_EQ(with(34735, keys(3072, 25832))->crs(), "EPSG:25832");
  const auto survey_feet = with(2112, "PROJCS[\"a\",UNIT[\"US survey foot\",0.3048006096]]");
  expect_at(points_of(*survey_feet)[0], 1200000.0 / 3937, 2400000.0 / 3937, 1200.0 / 3937);
  EXPECT_EQ(survey_feet->crs(), "");
  EXPECT_EQ(survey_feet->notes().size(), 1u);
  const std::string metres = "PROJCS[\"Left\",UNIT[\"metre\",1]]";
  EXPECT_EQ(with(2112, metres)->crs(), metres);
  expect_refused_for("degrees", [&] { with(34735, keys(1024, 2)); });
  expect_refused_for("degrees", [&] { with(2112, "GEOGCS[\"WGS 84\"]"); });
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
  refused(changed(104, static_cast<char>(0x80)), "compressed (LAZ)");
  refused(changed(104, 11), "format 11");
  refused(changed(105, 19), "too short");
  refused(changed(25, 5), "LAS 1.5");
  refused(changed(107, 9), "truncated");
  refused(changed(107, 0), "no point");
  for (std::size_t length = 0; length < sound.size(); length += 5)
    EXPECT_THROW(points_of(*open_las(write("c.las", sound.substr(0, length)))), importer::Refused) << length;
}

}  // namespace
}  // namespace vantage::test
