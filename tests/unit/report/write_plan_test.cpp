// SPDX-License-Identifier: Apache-2.0
// The whole way on a small site: plan, write the folder, read it back, evaluate what was written.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "scene/scene_data.hpp"
#include "support/boxes_on_ground.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/vantage.hpp"

namespace vantage {
namespace {

using nlohmann::json;

// A cube of 2 m on nothing, surveyed, with its walls in 1 m squares, far from the world's origin.
constexpr Vec3 kPlace{500'000, 4'500'000, 100};

Scene cube() {
  std::vector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto n = static_cast<std::uint32_t>(p.size());
    for (const Vec3& v : {a, b, c, d}) p.push_back(v + kPlace);
    t.insert(t.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  };
  quad({-1, -1, 0}, {1, -1, 0}, {1, -1, 2}, {-1, -1, 2});
  quad({1, -1, 0}, {1, 1, 0}, {1, 1, 2}, {1, -1, 2});
  quad({1, 1, 0}, {-1, 1, 0}, {-1, 1, 2}, {1, 1, 2});
  quad({-1, 1, 0}, {-1, -1, 0}, {-1, -1, 2}, {-1, 1, 2});
  return Scene::from_triangles(p, t);
}

SearchArea around() {
  SearchMesh mesh;
  for (const auto& [x, y] : {std::pair{-5.0, -5.0}, {5.0, -5.0}, {5.0, 5.0}, {-5.0, 5.0}}) {
    mesh.positions.push_back(Vec3{x, y, 0} + kPlace);
    mesh.uvs.push_back({(x + 5) / 10, (y + 5) / 10});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return SearchArea::from_mesh(mesh);
}

struct Survey {
  explicit Survey(double radius_m = 0.3)
      : site(test::site_of(
            Simulator(cube(), {.azimuth_step = Angle::degrees(1), .zenith_step = Angle::degrees(1), .height_m = 1.2},
                      {.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.1}),
            around(), {.lower_m = 0.6, .upper_m = 1.35, .radius_m = radius_m})) {}
  Site site;
  Simulator& simulator = site.simulator();
};

json without_seconds(json value) {
  if (value.is_object()) {
    value.erase("seconds");
    value.erase("trace_seconds");
  }
  if (value.is_structured())
    for (json& child : value) child = without_seconds(child);
  return value;
}

// Three stations, or two to five.
SurveyProblem asked(const std::string& name) {
  return name.ends_with("-min") ? survey_problem(name, 2, 5) : survey_problem(name, 3, 3);
}

class WritePlan : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Report, WritePlan,
                         testing::Values("coverage-fix", "coverage-overlap-fix", "coverage-overlap-min"),
                         [](const auto& problem) {
                           std::string name = problem.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(WritePlan, WhatIsWrittenEvaluatesToTheSameNumbers) {
  const test::TemporaryFolder folder;
  Survey survey;
  const PlanConfig config{.population = 8, .iterations = 6, .sample_voxels = 200, .seed = 3};
  const PlanResult result = plan(survey.site, asked(GetParam()), config);
  ASSERT_FALSE(result.front.empty());
  EXPECT_EQ(result.evaluations, 48u);
  const PlanEntry& entry = result.front[answer(result)];
  EXPECT_TRUE(write_plan(folder / "out", result, survey.site).left_out.empty());
  const std::size_t chosen = answer(result);
  ASSERT_EQ(chosen, answer(result));

  for (const char* name :
       {"front.csv", "front.json", "history.csv", "fronts.csv", "coverage.ply", "overlap.csv", "stations.csv",
        "stations.dxf", "front.png", "front.svg", "hypervolume.png", "hypervolume.svg", "plan.png", "plan.svg",
        "missed.csv", "missed.ply", "missed.png", "elements.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;

  // stations.csv
  Network network;
  for (const StationRow& row : read_stations_csv(folder / "out" / "stations.csv"))
    network.push_back({.position = row.position.value_or(Vec3{}), .active = row.position.has_value()});
  for (std::size_t i = 0; i < network.size(); ++i)
    if (entry.stations[i].status != StationStatus::ok) network[i].active = false;
  VoxelField field;
  const NetworkCounts counts = survey.simulator.evaluate(network, {.overlap = true, .field = &field});
  EXPECT_EQ(coverage(counts, survey.simulator.goal_density()), entry.value("coverage"));
  EXPECT_EQ(clustering_coefficient(overlap_matrix(counts)), entry.value("overlap"));

  // front.json
  const json written = json::parse(test::content(folder / "out" / "front.json"));
  for (const char* key : {"problem", "objectives", "hypervolume", "evaluations", "stop_reason", "front", "seconds",
                          "engine", "device", "seed", "parameters", "version"})
    EXPECT_TRUE(written.contains(key)) << key;
  EXPECT_EQ(written["front"].size(), result.front.size());
  const json& first = written["front"][chosen];
  EXPECT_EQ(first["coverage"].get<double>(), entry.searched.at("coverage").value);
  EXPECT_EQ(first["exact"]["overlap"].get<double>(), entry.value("overlap"));
  EXPECT_EQ(first["station_count"].get<std::size_t>(), entry.stations.size());
  EXPECT_EQ(first["stations"][0]["position"][0].get<double>(), entry.stations[0].position.x);
  EXPECT_EQ(first["stations"][0]["uv"][1].get<double>(), entry.stations[0].uv.v);
  EXPECT_EQ(written["parameters"]["scanner"]["height_m"].get<double>(), 1.2);
  EXPECT_EQ(written["parameters"]["plan"]["sample_voxels"].get<std::uint64_t>(), 200u);

  // coverage.ply: a vertex a voxel, coloured and counted
  const std::string ply = test::content(folder / "out" / "coverage.ply");
  const std::size_t start = ply.find("end_header\n") + 11, record = 12 + 3 + 4 + 4 + 8;
  ASSERT_EQ(ply.size() - start, survey.simulator.voxel_count() * record);
  std::array<double, 3> origin{};
  std::istringstream(ply.substr(ply.find("comment origin ") + 15, 60)) >> origin[0] >> origin[1] >> origin[2];
  double filled = 0;
  for (std::uint64_t k = 0; k < survey.simulator.voxel_count(); ++k) {
    std::size_t at = start + k * record;
    const Vec3 centre = survey.simulator.voxel_centre(k);
    ASSERT_EQ(test::take<float>(ply, at), static_cast<float>(centre.x - origin[0]));
    ASSERT_EQ(test::take<float>(ply, at), static_cast<float>(centre.y - origin[1]));
    at += 4;
    const int red = test::take<std::uint8_t>(ply, at), green = test::take<std::uint8_t>(ply, at);
    at += 1;
    const float ratio = test::take<float>(ply, at);
    ASSERT_TRUE(ratio > 0 || red > 2 * green);
    ASSERT_TRUE(ratio < 1 || green > 2 * red);
    ASSERT_EQ(test::take<std::uint32_t>(ply, at), field.count[k]);
    ASSERT_EQ(test::take<std::uint32_t>(ply, at), static_cast<std::uint32_t>(field.stations.word(0, k)));
    filled += ratio;
  }
  EXPECT_NEAR(filled / static_cast<double>(survey.simulator.voxel_count()), entry.value("coverage"), 1e-6);
}

TEST_P(WritePlan, PliesHaveDoublesOnRequest) {
  const test::TemporaryFolder folder;
  Survey survey;
  const PlanResult result = plan(survey.site, asked(GetParam()), {.population = 6, .iterations = 2, .seed = 3});
  write_plan(folder / "out", result, survey.site, {.reports = false, .ply = PlyCoordinates::doubles});
  for (const char* name : {"coverage.ply", "missed.ply"}) {
    const std::string ply = test::content(folder / "out" / name);
    EXPECT_NE(ply.find("\nproperty double x\nproperty double y\nproperty double z\n"), std::string::npos) << name;
    EXPECT_EQ(ply.find("comment origin"), std::string::npos) << name;
  }
}

TEST_P(WritePlan, TheSameSeedGivesTheSameFrontButForSeconds) {
  const PlanConfig config{.population = 6, .iterations = 4, .seed = 9};
  std::string texts[2];
  for (std::string& text : texts) {
    Survey survey;
    text = front_json(plan(survey.site, asked(GetParam()), config), survey.simulator);
  }
  EXPECT_EQ(without_seconds(json::parse(texts[0])), without_seconds(json::parse(texts[1])));
  // Byte for byte, too: only lines inside "seconds" differ.
  const auto cut = [](std::string text) {
    const std::size_t at = text.find("\"seconds\": {");
    return text.erase(at, text.find('}', at) - at);
  };
  EXPECT_EQ(cut(texts[0]), cut(texts[1]));
}

TEST(Plan, SampledOfEveryVoxelIsExact) {
  Survey survey;
  PlanConfig config{.population = 6, .iterations = 3, .exact = true};
  const PlanResult exact = plan(survey.site, coverage_overlap_fix(3), config);
  config.exact = false;
  config.batch = 1;  // as the exact search has it
  config.sample_voxels = survey.simulator.voxel_count();
  const PlanResult sampled = plan(survey.site, coverage_overlap_fix(3), config);
  ASSERT_EQ(exact.front.size(), sampled.front.size());
  for (std::size_t k = 0; k < exact.front.size(); ++k) {
    EXPECT_EQ(exact.front[k].x, sampled.front[k].x);
    for (const auto& [name, seen] : sampled.front[k].searched) {
      EXPECT_EQ(seen.value, sampled.front[k].value(name)) << name;
      EXPECT_EQ(seen.standard_error, 0) << name;
    }
  }
}

TEST(Plan, ResumesOnARealSiteAndRefusesAnother) {
  const test::TemporaryFolder folder;
  PlanConfig config{.population = 6, .iterations = 5, .sample_voxels = 100};
  Survey whole;
  const PlanResult wanted = plan(whole.site, coverage_overlap_fix(3), config);
  config.checkpoint = folder / "c";
  config.resume = true;
  std::stop_source stop;
  Survey first;
  const PlanResult cut = plan(first.site, coverage_overlap_fix(3), config,
                              {.report =
                                   [&](const PlanProgress& p) {
                                     if (p.evaluations >= 14) stop.request_stop();
                                   },
                               .stop = stop.get_token()});
  EXPECT_EQ(cut.stop_reason, StopReason::cancelled);
  for (const PlanEntry& e : cut.front) EXPECT_TRUE(e.exact);  // what was found so far is still confirmed
  Survey second;
  const PlanResult rest = plan(second.site, coverage_overlap_fix(3), config);
  EXPECT_GE(rest.resumed_evaluations, 12u);
  ASSERT_EQ(rest.front.size(), wanted.front.size());
  for (std::size_t k = 0; k < rest.front.size(); ++k) EXPECT_EQ(rest.front[k].x, wanted.front[k].x);

  Survey wider(0.5);
  EXPECT_THROW(plan(wider.site, coverage_overlap_fix(3), config), Error);
  config.seed = 2;
  EXPECT_THROW(plan(second.site, coverage_overlap_fix(3), config), Error);
}

TEST(Plan, KeepsStationsThatAreThere) {
  Survey survey;
  SurveyProblem problem = coverage_fix(1);
  problem.existing = {kPlace + Vec3{-3, 0, 1.2}, kPlace + Vec3{3, 0, 1.2}};
  const PlanResult result = plan(survey.site, problem, {.iterations = 3});
  ASSERT_EQ(result.front.size(), 1u);
  ASSERT_EQ(result.front[0].stations.size(), 3u);
  EXPECT_EQ(result.front[0].stations[0].position, problem.existing[0]);
  EXPECT_EQ(result.front[0].stations[1].position, problem.existing[1]);
  EXPECT_GT(result.front[0].counts.points_on_surveyed[0], 0u);
}

// Nothing of the library knows it: far stations are dear.
TEST(Plan, SearchesForAnObjectiveOfTheCallersOwn) {
  Survey survey;
  SurveyProblem problem = coverage_fix(2);
  problem.objectives.push_back({.name = "walk",
                                .label = "Way between the stations",
                                .unit = "m",
                                .scale = minimise(0, 14),
                                .needs = {.counts = false},
                                .value = [](const MeasuredNetwork& m) {
                                  const Vec3 way = m.stations[1].position - m.stations[0].position;
                                  return std::sqrt(dot(way, way));
                                }});
  problem.requirements = {{.objective = problem.objectives[1], .bound = Requirement::Bound::at_least, .limit = 3}};
  const PlanResult result = plan(survey.site, problem, {.population = 12, .iterations = 20});
  ASSERT_GT(result.front.size(), 1u);
  for (const PlanEntry& entry : result.front) {
    const Vec3 way = entry.stations[1].position - entry.stations[0].position;
    EXPECT_EQ(entry.value("walk"), std::sqrt(dot(way, way)));
    EXPECT_EQ(entry.violation, 0);
    EXPECT_GE(entry.value("walk"), 3);
  }
  const json written = json::parse(front_json(result, survey.simulator));
  EXPECT_EQ(written["objectives"], (json{"coverage", "walk"}));
  EXPECT_EQ(written["front"][0]["values"]["walk"]["exact"].get<double>(), result.front[0].value("walk"));
  const test::TemporaryFolder folder;
  write_plan(folder / "out", result, survey.site);
  EXPECT_NE(test::content(folder / "out/front.csv").find(",exact_walk,"), std::string::npos);
  EXPECT_NE(test::content(folder / "out/front.svg").size(), 0u);

  // A stop leaves out what takes long, and no picture of an earlier plan stays.
  EXPECT_TRUE(std::filesystem::exists(folder / "out/plan.svg"));
  std::stop_source late;
  late.request_stop();
  std::vector<std::string> left_out{"missed.csv", "missed.ply", "missed.png", "plan.svg"};
  if (why_no_report().empty()) left_out.insert(left_out.end(), {"report.html", "report.pdf"});
  EXPECT_EQ(write_plan(folder / "out", result, survey.site, {}, {.stop = late.get_token()}).left_out, left_out);
  for (const std::string& name : left_out) EXPECT_FALSE(std::filesystem::exists(folder / "out" / name)) << name;
  for (const char* name : {"plan.png", "coverage.ply"})  // the answer kept its points when it was confirmed
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

// The surveyor's question on the cube, with existing stations that have names.
PlanResult surveyed(Survey& survey, std::size_t iterations, double max_seconds) {
  SurveyQuestion question{.capture = 0.8, .link = 0.05};
  question.existing = {kPlace + Vec3{-3, 0, 1.2}};
  question.existing_names = {"gate"};
  return plan(survey.site, question,
              {.population = 8, .iterations = iterations, .sample_voxels = 200, .max_seconds = max_seconds, .seed = 3});
}

TEST(WritePlan, APlanThatTheTimeEndedHasTheFilesOfAFinishedOne) {
  const test::TemporaryFolder folder;
  Survey survey;
  const PlanResult finished = surveyed(survey, 2, 0), ended = surveyed(survey, 100'000'000, 5);
  EXPECT_EQ(ended.stop_reason, StopReason::max_time);
  EXPECT_NE(finished.stop_reason, StopReason::max_time);
  for (const PlanResult* result : {&finished, &ended}) {
    const PlanEntry& entry = result->front[answer(*result)];
    EXPECT_TRUE(entry.exact);
    EXPECT_TRUE(entry.links());
    EXPECT_TRUE(entry.registration);
    EXPECT_TRUE(entry.visit);
    EXPECT_GT(result->trade_off.size(), 1u);
    EXPECT_EQ(std::ranges::count(result->trade_off, true, &TradeOffPoint::answer), 1);
    EXPECT_NE(trade_off_text(*result).find("<- the plan"), std::string::npos);
  }
  EXPECT_EQ(ended.trade_off.size(), finished.trade_off.size());
  EXPECT_TRUE(write_plan(folder / "finished", finished, survey.site).left_out.empty());
  EXPECT_TRUE(write_plan(folder / "ended", ended, survey.site).left_out.empty());
  EXPECT_EQ(files_in(folder / "ended"), files_in(folder / "finished"));
  EXPECT_NE(test::content(folder / "ended/stations.csv").find("gate"), std::string::npos);
}

TEST(WritePlan, StationsAreTheSameWhereMeshesAreShared) {
  const test::TemporaryFolder folder;
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  for (const std::vector<std::string>& surveyed : {std::vector<std::string>{}, {"ground", "box 1"}}) {
    for (const SharedMeshes shared : {SharedMeshes::always, SharedMeshes::never}) {
      const Scene scene = load(test::boxes_on_ground(), {.surveyed = surveyed, .shared_meshes = shared});
      ASSERT_EQ(scene.data().shares(), shared == SharedMeshes::always);
      Site site = test::site_of(Simulator(scene, scanner, {.engine = Engine::embree, .user_size_m = 0.2}));
      const PlanResult result =
          plan(site, coverage_overlap_fix(3), {.population = 6, .iterations = 3, .sample_voxels = 300, .seed = 3});
      write_plan(folder / to_string(shared), result, site);
    }
    for (const char* file : {"stations.csv", "front.csv", "fronts.csv", "overlap.csv"}) {
      const std::string once = test::content(folder / "always" / file);
      EXPECT_GT(once.size(), 50u) << file;
      EXPECT_EQ(once, test::content(folder / "never" / file)) << file;
    }
  }
}

}  // namespace
}  // namespace vantage
