// SPDX-License-Identifier: Apache-2.0
// Sources of values: typed, configuration file, scene, preset, built in; in this order.
#include <fstream>

#include "program.hpp"
#include "vantage/scanner.hpp"

namespace vantage::test {
namespace {

class Layers : public ProgramTest {
 protected:
  // The options that a run resolves to.
  nlohmann::json options(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"evaluate",  scene_,    "--engine", "embree",
                                       "--station", "8,0,1.5", "--sample", "50"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json_of(arguments)["options"];
  }
};

TEST_F(Layers, TheSceneBringsItsOwnDefaults) {
  const auto resolved = options({});
  EXPECT_NEAR(resolved["step"][0].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(resolved["height"], 1.5);
  EXPECT_EQ(resolved["user-size"], 0.1);
  EXPECT_EQ(resolved["spacing"], 0.01);
  EXPECT_EQ(resolved["noise"], "off");
}

TEST_F(Layers, ConfigurationGoesBeforeTheScene) {
  write("config.json", R"({"height": 1.7, "step": [0.4, 0.5], "user_size": 0.2, "noise": "rtc360", "population": 8})");
  const auto resolved = options({"--config", path("config.json")});
  EXPECT_EQ(resolved["height"], 1.7);
  EXPECT_NEAR(resolved["step"][0].get<double>(), 0.4, 1e-12);
  EXPECT_NEAR(resolved["step"][1].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(resolved["user-size"], 0.2);
  EXPECT_EQ(resolved["spacing"], 0.01);  // still the scene's
  EXPECT_EQ(resolved["noise"], "rtc360");
}

TEST_F(Layers, WhatIsTypedGoesBeforeAll) {
  write("config.json", R"({"height": 1.7, "step": 0.4})");
  const auto resolved = options({"--config", path("config.json"), "--height", "1.9"});
  EXPECT_EQ(resolved["height"], 1.9);
  EXPECT_NEAR(resolved["step"][1].get<double>(), 0.4, 1e-12);
}

TEST_F(Layers, ANamedPresetGoesBeforeTheScene) {
  const auto resolved = options({"--scanner", "rtc360@12mm"});
  EXPECT_GT(std::abs(resolved["step"][0].get<double>() - 0.1), 0.01);
  EXPECT_EQ(resolved["range"][1], 130);
  EXPECT_EQ(resolved["height"], 1.5);  // no preset knows the tripod
  const auto overridden = options({"--scanner", "rtc360@12mm", "--step", "1"});
  EXPECT_NEAR(overridden["step"][0].get<double>(), 1, 1e-12);
}

TEST_F(Layers, OptionsThatNobodyKnowsAreRefused) {
  write("config.json", R"({"hight": 1.7})");
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--config", path("config.json")})), 2,
                 "hight");
  write("config.json", R"({"height": "tall"})");
  const Outcome outcome = run_program(coarse("evaluate", {"--station", "8,0,1.5", "--config", path("config.json")}));
  expect_refused(outcome, 2, "config.json");
  expect_refused(outcome, 2, "'tall'");
}

TEST_F(Layers, StationsMayComeFromAConfiguration) {
  write("config.json", R"({"station": [[8, 0, 1.5], [-8, 0, 1.5]]})");
  const auto result = json_of(coarse("evaluate", {"--config", path("config.json")}));
  EXPECT_EQ(result["stations"].size(), 2u);
}

TEST_F(Layers, ResolvedOptionsReproduceTheRun) {
  auto first = json_of(coarse("evaluate", {"--station", "8,0,1.5", "--noise", "rtc360", "--seed", "7"}));
  write("again.json", first["options"].dump());
  auto second =
      json_of({"evaluate", scene_, "--engine", "embree", "--station", "8,0,1.5", "--config", path("again.json")});
  first.erase("seconds");
  second.erase("seconds");
  EXPECT_EQ(first, second);
}

// Anyone may write a scene, so it must not name files of the user's.
TEST_F(Layers, ASceneReachesForNoFileUnlessTheUserSaysSo) {
  const TemporaryFolder elsewhere;
  const std::string buffer = elsewhere / "triangle.bin";
  const std::vector<float> corners{0, 0, 0, 10, 0, 0, 0, 10, 0};
  std::ofstream(buffer, std::ios::binary).write(reinterpret_cast<const char*>(corners.data()), 36);
  nlohmann::json scene = nlohmann::json::parse(R"({
    "asset": {"version": "2.0", "extras": {"vantage": {"allow-outside": true}}},
    "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}]})");
  scene["buffers"] = {{{"byteLength", 36}, {"uri", buffer}}};
  write("scene.gltf", scene.dump());
  const std::vector<std::string> evaluate{"evaluate",  path("scene.gltf"), "--engine", "embree",
                                          "--station", "5,-5,1.5",         "--step",   "1"};
  expect_refused(run_program(evaluate), 1, "setting allow-outside");
  auto allowed = evaluate;
  allowed.push_back("--allow-outside");
  EXPECT_EQ(run_program(allowed).exit_code, 0);
  write("config.json", R"({"allow-outside": true})");
  auto configured = evaluate;
  configured.insert(configured.end(), {"--config", path("config.json")});
  EXPECT_EQ(json_of(configured)["options"]["allow-outside"], true);

  write("noise.csv", "reflectivity,10,20\n0.5,0.001,0.002\n");
  scene["asset"]["extras"]["vantage"] = {{"scanner", {{"noise", path("noise.csv")}}}};
  write("scene.gltf", scene.dump());
  expect_refused(run_program(allowed), 1, "noise.csv");
  allowed.insert(allowed.end(), {"--noise", path("noise.csv")});
  EXPECT_EQ(run_program(allowed).exit_code, 0);
}

// A scene without marks, larger than most sites, is measured by a person's lengths all the same.
TEST_F(Layers, LargeSitesStayInAPersonsLengths) {
  const std::string box = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "scale": [250, 250, 250]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/AAABAAIA"}]})";
  write("large.gltf", box);
  const std::vector<std::string> arguments{"evaluate",   path("large.gltf"), "--engine", "embree",   "--station",
                                           "125,-25,23", "--step",           "1",        "--sample", "10",
                                           "--json"};
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto resolved = nlohmann::json::parse(outcome.out)["options"];
  EXPECT_EQ(resolved["user-size"], 0.1);
  EXPECT_EQ(resolved["spacing"], 0.05);  // steps of 1° give 2.2 m at 125 m: half the user size, the widest
  EXPECT_EQ(resolved["height"], Scanner{}.height_m);
  EXPECT_EQ(resolved["range"][1], Scanner{}.max_range_m);
}

}  // namespace
}  // namespace vantage::test
