// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "ifc_house.hpp"
#include "import/import.hpp"
#include "import_fixture.hpp"
#include "vantage/export.hpp"
#include "vantage/missed.hpp"
#include "vantage/scene.hpp"
#include "vantage/site.hpp"
#include "vantage/summary.hpp"

namespace vantage::test {
namespace {

class IfcTest : public ImportTest {
 protected:
  // The importer's output, as JSON.
  nlohmann::json document(const std::filesystem::path& file) const {
    const auto glb = importers::as_glb(file, *importers::recognise(file).format);
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, sizeof length);
    return nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + length);
  }
};

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const MeshInfo& mesh : scene.meshes()) {
    const std::string name = mesh.name.substr(0, mesh.name.rfind(' '));  // without the GlobalId
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

bool has_note(const Scene& scene, const std::string& words) {
  return std::ranges::any_of(scene.notes(),
                             [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string summary_text_of(const std::vector<SummaryLine>& lines) {
  std::string text;
  for (const SummaryLine& line : lines) text += line.heading + ": " + line.text + "\n";
  return text;
}

void expect_house(const Scene& scene, const Vec3& at) {
  const Box box = scene.bounds();
  const Vec3 low = box.min - at, high = box.max - at;
  constexpr double kClose = 1e-3;
  EXPECT_NEAR(low.x, 0, kClose);
  EXPECT_NEAR(low.y, 0, kClose);
  EXPECT_NEAR(low.z, -0.2, kClose);
  EXPECT_NEAR(high.x, 8.6, kClose);
  EXPECT_NEAR(high.y, 4.4, kClose);
  EXPECT_NEAR(high.z, 2.7, kClose);
}

TEST_F(IfcTest, ProductsAreNodesByClassNameAndIdBelowTheirStorey) {
  const auto json = document(write("house.ifc", ifc_house()));
  const auto named = [&](const std::string& name) {
    const auto found = std::ranges::find_if(json["nodes"], [&](const auto& node) {
      return node["name"].template get<std::string>().starts_with(name + " 0Vantage");
    });
    if (found == json["nodes"].end()) throw std::runtime_error("no node " + name);
    return found;
  };
  const auto is_child = [&](const std::string& parent, const std::string& child) {
    const auto index = named(child) - json["nodes"].begin();
    return std::ranges::count((*named(parent))["children"], nlohmann::json(index)) == 1;
  };
  EXPECT_TRUE(is_child("IfcProject Two rooms", "IfcSite Meadow"));
  EXPECT_TRUE(is_child("IfcSite Meadow", "IfcBuilding House"));
  EXPECT_TRUE(is_child("IfcBuilding House", "IfcBuildingStorey Ground floor"));
  for (const char* product :
       {"IfcWall south", "IfcSlab floor", "IfcDoor inner", "IfcWindow view", "IfcStair stair", "IfcSpace 1"})
    EXPECT_TRUE(is_child("IfcBuildingStorey Ground floor", product)) << product;
  EXPECT_TRUE(is_child("IfcStair stair", "IfcStairFlight flight"));
  const auto& wall = (*named("IfcWall south"))["extras"]["vantage"];
  EXPECT_EQ(wall["class"], "IfcWall");
  EXPECT_EQ(wall["name"], "south");
  EXPECT_EQ(wall["id"].get<std::string>().size(), 22u);
  EXPECT_EQ(json["asset"]["extras"]["notes"].size(), 0u);
}

TEST_F(IfcTest, RoomsHaveNameBoxAndOutline) {
  const auto json = document(write("house.ifc", ifc_house()));
  std::size_t rooms = 0;
  for (const auto& node : json["nodes"]) {
    const auto& room = node["extras"]["vantage"];
    if (room.value("class", "") != "IfcSpace") continue;
    ++rooms;
    EXPECT_FALSE(node.contains("mesh"));
    const bool kitchen = room["long_name"] == "Kitchen";
    const double x = kitchen ? 0.2 : 4.4;
    const double wanted[2][3] = {{x, 0, -4.2}, {x + 4, 2.5, -0.2}};  // Y up
    for (std::size_t corner = 0; corner < 2; ++corner)
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(room["box"][corner][c].get<double>(), wanted[corner][c], 1e-6);
    ASSERT_EQ(room["footprint"].size(), 1u);
    const auto& loop = room["footprint"][0];
    ASSERT_EQ(loop.size(), 4u);
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i)
      area += loop[i][0].get<double>() * loop[(i + 1) % 4][1].get<double>() -
              loop[(i + 1) % 4][0].get<double>() * loop[i][1].get<double>();
    EXPECT_NEAR(std::abs(area) / 2, 16, 1e-5);
  }
  EXPECT_EQ(rooms, 2u);
}

TEST_F(IfcTest, RoomsOfASceneHaveTheirStorey) {
  const Scene scene = Scene::load(write("house.ifc", ifc_house()));
  ASSERT_EQ(scene.rooms().size(), 2u);
  const Room& kitchen = scene.rooms()[0];
  EXPECT_EQ(kitchen.name, "1 Kitchen");
  EXPECT_EQ(kitchen.storey, "Ground floor");
  EXPECT_NEAR(floor_area(kitchen), 16, 1e-3);
  EXPECT_EQ(room_at(scene.rooms(), {4.19, 2, 1}), 0u);
  EXPECT_EQ(room_at(scene.rooms(), {4.41, 2, 1}), 1u);
}

// Rooms are captured one by one, and the one behind a closed door says so.
TEST_F(IfcTest, CapturedByRoom) {
  const auto judged = [&](SiteOptions options) {
    options.engine = Engine::embree;
    options.steps = {Angle::degrees(0.5), Angle::degrees(0.5)};
    options.user_size_m = 0.2, options.spacing_m = 0.05;
    Site site = Site::open(folder_ / "house.ifc", std::move(options));
    const std::vector<PlacedStation> stations{site.place_head({2, 2, 1.6}).station};
    const Evaluation found = site.evaluate(stations, {.field = true});
    const MissedVoxels missed = missed_voxels(site, found.field);
    write_rooms_csv(folder_ / "rooms.csv", site.scene().rooms(), missed.rooms, stations, {});
    return std::pair(missed.rooms, summary_text_of(ground_lines(site.scene(), site.area(), stations)));
  };
  write("house.ifc", ifc_house());
  const auto [open, nothing] = judged({.enter = {{1, 1, 0}}});
  ASSERT_EQ(open.size(), 2u);
  EXPECT_EQ(nothing.find("closed"), std::string::npos) << nothing;
  EXPECT_GT(open[0].share.voxels, 500u);
  EXPECT_GT(open[0].share.share(WhyMissed::captured), open[1].share.share(WhyMissed::captured) + 0.3);
  EXPECT_NEAR(open[0].ground_m2, 10, 4) << "16 m² without what is too near to walls and cupboards";
  EXPECT_EQ(why_no_station(open[1]), "no place in it was chosen");
  std::string table = content(folder_ / "rooms.csv");
  EXPECT_NE(table.find("\nGround floor,1 Kitchen,16.00,"), std::string::npos) << table;
  EXPECT_NE(table.find(",S1,,"), std::string::npos) << table;
  EXPECT_NE(table.find(",,no place in it was chosen,"), std::string::npos) << table;

  const auto [shut, told] = judged({.scene = {.doors = {"closed"}}, .enter = {{1, 1, 0}}});
  EXPECT_EQ(why_no_station(shut[1]), to_string(LeftOutReason::sealed));
  EXPECT_EQ(shut[1].ground_m2, 0);
  EXPECT_EQ(shut[1].share.share(WhyMissed::captured), 0);
  EXPECT_NE(told.find("behind a closed door: not reached; plan it too with ignore 'IfcDoor inner 0Vantage"),
            std::string::npos)
      << told;
  // The advice opens it.
  const std::string door = told.substr(told.find('\'') + 1, told.rfind('\'') - told.find('\'') - 1);
  const std::string opened = judged({.scene = {.ignore = {door}, .doors = {"closed"}}, .enter = {{1, 1, 0}}}).second;
  EXPECT_EQ(opened.find("closed"), std::string::npos) << opened;
}

TEST_F(IfcTest, DoorsAreOpenAndOpeningsAndSpacesAreNoBodies) {
  const auto file = write("house.ifc", ifc_house());
  const Scene open = Scene::load(file);
  const std::vector<std::string> wanted{
      "IfcFurniture cupboard", "IfcSlab ceiling", "IfcSlab floor", "IfcStairFlight flight", "IfcWall east",
      "IfcWall middle",        "IfcWall north",   "IfcWall south", "IfcWall west",          "IfcWindow view"};
  EXPECT_EQ(names_of(open), wanted);
  EXPECT_TRUE(has_note(open, "2 doors are taken as open, their leaves left out: \"IfcDoor front 0Vantage"));
  const std::size_t leaf = 12;  // triangles of a box
  const Scene closed = Scene::load(file, {.doors = {"closed"}});
  EXPECT_EQ(closed.triangle_count(), open.triangle_count() + 2 * leaf);
  EXPECT_FALSE(has_note(closed, "taken as open"));
  // Those that a pattern names are as it says.
  const auto names = names_of(Scene::load(file, {.blocking = {"IfcDoor front*"}}));
  EXPECT_EQ(std::ranges::count(names, "IfcDoor front"), 1);
  EXPECT_EQ(std::ranges::count(names, "IfcDoor inner"), 0);
  const Scene passable = Scene::load(file, {.doors = {"IfcDoor*"}});
  EXPECT_EQ(passable.triangle_count(), closed.triangle_count());
  EXPECT_EQ(std::ranges::count(passable.meshes(), true, &MeshInfo::door), 2);
}

TEST_F(IfcTest, PatternsNameClasses) {
  const Scene scene = Scene::load(write("house.ifc", ifc_house()), {.surveyed = {"IfcWall*"}});
  for (const MeshInfo& mesh : scene.meshes())
    EXPECT_EQ(mesh.role, mesh.name.starts_with("IfcWall") ? Role::surveyed : Role::blocking) << mesh.name;
}

TEST_F(IfcTest, GlassIsMarkedAndEqualProductsShareAMesh) {
  const auto json = document(write("house.ifc", ifc_house()));
  const auto glass = std::ranges::find(json["materials"], "glass", [](const auto& m) { return m["name"]; });
  ASSERT_NE(glass, json["materials"].end());
  EXPECT_EQ((*glass)["alphaMode"], "BLEND");
  EXPECT_NEAR((*glass)["extensions"]["KHR_materials_transmission"]["transmissionFactor"].get<double>(), 0.8, 1e-6);
  const auto index = glass - json["materials"].begin();
  std::vector<int> cupboards;
  for (const auto& node : json["nodes"]) {
    if (!node.contains("mesh")) continue;
    const auto name = node["name"].get<std::string>();
    if (name.starts_with("IfcFurniture")) cupboards.push_back(node["mesh"]);
    for (const auto& primitive : json["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
      EXPECT_TRUE(primitive.value("material", -1) != index || name.starts_with("IfcWindow")) << name;
  }
  ASSERT_EQ(cupboards.size(), 2u);
  EXPECT_EQ(cupboards[0], cupboards[1]);
  const Scene scene = Scene::load(write("house.ifc", ifc_house()));
  EXPECT_EQ(std::ranges::count(scene.meshes(), true, &MeshInfo::glass), 1);
  EXPECT_TRUE(scene.meshes().back().glass && scene.meshes().back().name.starts_with("IfcWindow"));
  EXPECT_TRUE(has_note(scene, "m² of glass"));
}

TEST_F(IfcTest, VersionsUnitsAndOriginsGiveTheSameHouse) {
  for (const IfcVersion version : {IfcVersion::ifc2x3, IfcVersion::ifc4})
    for (const IfcUnit unit : {IfcUnit::metre, IfcUnit::millimetre, IfcUnit::foot}) {
      const Vec3 at = unit == IfcUnit::metre ? Vec3{0, 0, 0} : Vec3{512'345, 5'412'345, 123};
      const Scene scene = Scene::load(write("house.ifc", ifc_house({version, unit, at})));
      expect_house(scene, at);
      EXPECT_EQ(names_of(scene).size(), 10u);
      EXPECT_FALSE(has_note(scene, "lengths are taken")) << "the file says its unit";
    }
}

TEST_F(IfcTest, HoleOfTheDoorIsCutOutOfTheWall) {
  // A wall of 8.6 x 2.5 m with holes of 1 x 2.1 and 1.5 x 1.2 m has 17.6 m² to the south.
  const auto file = write("house.ifc", ifc_house());
  const auto json = document(file);
  const auto wall = std::ranges::find_if(json["nodes"], [](const auto& node) {
    return node["name"].template get<std::string>().starts_with("IfcWall south");
  });
  const auto& accessors = json["accessors"];
  const auto& primitive = json["meshes"][(*wall)["mesh"].get<std::size_t>()]["primitives"][0];
  EXPECT_GT(accessors[primitive["indices"].get<std::size_t>()]["count"].get<int>(), 36);  // a box without holes
}

TEST_F(IfcTest, WhatHasNoShapeIsRefused) {
  std::string text = ifc_house();
  const auto nothing = write("nothing.ifc", text.substr(0, text.find("DATA;") + 6) + "ENDSEC;\nEND-ISO-10303-21;\n");
  expect_error(Errc::malformed_file, "nothing.ifc: it cannot be read as IFC", [&] { Scene::load(nothing); });
  const auto unknown =
      write("unknown.ifc", "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC9'));\nENDSEC;\nDATA;\nENDSEC;\n");
  expect_error(Errc::malformed_file, "unknown.ifc: it cannot be read as IFC", [&] { Scene::load(unknown); });
}

// Text of a house with a map conversion at its end.
std::string mapped_house(const IfcHouse& house = {}) {
  std::string text = ifc_house(house);
  text.insert(text.rfind("ENDSEC;"),
              "#9001=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
              "#9002=IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,#9001);\n"
              "#9003=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,$,$);\n"
              "#9004=IFCMAPCONVERSION(#9003,#9002,500000.,5400000.,120.,1.,0.,0.001);\n");
  return text;
}

TEST_F(IfcTest, MapConversionsReachTheSitesCoordinateSystem) {
  const auto file = write("house.ifc", mapped_house());
  const Site site = Site::open(file, SiteOptions{});
  expect_house(site.scene(), {500'000, 5'400'000, 120});
  EXPECT_EQ(site.crs(), "EPSG:25832");
  EXPECT_EQ(Site::open(file, {.crs = "EPSG:25833"}).crs(), "EPSG:25833") << "what is given goes first";
  EXPECT_TRUE(has_note(site.scene(), "EPSG:25832"));
  ASSERT_EQ(site.scene().rooms().size(), 2u);
  EXPECT_NEAR(site.scene().rooms()[0].box.min.y, 5'400'000.2, 1e-3);
}

TEST_F(IfcTest, SeveralFilesAreOneSite) {
  const auto first = write("both/a.ifc", ifc_house());
  const auto second = write("both/b.ifc", ifc_house({IfcVersion::ifc2x3, IfcUnit::metre, {20, 0, 0}}));
  const Scene one = Scene::load(first), folder = Scene::load(first.parent_path());
  const Scene both = Scene::load(first, {.beside = {second.string()}});
  // Products of one GlobalId are one product: the second house is the first one.
  EXPECT_EQ(both.triangle_count(), one.triangle_count());
  EXPECT_EQ(folder.triangle_count(), one.triangle_count());
  EXPECT_TRUE(has_note(both, "in another file of the site, too"));
  std::string other = ifc_house({IfcVersion::ifc4, IfcUnit::metre, {20, 0, 0}});
  for (std::size_t at = 0; (at = other.find("'0Vantage", at)) != std::string::npos; ++at) other[at + 1] = '1';
  write("both/b.ifc", other);
  const Scene two = Scene::load(first.parent_path());
  EXPECT_EQ(two.triangle_count(), 2 * one.triangle_count());
  EXPECT_NEAR(two.bounds().max.x, 28.6, 1e-3);
  const auto drawing = write("plan.glb", "glTF");
  expect_error(Errc::invalid_argument, "several files are one site if",
               [&] { Scene::load(first, {.beside = {drawing.string()}}); });
}

TEST_F(IfcTest, UnitsAreAskedAndAnswered) {
  std::string text = ifc_house();
  const auto at = text.find("IFCUNITASSIGNMENT");
  const auto hash = text.rfind('#', at);
  const std::string units = text.substr(hash, text.find('=', hash) - hash);
  text.replace(text.find("," + units + ")"), units.size() + 1, ",$");
  const auto file = write("house.ifc", text);
  const std::string asked = expect_error(Errc::malformed_file, "it states no unit of length; give the setting unit",
                                         [&] { Scene::load(file); });
  EXPECT_NE(asked.find("mm for millimetres (8.60 x 4.40 x 2.90 m)"), std::string::npos) << asked;
  expect_house(Scene::load(file, {.unit = Unit::millimetre}), {0, 0, 0});
}

TEST_F(IfcTest, TheDraftOfIfc5IsNamed) {
  const auto file = write("house.ifcx", R"({"header": {"id": "house", "ifcxVersion": "ifcx_alpha"}, "data": []})");
  expect_error(Errc::malformed_file, "this is IFC 5 (ifcx)", [&] { Scene::load(file); });
}

TEST_F(IfcTest, DamagedOnesGiveASceneOrOneError) {
  const std::string sound = ifc_house();
  std::mt19937 random(20'26);
  for (int k = 0; k < 12; ++k) {
    std::string text = sound;
    if (k % 3 == 0)
      text.resize(random() % text.size());
    else
      for (int flips = 0; flips < 20; ++flips) text[random() % text.size()] ^= static_cast<char>(1U << (random() % 7));
    const auto file = write(std::to_string(k) + ".ifc", text);
    try {
      load_within(file, 5);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(file.string()), 0u) << error.what();
      EXPECT_EQ(error.code(), Errc::malformed_file) << error.what();
    }
  }
}

}  // namespace
}  // namespace vantage::test
