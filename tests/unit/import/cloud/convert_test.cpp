// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/convert.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "cloud_files.hpp"
#include "e57_file.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

// Casts rays of a scanner into boxes of a room and returns its points in the scanner's frame.
struct Room {
  Vec3 size{6, 4, 2.5};
  Vec3 origin = {};                                // of its corner
  std::vector<std::pair<Vec3, Vec3>> people = {};  // boxes, in the room's frame

  std::vector<Eigen::Vector3d> scan(const Vec3& head, double step_deg, double noise_m) const {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, noise_m);
    std::vector<Eigen::Vector3d> points;
    for (double zenith = 0.5 * step_deg; zenith < 150; zenith += step_deg)
      for (double azimuth = 0; azimuth < 360; azimuth += step_deg) {
        const double t = zenith * M_PI / 180, a = azimuth * M_PI / 180;
        const Eigen::Vector3d d(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
        double range = leaves({0, 0, 0}, size, head, d);
        for (const auto& [low, high] : people)
          if (const double enters = meets(low, high, head, d); enters > 0) range = std::min(range, enters);
        points.push_back((range + noise(random)) * d);
      }
    return points;
  }

 private:
  static std::pair<double, double> slabs(const Vec3& low, const Vec3& high, const Vec3& from,
                                         const Eigen::Vector3d& d) {
    double in = -1e9, out = 1e9;
    const double l[]{low.x, low.y, low.z}, h[]{high.x, high.y, high.z}, f[]{from.x, from.y, from.z};
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (l[axis] - f[axis]) / d[axis], b = (h[axis] - f[axis]) / d[axis];
      in = std::max(in, std::min(a, b)), out = std::min(out, std::max(a, b));
    }
    return {in, out};
  }
  static double leaves(const Vec3& low, const Vec3& high, const Vec3& from, const Eigen::Vector3d& d) {
    return slabs(low, high, from, d).second;
  }
  static double meets(const Vec3& low, const Vec3& high, const Vec3& from, const Eigen::Vector3d& d) {
    const auto [in, out] = slabs(low, high, from, d);
    return in < out ? in : -1;
  }
};

class ConvertTest : public CloudTest {
 protected:
  // An E57 of scans of a room, each with its own people.
  std::filesystem::path room_file(const std::vector<Room>& rooms, const std::vector<Vec3>& heads) const {
    std::vector<E57TestScan> scans;
    for (std::size_t k = 0; k < heads.size(); ++k) {
      const auto points = rooms[k].scan(heads[k], 0.5, 0.001);
      const Vec3 head = heads[k] + rooms[k].origin;
      const auto value = [](const char* name, double v) {
        return "<" + std::string(name) + " type=\"Float\">" + std::to_string(v) + "</" + name + ">";
      };
      E57TestScan scan{
          .head = "<pose type=\"Structure\"><translation type=\"Structure\">" + value("x", head.x) +
                  value("y", head.y) + value("z", head.z) + "</translation></pose>",
          .prototype = "<cartesianX type=\"Float\"/><cartesianY type=\"Float\"/><cartesianZ type=\"Float\"/>",
          .count = points.size()};
      for (std::size_t first = 0; first < points.size(); first += 2000) {
        std::vector<std::string> streams(3);
        for (std::size_t p = first; p < std::min(points.size(), first + 2000); ++p)
          for (int axis = 0; axis < 3; ++axis) put(streams[static_cast<std::size_t>(axis)], points[p][axis]);
        scan.packets.push_back(streams);
      }
      scans.push_back(scan);
    }
    const auto file = folder_.path() / "room.e57";
    write_e57(file, scans);
    return file;
  }
  Scene scene_of(const std::filesystem::path& file, const std::string& format) const {
    const auto glb = folder_.path() / "out.glb";
    std::ofstream(glb, std::ios::binary) << importer::convert_cloud({file}, format);
    return Scene::load(glb);
  }
};

std::uint32_t json_length(const std::string& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  return length;
}

double area_of(const Scene& scene, const std::string& mesh) {
  const SceneData& data = scene.data();
  double area = 0;
  for (std::size_t m = 0; m < data.meshes.size(); ++m)
    if (data.meshes[m].name == mesh)
      for (std::uint32_t t = 0; t < data.ranges[m].triangle_count; ++t) {
        const auto& of = data.triangles[data.ranges[m].first_triangle + t];
        const auto corner = [&](std::size_t k) {
          const auto& p = data.positions[of[k]];
          return Vec3{p.x, p.y, p.z};
        };
        const Vec3 n = cross(corner(1) - corner(0), corner(2) - corner(0));
        area += 0.5 * std::sqrt(dot(n, n));
      }
  return area;
}

TEST_F(ConvertTest, ARoomIsItsFloorItsCeilingAndItsWalls) {
  const Room room{.origin = {500'000, 5'000'000, 100}};
  const Scene scene = scene_of(room_file({room, room}, {{1.5, 2, 1.6}, {4.5, 2.5, 1.6}}), "e57");
  const Box box = scene.bounds();
  EXPECT_NEAR(box.min.x, 500'000, 0.06);
  EXPECT_NEAR(box.max.x, 500'006, 0.06);
  EXPECT_NEAR(box.min.z, 100, 0.06);
  EXPECT_NEAR(box.max.z, 102.5, 0.06);
  EXPECT_NEAR(area_of(scene, "floors"), 24, 1.2);
  EXPECT_NEAR(area_of(scene, "ceilings"), 24, 1.2);
  EXPECT_NEAR(area_of(scene, "walls"), 50, 3);
  EXPECT_LT(area_of(scene, "slopes"), 0.5);
  EXPECT_LT(scene.triangle_count(), 1000u);
  // The floor is walked on.
  const SearchArea area = SearchArea::build(scene);
  const auto uv = area.project({500'003, 5'000'002, 100});
  ASSERT_TRUE(uv);
  EXPECT_NEAR(area.locate(*uv)->z, 100, 0.005);
}

TEST_F(ConvertTest, SomebodyWhoWalksThroughIsLeftOut) {
  Room first, second;
  first.people = {{{2.8, 1.8, 0.05}, {3.2, 2.2, 1.8}}};
  second.people = {{{3.8, 0.8, 0.05}, {4.2, 1.2, 1.8}}};
  const std::vector<Vec3> heads{{1, 1, 1.6}, {5, 3, 1.6}, {1, 3, 1.6}};
  const Scene alone = scene_of(room_file({first, first, first}, heads), "e57");
  const Scene moving = scene_of(room_file({first, second, Room()}, heads), "e57");
  const double empty = area_of(scene_of(room_file({Room(), Room(), Room()}, heads), "e57"), "walls");
  EXPECT_GT(area_of(alone, "walls"), empty + 1);  // it is furniture then
  EXPECT_NEAR(area_of(moving, "walls"), empty, 0.3);
  bool told = false;
  for (const std::string& note : moving.notes()) told |= note.find("saw through them") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST_F(ConvertTest, NobodyStandsBelowSpaceThatNobodySaw) {
  // Points of a floor behind a wall, as if they were seen through a slit at its foot.
  const Room room;
  auto file = room_file({room, room}, {{1, 1, 1.6}, {5, 3, 1.6}});
  EXPECT_LT(area_of(scene_of(file, "e57"), "floors-below-unknown-space"), 0.3);
  std::vector<Eigen::Vector3d> floor;
  std::string streams[3];
  std::uint64_t count = 0;
  for (double x = 6.2; x < 8; x += 0.01)
    for (double y = 1; y < 3; y += 0.01, ++count)
      put(streams[0], x), put(streams[1], y - 1.0), put(streams[2], 0.0 - 0.05);
  E57TestScan slit{.head = "<pose><translation><x>0</x><y>1</y><z>0.05</z></translation></pose>",
                   .prototype = "<cartesianX type=\"Float\"/><cartesianY type=\"Float\"/><cartesianZ type=\"Float\"/>",
                   .count = count};
  for (std::uint64_t first = 0; first < count; first += 2000)
    slit.packets.push_back({streams[0].substr(8 * first, 16'000), streams[1].substr(8 * first, 16'000),
                            streams[2].substr(8 * first, 16'000)});
  write_e57(file, {slit});
  const Scene below = scene_of(file, "e57");
  EXPECT_NEAR(area_of(below, "floors-below-unknown-space"), 3.6, 0.4);
  EXPECT_EQ(area_of(below, "floors"), 0);
  EXPECT_THROW(SearchArea::build(below), Error);
}

TEST_F(ConvertTest, PointsWithoutAScannerAreSurfacesToo) {
  std::string text;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.002);
  for (double x = 0; x < 5; x += 0.013)
    for (double y = 0; y < 4; y += 0.013)
      text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(0.1 * x + noise(random)) + "\n";
  text += "100 100 100\n100.01 100 100\n";  // alone
  const Scene scene = scene_of(write("a.xyz", text), "xyz");
  EXPECT_NEAR(area_of(scene, "floors"), 20 * std::sqrt(1.01), 0.4);
  EXPECT_LT(scene.bounds().max.x, 6);
  EXPECT_LT(scene.triangle_count(), 300u);
}

TEST_F(ConvertTest, TheSamePointsGiveTheSameBytes) {
  const Room room;
  const auto file = room_file({room, room}, {{1, 1, 1.6}, {5, 3, 1.6}});
  EXPECT_EQ(importer::convert_cloud({file}, "e57"), importer::convert_cloud({file}, "e57"));
}

// A point every 4 cm on the six faces of a room.
std::string room_text(double per_metre, const Vec3& size, const Vec3& at = {}) {
  std::string text;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-0.5, 0.5);
  constexpr double kStep = 0.04;
  const double s[]{size.x, size.y, size.z}, o[]{at.x, at.y, at.z};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, s[axis]})
      for (double u = 0.5 * kStep; u < s[(axis + 1) % 3]; u += kStep)
        for (double v = 0.5 * kStep; v < s[(axis + 2) % 3]; v += kStep) {
          double p[3];
          p[axis] = side, p[(axis + 1) % 3] = u + kStep * within(random),
          p[(axis + 2) % 3] = v + kStep * within(random);
          for (int k = 0; k < 3; ++k) text += std::to_string((p[k] + o[k]) * per_metre) + (k < 2 ? " " : "\n");
        }
  return text;
}

TEST_F(ConvertTest, AUnitThatNobodyToldIsRecognisedOrAsked) {
  const Vec3 size{7, 5, 2.8};
  for (const auto& [unit, per_metre] : {std::pair{"m", 1.0}, {"cm", 100.0}, {"mm", 1000.0}, {"in", 1 / 0.0254}}) {
    const auto file = write(std::string("room_") + unit + ".xyz", room_text(per_metre, size));
    try {
      const Box box = scene_of(file, "xyz").bounds();
      EXPECT_NEAR(box.max.x - box.min.x, 7, 0.3) << unit;
      EXPECT_NEAR(box.max.z - box.min.z, 2.8, 0.3) << unit;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("the setting unit"), std::string::npos) << unit << error.what();
    }
    const auto told = importer::convert_cloud({file}, "xyz", {.unit_m = 1 / per_metre});
    const auto glb = folder_.path() / "told.glb";
    std::ofstream(glb, std::ios::binary) << told;
    EXPECT_NEAR(Scene::load(glb).bounds().max.y, 5, 0.2) << unit;
  }
  // Metres are not asked.
  EXPECT_NEAR(scene_of(folder_.path() / "room_m.xyz", "xyz").bounds().max.x, 7, 0.2);
}

TEST_F(ConvertTest, NationalMillimetresAndDegreesAreKnown) {
  const Scene scene = scene_of(write("a.xyz", room_text(1000, {7, 5, 2.8}, {500'000, 5'400'000, 300})), "xyz");
  EXPECT_NEAR(scene.bounds().min.y, 5'400'000, 0.2);
  EXPECT_NEAR(scene.bounds().max.x, 500'007, 0.2);
  std::string degrees;
  for (int k = 0; k < 3000; ++k)
    degrees += std::to_string(9 + 1e-6 * (k % 60)) + " " + std::to_string(48 + 1e-6 * (k % 50)) + " " +
               std::to_string(300 + 0.001 * (k % 2800)) + "\n";
  expect_refused_for("look like degrees", [&] { importer::convert_cloud({write("b.xyz", degrees)}, "xyz"); });
}

// They are steps of 8 mm at 100 km, in cells of 2.5 cm.
TEST_F(ConvertTest, FloatsAtNationalCoordinatesAreTold) {
  const auto told = [this](const Vec3& origin, const std::string& type) {
    std::string body;
    std::uint64_t count = 0;
    for (const Eigen::Vector3d& p : Room().scan({3, 2, 1.5}, 0.5, 0.001)) {
      ++count;
      for (const double value : {origin.x + p.x(), origin.y + p.y(), origin.z + p.z()})
        type == "float" ? put(body, static_cast<float>(value)) : put(body, value);
    }
    std::string head =
        "ply\nformat binary_little_endian 1.0\ncomment crs none\nelement vertex " + std::to_string(count);
    for (const char* name : {"x", "y", "z"}) head += "\nproperty " + type + " " + name;
    const Scene scene = scene_of(write("a.ply", head + "\nend_header\n" + body), "ply");
    return std::ranges::any_of(
        scene.notes(), [](const std::string& note) { return note.find("told only to 0.00781 m") != note.npos; });
  };
  EXPECT_TRUE(told({100'000, 60'000, 300}, "float"));
  EXPECT_FALSE(told({100'000, 60'000, 300}, "double"));
  EXPECT_FALSE(told({100, 60, 3}, "float"));
}

// Some programs write as few digits as they show, and some floats as doubles.
TEST_F(ConvertTest, CoordinatesOfFewDigitsAreTold) {
  const auto said = [this](const char* format, double east) {
    std::string lines;
    for (const Eigen::Vector3d& p : Room().scan({3, 2, 1.5}, 0.5, 0.001)) {
      char line[96];
      std::snprintf(line, sizeof line, format, p.x() + east, p.y() + 5'400'000, p.z() + 300);
      lines += line;
    }
    try {
      const Scene scene = scene_of(write("a.xyz", lines), "xyz");
      std::string all;
      for (const std::string& note : scene.notes()) all += note + "\n";
      return all;
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  const std::string told = "told only to 0.5 ";
  EXPECT_NE(said("%.6g %.6g %.6g\n", 500'000).find(told), std::string::npos) << said("%.6g %.6g %.6g\n", 500'000);
  EXPECT_NE(said("%.7g %.7g %.7g\n", 500'000).find(told), std::string::npos);
  EXPECT_EQ(said("%.3f %.3f %.3f\n", 500'000).find(told), std::string::npos);
}

TEST_F(ConvertTest, AnotherAxisMayPointUp) {
  const auto file = write("a.xyz", room_text(1, {7, 2.8, 5}));
  const auto glb = folder_.path() / "up.glb";
  std::ofstream(glb, std::ios::binary) << importer::convert_cloud({file}, "xyz", {.unit_m = 1, .up = 'y'});
  const Box box = Scene::load(glb).bounds();
  EXPECT_NEAR(box.max.z - box.min.z, 2.8, 0.2);
  EXPECT_NEAR(box.min.y, -5, 0.2);
}

TEST_F(ConvertTest, AMachineAloneHasNoGround) {
  std::string text;
  for (double y = 0; y < 2; y += 0.01)
    for (double z = 0; z < 2; z += 0.01) text += "0.01 " + std::to_string(y) + " " + std::to_string(z) + "\n";
  const Scene scene = scene_of(write("wall.xyz", text), "xyz");
  try {
    SearchArea::build(scene);
    ADD_FAILURE() << "a plane was laid where nothing is known";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("no ground for a station shows"), std::string::npos) << error.what();
  }
}

TEST_F(ConvertTest, ScansOfAFileAreListed) {
  const Room room;
  const std::string glb = importer::list_scans(room_file({room, room}, {{1, 1, 1.6}, {5, 3, 1.6}}));
  const auto json = nlohmann::json::parse(glb.substr(20, json_length(glb)));
  const auto& scans = json["asset"]["extras"]["scans"];
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1]["name"], "scan 2");
  EXPECT_EQ(scans[1]["position"], (nlohmann::json{5.0, 3.0, 1.6}));
}

}  // namespace
}  // namespace vantage::test
