// SPDX-License-Identifier: Apache-2.0
// Results of scan, evaluate and the small commands.
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "program.hpp"
#include "vantage/simulator.hpp"

namespace vantage::test {
namespace {

const std::vector<std::string> four_heads{"--station", "8,0,1.5", "--station", "-8,0,1.5",
                                          "--station", "0,8,1.5", "--station", "0,-8,1.5"};

class Results : public ProgramTest {
 protected:
  std::vector<std::string> evaluate(const std::vector<std::string>& more) const {
    auto all = four_heads;
    all.insert(all.end(), more.begin(), more.end());
    return coarse("evaluate", all);
  }
};

TEST_F(Results, InfoListsEnginesAndScanners) {
  const auto info = json_of({"info"});
  bool embree = false;
  std::size_t chosen = 0;
  for (const auto& engine : info["engines"]) {
    embree |= engine["engine"] == "embree" && engine["usable"] == true;
    chosen += engine["chosen_by_default"] == true;
    EXPECT_NE(engine["reason"], "");
  }
  EXPECT_TRUE(embree);
  EXPECT_EQ(chosen, 1u);
  EXPECT_GE(info["scanners"].size(), 5u);
}

TEST_F(Results, GenerateGivesTheSameBytes) {
  const auto made = json_of({"generate", "three-walls", "-o", path("a.glb")});
  EXPECT_EQ(made["triangles"], 6);
  EXPECT_EQ(made["bytes"], read("a.glb").size());
  json_of({"generate", "three-walls", "-o", path("b.glb")});
  EXPECT_EQ(read("a.glb"), read("b.glb"));
}

TEST_F(Results, EvaluateHasItsKeys) {
  const auto result = json_of(evaluate({}));
  for (const char* key : {"coverage", "coverage_se", "overlap", "overlap_se", "overlap_matrix", "stations", "voxels",
                          "voxel_size", "goal_density", "rays", "sample", "seconds", "engine", "device"})
    EXPECT_TRUE(result.contains(key)) << key;
  EXPECT_GT(result["coverage"].get<double>(), 0.5);
  EXPECT_LE(result["coverage"].get<double>(), 1.0);
  EXPECT_EQ(result["coverage_se"], 0);
  EXPECT_EQ(result["overlap"], 0);  // each sees another wall
  EXPECT_EQ(result["overlap_matrix"].size(), 4u);
  EXPECT_TRUE(result["sample"].is_null());
  EXPECT_EQ(result["rays"], 4 * 360 * 150);
  EXPECT_EQ(result["engine"], "embree");
  ASSERT_EQ(result["stations"].size(), 4u);
  for (const auto& station : result["stations"]) {
    EXPECT_EQ(station["status"], "ok");
    EXPECT_GT(station["points"].get<std::uint64_t>(), 0u);
    EXPECT_GE(station["points"].get<std::uint64_t>(), station["points_on_surveyed"].get<std::uint64_t>());
    EXPECT_EQ(station["position"].size(), 3u);
    EXPECT_EQ(station["uv"].size(), 2u);
  }
}

TEST_F(Results, SkippingAndFullSamplesChangeNoCoverage) {
  const auto all = json_of(evaluate({"--exact"})), skipped = json_of(evaluate({"--skip"})),
             sampled = json_of(evaluate({"--sample", "100%"}));
  EXPECT_EQ(skipped["coverage"], all["coverage"]);
  EXPECT_EQ(skipped["overlap"], all["overlap"]);
  EXPECT_TRUE(skipped["stations"][0]["points"].is_null());
  EXPECT_EQ(skipped["stations"][0]["points_on_surveyed"], all["stations"][0]["points_on_surveyed"]);
  EXPECT_LT(skipped["rays"], all["rays"]);
  EXPECT_EQ(sampled["coverage"], all["coverage"]);
  EXPECT_EQ(sampled["coverage_se"], 0);
  EXPECT_EQ(sampled["sample"], all["voxels"]);
}

TEST_F(Results, PointsThatAreNotGoodEnoughAreToldByLimit) {
  const auto all = json_of(evaluate({})),
             good = json_of(evaluate({"--incidence", "40", "--detail", "*=15", "--beam", "0.5,6"}));
  EXPECT_TRUE(all["dropped"].is_null());
  EXPECT_TRUE(all["stations"][0]["dropped"].is_null());
  EXPECT_GT(good["dropped"]["incidence"], 0);
  EXPECT_EQ(good["dropped"]["noise"], 0);
  std::uint64_t dropped = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto lost = good["stations"][k]["dropped"]["points"].get<std::uint64_t>();
    EXPECT_EQ(good["stations"][k]["points_on_surveyed"].get<std::uint64_t>() + lost,
              all["stations"][k]["points_on_surveyed"]);
    dropped += lost;
  }
  EXPECT_EQ(good["dropped"]["points"], dropped);
  EXPECT_EQ(good["options"]["incidence"], 40);
  EXPECT_EQ(good["options"]["beam"][1], 6);
  EXPECT_TRUE(all["options"]["detail"].empty());
  const auto sampled =
      json_of(evaluate({"--incidence", "40", "--detail", "*=15", "--beam", "0.5,6", "--sample", "100%"}));
  EXPECT_EQ(sampled["coverage"], good["coverage"]);
  EXPECT_TRUE(sampled["dropped"].is_null());
}

TEST_F(Results, AWideBeamTellsItsMixedPoints) {
  const auto thin = json_of(evaluate({})), wide = json_of(evaluate({"--returns", "strongest", "--beam", "3,9"}));
  EXPECT_TRUE(thin["mixed"].is_null());
  EXPECT_TRUE(thin["stations"][0]["mixed"].is_null());
  std::uint64_t points = 0, counted = 0;
  for (const auto& station : wide["stations"]) {
    points += station["mixed"]["points"].get<std::uint64_t>();
    counted += station["mixed"]["counted"].get<std::uint64_t>();
    EXPECT_GT(station["points"], 0);
  }
  EXPECT_GT(points, 0u);
  EXPECT_EQ(wide["mixed"]["points"], points);
  EXPECT_EQ(wide["mixed"]["counted"], counted);
  EXPECT_LE(wide["mixed"]["wrong_voxel"].get<std::uint64_t>() + counted, points);
  EXPECT_EQ(wide["rays"], thin["rays"]);
  EXPECT_NEAR(wide["coverage"].get<double>(), thin["coverage"].get<double>(), 0.02);
  const auto headings = wide["summary"];
  EXPECT_TRUE(std::ranges::any_of(headings, [](const auto& line) { return line["heading"] == "mixed"; }));
  expect_refused(run_program(evaluate({"--returns", "strongest", "--beam", "3,9", "--sample", "100"})), 2, "every ray");
}

TEST_F(Results, NodesAreWantedAsDenselyAsTheirDetail) {
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"evaluate",    scene_,   "--engine", "embree",      "--step",
                                 "1",           "--beam", "0.5,6",    "--incidence", "90",
                                 "--user-size", "0.5",    "--detail", "wall-*=300"};
    all.insert(all.end(), four_heads.begin(), four_heads.end());
    all.insert(all.end(), more.begin(), more.end());
    return json_of(all);
  };
  const auto goal = [](const nlohmann::json& json, double detail_m) {
    return std::pow(json["voxel_size"].get<double>() / detail_m, 2);
  };
  // The scene brings a spacing of its own, which is that of all nodes unless it is said otherwise.
  const auto all = with({"--spacing", "0.1"}), one = with({"--spacing-by-detail"}),
             both = with({"--detail", "wall-south=100", "--spacing-by-detail"});
  EXPECT_NEAR(all["goal_density"], goal(all, 0.1), 1e-9);
  EXPECT_NEAR(one["goal_density"], goal(one, 0.3), 1e-9);
  EXPECT_NEAR(both["goal_density"], goal(both, 0.1), 1e-9);
  EXPECT_EQ(both["options"]["spacing-by-detail"], true);
  EXPECT_FALSE(all["options"].contains("spacing-by-detail"));
  // A wall of four is wanted more densely, then all.
  EXPECT_GT(one["coverage"], both["coverage"]);
  EXPECT_GT(both["coverage"], all["coverage"]);
}

TEST_F(Results, RegistrationMayGoByAllSurfaces) {
  // Two stations before one wall, which leaves their places along it free; the ground and other walls do not.
  const std::vector<std::string> heads{"--station", "8,0,1.5", "--station", "6,2,1.5", "--registration"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), heads.begin(), heads.end());
    return json_of(coarse("evaluate", more));
  };
  const auto surveyed = with({}), all = with({"--registration-surfaces", "all"});
  EXPECT_EQ(surveyed["registration"]["surfaces"], "surveyed");
  EXPECT_EQ(all["registration"]["surfaces"], "all");
  EXPECT_EQ(all["coverage"], surveyed["coverage"]);
  EXPECT_EQ(all["overlap"], surveyed["overlap"]);
  EXPECT_NE(all["registration"]["error_mm"], surveyed["registration"]["error_mm"]);
  const auto sampled = with({"--registration-surfaces", "all", "--sample", "100%"});
  EXPECT_NEAR(sampled["registration"]["error_mm"].get<double>(), all["registration"]["error_mm"].get<double>(),
              4 * sampled["registration"]["standard_error_mm"].get<double>() + 1e-9);
  with({"--registration-map", path("error.ply"), "--registration-map", path("error.png")});
  EXPECT_EQ(files(), (std::vector<std::string>{"error.ply", "error.png"}));
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--registration-surfaces", "some"})), 2,
                 "'some' is neither surveyed nor all");
  expect_refused(run_program(coarse("evaluate", {"--station", "8,0,1.5", "--registration-map", path("error.ply")})), 2,
                 "--registration-map");
}

TEST_F(Results, AWantedErrorIsReached) {
  const auto result = json_of({"evaluate", scene_, "--engine", "embree", "--station", "8,0,1.5", "--step", "0.5",
                               "--spacing", "0.05", "--error", "0.01"});
  EXPECT_GT(result["coverage_se"].get<double>(), 0);
  EXPECT_LE(result["coverage_se"].get<double>(), 0.01);
  EXPECT_LT(result["sample"], result["voxels"]);
}

TEST_F(Results, StationsComeFromTables) {
  write("heads.csv", "x,y,z\n8,0,1.5\n-8,0,1.5\n0,8,1.5\n0,-8,1.5\n");
  auto typed = json_of(evaluate({})), read_in = json_of(coarse("evaluate", {"--stations", path("heads.csv")}));
  typed.erase("seconds");
  read_in.erase("seconds");
  EXPECT_EQ(read_in, typed);
}

TEST_F(Results, StationsMayLieAndHaveScannersOfTheirOwn) {
  write("stations.csv", "x,y,z,heading,tilt,scanner,step\n8,0,1.5,0,90,,\n-8,0,1.5,30,,rtc360,2\n0,8,1.5,,,,\n");
  const auto result = json_of(coarse("evaluate", {"--stations", path("stations.csv")}));
  const auto& stations = result["stations"];
  EXPECT_EQ(stations[0]["tilt"], 90);
  EXPECT_EQ(stations[0]["step"], 1);
  EXPECT_NEAR(stations[1]["heading"].get<double>(), 30, 1e-12);
  EXPECT_EQ(stations[1]["scanner"], "Leica RTC360 @6mm");
  EXPECT_NEAR(stations[1]["step"].get<double>(), 2, 1e-12);
  EXPECT_FALSE(stations[2].contains("heading")) << "as all stations were";
  EXPECT_EQ(result["rays"], 2 * 360 * 150 + 180 * 75);
  // The same, typed.
  const auto typed =
      json_of(coarse("evaluate", {"--station", "x=8,y=0,z=1.5,tilt=90", "--station",
                                  "x=-8,y=0,z=1.5,heading=30,scanner=rtc360,step=2", "--station", "0,8,1.5"}));
  EXPECT_EQ(typed["coverage"], result["coverage"]);
  EXPECT_EQ(typed["stations"], stations);
  // A head that lies sees what is above and below, and not what is at its side.
  EXPECT_NE(stations[0]["points"], json_of(coarse("evaluate", {"--station", "8,0,1.5"}))["stations"][0]["points"]);
  expect_refused(run_program(coarse("evaluate", {"--station", "x=8,y=0,z=1.5,scanner=rtc306"})), 2, "rtc360");
  expect_refused(run_program(coarse("evaluate", {"--station", "x=8,y=0,z=1.5,step=0"})), 2, "azimuth_step");
}

TEST_F(Results, SurveyorsTablesAreRead) {
  auto plain = json_of(evaluate({}));
  plain.erase("seconds");
  for (const char* table : {"Easting;Northing;Height\r\n8,0;0;1,5\r\n-8;0;1,5\r\n0;8;1,5\r\n0;-8;1,5\r\n",
                            "N\tE\tZ\n0\t8\t1.5\n0\t-8\t1.5\n8\t0\t1.5\n-8\t0\t1.5\n"}) {
    write("heads.csv", table);
    auto read_in = json_of(coarse("evaluate", {"--stations", path("heads.csv")}));
    read_in.erase("seconds");
    EXPECT_EQ(read_in, plain);
  }
}

TEST_F(Results, PointCloudsCarryTheCoordinateSystem) {
  auto arguments = coarse("scan", {"--station", "8,0,1.5", "--crs", "EPSG:25832", "-o", path("c.las")});
  EXPECT_EQ(json_of(arguments)["options"]["crs"], "EPSG:25832");
  EXPECT_NE(read("c.las").find("PROJCS[\"ETRS89 / UTM zone 32N\""), std::string::npos);
}

TEST_F(Results, PlacesOnTheSearchAreaAreFoundAgain) {
  const auto heads = json_of(evaluate({}));
  std::vector<std::string> uvs;
  for (const auto& station : heads["stations"])
    uvs.insert(uvs.end(), {"--station", station["uv"][0].dump() + "," + station["uv"][1].dump()});
  const auto again = json_of(coarse("evaluate", uvs));
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(again["stations"][k]["position"][axis].get<double>(),
                  heads["stations"][k]["position"][axis].get<double>(), 1e-6);
  EXPECT_NEAR(again["coverage"].get<double>(), heads["coverage"].get<double>(), 1e-3);
}

TEST_F(Results, HolesAndClashesAreToldAndLeftOut) {
  const Outcome outcome = run_program(
      coarse("evaluate", {"--station", "8,0,1.5", "--station", "u=99,v=99", "--station", "5.1,0,1.5", "--json"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(result["stations"][0]["status"], "ok");
  EXPECT_EQ(result["stations"][1]["status"], "hole");
  EXPECT_TRUE(result["stations"][1]["position"].is_null());
  EXPECT_EQ(result["stations"][2]["status"], "clash");
  EXPECT_EQ(result["coverage"], json_of(coarse("evaluate", {"--station", "8,0,1.5"}))["coverage"]);
  EXPECT_NE(outcome.err.find("warning: S2 at"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: S3 at"), std::string::npos) << outcome.err;
}

TEST_F(Results, ScanCountsWhatItWrites) {
  for (const char* name : {"cloud.ply", "cloud.las"}) {
    auto arguments = coarse("scan", four_heads);
    arguments.insert(arguments.end(), {"-o", path(name)});
    const auto result = json_of(arguments);
    for (const char* key : {"rays", "points", "points_on_surveyed", "stations", "seconds", "engine", "device"})
      EXPECT_TRUE(result.contains(key)) << key;
    EXPECT_EQ(result["rays"], 4 * 360 * 150);
    std::uint64_t sum = 0;
    for (const auto& station : result["stations"]) sum += station["points"].get<std::uint64_t>();
    EXPECT_EQ(result["points"], sum);
    EXPECT_GT(sum, 0u);
    const std::string bytes = read(name);
    if (std::string(name).ends_with("ply")) {
      const auto count = bytes.find("element vertex ");
      ASSERT_NE(count, std::string::npos);
      EXPECT_EQ(std::stoull(bytes.substr(count + 15, 24)), sum);
    } else {
      EXPECT_EQ(bytes.substr(0, 4), "LASF");
    }
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"cloud.las", "cloud.ply"}));
}

TEST_F(Results, PliesHaveDoublesOnRequest) {
  const auto begins = [this](const char* name, const char* properties) {
    EXPECT_NE(read(name).find(properties), std::string::npos) << name;
  };
  for (const bool doubles : {false, true}) {
    auto scan = coarse("scan", {"--station", "8,0,1.5", "-o", path("cloud.ply")});
    auto measure = evaluate({"--cartography", path("coverage.ply"), "--missed", path("missed.ply")});
    if (doubles) scan.push_back("--ply-doubles"), measure.push_back("--ply-doubles");
    json_of(scan), json_of(measure);
    for (const char* name : {"cloud.ply", "coverage.ply", "missed.ply"})
      begins(name, doubles ? "\nproperty double x\n" : "\nproperty float x\n");
  }
}

TEST_F(Results, ScanWithoutAFileOnlyCounts) {
  const auto result = json_of(coarse("scan", four_heads));
  EXPECT_GT(result["points"].get<std::uint64_t>(), 0u);
  EXPECT_EQ(files(), std::vector<std::string>{});
}

// The same draw for every station of a run, by its seed.
TEST_F(Results, ScansHaveTheErrorsOfTheirInstrument) {
  const auto scanned = [&](std::vector<std::string> more) {
    auto command = coarse("scan", four_heads);
    command.insert(command.end(), {"-o", path("cloud.ply")});
    command.insert(command.end(), more.begin(), more.end());
    const auto result = json_of(command);
    return std::pair(result, read("cloud.ply"));
  };
  const auto [right, exact] = scanned({"--calibration", "3600,500,10"});
  const auto [wrong, cloud] = scanned({"--calibration", "3600,500,10", "--instrument-errors", "4"});
  const auto [other, another] = scanned({"--calibration", "3600,500,10", "--instrument-errors", "5"});
  EXPECT_FALSE(right["stations"][0].contains("instrument_errors"));
  EXPECT_EQ(wrong["points"], right["points"]);
  EXPECT_EQ(wrong["points_on_surveyed"], right["points_on_surveyed"]);
  EXPECT_NE(cloud, exact);
  EXPECT_NE(cloud, another);
  const auto& drawn = wrong["stations"][0]["instrument_errors"];
  EXPECT_NE(drawn["range_offset_mm"].get<double>(), 0);
  EXPECT_EQ(drawn, wrong["stations"][3]["instrument_errors"]);
  EXPECT_NE(drawn, other["stations"][0]["instrument_errors"]);
  expect_refused(run_program(coarse("scan", {"--station", "8,0,1.5", "--instrument-errors", "4"})), 2,
                 "states no calibration");
}

TEST_F(Results, PanoramasArePictures) {
  const auto result = json_of(
      coarse("panorama", {"--station", "8,0,1.5", "--width", "64", "--views", "range,mesh", "-o", path("views")}));
  EXPECT_EQ(files(), (std::vector<std::string>{"views/station_1_mesh.png", "views/station_1_range.png"}));
  EXPECT_EQ(read("views/station_1_range.png").substr(1, 3), "PNG");
  EXPECT_EQ(result["stations"][0]["pictures"].size(), 2u);
}

TEST_F(Results, EvaluateWritesItsTablesAndPictures) {
  json_of(evaluate(
      {"--cartography", path("coverage.ply"), "--overlap-csv", path("overlap.csv"), "--picture", path("plan.png")}));
  EXPECT_EQ(files(), (std::vector<std::string>{"coverage.ply", "overlap.csv", "plan.png"}));
  EXPECT_EQ(read("coverage.ply").substr(0, 3), "ply");
  EXPECT_EQ(read("plan.png").substr(1, 3), "PNG");
}

// Peak memory of the program against the estimate made before; among children that were waited for, the largest counts.
TEST_F(Results, MemoryIsAsEstimated) {
  const double size = 0.004;
  const MemoryEstimate estimate = estimate_memory(Scene::load(scene_), size);
  ASSERT_GT(estimate.voxels, 8'000'000u);
  std::vector<std::string> command{"evaluate", scene_};
  command.insert(command.end(), four_heads.begin(), four_heads.end());
  command.insert(command.end(), {"--engine", "embree", "--step", "1", "--user-size", "0.004", "--spacing", "0.002",
                                 "--memory", std::to_string(estimate.bytes - 1)});
  expect_refused(run_program(command), 1, "would fit");
  command.back() = std::to_string(estimate.bytes);
  EXPECT_EQ(run_program(command).exit_code, 0);
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  EXPECT_NEAR(static_cast<double>(used.ru_maxrss) * 1024 / static_cast<double>(estimate.bytes), 1, 0.2);
}

}  // namespace
}  // namespace vantage::test
