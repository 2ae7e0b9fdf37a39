// SPDX-License-Identifier: Apache-2.0
// Numbers as nobody should give them to the library: each call ends, with one Error that names the value, or with
// finite results. Values at the edges that mean something are taken.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"
#include "vantage/panorama.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
const std::vector<double> kNowhere{kNaN, -kNaN, kInf, -kInf, 1e30, -1e30, 0x1p63, -0x1p63, 1e160, 1e308, 2e6};
const std::vector<double> kSmall{0.0, -0.0, 5e-324, -5e-324, 1e-310};

SiteOptions coarse() {
  SiteOptions options;
  options.engine = Engine::embree;
  options.steps = {Angle::degrees(4), Angle::degrees(4)};
  options.user_size_m = 1, options.spacing_m = 0.5;
  return options;
}

// A floor of 8 m with two walls.
Scene room() {
  const std::vector<Vec3> corners{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0},  {-4, 4, 0}, {4, -4, 0}, {4, 4, 0},
                                  {4, 4, 3},   {4, -4, 3}, {-4, 4, 0}, {4, 4, 0},  {4, 4, 3},  {-4, 4, 3}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3},  {4, 5, 6},
                                                            {4, 6, 7}, {8, 9, 10}, {8, 10, 11}};
  return Scene::from_triangles(corners, triangles);
}

// The message of the Error that the call ends in; empty if it does not.
std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument) << error.what();
    return error.what();
  }
  return {};
}

class Positions : public testing::Test {
 protected:
  // Calls with a number in place of each coordinate of a good position.
  void expect_checked(const char* name, const std::function<void(const Vec3&)>& call) {
    SCOPED_TRACE(name);
    for (double Vec3::*coordinate : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      for (const double value : kNowhere) {
        Vec3 position{1, 1, 1.8};
        position.*coordinate = value;
        const std::string message = refusal([&] { call(position); });
        EXPECT_NE(message.find("within 1000 km of the scene"), std::string::npos) << value << ": " << message;
        EXPECT_NE(message.find(" at ("), std::string::npos) << message;
      }
      for (const double value : kSmall) {
        Vec3 position{1, 1, 1.8};
        position.*coordinate = value;
        EXPECT_EQ(refusal([&] { call(position); }), "") << value;
      }
    }
  }

  Site site_{room(), coarse()};
};

TEST_F(Positions, OfStationsAreFiniteAndInReach) {
  const auto placed = [](const Vec3& head) {
    return std::vector<PlacedStation>{{.uv = {}, .position = head, .ground = head}};
  };
  expect_checked("place_head", [&](const Vec3& p) { site_.place_head(p); });
  expect_checked("nearest_place", [&](const Vec3& p) { site_.nearest_place(p); });
  expect_checked("evaluate", [&](const Vec3& p) { site_.evaluate(placed(p)); });
  expect_checked("Simulator::evaluate", [&](const Vec3& p) { site_.simulator().evaluate({{.position = p}}); });
  expect_checked("Simulator::scan", [&](const Vec3& p) {
    site_.simulator().scan({.position = p}, {.outputs = scan_range}, [](const ScanChunk&) {});
  });
  expect_checked("visit", [&](const Vec3& p) { site_.on_site().visit(placed(p)); });
  expect_checked("panorama", [&](const Vec3& p) {
    const std::array views{PanoramaView::range};
    PanoramaRenderer(site_.scene(), {.width = 16}, site_.simulator_config()).render(p, views);
  });
}

TEST_F(Positions, OfChecksAndWaysAreFiniteAndInReach) {
  const Vec3 good{1, 1, 1.5};
  const ClashChecker& clash = site_.clash();
  const OnSite walk = site_.on_site();
  expect_checked("clashes", [&](const Vec3& p) { clash.clashes(p); });
  expect_checked("clashes with a head", [&](const Vec3& p) { clash.clashes(p, 1.8); });
  expect_checked("inside", [&](const Vec3& p) { clash.inside(p); });
  expect_checked("ground_below", [&](const Vec3& p) { clash.ground_below(p, 3); });
  expect_checked("sees from", [&](const Vec3& p) { clash.sees(p, good); });
  expect_checked("sees to", [&](const Vec3& p) { clash.sees(good, p); });
  expect_checked("ray_passes", [&](const Vec3& p) { clash.ray_passes(good, p); });
  expect_checked("distance", [&](const Vec3& p) { clash.distance(p, 1); });
  expect_checked("way_m from", [&](const Vec3& p) { walk.way_m(p, good); });
  expect_checked("way_m to", [&](const Vec3& p) { walk.way_m(good, p); });
  expect_checked("way from", [&](const Vec3& p) { walk.way(p, good); });
  expect_checked("way to", [&](const Vec3& p) { walk.way(good, p); });
  expect_checked("entrance", [&](const Vec3& p) {
    OnSiteOptions options;
    options.entrance = p;
    site_.on_site(options);
  });
  for (const double value : {kNaN, -1.0, -kInf}) EXPECT_NE(refusal([&] { clash.distance(good, value); }), "");
  for (const double value : {kNaN, kInf, 1e30}) EXPECT_NE(refusal([&] { clash.clashes(good, value); }), "");
}

TEST_F(Positions, OfQuestionsAreFiniteAndInReach) {
  expect_checked("existing", [&](const Vec3& p) {
    SurveyQuestion question;
    question.existing = {p};
    survey_problem(site_, question);
  });
  expect_checked("existing target", [&](const Vec3& p) {
    SurveyQuestion question;
    question.existing_targets = {{.name = "T1", .centre = p}};
    survey_problem(site_, question);
  });
  for (const double value : kNowhere) {
    SurveyProblem problem = coverage_fix(1);
    problem.existing = {{value, 0, 1.8}};
    EXPECT_NE(refusal([&] { plan(site_, problem); }), "") << value;
    PlanConfig config;
    config.start = {{0, value, 1.8}};
    EXPECT_NE(refusal([&] { plan(site_, coverage_fix(1), config); }), "") << value;
    EXPECT_NE(refusal([&] { greedy_network(site_, {.stations = 1, .existing = {{0, 0, value}}}); }), "") << value;
    EXPECT_NE(refusal([&] { exact_network(site_, {.stations = 1, .existing = {{value, 0, 1}}}); }), "") << value;
    SiteOptions options = coarse();
    options.enter = {{value, 1, 0}};
    EXPECT_NE(refusal([&] { Site(room(), options); }), "") << value;
  }
}

// A row's check accepts each value that the row reads, and refuses each other value that the options can hold.
template <class Options>
void expect_consistent(const SettingTable<Options>& table) {
  for (const SettingRow<Options>& row : table) {
    for (const char* text : {"nan", "inf", "-1",    "0",   "-0",     "5e-324", "1e-7",  "0.5",
                             "1",   "2",   "90",    "360", "1e6",    "1e30",   "1e308", "9223372036854775808",
                             "0,0", "1,2", "1,2,3", "a=1", "a=1e30", "90s"}) {
      Options options{};
      try {
        row.set(options, text, row.name);
      } catch (const Error&) {
        continue;
      }
      if (row.check) {
        EXPECT_EQ(refusal([&] { row.check(options, row.name); }), "") << row.name << " = " << text;
      }
    }
    if (row.check) {
      EXPECT_EQ(refusal([&] { row.check(Options{}, row.name); }), "") << "the default of " << row.name;
    }
  }
}

TEST(Bounds, OfATableTakeWhatItReads) {
  expect_consistent(site_settings());
  expect_consistent(question_settings());
  expect_consistent(plan_settings());
  expect_consistent(beam_settings());
  expect_consistent(next_settings());
}

// Sets each member to each bad number.
template <class Options>
void expect_refused(const std::vector<std::pair<const char*, std::function<void(Options&, double)>>>& members,
                    const std::function<void(const Options&)>& use, const std::vector<double>& values) {
  for (const auto& [name, set] : members)
    for (const double value : values) {
      Options options{};
      set(options, value);
      const std::string message = refusal([&] { use(options); });
      EXPECT_NE(message.find(name), std::string::npos) << name << " = " << value << ": " << message;
    }
}

TEST(Bounds, OfTheProgramHoldForMembersToo) {
  const std::vector<double> bad{kNaN, kInf, -kInf, -1, -1e30, -0x1p63};
  expect_refused<SiteOptions>(
      {{"height", [](SiteOptions& o, double v) { o.height_m = v; }},
       {"spacing", [](SiteOptions& o, double v) { o.spacing_m = v; }},
       {"user-size", [](SiteOptions& o, double v) { o.user_size_m = v; }},
       {"rate", [](SiteOptions& o, double v) { o.points_per_second = v; }},
       {"battery",
        [](SiteOptions& o, double v) {
          o.battery = {90, v};
        }},
       {"headroom", [](SiteOptions& o, double v) { o.headroom_m = v; }},
       {"min-area", [](SiteOptions& o, double v) { o.min_area_m2 = v; }},
       {"climb", [](SiteOptions& o, double v) { o.climb_m = v; }},
       {"slope", [](SiteOptions& o, double v) { o.max_slope = Angle::degrees(v); }},
       {"incidence", [](SiteOptions& o, double v) { o.max_incidence = Angle::degrees(v); }},
       {"horizontal", [](SiteOptions& o, double v) { o.horizontal_angle = Angle::degrees(v); }},
       {"passage",
        [](SiteOptions& o, double v) {
          o.passage_m = {v, 2};
        }},
       {"security",
        [](SiteOptions& o, double v) {
          o.security_m = {1, v, 0.5};
        }},
       {"range",
        [](SiteOptions& o, double v) {
          o.range_m = {0.5, v};
        }},
       {"beam",
        [](SiteOptions& o, double v) {
          o.beam = {v, 5};
        }},
       {"dropout", [](SiteOptions& o, double v) { o.dropout = v; }},
       {"detection",
        [](SiteOptions& o, double v) {
          o.detection = {100, v};
        }},
       {"step",
        [](SiteOptions& o, double v) {
          o.steps = {Angle::degrees(1), Angle::degrees(v)};
        }},
       {"diffuse", [](SiteOptions& o, double v) { o.scene.default_diffuse = v; }},
       {"wall-height", [](SiteOptions& o, double v) { o.scene.wall_height_m = v; }},
       {"detail",
        [](SiteOptions& o, double v) {
          o.scene.details_mm = {{"*", v}};
        }},
       {"accuracy",
        [](SiteOptions& o, double v) {
          o.scene.accuracies_mm = {{"*", v}};
        }}},
      [](const SiteOptions& options) { Site(room(), options); }, bad);
  Site site(room(), coarse());
  expect_refused<SurveyQuestion>(
      {{"capture", [](SurveyQuestion& q, double v) { q.capture = v; }},
       {"link", [](SurveyQuestion& q, double v) { q.link = v; }},
       {"apart", [](SurveyQuestion& q, double v) { q.apart_m = v; }},
       {"link-overlap", [](SurveyQuestion& q, double v) { q.link_overlap = v; }},
       {"min-overlap", [](SurveyQuestion& q, double v) { q.min_overlap = v; }},
       {"max-time-on-site", [](SurveyQuestion& q, double v) { q.minutes_on_site = v; }},
       {"heights",
        [](SurveyQuestion& q, double v) {
          q.heights_m = {v, 2};
        }},
       {"fitness",
        [](SurveyQuestion& q, double v) {
          q.fitness = {v, 0.5, 0.5};
        }},
       {"set-up", [](SurveyQuestion& q, double v) { q.on_site.set_up_min = v; }},
       {"walking", [](SurveyQuestion& q, double v) { q.on_site.walking_m_per_s = v; }},
       {"day", [](SurveyQuestion& q, double v) { q.on_site.day_min = v; }},
       {"registration-rho", [](SurveyQuestion& q, double v) { q.registration.model.rho_m = v; }},
       {"registration-heading", [](SurveyQuestion& q, double v) { q.registration.heading = Angle::degrees(v); }},
       {"target-diameter", [](SurveyQuestion& q, double v) { q.target.diameter_m = v; }}},
      [&](const SurveyQuestion& question) { survey_problem(site, question); }, bad);
  expect_refused<SurveyQuestion>({{"capture", [](SurveyQuestion& q, double v) { q.capture = v; }},
                                  {"link", [](SurveyQuestion& q, double v) { q.link = v; }}},
                                 [&](const SurveyQuestion& question) { survey_problem(site, question); }, {90, 1.001});
  expect_refused<PlanConfig>(
      {{"sigma", [](PlanConfig& c, double v) { c.sigma0 = v; }},
       {"max-time", [](PlanConfig& c, double v) { c.max_seconds = v; }},
       {"sample", [](PlanConfig& c, double v) { c.sample_share = v; }},
       {"target-hypervolume", [](PlanConfig& c, double v) { c.target_hypervolume = v; }}},
      [&](const PlanConfig& config) { plan(site, coverage_fix(1), config); }, bad);
  for (const double value : bad) {
    EXPECT_NE(refusal([&] { fewest_stations(value); }), "") << value;
    EXPECT_NE(refusal([&] { fewest_stations(0.9, value); }), "") << value;
    EXPECT_NE(refusal([&] { site.evaluate({}, {.link = value}); }), "") << value;
    OnSiteOptions options;
    options.detour = value;
    EXPECT_NE(refusal([&] { site.on_site(options); }).find("detour"), std::string::npos) << value;
  }
  EXPECT_NE(refusal([&] { fewest_stations(90); }).find("90"), std::string::npos);
}

TEST(Bounds, AnObjectiveWithoutANumberIsTold) {
  Site site(room(), coarse());
  SurveyProblem problem = coverage_fix(1);
  problem.objectives.front().name = "mine";
  problem.objectives.front().value = [](const MeasuredNetwork&) { return kNaN; };
  PlanConfig config;
  config.population = 4, config.iterations = 1, config.sample_voxels = 50;
  const std::string message = refusal([&] { plan(site, problem, config); });
  EXPECT_NE(message.find("objective \"mine\": its value is NaN"), std::string::npos) << message;
}

// A round over legs so long that a gain of a nanometre is rounding has an end.
TEST(Bounds, ARoundWithLongDetoursEnds) {
  Site site(room(), coarse());
  OnSiteOptions options;
  options.detour = 1000;
  std::vector<PlacedStation> stations;
  for (int k = 0; k < 12; ++k) {
    const Vec3 ground{9e5 * std::cos(k * 2.4), 9e5 * std::sin(k * 2.4), 0};
    stations.push_back({.uv = {}, .position = ground, .ground = ground});
  }
  const Visit visit = site.on_site(options).visit(stations);
  EXPECT_EQ(visit.order.size(), stations.size());
  EXPECT_TRUE(std::isfinite(visit.minutes));
}

}  // namespace
}  // namespace vantage
