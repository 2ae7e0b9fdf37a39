// SPDX-License-Identifier: Apache-2.0
// Every field of every configuration, changed in turn: a run must not be resumed under another value that can change
// what it finds, and its results must tell every value.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "formats/run_json.hpp"
#include "search/checkpoint.hpp"
#include "search/identity.hpp"
#include "search/measures.hpp"
#include "support/member_count.hpp"
#include "trace/tracer_maker.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {
namespace {

struct PlanRun {
  Scanner scanner{.azimuth_step = Angle::degrees(5), .zenith_step = Angle::degrees(5)};
  SimulatorConfig simulation{.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.2};
  WalkableOptions walkable;
  SecurityVolume security;
  SurveyProblem problem = coverage_overlap_fix(3);
  PlanConfig config;
};

template <class Struct>
struct Change {
  std::string member;
  std::function<void(Struct&)> make;
  bool decides = true;  // true if a run may not be resumed across it
  bool told = true;
};

const std::vector<Change<Scanner>> kScanner{
    {"name", [](Scanner& s) { s.name = "other"; }, false},
    {"heading", [](Scanner& s) { s.heading = Angle::degrees(1); }},
    {"horizontal_angle", [](Scanner& s) { s.horizontal_angle = Angle::degrees(180); }},
    {"vertical_angle", [](Scanner& s) { s.vertical_angle = Angle::degrees(200); }},
    {"zenith_start", [](Scanner& s) { s.zenith_start = Angle::degrees(30); }},
    {"azimuth_step", [](Scanner& s) { s.azimuth_step = Angle::degrees(4); }},
    {"zenith_step", [](Scanner& s) { s.zenith_step = Angle::degrees(4); }},
    {"row_zeniths",
     [](Scanner& s) {
       s.row_zeniths = {Angle::degrees(70), Angle::degrees(75)};
     }},
    {"directions",
     [](Scanner& s) {
       s.set_directions({{Angle::degrees(70), Angle::degrees(3)}});
     }},
    {"times_s",
     [](Scanner& s) {
       s.set_directions({{Angle::degrees(70), Angle::degrees(3)}}, {0.5});
     }},
    {"height_m", [](Scanner& s) { s.height_m = 2; }},
    {"min_range_m", [](Scanner& s) { s.min_range_m = 0.2; }},
    {"max_range_m", [](Scanner& s) { s.max_range_m = 99; }},
    {"noise", [](Scanner& s) { s.noise = rtc360_noise(); }},
    {"points_per_second", [](Scanner& s) { s.points_per_second = 2e6; }},
    {"battery_min", [](Scanner& s) { s.battery_min = 90; }, false},
    {"battery_scans", [](Scanner& s) { s.battery_scans = 40; }, false},
    {"beam_divergence", [](Scanner& s) { s.beam_divergence = Angle::radians(3e-4); }},
    {"exit_diameter_m", [](Scanner& s) { s.exit_diameter_m = 0.004; }},
    {"detection_range_m", [](Scanner& s) { s.detection_range_m = 80; }},
    {"angle_accuracy", [](Scanner& s) { s.angle_accuracy = Angle::degrees(0.005); }},
    {"range_accuracy_m", [](Scanner& s) { s.range_accuracy_m = 0.001; }},
    {"range_accuracy_ppm", [](Scanner& s) { s.range_accuracy_ppm = 10; }},
    {"tilt_accuracy", [](Scanner& s) { s.tilt_accuracy = Angle::degrees(0.05); }, false},  // the registration's decides
    {"detection_reflectivity", [](Scanner& s) { s.detection_range_m = 80, s.detection_reflectivity = 0.5; }},
    {"dropout", [](Scanner& s) { s.dropout = 0.1; }}};
static_assert(test::member_count<Scanner>() == 26);

// The file's settings; a scene's own fingerprint tells runs apart.
const std::vector<Change<SceneOptions>> kScene{
    {"surveyed", [](SceneOptions& o) { o.surveyed = {"wall*"}; }, false},
    {"blocking", [](SceneOptions& o) { o.blocking = {"nothing"}; }, false},
    {"search", [](SceneOptions& o) { o.search = {"floor"}; }, false},
    {"ignore", [](SceneOptions& o) { o.ignore = {"nothing"}; }, false},
    {"weights",
     [](SceneOptions& o) {
       o.weights = {{"wall*", 3}};
     },
     false},
    {"doors", [](SceneOptions& o) { o.doors = {"door*"}; }, false},
    {"station_area", [](SceneOptions& o) { o.station_area = {"floor"}; }, false},
    {"glass", [](SceneOptions& o) { o.glass = {"nothing"}; }, false},
    {"mirror", [](SceneOptions& o) { o.mirror = {"nothing"}; }, false},
    {"details_mm",
     [](SceneOptions& o) {
       o.details_mm = {{"wall*", 5}};
     },
     false},
    {"accuracies_mm",
     [](SceneOptions& o) {
       o.accuracies_mm = {{"wall*", 2}};
     },
     false},
    {"scene_index", [](SceneOptions& o) { o.scene_index = 0; }, false},
    {"default_diffuse", [](SceneOptions& o) { o.default_diffuse = 0.25; }, false},
    {"allow_outside", [](SceneOptions& o) { o.allow_outside = true; }, false},
    {"unit", [](SceneOptions& o) { o.unit = Unit::foot; }, false},
    {"up", [](SceneOptions& o) { o.up = UpAxis::z; }, false},
    {"beside", [](SceneOptions& o) { o.beside = {"structure.ifc"}; }, false},
    {"wall_layers", [](SceneOptions& o) { o.wall_layers = {"A-WALL"}; }, false},
    {"wall_height_m", [](SceneOptions& o) { o.wall_height_m = 3.0; }, false},
    {"shared_meshes", [](SceneOptions& o) { o.shared_meshes = SharedMeshes::always; }, false},
    {"max_memory_bytes", [](SceneOptions& o) { o.max_memory_bytes = std::uint64_t{1} << 40; }, false, false}};
static_assert(test::member_count<SceneOptions>() == 21);

struct Alone final : TracerMaker {
  std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene&, std::uint64_t) override { return own; }
  std::size_t networks_at_once() const override { return 1; }
};

const std::vector<Change<SimulatorConfig>> kSimulation{
    {"engine", [](SimulatorConfig& c) { c.engine = Engine::automatic; }, false},
    {"device_index", [](SimulatorConfig& c) { c.device_index = 0; }, false},
    {"devices",
     [](SimulatorConfig& c) {
       c.devices = {{Engine::embree, 0}};
     },
     false},
    {"warn", [](SimulatorConfig& c) { c.warn = [](const std::string&) {}; }, false, false},
    {"shared", [](SimulatorConfig& c) { c.shared = std::make_shared<Alone>(); }, false, false},
    {"user_size_m", [](SimulatorConfig& c) { c.user_size_m = 0.4; }},
    {"point_spacing_m", [](SimulatorConfig& c) { c.point_spacing_m = 0.1; }},
    {"spacing_by_detail", [](SimulatorConfig& c) { c.spacing_by_detail = true; }},
    {"max_incidence", [](SimulatorConfig& c) { c.max_incidence = Angle::degrees(70); }},
    {"noise", [](SimulatorConfig& c) { c.noise = false; }},
    {"seed", [](SimulatorConfig& c) { c.seed = 2; }},
    {"validation", [](SimulatorConfig& c) { c.validation = true; }, false},
    {"max_rays_per_dispatch", [](SimulatorConfig& c) { c.max_rays_per_dispatch = 1000; }, false},
    // The free memory of a machine does not change results.
    {"max_memory_bytes", [](SimulatorConfig& c) { c.max_memory_bytes = std::uint64_t{1} << 40; }, false, false}};
static_assert(test::member_count<SimulatorConfig>() == 14);

const std::vector<Change<WalkableOptions>> kWalkable{
    {"max_slope", [](WalkableOptions& o) { o.max_slope = Angle::degrees(5); }},
    {"headroom_m", [](WalkableOptions& o) { o.headroom_m = 3; }},
    {"min_area_m2", [](WalkableOptions& o) { o.min_area_m2 = 3; }},
    {"passage_width_m", [](WalkableOptions& o) { o.passage_width_m = 1; }},
    {"passage_height_m", [](WalkableOptions& o) { o.passage_height_m = 3; }},
    {"climb_m", [](WalkableOptions& o) { o.climb_m = 0.1; }},
    {"enter",
     [](WalkableOptions& o) {
       o.enter = {Vec3{0, -5, 0}};
     }},
    {"levels",
     [](WalkableOptions& o) {
       o.levels = {-1, 1};
     }},
    {"enter_closed", [](WalkableOptions& o) { o.enter_closed = false; }},
    {"within",
     [](WalkableOptions& o) {
       o.within = {{{{{-9, -9}, {9, -9}, {9, 9}}}}};
     }},
    {"without", [](WalkableOptions& o) {
       o.without = {{{{{-9, -9}, {9, -9}, {9, 9}}}}};
     }}};
static_assert(test::member_count<WalkableOptions>() == 11);

const std::vector<Change<SecurityVolume>> kSecurity{{"lower_m", [](SecurityVolume& v) { v.lower_m = 0.7; }},
                                                    {"upper_m", [](SecurityVolume& v) { v.upper_m = 1.5; }},
                                                    {"radius_m", [](SecurityVolume& v) { v.radius_m = 0.2; }}};
static_assert(test::member_count<SecurityVolume>() == 3);

const std::vector<Change<SurveyProblem>> kProblem{
    {"name", [](SurveyProblem& p) { p.name = "other"; }, false},
    {"stations_min", [](SurveyProblem& p) { p.stations_min = 2; }},
    {"stations_max", [](SurveyProblem& p) { p.stations_max = 5; }},
    {"existing",
     [](SurveyProblem& p) {
       p.existing = {{1, 2, 3}};
     }},
    {"existing_setups", [](SurveyProblem& p) { p.existing_setups = {{.tilt = Angle::degrees(90)}}; }},
    {"scanners",
     [](SurveyProblem& p) {
       p.scanners = {Scanner(), Scanner{.height_m = 2}};
     }},
    {"every_echo", [](SurveyProblem& p) { p.every_echo = true; }},
    {"heights_m",
     [](SurveyProblem& p) {
       p.heights_m = {1, 2};
     }},
    {"objectives", [](SurveyProblem& p) { p.objectives.pop_back(); }},
    {"requirements", [](SurveyProblem& p) { p.requirements = {make_requirement("coverage>=0.5")}; }},
    {"link_overlap", [](SurveyProblem& p) { p.link_overlap = 0.05; }},
    {"registration", [](SurveyProblem& p) { p.registration.tilt = Angle::degrees(1); }},
    {"fewest", [](SurveyProblem& p) { p.fewest = true; }},
    {"attainable", [](SurveyProblem& p) { p.attainable = 0.7; }},
    {"pays_m2", [](SurveyProblem& p) { p.pays_m2 = 25; }},
    {"pays_share", [](SurveyProblem& p) { p.pays_share = 0.2; }},
    {"on_site", [](SurveyProblem& p) { p.on_site.set_up_min = 5; }},
    // Targets are of the answer, and decide nothing in its search.
    {"targets", [](SurveyProblem& p) { p.targets = 4; }, false},
    {"existing_names", [](SurveyProblem& p) { p.existing_names = {"A"}; }, false, false},
    {"existing_targets",
     [](SurveyProblem& p) {
       p.existing_targets = {{.name = "C1", .centre = {1, 2, 3}, .control_m = 0.002}};
     },
     false},
    {"target", [](SurveyProblem& p) { p.target.diameter_m = 0.2; }, false}};
static_assert(test::member_count<SurveyProblem>() == 21);

const std::vector<Change<SurveyProblem>> kRegistration{
    {"rho_m", [](SurveyProblem& p) { p.registration.model.rho_m = 0.002; }},
    {"patch_m", [](SurveyProblem& p) { p.registration.model.patch_m = 1; }},
    {"position_m", [](SurveyProblem& p) { p.registration.position_m = 0.1; }},
    {"heading", [](SurveyProblem& p) { p.registration.heading = Angle::degrees(1); }},
    {"tilt", [](SurveyProblem& p) { p.registration.tilt = Angle(); }},
    {"tilt_of_scanner", [](SurveyProblem& p) { p.registration.tilt_of_scanner = true; }},
    {"surfaces", [](SurveyProblem& p) { p.registration.surfaces = RegistrationSurfaces::all; }}};
static_assert(test::member_count<RegistrationOptions>() == 6 && test::member_count<RegistrationModel>() == 2);

const std::vector<Change<PlanConfig>> kPlan{
    {"population", [](PlanConfig& c) { c.population = 7; }},
    {"iterations", [](PlanConfig& c) { c.iterations = 7; }, false},
    {"sigma0", [](PlanConfig& c) { c.sigma0 = 0.3; }},
    {"optimiser",  // a saved state tells which it is of
     [](PlanConfig& c) {
       c.optimiser = [](std::size_t n, std::size_t m, const OptimiserConfig& o) {
         return std::make_unique<MoCmaEs>(n, m, o);
       };
     },
     false, false},
    {"scheme", [](PlanConfig& c) { c.scheme = MoScheme::generational; }},
    {"batch", [](PlanConfig& c) { c.batch = 3; }},
    {"sample_voxels", [](PlanConfig& c) { c.sample_voxels = 100; }},
    {"renew_iterations", [](PlanConfig& c) { c.renew_iterations = 10; }},
    {"start",
     [](PlanConfig& c) {
       c.start = {{1, 2, 3}};
     }},
    {"redraws", [](PlanConfig& c) { c.redraws = 3; }},
    {"max_seconds", [](PlanConfig& c) { c.max_seconds = 3; }, false},
    {"target_hypervolume", [](PlanConfig& c) { c.target_hypervolume = 0.5; }, false},
    {"stagnation_iterations", [](PlanConfig& c) { c.stagnation_iterations = 3; }, false},
    {"seed", [](PlanConfig& c) { c.seed = 3; }},
    // The place and use of a checkpoint do not change results.
    {"checkpoint", [](PlanConfig& c) { c.checkpoint = "elsewhere"; }, false, false},
    {"checkpoint_seconds", [](PlanConfig& c) { c.checkpoint_seconds = 5; }, false, false},
    {"resume", [](PlanConfig& c) { c.resume = true; }, false, false},
    // `sample_voxels` is what they come to.
    {"exact", [](PlanConfig& c) { c.exact = true; }, false, false},
    {"sample_share", [](PlanConfig& c) { c.sample_share = 0.5; }, false, false}};
static_assert(test::member_count<PlanConfig>() == 19);

SearchMesh ground() {
  return {.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}},
          .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
          .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

// The identity of a run, and the settings in its results, must show each change.
struct Told {
  std::string identity, json;
};
Told told(const PlanRun& run) {
  const SearchMesh wall = ground();
  std::vector<Vec3> upright;
  for (const Vec3& p : wall.positions) upright.push_back({p.x, 6, p.y + 5});
  const Scene scene = Scene::from_triangles(upright, wall.triangles);
  Site site(Simulator(scene, run.scanner, run.simulation), SearchArea::build(scene, run.walkable),
            ClashChecker(scene, run.security));
  PlanResult result;
  result.problem = run.problem, result.config = run.config;
  result.walkable = site.area().options(), result.security = site.clash().volume();
  return {identity(site, run.problem, run.config, 20, 4), run_parameters_json(site.simulator(), &result)};
}

template <class Struct>
void expect_all_count(const std::vector<Change<Struct>>& changes, Struct PlanRun::*part,
                      std::size_t members = test::member_count<Struct>()) {
  ASSERT_EQ(changes.size(), members);
  const Told before = told({});
  for (const Change<Struct>& change : changes) {
    PlanRun run;
    change.make(run.*part);
    const Told after = told(run);
    EXPECT_EQ(before.json != after.json, change.told) << change.member;
    const auto resume = [&] { require_same_run("checkpoint", before.identity, after.identity); };
    if (change.decides)
      EXPECT_THROW(resume(), Error) << change.member;
    else
      EXPECT_NO_THROW(resume()) << change.member;
  }
}

TEST(Settings, OfAScannerAllCount) { expect_all_count(kScanner, &PlanRun::scanner); }
TEST(Settings, OfASimulationAllCount) { expect_all_count(kSimulation, &PlanRun::simulation); }
TEST(Settings, OfASearchAreaAllCount) { expect_all_count(kWalkable, &PlanRun::walkable); }
TEST(Settings, OfASecurityVolumeAllCount) { expect_all_count(kSecurity, &PlanRun::security); }
TEST(Settings, OfAProblemAllCount) { expect_all_count(kProblem, &PlanRun::problem); }
// A part of the problem, and the model a part of that.
TEST(Settings, OfRegistrationAllCount) {
  expect_all_count(kRegistration, &PlanRun::problem,
                   test::member_count<RegistrationOptions>() - 1 + test::member_count<RegistrationModel>());
}
TEST(Settings, OfASearchAllCount) { expect_all_count(kPlan, &PlanRun::config); }

TEST(Settings, OfASceneAllCount) {
  ASSERT_EQ(kScene.size(), test::member_count<SceneOptions>());
  const auto json_of = [](const SceneOptions& options) {
    std::string text;
    for (const Setting& setting : settings(options)) text += setting.name + setting.json;
    return text;
  };
  for (const auto& change : kScene) {
    SceneOptions options;
    change.make(options);
    EXPECT_EQ(json_of(options) != json_of({}), change.told) << change.member;
  }
  const Scene scene = Scene::load(VANTAGE_DATA_FOLDER "/four_walls.glb", {.default_diffuse = 0.25});
  EXPECT_EQ(scene.options().default_diffuse, 0.25);
}

TEST(Settings, OfObjectivesAreTheirParameters) {
  PlanRun few, heavy;
  few.problem = fitness_min(2, 4);
  heavy.problem = fitness_min(2, 4, {.coverage = 0.6});
  EXPECT_NE(told(few).identity, told(heavy).identity);
  EXPECT_NE(told(few).json, told(heavy).json);
}

}  // namespace
}  // namespace vantage
