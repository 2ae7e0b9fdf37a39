// SPDX-License-Identifier: Apache-2.0
#include "map/pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "map/chart.hpp"
#include "map/front_view.hpp"
#include "map/relief.hpp"
#include "map/search_tint.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "unit/map/drawn.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

TEST(Chart, TicksAreRoundAndInside) {
  EXPECT_EQ(nice_ticks(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(tick_labels(nice_ticks(0, 1, 5)), (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(tick_labels(nice_ticks(-30, 30, 6)),
            (std::vector<std::string>{"-30", "-20", "-10", "0", "10", "20", "30"}));
  EXPECT_EQ(tick_labels(nice_ticks(4'500'000.2, 4'500'020.1, 4)).front(), "4500005");
  EXPECT_EQ(tick_labels({0}), (std::vector<std::string>{"0"}));
  std::mt19937 random(2);
  for (int round = 0; round < 1000; ++round) {
    const double low = std::ldexp(static_cast<double>(random()) - 2e9, -static_cast<int>(random() % 60));
    const double high = low + std::ldexp(1.0 + static_cast<double>(random()), -static_cast<int>(random() % 30));
    if (!(high - low > 1e-9 * std::abs(low))) continue;
    const auto ticks = nice_ticks(low, high, 6);
    EXPECT_LE(ticks.size(), 13u);
    EXPECT_GE(ticks.size(), 2u) << low << " " << high;
    for (const double t : ticks) EXPECT_TRUE(t >= low - 1e-6 * (high - low) && t <= high + 1e-6 * (high - low));
  }
}

TEST(Chart, LabelsOfNationalCoordinatesTellTheirTicksApart) {
  const std::vector<double> ticks = nice_ticks(5621391.2, 5621392.9, 4);
  const std::vector<std::string> labels = tick_labels(ticks);
  EXPECT_EQ(std::set<std::string>(labels.begin(), labels.end()).size(), ticks.size());
  EXPECT_EQ(labels.front(), "5621391.5");
  EXPECT_EQ(tick_labels({5621390, 5621400}).front(), "5621390");
}

TEST(Chart, ANationalCoordinateHasRoomBesideItsAxis) {
  const Axis axis{.label = "y (m)", .low = 5621391.2, .high = 5621392.9, .wanted_ticks = 4};
  Canvas canvas(10, 10);
  EXPECT_GT(room_left_of(canvas, axis), canvas.text_width("5621391.5", {.size = 12.5}) + 40);
  EXPECT_EQ(room_left_of(canvas, {.label = "", .low = 0, .high = 9}), 86);
}

TEST(Chart, LogarithmicTicksArePowersOfTenAndMoreWhereTheseAreFew) {
  const auto many = logarithmic_ticks(0.003, 2000), few = logarithmic_ticks(0.9, 60);
  EXPECT_EQ(logarithmic_labels(many), (std::vector<std::string>{"0.01", "0.1", "1", "10", "100", "1\u2009000"}));
  EXPECT_EQ(logarithmic_labels(few), (std::vector<std::string>{"1", "2", "5", "10", "20", "50"}));
  EXPECT_EQ(logarithmic_labels(logarithmic_ticks(0.02, 0.5)),
            (std::vector<std::string>{"0.02", "0.05", "0.1", "0.2", "0.5"}));
}

TEST(Chart, LogarithmicAxesGiveEveryFactorTheSameLength) {
  Canvas canvas(400, 300);
  const Chart chart(canvas, {50, 50, 300, 200}, {.label = "x", .low = 1, .high = 1000, .logarithmic = true},
                    {.label = "y", .low = 0, .high = 2}, "");
  EXPECT_NEAR(chart.at(10, 0).x, 150, 1e-9);
  EXPECT_NEAR(chart.at(100, 1).x, 250, 1e-9);
  EXPECT_NEAR(chart.at(1, 1).y, 150, 1e-9);
}

TEST(Chart, AxesHoldTheirDataAndNoTickBeyondWhatCanBe) {
  const Axis narrow = axis_over("", 0.985, 0.985, 0, 1);
  EXPECT_LT(narrow.low, 0.985);
  EXPECT_GT(narrow.high, 0.985);
  const Axis full = axis_over("", 0.2, 1, 0, 1);
  EXPECT_GT(full.high, 1);  // a dot at 1 is whole
  EXPECT_LE(full.ticks.back(), 1);
}

TEST(Chart, LabelsKeepOffEachOther) {
  std::mt19937 random(5);
  std::vector<Rect> taken;
  for (int k = 0; k < 12; ++k) {
    const Point at{100 + static_cast<double>(random() % 400), 100 + static_cast<double>(random() % 300)};
    const Rect r = place_label(at, 10, 80, 16, {0, 0, 600, 500}, taken);
    EXPECT_GE(r.x, 0);
    EXPECT_LE(r.right(), 600);
  }
  for (std::size_t i = 0; i < taken.size(); ++i)
    for (std::size_t j = i + 1; j < taken.size(); ++j) EXPECT_FALSE(taken[i].overlaps(taken[j])) << i << " " << j;
}

TEST(SearchTint, HasARimAtItsEdgeAndNoneAtSeams) {
  // Two squares side by side, the second with vertices of its own and cut otherwise, as a chart's seam makes them.
  SearchMesh mesh;
  for (const auto& [x, y] : {std::pair{0.0, 0.0},
                             {1.0, 0.0},
                             {1.0, 1.0},
                             {0.0, 1.0},
                             {1.0, 0.0},
                             {2.0, 0.0},
                             {2.0, 1.0},
                             {1.0, 1.0},
                             {1.0, 0.4}})
    mesh.positions.push_back({x, y, 0});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 8}, {8, 5, 6}, {8, 6, 7}};
  const MapWindow window{.x_min = -1, .y_max = 2, .pixel_m = 0.02, .columns = 200, .rows = 150};
  const auto pixel_of = [&](double x, double y) {
    const MapPoint p = window.at({x, y, 0});
    return static_cast<std::size_t>(p.y) * window.columns + static_cast<std::size_t>(p.x);
  };
  std::vector<std::uint32_t> pixels(window.columns * window.rows, 0xFFFFFFFFu);
  pixels[60 * window.columns + 60] = 0;  // nothing there: paper
  // at z = 0 with the local frame's origin 5 lower
  HeightBuffer heights{window, std::vector<float>(pixels.size(), 5), {}};
  heights.z[pixel_of(1.5, 0.4)] = 5.2f;
  for (const double y : {0.03, 0.6}) heights.z[pixel_of(1.5, y)] = 5.4f;
  tint_search_area(pixels, heights, -5, mesh);
  const auto green_at = [&](double x, double y) {
    const std::uint32_t pixel = pixels[pixel_of(x, y)];
    EXPECT_EQ(pixel >> 24, 255u);
    return 255.0 - (pixel >> 16 & 255u);  // red goes first
  };
  const double full = 255 * (1 - kSearchTint.r);
  EXPECT_EQ(green_at(-0.03, 0.5), 0);
  EXPECT_EQ(green_at(0.5, 1.03), 0);
  for (const auto& [x, y] : {std::pair{0.5, 0.5}, {0.99, 0.7}, {1.5, 0.4}, {1.01, 0.41}, {1.3, 0.2}, {0.21, 0.79}})
    EXPECT_NEAR(green_at(x, y), kSearchOpacity * full, 1) << x << ' ' << y;
  for (const auto& [x, y] : {std::pair{0.03, 0.5}, {0.5, 0.03}, {1.97, 0.5}, {1.2, 0.97}, {0.01, 0.01}, {0.05, 0.5}})
    EXPECT_NEAR(green_at(x, y), kSearchRim * full, 1) << x << ' ' << y;
  EXPECT_NEAR(green_at(0.11, 0.5), kSearchOpacity * full, 1);
  EXPECT_EQ(green_at(1.5, 0.6), 0) << "under something";
  EXPECT_NEAR(green_at(1.5, 0.03), kHiddenRim * full, 1) << "at the edge, and under something";
}

// A floor of 4 x 4 m at z = 0, a table of 2 x 2 m at z = 1 in its middle, a wall without thickness at x = -1.5, in
// local coordinates.
Scene room() {
  std::vector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto n = static_cast<std::uint32_t>(p.size());
    p.insert(p.end(), {a, b, c, d});
    t.insert(t.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  };
  quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  quad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  quad({-1.5, -1, 0}, {-1.5, 1, 0}, {-1.5, 1, 2}, {-1.5, -1, 2});
  return Scene::from_triangles(p, t);
}

TEST(Relief, ShowsTheTopmostSurface) {
  const Scene scene = room();
  const SceneData& data = scene.data();
  const MapWindow window{.x_min = -4, .y_max = 4, .pixel_m = 0.04, .columns = 200, .rows = 200};
  const auto z_at = [&](const HeightBuffer& h, double x, double y) {
    return h.z[static_cast<std::size_t>((4 - y) / 0.04) * 200 + static_cast<std::size_t>((x + 4) / 0.04)] +
           data.origin.z;
  };
  const HeightBuffer open = look_from_above(data, window, 1e9);
  EXPECT_NEAR(z_at(open, 0.3, 0.2), 1, 1e-6);
  EXPECT_NEAR(z_at(open, 1.7, 1.7), 0, 1e-6);
  EXPECT_NEAR(z_at(open, -1.5, 0.5), 2, 1e-6);  // the wall is there, though it covers no area
  EXPECT_FALSE(std::isfinite(z_at(open, 3, 0)));
  const HeightBuffer cut = look_from_above(data, window, 0.5);
  EXPECT_NEAR(z_at(cut, 0.3, 0.2), 0, 1e-6);
  EXPECT_NEAR(z_at(cut, -1.5, 0.5), 0, 1e-6);  // the wall is cut through
  const auto pixels = shade(data, open);
  EXPECT_EQ(pixels[100 * 200 + 190], 0u);
  EXPECT_EQ(pixels[100 * 200 + 105] >> 24, 255u);
  const auto half = halve(pixels, 200);
  EXPECT_EQ(half.size(), 100u * 100);
  EXPECT_EQ(half[50 * 100 + 52], pixels[100 * 200 + 105]);  // amid an even surface
}

constexpr std::size_t kDot = 100;  // pixels; a disc of the front has 250, a letter in its colour fewer

// Shapes of an SVG: every stroke and fill is a path of its own.
std::size_t shapes(const std::string& svg) {
  std::size_t count = 0;
  for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) ++count;
  return count;
}

TEST(Pictures, EveryFrontIsDrawnAsPngAndSvg) {
  const test::TemporaryFolder folder;
  for (const std::string problem : {"coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min"}) {
    const std::size_t networks = problem == "coverage-fix" ? 1 : 12;
    const PlanResult result = test::sample_result(problem, 2, 9, networks, 1000);
    for (const char* name : {"a.png", "a.svg"}) {
      const auto drawn = [&](auto draw) {
        draw(folder / name, result);
        const std::string bytes = test::content(folder / name);
        if (std::string(name) == "a.png") {
          EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1A\n");
          EXPECT_EQ(test::Drawn(folder / name).width(), 1560u);
        } else {
          EXPECT_EQ(bytes.substr(0, 5), "<?xml");
          EXPECT_NE(bytes.find("</svg>"), std::string::npos);
          EXPECT_GT(shapes(bytes), 15u);  // frame, grid and ticks alone
        }
        if (problem != "coverage-overlap-min") return;
        draw(folder / (std::string("again") + name).c_str(), result);
        EXPECT_TRUE(test::content(folder / (std::string("again") + name).c_str()) == bytes) << problem << " " << name;
      };
      drawn(draw_front);
      drawn(draw_hypervolume);
      drawn(draw_history_fronts);
    }
  }
}

// One disc a network, in the colour of its number of stations where that is an objective, and one in the legend or the
// bar.
TEST(Pictures, TheFrontHasADotForEveryNetwork) {
  const test::TemporaryFolder folder;
  for (const std::string problem : {"coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min"}) {
    const std::size_t networks = problem == "coverage-fix" ? 1 : 12;
    const PlanResult result = test::sample_result(problem, 2, 9, networks, 1000);
    draw_front(folder / "front.png", result);
    const test::Drawn front(folder / "front.png");
    EXPECT_EQ(front.patches(style::kOrange, 2 * kDot).size(), problem == "coverage-fix" ? 0u : 2u)
        << problem << ": a ring around the answer, and the legend's";
    if (problem != "coverage-overlap-min") {
      EXPECT_EQ(front.patches(style::kBlue, kDot).size(), networks + 1) << problem;
      continue;
    }
    for (std::size_t n = 2; n <= 9; ++n) {
      const auto of_size = std::count_if(result.front.begin(), result.front.end(),
                                         [&](const PlanEntry& entry) { return entry.stations.size() == n; });
      const Colour colour = FrontView(result).colour({.colour = static_cast<double>(n)});
      EXPECT_EQ(front.patches(colour, kDot).size(), static_cast<std::size_t>(of_size) + 1) << n << " stations";
    }
  }
}

TEST(Pictures, TheHypervolumeIsACurveOverAllIterations) {
  const test::TemporaryFolder folder;
  const PlanResult result = test::sample_result("coverage-overlap-fix", 4, 4, 12);
  draw_hypervolume(folder / "curve.png", result);
  const auto patches = test::Drawn(folder / "curve.png").patches(style::kBlue, kDot);
  ASSERT_FALSE(patches.empty());
  const auto longest = std::max_element(patches.begin(), patches.end(),
                                        [](const auto& a, const auto& b) { return a.columns < b.columns; });
  EXPECT_GT(longest->columns, 1100u);  // 19 of 20.4 iterations on 1328 pixels, its label over the end
  EXPECT_LT(longest->columns, 1328u);
}

TEST(Pictures, TheHistoryEndsWithTheLastFront) {
  const test::TemporaryFolder folder;
  const PlanResult result = test::sample_result("coverage-overlap-fix", 4, 4, 12);
  draw_history_fronts(folder / "history.png", result);
  const test::Drawn history(folder / "history.png");
  EXPECT_EQ(history.patches(mix({1, 1, 1}, style::kBlue, 0.85), 60, 6).size(), 12u);
  EXPECT_EQ(history.patches(style::kBlue, 60).size(), 1u) << "the legend";
}

TEST(Pictures, DrawResultsThatHoldLittle) {
  const test::TemporaryFolder folder;
  for (const std::string problem : {"coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min"}) {
    PlanResult one = test::sample_result(problem, 1, problem.ends_with("-min") ? 64 : 1, 1);
    one.front[0].exact = false;
    one.front[0].values["coverage"] = one.front[0].values["overlap"] = Estimate{std::nan(""), 0};
    one.history.resize(1);
    one.history[0].hypervolume = 0;
    const auto drawn = [&](auto draw) {
      draw(folder / "empty.png", PlanResult{});
      draw(folder / "one.png", one);
      for (const char* name : {"empty.png", "one.png"})
        EXPECT_GT(test::Drawn(folder / name).ink(), 50'000u)
            << problem << ", " << name << ": title, frame, grid and labels";
      EXPECT_FALSE(test::content(folder / "empty.png") == test::content(folder / "one.png")) << problem;
    };
    drawn(draw_front);
    drawn(draw_hypervolume);
    drawn(draw_history_fronts);
  }
  EXPECT_EQ(test::entries(folder.path()), 2u);
}

TEST(Pictures, RefuseOtherFormats) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(draw_hypervolume(folder / "a.pdf", {}), Error);
  EXPECT_EQ(test::entries(folder.path()), 0u);
}

SearchArea floor_of_room() {
  SearchMesh mesh;
  mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return SearchArea::from_mesh(mesh);
}

Site site_of(const Scene& scene, const SearchArea& area) {
  return test::site_of(
      Simulator(scene, test::coarse_scanner(5), {.engine = Engine::embree, .user_size_m = 1, .point_spacing_m = 0.5}),
      area);
}

TEST(Pictures, PlanViewDrawsEveryKindOfStation) {
  const test::TemporaryFolder folder;
  Site site = site_of(room(), floor_of_room());
  const auto station = [](double x, double y, StationStatus status, bool kept) {
    return PlacedStation{.uv = {}, .position = {x, y, 1.8}, .ground = {x, y, 0}, .status = status, .existing = kept};
  };
  const std::vector<PlacedStation> stations{
      station(-1, -1, StationStatus::ok, false),  station(-1, -1, StationStatus::ok, false),
      station(1.6, -1, StationStatus::ok, false), station(1.6, 1.6, StationStatus::clash, false),
      station(0, 1.6, StationStatus::ok, true),   {.uv = {5, 5}, .position = {}, .status = StationStatus::hole}};
  OverlapMatrix overlap(6);
  overlap.set(0, 2, 0.5);
  const StationLinks links{.least = 0.01, .values = overlap};
  draw_plan_view(folder / "plan.png", site, stations, links, "A room");
  draw_plan_view(folder / "plan.svg", site, stations, links, "A room");
  draw_plan_view(folder / "unlinked.png", site, stations, {.values = OverlapMatrix(6)}, "A room");
  const auto written = draw_plan_view(folder / "none.png", site, {}, {}, "No station");
  EXPECT_EQ(written, std::vector{folder / "none.png"});
  EXPECT_EQ(test::entries(folder.path()), 4u);
  const test::Drawn plan(folder / "plan.png"), unlinked(folder / "unlinked.png"), none(folder / "none.png");
  constexpr Colour number{0.10, 0.22, 0.45}, kept{0.42, 0.16, 0.44}, skipped{0.93, 0.93, 0.94};
  constexpr std::size_t disc = 600;  // pixels; one with its name has 700 and more
  constexpr std::size_t spot = 80;   // a true spot, without the rim
  EXPECT_EQ(plan.patches(number, disc).size(), 4u) << "three stations, two moved apart, and the legend's";
  EXPECT_EQ(plan.patches(kept, disc).size(), 2u) << "the kept one, and the legend's";
  EXPECT_EQ(plan.patches(skipped, disc).size(), 2u) << "the one that clashes, and the legend's";
  EXPECT_GE(plan.patches(number, spot).size(), 5u) << "and the spot that two stand on";
  EXPECT_EQ(none.patches(number, disc).size(), 1u);
  EXPECT_EQ(none.patches(skipped, disc).size(), 0u);
  EXPECT_GT(plan.near(style::kOrange, 40), unlinked.near(style::kOrange, 40) + 200) << "the link, the only one";
  // The map is room and search area: 640 units high at two pixels each, nearly as wide.
  EXPECT_GT(none.ink(), 1'000'000u);
  EXPECT_GT(shapes(test::content(folder / "plan.svg")), 40u);
  EXPECT_THROW(draw_plan_view(folder / "bad.png", site, stations, {.values = OverlapMatrix(3)}, "Wrong"), Error);
}

TEST(Pictures, PlanViewNamesTheRoomsOfItsFloor) {
  const auto ink = [&](double z) {
    const test::TemporaryFolder folder;
    auto data = std::make_shared<SceneData>(room().data());
    for (const auto& [name, x] : {std::pair{"Kitchen", -1.0}, {"Hall", 1.0}})
      data->rooms.push_back({.name = name, .storey = "", .box = {{x - 1, -2, z}, {x + 1, 2, z + 2.5}}});
    Site site = site_of(Scene(std::shared_ptr<const SceneData>(std::move(data))), floor_of_room());
    draw_plan_view(folder / "plan.png", site, {}, {}, "Rooms");
    return test::Drawn(folder / "plan.png").near(style::kFaint, 30);
  };
  EXPECT_GT(ink(0), ink(3) + 100) << "above the floor that is shown, they have no name on it";
}

TEST(Pictures, PlanViewDrawsStandardEllipses) {
  const test::TemporaryFolder folder;
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {-1, -1, 1.8}, .ground = {-1, -1, 0}},
                                            {.uv = {}, .position = {1, 1, 1.8}, .ground = {1, 1, 0}}};
  std::vector<StationError> errors(2);
  errors[0].covariance = {4e-6, 0, 0, 0, 1e-6, 0, 0, 0, 1e-6};
  errors[1].covariance = {5e-6, 4e-6, 0, 4e-6, 5e-6, 0, 0, 0, 1e-6};  // 3 mm and 1 mm along the diagonals
  const PlanView view{.scene = room(),
                      .area = floor_of_room(),
                      .stations = stations,
                      .names = {"S1", "S2"},
                      .title = "",
                      .errors = errors};
  EXPECT_NEAR(kWidestEllipse / view.ellipse_scale(), 3e-3, 1e-12);
  Site site = site_of(room(), floor_of_room());
  const auto red = [&](const char* name, std::span<const StationError> shown) {
    draw_plan_view(folder / name, site, stations, {}, "A room", {}, shown);
    return test::Drawn(folder / name).near({0.72, 0.12, 0.12}, 40);
  };
  EXPECT_GT(red("with.png", errors), red("without.png", {}) + 200);
  EXPECT_THROW(red("wrong.png", std::span(errors).first(1)), Error);
}

// Maps of two stations, alone and among so many that their bits are in two words.
class RegistrationMaps : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Pictures, RegistrationMaps, testing::Values(2, 67));
TEST_P(RegistrationMaps, ShowTheErrorWhereItIs) {
  const std::size_t count = GetParam(), last = count - 1;
  const test::TemporaryFolder folder;
  Site site = test::site_of(Simulator(test::wall_and_floor().scene(), test::coarse_scanner(1),
                                      {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.2}));
  const Simulator& simulator = site.simulator();
  VoxelField field;
  field.count.assign(simulator.voxel_count(), 1);
  const std::size_t voxels = simulator.voxel_count();
  std::vector<std::vector<std::uint64_t>> words(last / 64 + 1, std::vector<std::uint64_t>(voxels, 0));
  for (std::size_t k = 1; k < voxels; ++k) {
    words.front()[k] = 1;
    if (k % 2 == 0) words.back()[k] |= std::uint64_t{1} << (last % 64);
  }
  field.stations = StationMasks(voxels, count);
  for (std::size_t w = 0; w < words.size(); ++w) field.stations.set_words(w, words[w]);
  // Shifts of 1 mm and 7 mm, one sigma along x.
  RegistrationError error;
  error.stations.resize(count), error.poses.resize(count);
  error.poses[0][21] = 1e-6, error.poses[last][21] = 49e-6;
  for (const PlyCoordinates coordinates : {PlyCoordinates::floats, PlyCoordinates::doubles}) {
    write_registration_ply(folder / "error.ply", simulator, field, error, coordinates);
    const std::string ply = test::content(folder / "error.ply");
    std::size_t at = ply.find("end_header\n") + 11;
    EXPECT_NE(ply.find("element vertex " + std::to_string(voxels - 1) + "\n"), std::string::npos);
    for (std::size_t k = 1; k < voxels; ++k) {
      const double x = simulator.voxel_centre(k).x;
      if (coordinates == PlyCoordinates::doubles)
        ASSERT_EQ(test::take<double>(ply, at), x);
      else
        ASSERT_EQ(test::take<float>(ply, at), static_cast<float>(x));
      at += coordinates == PlyCoordinates::doubles ? 19 : 11;
      ASSERT_FLOAT_EQ(test::take<float>(ply, at), k % 2 ? 1.0f : 5.0f) << k;
    }
    EXPECT_EQ(at, ply.size());
  }
  write_coverage_ply(folder / "coverage.ply", simulator, field);
  const std::string coverage = test::content(folder / "coverage.ply");
  EXPECT_EQ(coverage.find("property uint stations_low\nproperty uint stations_high\n") == std::string::npos,
            count > 64);
  EXPECT_EQ(coverage.find("property uint stations\n") == std::string::npos, count <= 64);
  const std::size_t many = coverage.size() - sizeof(std::uint32_t);  // stations of the last voxel
  if (count > 64) {
    std::size_t last_number = many;
    EXPECT_EQ(test::take<std::uint32_t>(coverage, last_number), voxels % 2 == 1 ? 2u : 1u);
  }
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {0, 0, 0}, .status = StationStatus::ok}};
  for (const char* name : {"error.png", "error.svg"})
    draw_registration(folder / name, site, field, error, stations, "Where scans are off");
  EXPECT_GT(test::Drawn(folder / "error.png").near(kRisingRamp.back(), 40), 500u) << "the largest on top";
  field.stations = StationMasks(voxels - 1, count);
  EXPECT_THROW(write_registration_ply(folder / "bad.ply", simulator, field, error), Error);
}

TEST(Pictures, NothingOfAPlanViewIsCutOff) {
  const test::TemporaryFolder folder;
  const std::string title(90, 'W');  // wider than the map
  const auto page = plan_view_pictures(
      {.scene = room(), .area = floor_of_room(), .stations = {}, .names = {}, .links = {}, .title = title});
  ASSERT_EQ(page.size(), 1u);
  Canvas scratch(1, 1);
  EXPECT_GT(page[0].canvas->width(), 86 + scratch.text_width(title, {.size = 17, .bold = true}));
}

// Two floors with a wall as a box on each, and a slab between them.
TEST(Pictures, EachFloorHasAPageAndItsWallsAreFilled) {
  std::vector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  const auto box = [&](Vec3 a, Vec3 b) {
    const auto n = static_cast<std::uint32_t>(p.size());
    for (int k = 0; k < 8; ++k) p.push_back({k & 1 ? b.x : a.x, k & 2 ? b.y : a.y, k & 4 ? b.z : a.z});
    for (const auto& [i, j, k, l] : std::vector<std::array<std::uint32_t, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
      t.insert(t.end(), {{n + i, n + j, n + k}, {n + i, n + k, n + l}});
  };
  box({0, 0, -0.2}, {10, 8, 0}), box({0, 0, 2.8}, {10, 8, 3});
  box({4.8, 0, 0}, {5.2, 8, 2.8});  // across the lower floor
  box({0, 3.9, 3}, {3, 4.1, 5.5});  // a short one on the upper floor
  SearchMesh mesh;
  for (const double z : {0.0, 3.0}) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{0, 0, z}, {10, 0, z}, {10, 8, z}, {0, 8, z}});
    mesh.uvs.insert(mesh.uvs.end(), {{z, 0}, {z + 1, 0}, {z + 1, 1}, {z, 1}});
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  }
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {2, 2, 1.85}, .ground = {2, 2, 0}},
                                            {.uv = {}, .position = {8, 6, 4.85}, .ground = {8, 6, 3}}};
  const test::TemporaryFolder folder;
  Site site = site_of(Scene::from_triangles(p, t), SearchArea::from_mesh(mesh));
  const auto written = draw_plan_view(folder / "plan.png", site, stations, {.values = OverlapMatrix(2)}, "A house");
  ASSERT_EQ(written, (std::vector{folder / "plan.png", folder / "plan-level-1.png", folder / "plan-level-2.png"}));
  constexpr Colour cut{0.27, 0.28, 0.31}, number{0.10, 0.22, 0.45};
  const auto largest = [&](const std::filesystem::path& file) {
    std::size_t pixels = 0;
    for (const auto& patch : test::Drawn(file).patches(cut, 100)) pixels = std::max(pixels, patch.pixels);
    return static_cast<double>(pixels);
  };
  // The window is 10.6 m on 700 units of two pixels.
  const double metre = 1400 / 10.6;
  EXPECT_NEAR(largest(written[1]), 0.4 * 8 * metre * metre, 0.12 * 0.4 * 8 * metre * metre);
  EXPECT_NEAR(largest(written[2]), 0.2 * 3 * metre * metre, 0.12 * 0.2 * 3 * metre * metre);
  EXPECT_EQ(test::Drawn(written[0]).patches(number, 600).size(), 3u) << "both floors side by side, and the legend's";
  for (const std::size_t k : {1u, 2u})
    EXPECT_EQ(test::Drawn(written[k]).patches(number, 600).size(), 2u) << "its own station, and the legend's";
}

// Marks of the usual size would hide a narrow site.
TEST(Pictures, MarksAreSmallerOnANarrowSite) {
  SearchMesh mesh;
  mesh.positions = {{0, 0, 0}, {60, 0, 0}, {60, 3, 0}, {0, 3, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  std::vector<PlacedStation> stations;
  for (int k = 0; k < 8; ++k) {
    const Vec3 ground{4 + 7.5 * k, 1.5, 0};
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  }
  const test::TemporaryFolder folder;
  Site site = site_of(Scene::from_triangles(mesh.positions, mesh.triangles), SearchArea::from_mesh(mesh));
  draw_plan_view(folder / "plan.png", site, stations, {.values = OverlapMatrix(8)}, "A tunnel");
  const test::Drawn plan(folder / "plan.png");
  constexpr Colour number{0.10, 0.22, 0.45};
  EXPECT_EQ(plan.patches(number, 600).size(), 1u) << "the legend's";
  EXPECT_EQ(plan.patches(number, 150).size(), 9u);
}

// A picture of all levels is an overview: each has one of its own.
TEST(Pictures, ManyLevelsAreAContactSheet) {
  std::vector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  SearchMesh mesh;
  std::vector<PlacedStation> stations;
  constexpr int kLevels = 8;
  for (int level = 0; level <= kLevels; ++level) {
    const double z = 3.0 * level;
    const auto n = static_cast<std::uint32_t>(p.size());
    p.insert(p.end(),
             {{456'789, 5'621'391, z}, {456'801, 5'621'391, z}, {456'801, 5'621'399, z}, {456'789, 5'621'399, z}});
    t.insert(t.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
    if (level == kLevels) break;
    for (std::uint32_t k = 0; k < 4; ++k) mesh.positions.push_back(p[n + k]), mesh.uvs.push_back({z + k % 2, k / 2.0});
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
    const Vec3 ground{456'795, 5'621'395, z};
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  }
  const test::TemporaryFolder folder;
  Site site = site_of(Scene::from_triangles(p, t), SearchArea::from_mesh(mesh));
  const auto written =
      draw_plan_view(folder / "plan.png", site, stations, {.values = OverlapMatrix(kLevels)}, "A tower");
  ASSERT_EQ(written.size(), kLevels + 1u);
  const Image sheet = read_image(written.front());
  EXPECT_LT(sheet.width, 4000u);
  EXPECT_LT(sheet.height, 4000u);
  EXPECT_GT(test::Drawn(written.front()).patches({0.10, 0.22, 0.45}, 100).size(), kLevels) << "a mark on each level";
}

}  // namespace
}  // namespace vantage
