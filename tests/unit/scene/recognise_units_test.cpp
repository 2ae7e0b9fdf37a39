// SPDX-License-Identifier: Apache-2.0
// Units and the up axis: what is recognised, what keeps glTF's rule, and what options and marks decide.
#include "scene/recognise_units.hpp"

#include <gtest/gtest.h>

#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::GlbBuilder;
using test::load;

// A thing of `size` with its lower corner at `low`, in the file's axes.
NamedBox thing(const std::string& name, const Vec3& low, const Vec3& size) { return {name, {low, low + size}}; }

// A room of ten by eight by three, Y up, with a floor and a ceiling, and nothing named.
SceneEvidence bare_room(double unit = 1) {
  SceneEvidence evidence;
  evidence.bounds = {{0, 0, 0}, Vec3{10, 3, 8} * unit};
  const double square = unit * unit;
  evidence.levels[1] = {{0, 80 * square, true}, {2.7 * unit, 80 * square, false}, {3 * unit, 80 * square, true}};
  evidence.levels[0] = {{0, 24 * square, false}, {10 * unit, 24 * square, true}};
  evidence.levels[2] = {{0, 30 * square, false}, {8 * unit, 30 * square, true}};
  evidence.area = 500 * square;
  return evidence;
}

SceneEvidence furnished_room(double unit) {
  SceneEvidence evidence = bare_room(unit);
  evidence.nodes = {thing("Chair.001", {}, Vec3{0.5, 0.95, 0.5} * unit),
                    thing("deskLeft", {}, Vec3{1.6, 0.74, 0.8} * unit), thing("bed", {}, Vec3{2.0, 0.5, 1.6} * unit)};
  return evidence;
}

// Y up becomes Z up: (x, y, z) as (x, −z, y).
SceneEvidence lying(SceneEvidence evidence) {
  const auto turned = [](const Box& box) {
    Box out;
    out.extend({box.min.x, -box.min.z, box.min.y});
    out.extend({box.max.x, -box.max.z, box.max.y});
    return out;
  };
  evidence.bounds = turned(evidence.bounds);
  for (NamedBox& node : evidence.nodes) node.box = turned(node.box);
  std::swap(evidence.levels[1], evidence.levels[2]);
  for (FlatLevel& level : evidence.levels[1]) level.at = -level.at, level.forward = !level.forward;
  std::ranges::sort(evidence.levels[1], {}, &FlatLevel::at);
  return evidence;
}

Recognised recognised(const SceneEvidence& evidence) { return recognise(evidence, {}, {}); }

TEST(RecogniseUnits, FindsTheUnitOfThingsByTheirNames) {
  for (const Unit unit : {Unit::millimetre, Unit::centimetre, Unit::inch, Unit::foot, Unit::metre}) {
    const Recognised found = recognised(furnished_room(1 / metres_in(unit)));
    EXPECT_EQ(found.unit, unit) << to_string(unit) << ": " << found.note;
    EXPECT_EQ(found.up, UpAxis::y);
    EXPECT_EQ(found.note.empty(), unit == Unit::metre) << found.note;
    EXPECT_EQ(found.note.find("give the setting unit") != std::string::npos, unit != Unit::metre) << found.note;
  }
}

TEST(RecogniseUnits, OneSignIsEnoughOnlyWhereMetresAreAbsurd) {
  EXPECT_EQ(recognised(bare_room(1000)).unit, Unit::millimetre);  // ten kilometres; a storey is 2.7 m high
  EXPECT_EQ(recognised(bare_room(1 / 0.3048)).unit, Unit::metre);
  EXPECT_EQ(recognised(bare_room(100)).unit, Unit::centimetre);  // a kilometre wide and 300 m high
  EXPECT_EQ(recognised(bare_room(1)).note, "");
}

// Many faces across each axis, on a grid.
SceneEvidence drawn_on(double grid, double extent) {
  SceneEvidence evidence;
  evidence.bounds = {{0, 0, 0}, {extent, 0.3 * extent, extent}};
  for (auto& levels : evidence.levels)
    for (int k = 1; k <= 40; ++k) levels.push_back({grid * (k * k % 97 + k), 100.0 + k, k % 2 == 0});
  for (auto& levels : evidence.levels) std::ranges::sort(levels, {}, &FlatLevel::at);
  evidence.area = 3 * 40 * 120, evidence.open = {0, evidence.area, 0};
  return evidence;
}

TEST(RecogniseUnits, ADrawingsGridTellsInchesFromPartsOfAMetre) {
  EXPECT_EQ(recognised(drawn_on(8, 4096)).unit, Unit::inch);
  EXPECT_NE(recognised(drawn_on(8, 4096)).note.find("a drawing grid of 8"), std::string::npos);
  EXPECT_EQ(recognised(drawn_on(10, 4096)).unit, Unit::metre) << "tens are of centimetres as well as of millimetres";
  EXPECT_EQ(recognised(drawn_on(7, 4096)).unit, Unit::metre);
  EXPECT_EQ(recognised(drawn_on(8.02, 4096)).unit, Unit::metre);
  EXPECT_EQ(recognised(drawn_on(8, 1800)).unit, Unit::inch) << "540 m high";
  EXPECT_EQ(recognised(drawn_on(8, 400)).unit, Unit::metre) << "one sign is not enough where metres may be right";
}

TEST(RecogniseUnits, TellsWhatNothingSettles) {
  SceneEvidence terrain;  // open below, and 20 km wide
  terrain.bounds = {{0, 0, 0}, {20'000, 900, 20'000}};
  terrain.area = 5e8, terrain.open = {0, 4e8, 0};
  const Recognised found = recognised(terrain);
  EXPECT_EQ(found.unit, Unit::metre);
  EXPECT_EQ(found.up, UpAxis::y);
  EXPECT_NE(found.note.find("give the setting unit"), std::string::npos) << found.note;
}

TEST(RecogniseUnits, TakesAMachineAsMillimetres) {
  SceneEvidence machine;
  machine.bounds = {{-100, -150, -120}, {280, 200, 180}};
  machine.area = 1e6;
  EXPECT_EQ(recognised(machine).unit, Unit::millimetre);
  machine.open = {0, 1e5, 0};  // open below: a city or a valley
  EXPECT_EQ(recognised(machine).unit, Unit::metre);
  machine.open = {};
  machine.bounds.max.y = -100;  // flat
  EXPECT_EQ(recognised(machine).unit, Unit::metre);
}

TEST(RecogniseUnits, NamesOfPartsAreNotThoseOfTheWhole) {
  SceneEvidence evidence = bare_room();
  evidence.nodes = {thing("door_handle", {}, {0.002, 0.0021, 0.002}), thing("Car_Wheel_03", {}, {0.004, 0.004, 0.001})};
  EXPECT_EQ(recognised(evidence).unit, Unit::metre);
  EXPECT_EQ(recognised(evidence).note, "");
  evidence.nodes = {thing("outdoors", {}, {0.002, 0.0021, 0.002}), thing("carpet", {}, {0.004, 0.004, 0.001})};
  EXPECT_EQ(recognised(evidence).unit, Unit::metre);
}

TEST(RecogniseUnits, ZIsUpByTwoSigns) {
  const Recognised bare = recognised(lying(bare_room()));
  EXPECT_EQ(bare.up, UpAxis::z) << bare.note;
  EXPECT_NE(bare.note.find("give the setting up"), std::string::npos) << bare.note;
  const Recognised both = recognised(lying(furnished_room(1000)));
  EXPECT_EQ(both.up, UpAxis::z);
  EXPECT_EQ(both.unit, Unit::millimetre);
  EXPECT_NE(both.note.find("give the setting unit and the setting up"), std::string::npos) << both.note;
}

// A wall that fills the picture is as flat as a floor; only glTF's rule can distinguish them.
TEST(RecogniseUnits, AFacadeStaysUpright) {
  SceneEvidence facade;
  facade.bounds = {{0, 0, 0}, {24, 12, 1}};
  facade.levels[2] = {{0, 288, false}, {0.7, 60, true}, {1, 200, true}};
  facade.levels[0] = {{0, 12, false}, {24, 12, true}};
  facade.levels[1] = {{0, 24, false}, {12, 24, true}};
  facade.area = 700;
  EXPECT_EQ(recognised(facade).up, UpAxis::y);
  facade.nodes = {thing("Roof", {0, 11.7, 0}, {24, 0.3, 1}), thing("Door_1", {3, 0, 0}, {0.9, 2.1, 0.1})};
  EXPECT_EQ(recognised(facade).up, UpAxis::y);
  EXPECT_EQ(recognised(facade).note, "");
}

TEST(RecogniseUnits, OptionsAreNotDoubted) {
  const SceneEvidence evidence = lying(furnished_room(1000));
  const Recognised all = recognise(evidence, Unit::inch, UpAxis::y);
  EXPECT_EQ(all.unit, Unit::inch);
  EXPECT_EQ(all.up, UpAxis::y);
  EXPECT_EQ(all.note, "");
  EXPECT_EQ(recognise(evidence, {}, UpAxis::z).unit, Unit::millimetre);
  EXPECT_EQ(recognise(evidence, Unit::millimetre, {}).up, UpAxis::z);
}

TEST(RecogniseUnits, NothingIsNoEvidence) {
  EXPECT_EQ(recognised({}).unit, Unit::metre);
  EXPECT_EQ(recognised({}).note, "");
}

// --- through a file ---

// A room of 6000 × 4000 × 2700 with a chair and a desk, as boxes.
GlbBuilder room_in_millimetres() {
  GlbBuilder glb;
  const auto box = [&](const std::string& name, const Vec3& low, const Vec3& size) {
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(static_cast<float>(low.x + (i & 1 ? size.x : 0)));
      corners.push_back(static_cast<float>(low.y + (i & 2 ? size.y : 0)));
      corners.push_back(static_cast<float>(low.z + (i & 4 ? size.z : 0)));
    }
    const std::vector<std::uint32_t> faces{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const int points = glb.positions(corners), indices = glb.accessor(faces, 5125, "SCALAR");
    glb.node({{"name", name}, {"mesh", glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}})}});
  };
  box("floor", {0, -200, 0}, {6000, 200, 4000});
  box("ceiling", {0, 2700, 0}, {6000, 200, 4000});
  box("chair", {1000, 0, 1000}, {450, 900, 450});
  box("desk", {2000, 0, 1000}, {1600, 740, 800});
  return glb;
}

TEST(RecogniseUnits, LoadsMetres) {
  const Scene scene = load(room_in_millimetres());
  EXPECT_DOUBLE_EQ(scene.bounds().size().x, 6);
  EXPECT_DOUBLE_EQ(scene.bounds().size().y, 4);
  EXPECT_NEAR(scene.bounds().max.z, 2.9, 1e-6);
  ASSERT_EQ(scene.notes().size(), 1U);
  EXPECT_NE(scene.notes()[0].find("millimetres"), std::string::npos) << scene.notes()[0];
}

TEST(RecogniseUnits, OptionsSettleIt) {
  const Scene metres = load(room_in_millimetres(), {.unit = Unit::metre});
  EXPECT_EQ(metres.bounds().size().x, 6000);
  EXPECT_TRUE(metres.notes().empty());
  const Scene inches = load(room_in_millimetres(), {.unit = Unit::inch, .up = UpAxis::z});
  EXPECT_NEAR(inches.bounds().size().x, 152.4, 1e-4);
  EXPECT_NEAR(inches.bounds().max.y, 2900 * 0.0254, 1e-4);
  EXPECT_NEAR(inches.bounds().max.z, 4000 * 0.0254, 1e-4);
}

TEST(RecogniseUnits, MarkedFilesAreNotAsked) {
  const nlohmann::json mark{{"vantage", {{"diffuse", 0.4}}}};
  for (const char* array : {"nodes", "meshes"}) {
    GlbBuilder glb = room_in_millimetres();
    glb.json[array][1]["extras"] = mark;
    EXPECT_EQ(load(glb).bounds().size().x, 6000) << array;
    EXPECT_EQ(load(glb, {.unit = Unit::millimetre}).bounds().size().x, 6) << array;
  }
  GlbBuilder glb = room_in_millimetres();
  glb.json["asset"]["extras"] = {{"vantage", {{"step", 1}}}};
  EXPECT_EQ(load(glb).bounds().size().x, 6000);
  EXPECT_TRUE(load(glb).notes().empty());
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
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) EXPECT_EQ(up_axis_from_string(to_string(up)), up);
  EXPECT_THROW(unit_from_string("yard"), Error);
  EXPECT_THROW(up_axis_from_string("x"), Error);
}

}  // namespace
}  // namespace vantage
