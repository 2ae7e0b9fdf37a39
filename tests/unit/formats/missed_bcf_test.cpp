// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/export.hpp"
#include "vantage/rays.hpp"

namespace vantage {
namespace {

constexpr const char *kSeen = "2O2Fr$t4X7Zf8NOew3FLOH", *kBehind = "1hqIFTRjfV6AWq_bMtnZwI",
                     *kBelow = "0juf4qyggSI8rxA20Qwnsj";

// Files of an archive by their local headers (APPNOTE 4.3.7) and zlib's inflate; all must be of 1980-01-01.
std::map<std::string, std::string> unzipped(const std::string& bytes) {
  std::map<std::string, std::string> files;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t k = size; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
  };
  // Sizes stand in the central directory (4.3.12), which the end of the archive (4.3.16) tells.
  const std::size_t end = bytes.rfind("PK\5\6");
  std::size_t at = number(end + 16, 4);
  for (std::uint64_t left = number(end + 10, 2); left > 0; --left) {
    EXPECT_EQ(bytes.substr(at, 4), "PK\1\2");
    EXPECT_EQ(number(at + 10, 2), 8u) << "deflated";
    EXPECT_EQ(number(at + 12, 2), 0u);
    EXPECT_EQ(number(at + 14, 2), 1u << 5 | 1u) << "1980-01-01 of MS-DOS";
    const std::uint64_t packed = number(at + 20, 4), size = number(at + 24, 4), local = number(at + 42, 4);
    const std::uint64_t name = number(at + 28, 2), more = number(at + 30, 2) + number(at + 32, 2);
    std::string text(size, '\0'), in = bytes.substr(local + 30 + number(local + 26, 2) + number(local + 28, 2), packed);
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -MAX_WBITS), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(in.data()), stream.avail_in = static_cast<uInt>(packed);
    stream.next_out = reinterpret_cast<Bytef*>(text.data()), stream.avail_out = static_cast<uInt>(size);
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    inflateEnd(&stream);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(size)), number(at + 16, 4));
    files[bytes.substr(at + 46, name)] = text;
    at += 46 + name + more;
  }
  return files;
}

// A wall that a station sees, a small one behind it, and a floor in two nodes below a deck that hides it.
Scene bcf_walls(const std::string& defaults = "{}") {
  test::QuadScene scene = test::wall_and_floor();
  scene.quad({8, 0, 0}, {0, 1, 0}, {0, 0, 1});
  scene.quad({-3, -1, -2.5F}, {2, 0, 0}, {0, 2, 0});
  scene.quad({-1, -1, -2.5F}, {2, 0, 0}, {0, 2, 0});
  const std::string below = std::string("IfcSlab Cellar & <yard> ") + kBelow;
  const std::string names[] = {std::string("IfcWall North wall ") + kSeen, "floor",
                               std::string("IfcWall Behind ") + kBehind, below, below};
  for (std::size_t m = 0; m < std::size(names); ++m) scene.data().meshes[m].name = names[m];
  scene.data().defaults_json = defaults;
  return scene.scene();
}

std::map<std::string, std::string> written(const Scene& scene, std::size_t most_topics = 1000) {
  const test::TemporaryFolder folder;
  Site site = test::site_of(Simulator(scene, test::coarse_scanner(0.2),
                                      {.engine = Engine::embree, .user_size_m = 0.25, .point_spacing_m = 0.1}));
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {0, 0, 0}, .ground = {0, 0, -1.5}}};
  const Evaluation found = site.evaluate(stations, {.field = true});
  const auto elements = element_shares(site.simulator(), found, found.field);
  MissedShare share{.node = std::string("IfcWall Behind ") + kBehind, .voxels = 9};
  share.shares[static_cast<std::size_t>(WhyMissed::hidden)] = 0.75;
  share.shares[static_cast<std::size_t>(WhyMissed::not_chosen)] = 0.25;
  std::string before;
  for (int again = 0; again < 2; ++again) {
    const std::size_t topics =
        write_missed_bcf(folder.path() / "missed.bcf", elements, {&share, 1}, site, 0.1, most_topics);
    EXPECT_EQ(topics, std::min<std::size_t>(2, most_topics));
    const std::string bytes = test::content(folder.path() / "missed.bcf");
    if (again > 0) {
      EXPECT_EQ(bytes, before) << "the same bytes";
    }
    before = bytes;
  }
  return unzipped(before);
}

// The text of a file of the topic of an element.
std::string of(const std::map<std::string, std::string>& files, const std::string& global_id, const std::string& name) {
  for (const auto& [path, text] : files)
    if (path.ends_with("/viewpoint.bcfv") && text.find(global_id) != std::string::npos)
      return files.at(path.substr(0, path.find('/') + 1) + name);
  return {};
}

Vec3 vector_in(const std::string& text, const std::string& name) {
  std::smatch found;
  const std::regex wanted("<" + name + "><X>([-.0-9]+)</X><Y>([-.0-9]+)</Y><Z>([-.0-9]+)</Z></" + name + ">");
  EXPECT_TRUE(std::regex_search(text, found, wanted)) << text;
  return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3])};
}

TEST(MissedBcf, HasATopicForEachElementThatIsNotCaptured) {
  const auto files = written(bcf_walls());
  EXPECT_EQ(files.size(), 5u) << "the version and two files for each topic, but none for the wall that is seen";
  EXPECT_NE(files.at("bcf.version").find("<Version VersionId=\"2.1\">"), std::string::npos);
  for (const auto& [path, text] : files) EXPECT_EQ(text.find(kSeen), std::string::npos) << path;
  const std::string markup = of(files, kBehind, "markup.bcf"), view = of(files, kBehind, "viewpoint.bcfv");
  EXPECT_NE(markup.find("<Title>Not captured: IfcWall Behind</Title>"), std::string::npos) << markup;
  EXPECT_NE(markup.find("<Description>Of 1.00 m² of surface, 0.0 % of the wanted points are captured. The rest: hidden "
                        "from everywhere 75.0 %, other stations would capture it 25.0 %.</Description>"),
            std::string::npos)
      << markup;
  EXPECT_NE(view.find(std::string("<Selection><Component IfcGuid=\"") + kBehind + "\"/></Selection>"),
            std::string::npos);
  const std::string below = of(files, kBelow, "markup.bcf");
  EXPECT_NE(below.find("<Title>Not captured: IfcSlab Cellar &amp; &lt;yard&gt;</Title>"), std::string::npos) << below;
  EXPECT_NE(below.find("<Index>0</Index>"), std::string::npos) << "the largest first";
  // Files that refer to each other share a name, and all of these names differ.
  std::smatch topic, viewpoint;
  const std::string guid = "([0-9A-F]{8}-[0-9A-F]{4}-8[0-9A-F]{3}-[89AB][0-9A-F]{3}-[0-9A-F]{12})";
  ASSERT_TRUE(std::regex_search(markup, topic, std::regex("<Topic Guid=\"" + guid)));
  ASSERT_TRUE(
      std::regex_search(markup, viewpoint, std::regex("<Viewpoints Guid=\"" + guid + "\"><Viewpoint>viewpoint.bcfv<")));
  EXPECT_EQ(files.count(topic.str(1) + "/viewpoint.bcfv"), 1u);
  EXPECT_NE(view.find("<VisualizationInfo Guid=\"" + viewpoint.str(1)), std::string::npos);
  EXPECT_NE(topic.str(1), viewpoint.str(1));
  EXPECT_EQ(written(bcf_walls(), 1).size(), 3u) << "the largest alone";
}

TEST(MissedBcf, CamerasLookAtTheElementFromWhereItIsInSight) {
  const Scene scene = bcf_walls();
  const auto files = written(scene);
  const RayTracer tracer(scene);
  for (const auto& [global_id, middle] : {std::pair{kBehind, Vec3{8, 0.5, 0.5}}, {kBelow, Vec3{-1, 0, -2.5}}}) {
    const std::string view = of(files, global_id, "viewpoint.bcfv");
    const Vec3 eye = vector_in(view, "CameraViewPoint"), way = vector_in(view, "CameraDirection"),
               up = vector_in(view, "CameraUpVector"), to = middle - eye;
    EXPECT_NEAR(dot(to, way) / std::sqrt(dot(to, to)), 1, 2e-6) << view;
    EXPECT_NEAR(dot(way, up), 0, 2e-6);
    EXPECT_GT(up.z, 0);
    const RayHits hits = tracer.nearest({.origins = {&eye, 1}, .directions = {&way, 1}});
    EXPECT_NE(scene.meshes()[hits.mesh[0]].name.find(global_id), std::string::npos) << "nothing stands before it";
    EXPECT_NE(view.find("<FieldOfView>60</FieldOfView>"), std::string::npos);
    EXPECT_LE(2, std::sqrt(dot(to, to)) / (global_id == kBehind ? std::sqrt(2) / 2 : std::sqrt(20) / 2))
        << "all in view";
  }
}

// The importer's matrix is of (x, z, −y): here a turn by 30° about up, a scale of 0.9996, and a shift.
TEST(MissedBcf, CamerasAreInTheCoordinatesOfTheModel) {
  const double c = 0.9996 * std::cos(M_PI / 6), s = 0.9996 * std::sin(M_PI / 6);
  const auto text = [](double value) { return std::to_string(value); };
  const auto plain = written(bcf_walls());
  const auto moved = written(bcf_walls("{\"model_in_site\": [" + text(c) + ",0," + text(-s) + ",0, 0,1,0,0, " +
                                       text(s) + ",0," + text(c) + ",0, 500,20,-7000,1]}"));
  const Vec3 site = vector_in(of(plain, kBehind, "viewpoint.bcfv"), "CameraViewPoint"),
             model = vector_in(of(moved, kBehind, "viewpoint.bcfv"), "CameraViewPoint");
  EXPECT_NEAR(c * model.x - s * model.y + 500, site.x, 0.01);
  EXPECT_NEAR(s * model.x + c * model.y + 7000, site.y, 0.01);
  EXPECT_NEAR(model.z + 20, site.z, 1e-3);
  const auto several = written(bcf_walls(R"({"model_in_site": null})"));
  EXPECT_EQ(of(several, kBehind, "viewpoint.bcfv").find("Camera"), std::string::npos) << "it is not known where";
}

}  // namespace
}  // namespace vantage
