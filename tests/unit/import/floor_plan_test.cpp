// SPDX-License-Identifier: Apache-2.0
// Drawings of floor plans, through their importer into a scene.
#include <algorithm>
#include <fstream>
#include <random>

#include "drawing.hpp"
#include "import_fixture.hpp"
#include "scene/scene_data.hpp"
#include "support/site_of.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

class FloorPlanTest : public ImportTest {
 protected:
  Scene load(const DrawingText& drawing, const SceneOptions& options = {}) const {
    return Scene::load(write("plan.dxf", drawing.str()), options);
  }
  std::string refused(const DrawingText& drawing, const std::string& words, const SceneOptions& options = {}) const {
    return expect_error(Errc::malformed_file, words, [&] { load(drawing, options); });
  }
};

std::string notes_of(const Scene& scene) {
  std::string all;
  for (const std::string& note : scene.notes()) all += note + "\n";
  return all;
}

void expect_note(const Scene& scene, const std::string& words) {
  EXPECT_NE(notes_of(scene).find(words), std::string::npos) << "'" << words << "' is not in: " << notes_of(scene);
}

std::vector<std::string> room_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Room& room : scene.rooms()) names.push_back(room.name);
  std::ranges::sort(names);
  return names;
}

void expect_box(const Box& box, const Vec3& low, const Vec3& high) {
  constexpr double kClose = 2e-3;
  for (const auto& [is, wanted] : {std::pair{box.min, low}, std::pair{box.max, high}}) {
    EXPECT_NEAR(is.x, wanted.x, kClose);
    EXPECT_NEAR(is.y, wanted.y, kClose);
    EXPECT_NEAR(is.z, wanted.z, kClose);
  }
}

// True if a triangle of the scene crosses a level line.
bool blocked(const Scene& scene, const Vec3& from, const Vec3& to) {
  const SceneData& data = scene.data();
  const Vec3 origin = data.origin;
  for (const auto& t : data.triangles) {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) {
      const auto& v = data.positions[t[static_cast<std::size_t>(k)]];
      p[k] = {double{v.x} + origin.x, double{v.y} + origin.y, double{v.z} + origin.z};
    }
    const auto minus = [](Vec3 a, Vec3 b) { return Vec3{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const auto volume = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
      const Vec3 u = minus(b, a), v = minus(c, a), w = minus(d, a);
      return u.x * (v.y * w.z - v.z * w.y) - u.y * (v.x * w.z - v.z * w.x) + u.z * (v.x * w.y - v.y * w.x);
    };
    if ((volume(from, p[0], p[1], p[2]) > 0) == (volume(to, p[0], p[1], p[2]) > 0)) continue;
    const bool a = volume(from, to, p[0], p[1]) > 0, b = volume(from, to, p[1], p[2]) > 0,
               c = volume(from, to, p[2], p[0]) > 0;
    if (a == b && b == c) return true;
  }
  return false;
}

TEST_F(FloorPlanTest, WallsStandAroundRoomsThatTextsName) {
  const Scene scene = load(small_flat());
  expect_box(scene.bounds(), {-0.3, -0.3, 0}, {10.3, 6.3, 2.7});
  EXPECT_EQ(room_names(scene), (std::vector<std::string>{"Flur", "Küche", "Wohnen"}));
  for (const Room& room : scene.rooms()) {
    if (room.name == "Küche") expect_box(room.box, {0, 0, 0}, {4.95, 4, 2.7});
    if (room.name == "Flur") expect_box(room.box, {0, 4.1, 0}, {10, 6, 2.7});
  }
  expect_note(scene, "unit m, by its header; walls of layer A-WALL, 2.70 m high");
  expect_note(scene, "3 rooms, 3 with a name; 3 doors and 0 passages");
  expect_note(scene, "2 windows from 0.9 m; 1 piece of furniture");
}

TEST_F(FloorPlanTest, DoorsOpenBelowTheirLintelAndWindowsAboveTheirSill) {
  const Scene scene = load(small_flat());
  // From the corridor through the kitchen's door, and beside it.
  EXPECT_FALSE(blocked(scene, {2.4, 4.5, 1.0}, {2.4, 3.5, 1.0}));
  EXPECT_FALSE(blocked(scene, {2.4, 4.5, 0.05}, {2.4, 3.5, 0.05}));
  EXPECT_TRUE(blocked(scene, {2.4, 4.5, 2.3}, {2.4, 3.5, 2.3}));
  EXPECT_TRUE(blocked(scene, {3.4, 4.5, 1.0}, {3.4, 3.5, 1.0}));
  // Through the kitchen's window, and below it.
  EXPECT_FALSE(blocked(scene, {2.2, 0.2, 1.5}, {2.2, -0.5, 1.5}));
  EXPECT_TRUE(blocked(scene, {2.2, 0.2, 0.5}, {2.2, -0.5, 0.5}));
  EXPECT_TRUE(blocked(scene, {2.2, 0.2, 2.3}, {2.2, -0.5, 2.3}));
  // The table, and above it.
  EXPECT_TRUE(blocked(scene, {2.5, 2.5, 0.5}, {2.5, 0.5, 0.5}));
  EXPECT_FALSE(blocked(scene, {2.5, 2.5, 0.8}, {2.5, 0.5, 0.8}));
}

TEST_F(FloorPlanTest, UnitIsTheHeadersElseThatOfDoors) {
  const Box metres = load(small_flat()).bounds();
  struct Case {
    int code;
    double scale;
    const char* note;
  };
  for (const Case& unit :
       {Case{4, 1000, "unit mm, by its header"}, Case{1, 1 / 0.0254, "unit in, by its header"},
        Case{0, 1000, "unit mm, as its doors are 900 wide"}, Case{0, 100, "unit cm, as its doors are 90 wide"},
        Case{0, 1 / 0.3048, "unit ft, as its doors are 2.95 wide"}}) {
    const Scene scene = load(small_flat(unit.code, unit.scale));
    expect_note(scene, unit.note);
    expect_box(scene.bounds(), metres.min, metres.max);
    EXPECT_EQ(scene.rooms().size(), 3u) << unit.note;
  }
}

TEST_F(FloorPlanTest, UnclearUnitIsAsked) {
  DrawingText room(0, 1000);
  room.rectangle("wall", 0, 0, 5, 4);
  refused(room, "give the setting unit: m (5e+03 x 4e+03 m), cm (50 x 40 m), mm (5 x 4 m)");
  expect_box(load(room, {.unit = Unit::millimetre}).bounds(), {-0.05, -0.05, 0}, {5.05, 4.05, 2.7});
  const std::string message = refused(small_flat(6, 1000), "states m, but its doors are 900 wide, as in mm");
  EXPECT_EQ(message.find(folder_.path().string()), 0u) << message;
  expect_box(load(small_flat(6, 1000), {.unit = Unit::millimetre}).bounds(), {-0.3, -0.3, 0}, {10.3, 6.3, 2.7});
}

TEST_F(FloorPlanTest, LinesThatMissEachOtherByCentimetresCloseRooms) {
  const Scene scene = load(small_flat(6, 1, 0.03));
  EXPECT_EQ(scene.rooms().size(), 3u);
  expect_note(scene, "1 end of wall lines joined to what they missed by up to 3.0 cm (5 cm at most)");
  EXPECT_EQ(notes_of(load(small_flat())).find("joined"), std::string::npos);
  EXPECT_EQ(load(small_flat(6, 1, 0.03)).triangle_count(), load(small_flat()).triangle_count());
}

TEST_F(FloorPlanTest, WallsWithoutANamedLayerAreThoseThatEnclose) {
  DrawingText drawing(6);
  for (const double x : {0.0, 4.1}) drawing.rectangle("Layer1", x, 0, x + 4, 3);
  drawing.rectangle("Layer1", -0.2, -0.2, 8.3, 3.2);
  drawing.rectangle("Rand", -30, -30, 40, 30);  // a sheet's border
  for (int i = 0; i < 40; ++i) drawing.line("Raster", -5 + i, -5, -5 + i, 10);
  const Scene scene = load(drawing);
  expect_note(scene, "walls of layer Layer1, whose lines enclose rooms");
  expect_box(scene.bounds(), {-0.2, -0.2, 0}, {8.3, 3.2, 2.7});
  DrawingText none(6);
  none.line("a", 0, 0, 5, 0);
  refused(none, "no layer of the drawing encloses a room; name the walls' with the setting wall-layer (it has a)");
}

TEST_F(FloorPlanTest, SettingsReachTheImporterAndAreKeptApart) {
  const auto height = [&](const SceneOptions& options) { return load(small_flat(), options).bounds().max.z; };
  EXPECT_NEAR(height({.wall_height_m = 3.2}), 3.2, 1e-6);
  EXPECT_NEAR(height({}), 2.7, 1e-6);
  EXPECT_NEAR(height({.wall_height_m = 3.2}), 3.2, 1e-6);
  expect_note(load(small_flat(), {.wall_layers = {"a-w*"}}), "walls of layer A-WALL");
  refused(small_flat(), "no layer matches the setting wall-layer \"mur*\"; it has 0, A-WALL",
          {.wall_layers = {"mur*"}});
  const auto other = write("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_error(Errc::invalid_argument, "the setting wall-height is for floor plans, and this is OBJ",
               [&] { Scene::load(other, {.wall_height_m = 3}); });
  expect_error(Errc::invalid_argument, "wall_height_m must be above 0",
               [&] { load(small_flat(), {.wall_height_m = 0}); });
}

TEST_F(FloorPlanTest, BlocksAreNestedScaledTurnedAndMirrored) {
  DrawingText drawing(6);
  drawing.begin_block("cell");
  drawing.rectangle("WALL", 0, 0, 2, 1);
  drawing.end_block();
  drawing.begin_block("wing");
  drawing.insert("0", "cell", 0, 0, 2, 2, 90);  // x from -2 to 0, y from 0 to 4
  drawing.end_block();
  drawing.insert("0", "wing", 10, 20, -1, 1);
  expect_box(load(drawing).bounds(), {9.95, 19.95, 0}, {12.05, 24.05, 2.7});

  DrawingText endless(6);
  endless.begin_block("a");
  endless.insert("0", "a", 1, 0);
  endless.line("WALL", 0, 0, 1, 0);
  endless.end_block();
  endless.insert("0", "a", 0, 0);
  refused(endless, "its blocks are nested deeper than 16, or one holds itself (a)");
  DrawingText many(6);
  many.begin_block("b0");
  many.line("WALL", 0, 0, 1, 0);
  many.end_block();
  for (int k = 1; k < 14; ++k) {
    many.begin_block("b" + std::to_string(k));
    for (int copy = 0; copy < 4; ++copy) many.insert("0", "b" + std::to_string(k - 1), copy, 0);
    many.end_block();
  }
  many.insert("0", "b13", 0, 0);
  refused(many, "it places more than 200000 blocks");
}

TEST_F(FloorPlanTest, NamesAreUtf8WithoutFormatting) {
  DrawingText drawing(6);
  for (const double x : {0.0, 5.0, 10.0, 15.0}) drawing.rectangle("MUR", x, 0, x + 4.8, 4);
  drawing.paragraph("t", 1, 3, "{\\fArial|b1|i0;Salle \\U+00E0}\\Pmanger");
  drawing.text("t", 6, 3, "S\xE9jour");
  drawing.text("t", 11, 3, "2.04");
  drawing.text("t", 11, 2.5,
               "\xC3\x9C"
               "bergang");
  drawing.text("t", 16, 3, "12.50");  // an area
  EXPECT_EQ(room_names(load(drawing)), (std::vector<std::string>{"2.04 Übergang", "Salle à manger", "Séjour"}));
}

TEST_F(FloorPlanTest, DrawingsInMapCoordinatesLoseNothing) {
  DrawingText drawing(6);
  drawing.rectangle("WALL", 500000.25, 5400000.5, 500005.25, 5400004.5);
  const Scene scene = load(drawing);
  expect_box(scene.bounds(), {500000.2, 5400000.45, 0}, {500005.3, 5400004.55, 2.7});
}

TEST_F(FloorPlanTest, WallsThatEncloseLittleStandOnOpenGround) {
  DrawingText pavilion(6);
  pavilion.rectangle("WALL", 0, 0, 8, 0.3);
  pavilion.rectangle("WALL", 2, 6, 12, 6.3);
  const Scene scene = load(pavilion);
  expect_note(scene, "the ground is all that lies between them, without a ceiling");
  EXPECT_TRUE(std::ranges::none_of(scene.meshes(), [](const MeshInfo& m) { return m.name.starts_with("ceiling"); }));
}

TEST_F(FloorPlanTest, AnElevationIsToldOrRefused) {
  DrawingText front(6);
  front.rectangle("0", 0, 0, 12, 6);
  for (const double x : {1.0, 4.0, 7.0}) front.rectangle("0", x, 3, x + 1.2, 4.5);
  expect_note(load(front), "is this an elevation, a section or a roof");
  front.text("0", 5, -1, "South Elevation 1:100");
  refused(front, "a text says \"South Elevation 1:100\"; give a floor plan, or name its layer of walls");
  load(front, {.wall_layers = {"0"}});
  // A plan with doors may refer to a section.
  DrawingText plan = small_flat();
  plan.text("A-NAME", 8, 2, "Section A-A");
  const std::string notes = notes_of(load(plan));
  EXPECT_EQ(notes.find("elevation"), std::string::npos) << notes;
}

TEST_F(FloorPlanTest, MultilinesAreTheirLines) {
  std::string text = small_flat().str();
  const Scene without = load(small_flat());
  // A wall 0.2 m thick across the living room, from (5.05, 2) to (10, 2).
  std::string wall = "0\nMLINE\n8\nA-WALL\n2\nSTANDARD\n40\n0.2\n70\n1\n71\n1\n72\n2\n73\n2\n10\n5.05\n20\n2\n30\n0\n";
  for (const char* x : {"5.05", "10"})
    wall += std::string("11\n") + x +
            "\n21\n2\n31\n0\n12\n1\n22\n0\n32\n0\n13\n0\n23\n1\n33\n0\n74\n2\n41\n0.1\n41\n0\n75\n0\n74\n2\n41\n-0."
            "1\n41\n0\n75\n0\n";
  const std::size_t entities = text.find("ENTITIES\n") + 9;
  text.insert(entities, wall);
  const Scene scene = Scene::load(write("multiline.dxf", text));
  EXPECT_TRUE(blocked(scene, {8, 1, 1}, {8, 3, 1}));
  EXPECT_FALSE(blocked(without, {8, 1, 1}, {8, 3, 1}));
  EXPECT_TRUE(blocked(scene, {8, 1.95, 1}, {8, 1.85, 1})) << "its side is 0.1 m from its middle";
  EXPECT_FALSE(blocked(scene, {8, 1.85, 1}, {8, 1.5, 1}));
}

TEST_F(FloorPlanTest, AFolderHasAStoreyInEachFile) {
  std::filesystem::create_directory(folder_.path() / "house");
  write("house/0 ground.dxf", small_flat().str());
  write("house/1 first.dxf", small_flat(4, 1000).str());  // drawn in millimetres
  const Scene scene = Scene::load(folder_.path() / "house");
  expect_box(scene.bounds(), {-0.3, -0.3, 0}, {10.3, 6.3, 5.7});
  EXPECT_EQ(scene.rooms().size(), 6u);
  std::vector<std::string> storeys;
  for (const Room& room : scene.rooms()) {
    storeys.push_back(room.storey);
    EXPECT_NEAR(room.box.min.z, room.storey == "0 ground" ? 0 : 3, 1e-9);
  }
  EXPECT_EQ(std::ranges::count(storeys, "0 ground"), 3);
  EXPECT_EQ(std::ranges::count(storeys, "1 first"), 3);
  expect_note(scene, "1 first.dxf, 3.00 m up: floor plan: unit mm");
  write("house/scan.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  expect_error(Errc::malformed_file, "give files of one format", [&] { Scene::load(folder_.path() / "house"); });
  write("house/2.dxf", "nothing");
  expect_error(Errc::malformed_file, "2.dxf", [&] { Scene::load(folder_.path() / "house"); });
}

// Walls of 0.3 m around 8 × 5 m from (0, 0), with a door in the south wall, and a straight stair along the north wall:
// `lines` lines of treads from x = 2 on, with a word at that end.
DrawingText hall_with_stair(int lines, const std::string& word, bool door) {
  DrawingText drawing;
  drawing.rectangle("A-WALL", -0.3, -0.3, 8.3, 5.3);
  drawing.rectangle("A-WALL", 0, 0, 8, 5);
  if (door) drawing.arc("A-DOOR", 5, 0, 0.9, 90, 180), drawing.line("A-DOOR", 5, 0, 5, 0.9);
  for (int k = 0; k < lines; ++k) drawing.line("A-FLOR-STRS", 2 + 0.27 * k, 4, 2 + 0.27 * k, 5);
  if (!word.empty()) drawing.text("A-ANNO", 1.9, 4.5, word);
  drawing.text("A-ANNO", 3, 2, "HALL");
  return drawing;
}

std::filesystem::path two_halls(const std::filesystem::path& folder, int lines, const std::string& word) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "0.dxf") << hall_with_stair(lines, word, true).str();
  std::ofstream(folder / "1.dxf") << hall_with_stair(lines, "", false).str();
  return folder;
}

// Parts of the floor that no path leads to, planned or not.
std::size_t not_entered(const Scene& scene) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  Site site = test::site_of(Simulator(scene, scanner, {.engine = Engine::embree, .user_size_m = 0.3}));
  return site.area().not_entered().size() + site.area().entered().size();
}

TEST_F(FloorPlanTest, StairsLinkStoreys) {
  const Scene scene = Scene::load(two_halls(folder_.path() / "halls", 16, "UP"));
  expect_note(scene, "0.dxf, 0.00 m up: stairs from 2.00,4.50 to the storey above, in risers of 18.8 cm");
  EXPECT_EQ(notes_of(scene).find("assumed"), std::string::npos) << notes_of(scene);
  EXPECT_FALSE(blocked(scene, {3, 4.5, 2}, {3, 4.5, 4})) << "the slab is open";
  EXPECT_TRUE(blocked(scene, {3, 2.5, 2}, {3, 2.5, 4}));
  EXPECT_TRUE(blocked(scene, {2.4, 4.5, 0.5}, {2.4, 4.5, 0.3})) << "the second step, 37.5 cm high";
  EXPECT_FALSE(blocked(scene, {2.4, 4.5, 0.5}, {2.4, 4.5, 0.4}));
  EXPECT_TRUE(blocked(scene, {5.9, 4.5, 3}, {5.9, 4.5, 2.7})) << "the last one";
  EXPECT_EQ(not_entered(scene), 0u);
  // The other way, by another word.
  const Scene down = Scene::load(two_halls(folder_.path() / "down", 16, "DN"));
  EXPECT_TRUE(blocked(down, {2.1, 4.5, 3}, {2.1, 4.5, 2.7}));
  EXPECT_EQ(not_entered(down), 0u);
  expect_note(Scene::load(two_halls(folder_.path() / "no word", 16, "")), "which end is the lower one is assumed");
}

TEST_F(FloorPlanTest, StairsThatNobodyClimbsAreTold) {
  const Scene scene = Scene::load(two_halls(folder_.path() / "halls", 8, "UP"));
  expect_note(scene, "are not made: 8 risers would be 38 cm high; enter the storey above with the setting enter");
  EXPECT_TRUE(blocked(scene, {3, 4.5, 2}, {3, 4.5, 4}));
  EXPECT_GT(not_entered(scene), 0u);
  expect_note(load(hall_with_stair(16, "UP", true)), "1 flight of stairs left out");
}

TEST_F(FloorPlanTest, TwoFlightsTurnOnTheirLanding) {
  std::filesystem::create_directories(folder_.path() / "well");
  for (const char* name : {"0.dxf", "1.dxf"}) {
    DrawingText drawing;
    drawing.rectangle("A-WALL", -0.3, -0.3, 2.8, 6.3);
    drawing.rectangle("A-WALL", 0, 0, 2.5, 6);
    drawing.arc("A-DOOR", 1.7, 0, 0.9, 90, 180), drawing.line("A-DOOR", 1.7, 0, 1.7, 0.9);
    for (int k = 0; k < 8; ++k)
      for (const double x : {0.1, 1.3}) drawing.line("STAIRS", x, 2.4 + 0.28 * k, x + 1.1, 2.4 + 0.28 * k);
    drawing.text("A-ANNO", 1.2, 1.2, "STAIRWELL");
    write(std::string("well/") + name, drawing.str());
  }
  const Scene scene = Scene::load(folder_.path() / "well");
  expect_note(scene, "to the storey above, in risers of 18.8 cm");
  EXPECT_TRUE(blocked(scene, {1.25, 5, 1.6}, {1.25, 5, 1.4})) << "the landing, 1.5 m up";
  EXPECT_FALSE(blocked(scene, {1.25, 5, 1.6}, {1.25, 5, 4})) << "and nothing over it";
  EXPECT_EQ(not_entered(scene), 0u);
}

// A room is entered, or captured from its door nearly as well as the whole.
TEST_F(FloorPlanTest, DefaultPlanCapturesEveryRoom) {
  const Scene scene = load(small_flat());
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.6);
  Site site =
      test::site_of(Simulator(scene, scanner, {.engine = Engine::embree, .user_size_m = 0.3, .point_spacing_m = 0.1}));
  Simulator& simulator = site.simulator();
  EXPECT_TRUE(site.area().not_entered().empty());
  const PlanResult result = plan(site, fewest_stations(), {.iterations = 0, .sample_voxels = 4000});
  EXPECT_TRUE(met(result));
  const PlanEntry& entry = result.front[answer(result)];
  const auto within = [](const Room& room, const Vec3& p) {
    return p.x > room.box.min.x && p.x < room.box.max.x && p.y > room.box.min.y && p.y < room.box.max.y;
  };
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(to_network(entry.stations), {.overlap = false, .field = &field});
  constexpr double kRoomShare = 0.7;
  for (const Room& room : scene.rooms()) {
    const bool entered =
        std::ranges::any_of(entry.stations, [&](const PlacedStation& station) { return within(room, station.ground); });
    double sum = 0, count = 0;
    for (std::uint64_t v = 0; v < simulator.voxel_count(); ++v)
      if (within(room, simulator.voxel_centre(v)))
        sum += std::min(1.0, field.count[v] / simulator.goal_density()), ++count;
    EXPECT_GT(count, 100) << room.name;
    EXPECT_TRUE(entered || sum >= kRoomShare * count * coverage(counts, simulator.goal_density())) << room.name;
  }
}

TEST_F(FloorPlanTest, DamagedFilesGiveASceneOrOneError) {
  const std::string whole = small_flat(4, 1000).str();
  std::mt19937 random(20'26);
  int cut = 0, scenes = 0;
  for (int k = 0; k < 40; ++k) {
    std::string content = whole;
    if (k % 3 == 0)
      content.resize(random() % content.size());
    else  // one bit; more are nearly always told
      content[random() % content.size()] ^= static_cast<char>(1U << (random() % 8));
    const auto file = write(std::to_string(k) + ".dxf", content);
    try {
      load_within(file, 5);
      ++scenes;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(file.string()), 0u) << message;
      EXPECT_TRUE(error.code() == Errc::malformed_file || error.code() == Errc::out_of_memory) << message;
      EXPECT_EQ(message.find("crashed"), std::string::npos) << message;
      cut += message.find("the file is truncated: its end (EOF) is missing") != std::string::npos;
    }
  }
  EXPECT_GT(cut, 5);
  EXPECT_GT(scenes, 5);
}

}  // namespace
}  // namespace vantage::test
