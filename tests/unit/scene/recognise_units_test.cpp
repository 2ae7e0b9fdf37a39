// SPDX-License-Identifier: Apache-2.0
// Units and the up axis: those that are recognised, those that need a question, and the effect of options and marks.
#include "scene/recognise_units.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/positions.hpp"
#include "support/box.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::GlbBuilder;
using test::load;

// A house of two rooms with an open door between them and one to the outside, a table, and a stair to its flat roof.
// In metres, Z up.
class House {
 public:
  House() {
    box({-4, -4, -0.2}, {14, 10, 0});
    for (const double y : {0.0, 5.7}) box({0, y, 0}, {10, y + 0.3, 2.6});
    box({0, 0, 0}, {0.3, 6, 2.6}), box({9.7, 0, 0}, {10, 2, 2.6}), box({9.7, 3, 0}, {10, 6, 2.6});
    box({9.7, 2, 2.05}, {10, 3, 2.6});  // over the door
    box({5, 0, 0}, {5.15, 3, 2.6}), box({5, 3.9, 0}, {5.15, 6, 2.6}), box({5, 3, 2.05}, {5.15, 3.9, 2.6});
    box({0, 0, 2.6}, {10, 6, 2.8});
    box({2, 2, 0.7}, {3.6, 2.8, 0.74});
    for (int i = 0; i < 16; ++i) box({1 + 0.28 * i, -1.2, 0}, {1 + 0.28 * (i + 1), 0, 0.175 * (i + 1)});
  }
  void box(const Vec3& low, const Vec3& high) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Vec3& corner : test::box_corners(low, high)) points.push_back(corner);
    for (const Triangle& t : test::box_triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  // Loads the file by glTF's rule, when it is in this unit with this axis up.
  RawScene written(Unit unit, UpAxis up) const {
    RawScene raw;
    for (const Vec3& p : points) {
      const glm::dvec3 q = glm::dvec3{p.x, p.y, p.z} / metres_in(unit);
      raw.positions.push_back(up == UpAxis::x   ? glm::dvec3{q.z, q.y, -q.x}
                              : up == UpAxis::y ? q
                                                : glm::dvec3{q.x, -q.z, q.y});
    }
    raw.triangles = triangles;
    return raw;
  }

  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

constexpr Unit kUnits[] = {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot};

TEST(RecogniseUnits, AHouseIsReadAsAPersonUsesIt) {
  for (const Unit unit : kUnits)
    for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z}) {
      const Recognised found = recognise(House().written(unit, up), {}, {});
      SCOPED_TRACE(std::string(to_string(unit)) + " " + to_string(up) + ": " + found.note + found.question);
      EXPECT_TRUE(found.question.empty());
      EXPECT_EQ(found.unit, unit);
      EXPECT_EQ(found.up, up);
      EXPECT_EQ(found.note.empty(), unit == Unit::metre && up == UpAxis::y);
      EXPECT_EQ(found.note.find("setting unit") != std::string::npos, unit != Unit::metre);
      EXPECT_EQ(found.note.find("setting up") != std::string::npos, up != UpAxis::y);
    }
}

TEST(RecogniseUnits, MeasuresWhatAPersonDoes) {
  const std::vector<Hypothesis> all = weigh_hypotheses(House().written(Unit::inch, UpAxis::z), {}, {});
  ASSERT_EQ(all.size(), 15U);
  const Hypothesis& best = all[0];
  EXPECT_EQ(best.unit, Unit::inch);
  EXPECT_NEAR(best.size.x, 18, 1e-6);
  EXPECT_NEAR(best.size.z, 3, 1e-6);
  EXPECT_NEAR(best.headroom_m, 2.6, 0.01);
  EXPECT_EQ(best.doors, 2);
  EXPECT_GT(best.flights, 5);
  EXPECT_GT(best.reached, 0.9);
  for (const Hypothesis& other : all)
    if (other.unit != Unit::inch || other.up != UpAxis::z) {
      EXPECT_LT(other.flights, 1) << to_string(other.unit) << to_string(other.up);
    }
}

// A closed tube, as wide as high: either axis may be up.
TEST(RecogniseUnits, AsksWhereNothingTells) {
  House tube;
  tube.points.clear(), tube.triangles.clear();
  tube.box({0, 0, 0}, {20, 3, 0.2}), tube.box({0, 0, 3.2}, {20, 3, 3.4});
  tube.box({0, 0, 0.2}, {20, 0.2, 3.2}), tube.box({0, 2.8, 0.2}, {20, 3, 3.2});
  const Recognised found = recognise(tube.written(Unit::millimetre, UpAxis::z), {}, {});
  EXPECT_FALSE(found.question.empty());
  ASSERT_GE(found.choices.size(), 2U);
  EXPECT_NE(found.choices[0].find("unit mm, up "), std::string::npos) << found.choices[0];
  EXPECT_NE(found.choices[1].find(" m²"), std::string::npos) << found.choices[1];
  EXPECT_TRUE(recognise(tube.written(Unit::millimetre, UpAxis::z), {}, UpAxis::z).question.empty());
}

// A giant steps over the benches of a greenhouse, and finds doors on its beams.
TEST(RecogniseUnits, NobodyBuildsRoomsForGiants) {
  House house;
  house.points.clear(), house.triangles.clear();
  house.box({-6, -6, -0.2}, {32, 36, 0});
  for (const double y : {0.0, 29.8}) house.box({0, y, 0}, {12, y + 0.2, 4}), house.box({13, y, 0}, {26, y + 0.2, 4});
  for (const double y : {0.0, 29.8}) house.box({12, y, 2.1}, {13, y + 0.2, 4});
  house.box({0, 0, 0}, {0.2, 30, 4}), house.box({25.8, 0, 0}, {26, 30, 4}), house.box({0, 0, 4}, {26, 30, 4.2});
  for (const double x : {1.2, 3.4, 5.6, 7.8, 10.0, 14.6, 16.8, 19.0, 21.2, 23.4})
    house.box({x, 1.2, 0.75}, {x + 1.25, 28.8, 0.8}), house.box({x + 0.1, 1.3, 0}, {x + 0.15, 28.7, 0.75});
  for (double y = 3; y < 29; y += 4) house.box({0.2, y, 3.6}, {25.8, y + 0.16, 3.7});  // its beams, and doors on them
  for (double x = 2; x < 25; x += 3) house.box({x, 0.2, 3.92}, {x + 0.05, 29.8, 4});
  for (const Unit unit : kUnits) {
    const Recognised found = recognise(house.written(unit, UpAxis::z), {}, UpAxis::z);
    EXPECT_EQ(found.question, "") << to_string(unit);
    EXPECT_EQ(found.unit, unit);
  }
}

TEST(RecogniseUnits, NationalCoordinatesTellTheAxisAndAreInMetres) {
  const auto pit = [](const Vec3& at) {
    House site;
    site.points.clear(), site.triangles.clear();
    const auto box = [&](const Vec3& low, const Vec3& high) { site.box(at + low, at + high); };
    box({0, 0, -1}, {80, 20, 0}), box({0, 20, -8}, {80, 45, -7}), box({0, 45, -1}, {80, 65, 0});
    box({10, 50, 0}, {16, 52.4, 2.6}), box({46, 10, 0}, {50, 14, 30});
    return site.written(Unit::metre, UpAxis::z);
  };
  EXPECT_FALSE(recognise(pit({0, 0, 0}), {}, {}).question.empty());
  const Recognised found = recognise(pit({562'100, 5'621'300, 210}), {}, {});
  EXPECT_EQ(found.question, "");
  EXPECT_EQ(found.unit, Unit::metre);
  EXPECT_EQ(found.up, UpAxis::z);
  EXPECT_NE(found.note.find("its coordinates would be heights"), std::string::npos) << found.note;
}

TEST(RecogniseUnits, OptionsAreNotDoubted) {
  const RawScene raw = House().written(Unit::millimetre, UpAxis::z);
  const Recognised all = recognise(raw, Unit::inch, UpAxis::y);
  EXPECT_EQ(all.unit, Unit::inch);
  EXPECT_EQ(all.up, UpAxis::y);
  EXPECT_EQ(all.note + all.question, "");
  EXPECT_EQ(recognise(raw, {}, UpAxis::z).unit, Unit::millimetre);
  EXPECT_EQ(recognise(raw, Unit::millimetre, {}).up, UpAxis::z);
}

TEST(RecogniseUnits, NothingIsNoEvidence) {
  const Recognised found = recognise({}, {}, {});
  EXPECT_EQ(found.unit, Unit::metre);
  EXPECT_EQ(found.up, UpAxis::y);
  EXPECT_EQ(found.note + found.question, "");
}

// --- through a file ---

GlbBuilder room_in_millimetres() {
  GlbBuilder glb;
  std::vector<float> corners;
  std::vector<std::uint32_t> faces;
  const House house;
  for (const Vec3& p : house.points)
    for (const double x : {p.x, p.z, -p.y}) corners.push_back(static_cast<float>(1000 * x));
  for (const Triangle& t : house.triangles) faces.insert(faces.end(), t.begin(), t.end());
  const int points = glb.positions(corners), indices = glb.accessor(faces, 5125, "SCALAR");
  glb.node({{"name", "house"}, {"mesh", glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}})}});
  glb.node({{"name", "again"}, {"mesh", 0}});
  return glb;
}

TEST(RecogniseUnits, LoadsMetres) {
  const Scene scene = load(room_in_millimetres());
  EXPECT_NEAR(scene.bounds().size().x, 18, 1e-5);
  EXPECT_NEAR(scene.bounds().size().y, 14, 1e-5);
  EXPECT_NEAR(scene.bounds().max.z, 2.8, 1e-5);
  ASSERT_FALSE(scene.notes().empty());
  EXPECT_NE(scene.notes()[0].find("millimetres"), std::string::npos) << scene.notes()[0];
}

TEST(RecogniseUnits, AQuestionIsAnErrorThatNamesTheChoices) {
  GlbBuilder glb;
  std::vector<float> corners;
  std::vector<std::uint32_t> faces;
  House tube;
  tube.points.clear(), tube.triangles.clear();
  tube.box({0, 0, 0}, {20, 3, 0.2}), tube.box({0, 0, 2.8}, {20, 3, 3});
  tube.box({0, 0, 0}, {20, 0.2, 3}), tube.box({0, 2.8, 0}, {20, 3, 3});
  for (const Vec3& p : tube.points)
    for (const double x : {p.x, p.z, -p.y}) corners.push_back(static_cast<float>(1000 * x));
  for (const Triangle& t : tube.triangles) faces.insert(faces.end(), t.begin(), t.end());
  const int points = glb.positions(corners), indices = glb.accessor(faces, 5125, "SCALAR");
  glb.node({{"name", "tube"}, {"mesh", glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}})}});
  try {
    load(glb);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::malformed_file);
    EXPECT_GE(error.details().size(), 2U);
  }
}

TEST(RecogniseUnits, OptionsSettleIt) {
  const Scene metres = load(room_in_millimetres(), {.unit = Unit::metre});
  EXPECT_EQ(metres.bounds().size().x, 18'000);
  const Scene inches = load(room_in_millimetres(), {.unit = Unit::inch, .up = UpAxis::z});
  EXPECT_NEAR(inches.bounds().size().x, 18'000 * 0.0254, 1e-3);
  EXPECT_NEAR(inches.bounds().size().y, 3000 * 0.0254, 1e-3);
  EXPECT_NEAR(inches.bounds().size().z, 14'000 * 0.0254, 1e-3);
}

// Rooms, openings and a stair that fit a person in centimetres, drawn on a grid of eight as models in inches are.
TEST(RecogniseUnits, AnotherUnitsDrawingGridIsAskedAbout) {
  for (const double shift : {0.0, 1.0}) {
    House drawn;
    drawn.points.clear(), drawn.triangles.clear();
    const double s = shift;
    const auto box = [&](Vec3 low, Vec3 high) {
      const Vec3 by{s, 3 * s, 5 * s};
      drawn.box(low + by, high + by);
    };
    box({-400, -400, -16}, {1400, 1000, 0});
    for (const double y : {0.0, 584.0}) box({0, y, 0}, {1000, y + 16, 264});
    box({0, 0, 0}, {16, 600, 264}), box({984, 0, 0}, {1000, 200, 264}), box({984, 288, 0}, {1000, 600, 264});
    box({984, 200, 208}, {1000, 288, 264});
    for (const double x : {240.0, 504.0, 752.0})
      box({x, 0, 0}, {x + 16, 304, 264}), box({x, 392, 0}, {x + 16, 600, 264}), box({x, 304, 208}, {x + 16, 392, 264});
    box({0, 0, 264}, {1000, 600, 280});
    for (int i = 0; i < 16; ++i) box({104.0 + 32 * i, -120, 0}, {136.0 + 32 * i, 0, 16.0 * (i + 1)});
    const RawScene raw = drawn.written(Unit::metre, UpAxis::z);  // the numbers as they are
    const Recognised found = recognise(raw, {}, UpAxis::z);
    EXPECT_EQ(found.unit, Unit::centimetre) << found.question;
    EXPECT_EQ(found.question.empty(), shift != 0) << found.question << found.note;
    const auto inches = [](const std::string& choice) { return choice.find("unit in,") != std::string::npos; };
    EXPECT_EQ(std::ranges::any_of(found.choices, inches), shift == 0);
  }
}

TEST(RecogniseUnits, MarkedFilesAreNotAsked) {
  const nlohmann::json mark{{"vantage", {{"diffuse", 0.4}}}};
  for (const char* array : {"nodes", "meshes"}) {
    GlbBuilder glb = room_in_millimetres();
    glb.json[array][0]["extras"] = mark;
    EXPECT_EQ(load(glb).bounds().size().x, 18'000) << array;
    EXPECT_NEAR(load(glb, {.unit = Unit::millimetre}).bounds().size().x, 18, 1e-5) << array;
  }
  GlbBuilder glb = room_in_millimetres();
  glb.json["asset"]["extras"] = {{"vantage", {{"step", 1}}}};
  EXPECT_EQ(load(glb).bounds().size().x, 18'000);
}

TEST(RecogniseUnits, BuiltInScenesStayAsTheyAre) {
  const test::TemporaryFolder folder;
  for (const std::string& name : built_in_scene_names()) {
    write_built_in_scene(name, 20'000, folder / "scene.glb");
    const Scene asked = Scene::load(folder / "scene.glb");
    const Scene told = Scene::load(folder / "scene.glb", {.unit = Unit::metre, .up = UpAxis::y});
    EXPECT_EQ(asked.fingerprint(), told.fingerprint()) << name;
    for (const std::string& note : asked.notes()) EXPECT_EQ(note.find("setting u"), std::string::npos) << note;
  }
}

TEST(RecogniseUnits, UnitsAndAxesAreReadAsTheyAreWritten) {
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot})
    EXPECT_EQ(unit_from_string(to_string(unit)), unit);
  for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z}) EXPECT_EQ(up_axis_from_string(to_string(up)), up);
  EXPECT_THROW(unit_from_string("yard"), Error);
  EXPECT_THROW(up_axis_from_string("w"), Error);
}

}  // namespace
}  // namespace vantage
