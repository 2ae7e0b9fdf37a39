// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "program.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

class ImportCommandTest : public ProgramTest {
 protected:
  ImportCommandTest() {
    setenv("XDG_CACHE_HOME", path("cache").c_str(), 1);
    write("site.obj", "o wall\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nf 1 2 3 4\no floor\nv 0 0 4\nf 1 2 5\n");
  }
  ~ImportCommandTest() override { unsetenv("XDG_CACHE_HOME"); }
};

TEST_F(ImportCommandTest, WritesAGlb) {
  const auto json = json_of({"import", path("site.obj"), "-o", path("site.glb")});
  EXPECT_EQ(json["format"], "OBJ");
  EXPECT_EQ(json["triangles"], 3);
  EXPECT_EQ(json["meshes"], 2);
  const Scene scene = Scene::load(path("site.glb"));
  EXPECT_EQ(scene.triangle_count(), 3u);
  EXPECT_EQ(scene.meshes()[0].name, "wall");
  EXPECT_EQ(scene.bounds().max.z, 3);  // Y up in both
}

TEST_F(ImportCommandTest, TakesTheUnitAndTheAxisAndWritesMetres) {
  write("plan.obj",
        "o wall\nv 0 0 0\nv 4000 0 0\nv 4000 0 3000\nv 0 0 3000\nf 1 2 3 4\no floor\nv 0 5000 0\nf 1 2 5\n");
  json_of({"import", path("plan.obj"), "--unit", "mm", "--up", "z", "-o", path("plan.glb")});
  const Scene scene = Scene::load(path("plan.glb"));
  EXPECT_NEAR(scene.bounds().max.x, 4, 1e-6);
  EXPECT_NEAR(scene.bounds().max.y, 5, 1e-6);
  EXPECT_NEAR(scene.bounds().max.z, 3, 1e-6);
  json_of({"import", path("plan.obj"), "--unit", "cm", "--up", "x", "-o", path("turned.glb")});
  const Scene turned = Scene::load(path("turned.glb"));
  EXPECT_NEAR(turned.bounds().max.z, 40, 1e-6);
  EXPECT_NEAR(turned.bounds().min.x, -50, 1e-6);
}

TEST_F(ImportCommandTest, OtherCommandsTakeModelsAsTheyAre) {
  const auto json = json_of({"scan", path("site.obj"), "--station", "2,-2,1.5", "--step", "2", "--engine", "embree"});
  EXPECT_GT(json["points"].get<int>(), 0);
}

TEST_F(ImportCommandTest, SaysWhatItWants) {
  expect_refused(run_program({"import", path("site.obj")}), 2, "no file to write");
  expect_refused(run_program({"import"}), 2, "no model given");
  expect_refused(run_program({"import", scene_, "-o", path("out.glb")}), 2, "is glTF already");
  write("cloud.xyz", "1 2 3\n4 5 6\n");
  expect_refused(run_program({"import", path("cloud.xyz"), "-o", path("out.glb")}), 1, "too thin for surfaces");
  expect_refused(run_program({"import", path("none.obj"), "-o", path("out.glb")}), 1, "none.obj");
}

// A room of 6 x 4 x 2.5 m with a box in it, Y up.
constexpr const char* kRoom =
    "v 0 0 0\nv 6 0 0\nv 6 0 -4\nv 0 0 -4\nv 0 2.5 0\nv 6 2.5 0\nv 6 2.5 -4\nv 0 2.5 -4\n"
    "v 2.6 0 -1.6\nv 3.4 0 -1.6\nv 3.4 0 -2.4\nv 2.6 0 -2.4\nv 2.6 1 -1.6\nv 3.4 1 -1.6\nv 3.4 1 -2.4\nv 2.6 1 -2.4\n"
    "o floor\nf 1 2 3 4\no ceiling\nf 5 8 7 6\no walls\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
    "o box\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\nf 13 14 15 16\n";

TEST_F(ImportCommandTest, AScanOfARoomIsPlannedAsTheRoom) {
  write("room.obj", kRoom);
  json_of({"scan",    path("room.obj"), "--unit",  "m",      "--up", "y",       "--station", "1,1,1.6",  "--station",
           "5,3,1.6", "--station",      "1,3,1.6", "--step", "0.4",  "--noise", "rtc360",    "--engine", "embree",
           "-o",      path("room.e57")});
  json_of({"import", path("room.e57"), "-o", path("room.glb")});
  const Scene scene = Scene::load(path("room.glb"));
  EXPECT_NEAR(scene.bounds().min.z, 0, 0.05);
  EXPECT_NEAR(scene.bounds().max.x, 6, 0.05);
  const auto front = json_of({"plan", path("room.e57"), "--step", "1", "--engine", "embree", "--no-report", "-o",
                              path("plan"), "--iterations", "2"});
  const auto& stations = front["front"][0]["stations"];
  ASSERT_GT(stations.size(), 0u);
  for (const auto& station : stations) {
    const auto ground = station["ground"].get<std::array<double, 3>>();
    EXPECT_NEAR(ground[2], 0, 0.02);
    EXPECT_TRUE(ground[0] > 0 && ground[0] < 6 && ground[1] > 0 && ground[1] < 4);
    EXPECT_FALSE(ground[0] > 2.6 && ground[0] < 3.4 && ground[1] > 1.6 && ground[1] < 2.4) << "on the box";
  }
  // Cells of another size, by hand.
  const Outcome coarse = run_program({"import", path("room.e57"), "--cell", "0.15", "-o", path("coarse.glb")});
  EXPECT_EQ(coarse.exit_code, 0) << coarse.err;
  EXPECT_NE(coarse.err.find("cells of 15 cm"), std::string::npos) << coarse.err;
  EXPECT_NEAR(Scene::load(path("coarse.glb")).bounds().max.x, 6, 0.1);
  expect_refused(run_program({"import", path("room.obj"), "--cell", "0.1", "-o", path("no.glb")}), 2,
                 "--cell is for point clouds, and this is OBJ");
  // The scans are the stations of another plan.
  const auto more =
      json_of({"plan", path("room.obj"), "--unit", "m", "--up", "y", "--keep-from", path("room.e57"), "--step", "1",
               "--engine", "embree", "--no-report", "-o", path("more"), "--stations", "1", "--iterations", "2"});
  const auto& all = more["front"][0]["stations"];
  ASSERT_EQ(all.size(), 4u);
  EXPECT_TRUE(all[2]["existing"].get<bool>() && !all[3]["existing"].get<bool>());
  EXPECT_EQ(all[1]["position"], (nlohmann::json{5.0, 3.0, 1.6}));
  // Keeps the file's names and steps; new stations are numbered on from there.
  EXPECT_EQ(all[0]["name"], "S1");
  EXPECT_EQ(all[3]["name"], "S4");
  EXPECT_NEAR(all[1]["step"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(all[3]["step"].get<double>(), 1, 1e-9);
  // And again from its results.
  const auto again = json_of({"evaluate", path("room.obj"), "--unit", "m", "--up", "y", "--step", "1", "--engine",
                              "embree", "--stations", path("more") + "/front.json"});
  EXPECT_EQ(again["coverage"], more["front"][0]["exact"]["coverage"]);
}

// A room of 8 × 6 × 2.8 m, a point every 10 cm; each line by `line`.
template <class Line>
std::string room_text(Line&& line) {
  std::string text;
  const auto add = [&](double x, double y, double z) { text += line(x, y, z) + "\n"; };
  const auto each = [](double to, auto&& visit) {
    for (double at = 0.05; at < to; at += 0.1) visit(at);
  };
  each(8, [&](double x) { each(6, [&](double y) { add(x, y, 0), add(x, y, 2.8); }); });
  each(8, [&](double x) { each(2.8, [&](double z) { add(x, 0, z), add(x, 6, z); }); });
  each(6, [&](double y) { each(2.8, [&](double z) { add(0, y, z), add(8, y, z); }); });
  return text;
}

TEST_F(ImportCommandTest, TakesColumnsUnitAndAxisOfPointsInText) {
  const auto with = [](char decimal, const char* format) {
    return [=](double a, double b, double c) {
      char text[128];
      std::snprintf(text, sizeof text, format, a, b, c);
      std::string out = text;
      std::ranges::replace(out, '.', decimal);
      return out;
    };
  };
  const auto expect_room = [&](const std::string& text, const std::vector<std::string>& options) {
    write("room.csv", text);
    std::vector<std::string> words{"import", path("room.csv"), "-o", path("room.glb")};
    words.insert(words.end(), options.begin(), options.end());
    json_of(words);
    const Box box = Scene::load(path("room.glb")).bounds();
    EXPECT_NEAR(box.size().x, 8, 0.5);
    EXPECT_NEAR(box.size().y, 6, 0.5);
    EXPECT_NEAR(box.size().z, 2.8, 0.5);
  };
  const auto plain = with('.', "%.2f %.2f %.2f"), comma = with(',', "7;%.2f;%.2f;%.2f");
  expect_room(room_text(plain), {});
  expect_room(room_text([&](double x, double y, double z) { return plain(z, y, x); }), {"--columns", "z,y,x"});
  expect_room(room_text([&](double x, double y, double z) { return comma(y, x, z); }), {"--columns", "-;y;x;z"});
  expect_room(room_text([&](double x, double y, double z) { return comma(1000 * x, 1000 * z, -1000 * y); }),
              {"--columns", "-,x,y,z", "--unit", "mm", "--up", "y"});
  expect_room("no,height,north,east\n" +
                  room_text([&](double x, double y, double z) { return with('.', "1,%.2f,%.2f,%.2f")(z, y, x); }),
              {});
  // The import refuses an unclear unit with a question, and leaves no file.
  write("turned.xyz", room_text([&](double x, double y, double z) { return plain(z, y, x); }));
  expect_refused(run_program({"import", path("turned.xyz"), "--columns", "x,y,z", "-o", path("none.glb")}), 1,
                 "turned.xyz: its unit");
  EXPECT_FALSE(std::filesystem::exists(path("none.glb")));
  expect_refused(run_program({"import", path("turned.xyz"), "--columns", "x,y,-,z", "-o", path("none.glb")}), 1,
                 "names column 4 z");
  expect_refused(run_program({"import", path("site.obj"), "--columns", "x,y,z", "-o", path("none.glb")}), 2,
                 "--columns is for points");
}

}  // namespace
}  // namespace vantage::test
