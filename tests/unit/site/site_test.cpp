// SPDX-License-Identifier: Apache-2.0
#include "vantage/site.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

const std::string kFourWalls = VANTAGE_DATA_FOLDER "/four_walls.glb";

SiteOptions on_embree() {
  SiteOptions options;
  options.engine = Engine::embree;
  return options;
}

std::string why_of(const Site& site, const std::string& setting) {
  const auto found = std::ranges::find(site.choices(), setting, &SiteChoice::setting);
  return found == site.choices().end() ? "" : found->why;
}

// A square floor of so many metres, in metres.
Scene floor_of(double side) {
  const std::vector<Vec3> corners{{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  return Scene::from_triangles(corners, triangles);
}

TEST(Site, TakesTheDefaultsThatTheSceneCarries) {
  const Site site = Site::open(kFourWalls, on_embree());
  EXPECT_EQ(site.name(), "four_walls");
  EXPECT_NEAR(site.scanner().azimuth_step.in_degrees(), 0.1, 1e-12);
  EXPECT_EQ(site.scanner().height_m, 1.5);
  EXPECT_EQ(site.simulator_config().point_spacing_m, 0.01);
  EXPECT_TRUE(site.scanner().noise.empty());
  EXPECT_EQ(why_of(site, "spacing"), "");  // the scene says it
}

TEST(Site, NameOfAFileInLatin1IsUtf8) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "B\xFCro.glb";
  std::filesystem::copy_file(kFourWalls, file);
  EXPECT_EQ(Site::open(file, on_embree()).name(), "B\xC3\xBCro");
}

TEST(Site, GoesByWhatIsGivenBeforeTheScene) {
  SiteOptions options = on_embree();
  options.steps = {Angle::degrees(0.4), Angle::degrees(0.5)};
  options.height_m = 1.7;
  const Site site = Site::open(kFourWalls, options);
  EXPECT_NEAR(site.scanner().zenith_step.in_degrees(), 0.5, 1e-12);
  EXPECT_EQ(site.scanner().height_m, 1.7);
  EXPECT_EQ(site.simulator_config().point_spacing_m, 0.01);
}

TEST(Site, GoesByAPresetBeforeTheScene) {
  SiteOptions options = on_embree();
  options.scanner = "rtc360@12mm";
  const Site site = Site::open(kFourWalls, options);
  EXPECT_GT(std::abs(site.scanner().azimuth_step.in_degrees() - 0.1), 0.01);
  EXPECT_EQ(site.scanner().max_range_m, 130);
  EXPECT_EQ(site.scanner().height_m, 1.5);  // no preset knows the tripod
}

TEST(Site, TellsWhatItChoseAndWhy) {
  std::vector<std::string> lines;
  SiteOptions options = on_embree();
  options.log = [&](const std::string& line) { lines.push_back(line); };
  const Site small(floor_of(1), options);
  EXPECT_LT(small.length_scale(), 1);
  EXPECT_LT(small.scanner().height_m, 0.5);
  EXPECT_EQ(why_of(small, "user-size"), "by the size of the scene");
  EXPECT_TRUE(
      std::ranges::any_of(lines, [](const std::string& line) { return line.starts_with("the scene measures"); }));
  const Site usual(floor_of(20), options);
  EXPECT_EQ(usual.length_scale(), 1);
  EXPECT_EQ(usual.scanner().height_m, Scanner().height_m);
  EXPECT_EQ(why_of(usual, "user-size"), "the usual size");
}

// A scanner that a surveyor is likely to have stands in for one that exists nowhere.
TEST(Site, AssumesAUsualScannerWhereNoneIsDescribed) {
  std::vector<std::string> lines;
  SiteOptions options = on_embree();
  options.log = [&](const std::string& line) { lines.push_back(line); };
  const Site site(floor_of(20), options);
  EXPECT_EQ(site.scanner().name, load_scanner(usual_scanner).name);
  EXPECT_EQ(why_of(site, "scanner"), "no scanner was named");
  EXPECT_EQ(lines.at(0), "scanner: none was named, so a Leica RTC360 @6mm is assumed, 23 s a scan");
  EXPECT_EQ(site.simulator_config().point_spacing_m, usual_spacing_m);
  options.steps = {Angle::degrees(0.1), Angle::degrees(0.1)};
  const Site other(floor_of(20), options);
  EXPECT_EQ(other.scanner().name, Scanner().name);
  EXPECT_EQ(why_of(other, "scanner"), "");
  EXPECT_NEAR(other.simulator_config().point_spacing_m, 0.01745, 1e-5) << "its own steps at 10 m";
}

TEST(Site, TakesTheSpacingOfWhatIsToBeMade) {
  SiteOptions options = on_embree();
  for (const auto& [deliverable, spacing_m] : std::initializer_list<std::pair<const char*, double>>{
           {"1:50", 0.005}, {"1:100", 0.01}, {"1:2.5", 0.00025}, {"LOA20", 0.05}, {"loa30", 0.015}, {"LOA40", 0.005}}) {
    options.deliverable = deliverable;
    EXPECT_DOUBLE_EQ(Site(floor_of(20), options).simulator_config().point_spacing_m, spacing_m) << deliverable;
  }
  options.spacing_m = 0.03;
  EXPECT_EQ(Site(floor_of(20), options).simulator_config().point_spacing_m, 0.03);
  for (const char* wrong : {"1:0", "1:", "50", "LOA60", "1:nan", ""}) {
    options.deliverable = wrong;
    EXPECT_THROW(Site(floor_of(20), options), Error) << wrong;
  }
}

TEST(Site, RefusesSettingsThatLeaveNoGround) {
  SiteOptions options = on_embree();
  options.enter = {{500, 4, 0}};
  try {
    Site site(floor_of(20), options);
    FAIL() << "an entrance half a kilometre off the floor";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("entrance"), std::string::npos) << error.what();
  }
  options.enter = {}, options.levels_m = {{50, 60}};
  EXPECT_THROW(Site(floor_of(20), options), Error);
}

TEST(Site, MakesGroundAndSimulatorOnce) {
  SiteOptions options = on_embree();
  options.user_size_m = 0.5, options.spacing_m = 0.2;
  Site site(floor_of(8), options);
  ASSERT_TRUE(site.has_area());
  EXPECT_EQ(&site.area(), &site.area());
  EXPECT_EQ(&site.simulator(), &site.simulator());
  EXPECT_EQ(&site.surroundings(), &site.surroundings());
  EXPECT_GT(site.simulator().voxel_count(), 0u);
  Site moved = std::move(site);
  EXPECT_TRUE(moved.area().locate(moved.area().project({4, 4, 0}).value()).has_value());
}

TEST(Site, TakesFurtherScanners) {
  SiteOptions options = on_embree();
  options.user_size_m = 0.5, options.spacing_m = 0.2;
  Site site(floor_of(8), options);
  Scanner finer = site.scanner();
  finer.azimuth_step = finer.zenith_step = Angle::degrees(0.05);
  EXPECT_EQ(site.place_of(site.scanner()), 0u);
  EXPECT_EQ(site.place_of(finer), 1u);
  EXPECT_EQ(site.place_of(finer), 1u);
  Simulator& simulator = site.simulator();
  EXPECT_EQ(simulator.scanners().size(), 2u);
  EXPECT_EQ(site.place_of(finer), 1u);
  const Simulator& surroundings = site.surroundings();
  EXPECT_EQ(surroundings.scanners().size(), 2u);
  site.surroundings().evaluate({{.position = {2, 2, 1.8}}});
  finer.azimuth_step = Angle::degrees(0.3);
  EXPECT_EQ(site.place_of(finer), 2u) << "also once the simulator is made";
  EXPECT_EQ(simulator.scanners().size(), 3u);
  const Work before = site.work();
  EXPECT_EQ(&site.surroundings(), &surroundings);
  EXPECT_EQ(surroundings.scanners().size(), 3u);
  site.surroundings().evaluate({{.position = {4, 4, 1.8}}});
  EXPECT_EQ((site.work() - before).networks, 1u);
  finer.height_m = -1;
  EXPECT_THROW(site.place_of(finer), Error);
  EXPECT_EQ(site.scanners().size(), 3u);
  EXPECT_EQ(simulator.scanners().size(), 3u);
}

TEST(Site, StandsOnPartsThatTheCallerMade) {
  const Scene scene = floor_of(8);
  Simulator simulator(scene, Scanner{}, {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.2});
  Site site(std::move(simulator), SearchArea::build(scene), ClashChecker(scene), "floor");
  EXPECT_EQ(site.name(), "floor");
  EXPECT_EQ(site.simulator_config().user_size_m, 0.5);
  EXPECT_GT(site.simulator().voxel_count(), 0u);
}

TEST(Site, RefusesWhatCannotBe) {
  const auto refused = [](auto change) {
    SiteOptions options = on_embree();
    change(options);
    try {
      Site site(floor_of(8), options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused([](SiteOptions& o) { o.range_m = {5, 2}; }).find("range:"), std::string::npos);
  EXPECT_NE(refused([](SiteOptions& o) { o.levels_m = {5, 2}; }).find("levels: 5 is not below 2"), std::string::npos);
  EXPECT_NE(refused([](SiteOptions& o) { o.scanner = "rtc36"; }).find("rtc360"), std::string::npos);
}

}  // namespace
}  // namespace vantage
