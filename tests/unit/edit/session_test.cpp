// SPDX-License-Identifier: Apache-2.0
#include "edit/session.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "scene/scene_data.hpp"
#include "support/boxes_on_ground.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "unit/placement/placement_scenes.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/planner.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using State = nlohmann::ordered_json;

// A wall that is surveyed, and more of it that counts three times, on a floor to stand on; a scanner with noise.
Scene weighed_site() {
  test::QuadScene quads = test::wall_and_floor({1000, 2000, 50});
  quads.quad({-5, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
  quads.data().meshes.back().weight = 3;
  return quads.scene();
}

Scanner noisy_scanner() {
  Scanner scanner = load_scanner("rtc360");
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.5);
  scanner.height_m = 1.5;
  return scanner;
}

// The state once nothing is under way, or after two minutes.
State finished(const EditSession& session) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  State state = session.state();
  while (!state["busy"].is_null() && std::chrono::steady_clock::now() < end) state = session.state();
  return state;
}

struct Bench {
  Site site = test::site_of(Simulator(weighed_site(), noisy_scanner(),
                                      {.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.1}));
  Simulator& simulator = site.simulator();
  EditOptions options{.voxels = 300, .cells = 200, .improve_seconds = 2, .attainable_voxels = 0};
  std::size_t kept = 0;
  std::vector<EditStation> last_kept;
  std::vector<PlacedStation> saved;
  std::uint64_t saved_voxels = 0;
  std::vector<std::string> saved_names;
  EditSession session{site,
                      {},
                      options,
                      [this](const std::vector<EditStation>& stations) { ++kept, last_kept = stations; },
                      [this](const Evaluation& exact, const Progress&) {
                        saved = exact.stations, saved_voxels = exact.counts.voxels, saved_names = exact.names;
                        return std::string("saved in a folder");
                      }};

  State add(double x, double y) {
    session.change({{"do", "add"}, {"to", {1000 + x, 2000 + y, 50 - 1.5}}});
    return session.state();
  }
  void move(int id, double x, double y) {
    session.change({{"do", "move"}, {"id", id}, {"to", {1000 + x, 2000 + y, 50 - 1.5}}});
  }
  Network network() const {
    Network stations;
    const State state = session.state();
    for (const auto& s : state["network"]["stations"])
      stations.push_back({.position = {s["position"][0], s["position"][1], s["position"][2]}, .active = s["active"]});
    return stations;
  }
  State finished() const { return vantage::finished(session); }
};

// The numbers of `vantage evaluate --sample` and `--exact` for the same stations, to the last bit.
TEST(EditSession, ShowsTheNumbersOfTheProgram) {
  Bench bench;
  bench.add(2, -1);
  bench.add(-2, 1);
  bench.add(0, 3);
  for (const auto& [id, x, y] : {std::tuple{2, -3.0, 2.0}, {1, 3.0, -2.5}, {3, 1.0, 0.5}, {2, -2.5, -2.0}}) {
    bench.move(id, x, y);
    const State state = bench.session.state();
    const Network network = bench.network();
    const NetworkCounts counts =
        bench.simulator.evaluate_sampled({&network, 1}, {.voxels = bench.options.voxels}).front();
    const std::uint64_t voxels = bench.simulator.voxel_count();
    ASSERT_GT(voxels, bench.options.voxels);
    const Estimate covered = coverage_estimate(counts, bench.simulator.goal_density(), voxels);
    const Estimate overlap = overlap_estimate(counts, voxels);
    EXPECT_GT(covered.value, 0);
    EXPECT_EQ(state["network"]["values"]["coverage"]["value"], covered.value);
    EXPECT_EQ(state["network"]["values"]["coverage"]["standard_error"], covered.standard_error);
    EXPECT_EQ(state["network"]["values"]["overlap"]["value"], overlap.value);
    EXPECT_EQ(state["network"]["values"]["overlap"]["standard_error"], overlap.standard_error);
    Simulator all = surroundings_of(bench.simulator);
    const ScanOverlapMatrix links = scan_overlap_matrix(
        all.evaluate_sampled({&network, 1}, {.voxels = std::min(bench.options.link_voxels, all.voxel_count())})
            .front());
    EXPECT_GT(state["network"]["links"].size(), 0u);
    for (const auto& link : state["network"]["links"]) {
      EXPECT_EQ(link["value"], links(link["a"], link["b"]));
      const double share = link["value"], of = link["voxels"];
      EXPECT_GT(of, 0);
      EXPECT_NEAR(link["error"], std::sqrt(share * (1 - share) / of), 1e-12);
    }
  }
  bench.session.change({{"do", "exact"}});
  const State state = bench.finished();
  EXPECT_TRUE(state["exact"]);
  const Network network = bench.network();
  EXPECT_EQ(state["network"]["values"]["coverage"]["value"],
            coverage(bench.simulator.evaluate(network), bench.simulator.goal_density()));
  EXPECT_EQ(state["network"]["values"]["coverage"]["standard_error"], 0);
  const ScanOverlapMatrix links = scan_overlap_matrix(surroundings_of(bench.simulator).evaluate(network));
  EXPECT_GT(state["network"]["links"].size(), 0u);
  for (const auto& link : state["network"]["links"]) EXPECT_EQ(link["value"], links(link["a"], link["b"]));
}

TEST(EditSession, GoesBackAndForth) {
  Bench bench;
  bench.add(2, -1);
  const State one = bench.session.state()["network"];
  bench.add(-2, 1);
  bench.move(1, 3, -2);
  const State moved = bench.session.state()["network"];
  // A drag is one step, however many places it goes through.
  for (const double x : {2.5, 2.0, 1.5})
    bench.session.change(
        {{"do", "move"}, {"id", 1}, {"to", {1000 + x, 2000.0, 48.5}}, {"begin", x == 2.5}, {"end", x == 1.5}});
  EXPECT_NE(bench.session.state()["network"], moved);
  bench.session.change({{"do", "undo"}});
  EXPECT_EQ(bench.session.state()["network"], moved);
  bench.session.change({{"do", "undo"}});
  bench.session.change({{"do", "undo"}});
  EXPECT_EQ(bench.session.state()["network"], one);
  for (int k = 0; k < 2; ++k) bench.session.change({{"do", "redo"}});
  EXPECT_EQ(bench.session.state()["network"], moved);
  bench.session.change({{"do", "remove"}, {"id", 2}});
  EXPECT_EQ(bench.session.state()["ids"], State({1}));
  EXPECT_FALSE(bench.session.state()["redo"]);
  EXPECT_EQ(bench.last_kept.size(), 1u);
}

TEST(EditSession, RefusesWhatCannotBe) {
  Bench bench;
  bench.add(2, -1);
  bench.session.change({{"do", "lock"}, {"id", 1}, {"locked", true}});
  const auto before = bench.session.state();
  const json far{9000, 9000, 0};
  for (const json& request : {
           json{{"do", "move"}, {"id", 1}, {"to", {1001, 2001, 48.5}}},  // locked
           json{{"do", "remove"}, {"id", 1}},
           json{{"do", "add"}, {"to", far}},  // no ground
           json{{"do", "add"}, {"to", {1, 2}}},
           json{{"do", "add"}, {"to", {1, "2", 3}}},
           json{{"do", "add"}},
           json{{"do", "move"}, {"id", 7}, {"to", {1001, 2001, 48.5}}},
           json{{"do", "move"}, {"id", "1"}, {"to", {1001, 2001, 48.5}}},
           json{{"do", "redo"}},
           json{{"do", "fly"}},
           json{{"do", 3}},
           json::array(),
           json(),
       }) {
    EXPECT_THROW(bench.session.change(request), Error) << request;
    EXPECT_EQ(bench.session.state()["network"], before["network"]) << request;
  }
}

TEST(EditSession, ImprovesTheOthersAndKeepsLockedOnes) {
  Bench bench;
  // A station far off the wall with triple weight, and a locked one.
  bench.add(9, 9);
  bench.add(2, -1);
  bench.session.change({{"do", "lock"}, {"id", 2}, {"locked", true}});
  const State before = bench.session.state();
  bench.session.change({{"do", "improve"}});
  EXPECT_THROW(bench.add(0, 0), Error);  // busy
  State after = bench.finished();
  // A machine that does much else may find nothing in the time of one search.
  for (int k = 0; k < 20 && after["message"] != "improved"; ++k) {
    bench.session.change({{"do", "improve"}});
    after = bench.finished();
  }
  EXPECT_EQ(after["message"], "improved");
  EXPECT_EQ(after["ids"], before["ids"]);
  EXPECT_EQ(after["network"]["stations"][1]["position"], before["network"]["stations"][1]["position"]);
  EXPECT_NE(after["network"]["stations"][0]["position"], before["network"]["stations"][0]["position"]);
  EXPECT_GT(after["network"]["coverage"], before["network"]["coverage"]);
  EXPECT_LE(after["network"]["parts"], before["network"]["parts"]);
  bench.session.change({{"do", "undo"}});
  EXPECT_EQ(bench.session.state()["network"], before["network"]);
}

// The first scanner sees nothing from anywhere.
TEST(EditSession, ImprovesAStationWithItsOwnScanner) {
  Bench bench;
  Scanner scanners[] = {noisy_scanner(), noisy_scanner()};
  scanners[0].min_range_m = 100;
  Site site = test::site_of(
      Simulator(bench.site.scene(), scanners, {.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.1}));
  const Uv ground = site.area().project({1009, 2009, 48.5}).value();
  const double pair[] = {ground.u, ground.v};
  PlacedStation far = place_stations(site, pair).front();
  far.setup.scanner = 1;
  std::vector<EditStation> kept;
  EditSession session(site, {{.id = 1, .placed = far}}, bench.options,
                      [&](const std::vector<EditStation>& stations) { kept = stations; }, {});
  const double before = session.state()["network"]["coverage"];
  session.change({{"do", "improve"}});
  const State after = finished(session);
  EXPECT_EQ(after["message"], "improved");
  EXPECT_GT(after["network"]["coverage"], before);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].placed.setup, far.setup);
}

TEST(EditSession, SavesWhatEveryRaySays) {
  Bench bench;
  bench.add(2, -1);
  bench.add(-2, 1);
  bench.session.change({{"do", "save"}});
  EXPECT_EQ(bench.finished()["message"], "saved in a folder");
  EXPECT_EQ(bench.saved.size(), 2u);
  EXPECT_EQ(bench.saved_voxels, bench.simulator.voxel_count());
}

// A floor of 20 × 8 m within walls, halved by a wall with an opening of 1.2 m at its end.
Scene halved_hall() {
  test::Builder builder;
  builder.floor(-10, -4, 10, 4, 0);
  builder.box({-10.2, -4, 0}, {-10, 4, 3}).box({10, -4, 0}, {10.2, 4, 3});
  builder.box({-10, -4.2, 0}, {10, -4, 3}).box({-10, 4, 0}, {10, 4.2, 3});
  builder.box({-0.1, -4, 0}, {0.1, 2.8, 3});
  return builder.scene();
}

// A session on a site, without noise, whose changes are made in its frame.
struct Hall {
  Site site;
  EditOptions options;
  std::vector<EditStation> kept;
  EditSession session;

  explicit Hall(const EditOptions& with = {})
      : site(test::site_of(Simulator(halved_hall(),
                                     [] {
                                       Scanner scanner;
                                       scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.5);
                                       scanner.height_m = 1.5;
                                       return scanner;
                                     }(),
                                     {.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.1}))),
        options(with),
        session(site, {}, options, [this](const std::vector<EditStation>& stations) { kept = stations; }, {}) {
    vantage::finished(session);
  }
  static json place(double x, double y) { return {test::origin.x + x, test::origin.y + y, test::origin.z}; }
  State change(const json& request) {
    session.change(request);
    return vantage::finished(session);
  }
  State add(double x, double y) { return change({{"do", "add"}, {"to", place(x, y)}}); }
  std::vector<PlacedStation> placed() const {
    std::vector<PlacedStation> stations;
    for (const EditStation& station : kept) stations.push_back(station.placed);
    return stations;
  }
};

// `vantage evaluate --attainable --registration` of the same stations has the same figures.
TEST(EditSession, HasTheFiguresOfAReport) {
  Hall hall({.voxels = 3000, .cells = 200, .registration_voxels = 1000});
  hall.add(-6, -2);
  hall.add(1, 3.2);
  const State sampled = hall.add(6, 1);
  const AttainableCounts attainable = find_candidates(hall.site, {.sample_voxels = 3000}).attainable_counts();
  const auto stations = hall.placed();
  const EvaluationSite parts{.simulator = hall.site.simulator(), .surroundings = &hall.site.surroundings()};
  const Evaluation estimate = evaluate_stations(parts, stations, {.sample_voxels = 3000, .attainable = &attainable});
  EXPECT_FALSE(sampled["hidden"].is_null());
  EXPECT_GT(sampled["network"]["captured"], 0.3);
  EXPECT_EQ(sampled["network"]["captured"], estimate.value("capture"));
  EXPECT_EQ(sampled["network"]["values"]["capture"]["standard_error"], estimate.values.at("capture").standard_error);
  const Evaluation registered = evaluate_stations(
      parts, stations, {.sample_voxels = 1000, .registration = RegistrationOptions{}, .attainable = nullptr});
  EXPECT_EQ(sampled["network"]["values"]["registration"]["value"], registered.value("registration"));
  EXPECT_GT(sampled["network"]["values"]["registration"]["standard_error"], 0);

  const State exact = hall.change({{"do", "exact"}});
  const Evaluation whole =
      hall.site.evaluate(stations, {.registration = RegistrationOptions{}, .attainable = &attainable});
  EXPECT_EQ(exact["network"]["captured"], whole.value("capture"));
  EXPECT_EQ(exact["network"]["values"]["registration"]["value"], whole.value("registration"));
  EXPECT_EQ(exact["network"]["minutes_on_site"], whole.visit->minutes);
  EXPECT_EQ(sampled["network"]["minutes_on_site"], whole.visit->minutes);
  const auto lines = summary_lines(whole);
  ASSERT_EQ(exact["network"]["summary"].size(), lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) EXPECT_EQ(exact["network"]["summary"][k]["text"], lines[k].text);
}

TEST(EditSession, PutsAStationWhereItMayStand) {
  Hall hall({.voxels = 300, .cells = 200, .attainable_voxels = 0});
  State state = hall.add(-0.3, -1);  // beside the middle wall
  const auto head = [&](std::size_t k) {
    const auto& h = state["network"]["stations"][k]["position"];
    return Vec3{h[0], h[1], h[2]} - test::origin;
  };
  EXPECT_EQ(state["network"]["stations"][0]["status"], "ok");
  EXPECT_NEAR(head(0).x, -0.6, 0.02);
  EXPECT_NEAR(head(0).y, -1, 0.05);
  const std::string message = state["message"];
  EXPECT_EQ(message.find("the new station may not stand there: it was put 0.3"), 0u) << message;
  EXPECT_NE(message.find(" m to the west of it, where the nearest free place is"), std::string::npos) << message;
  // While it is dragged it is where the pointer is; put down, it is not.
  const auto drag = [&](double x, bool begin, bool end) {
    SCOPED_TRACE(x);
    ASSERT_NO_THROW(
        state = hall.change({{"do", "move"}, {"id", 1}, {"to", Hall::place(x, 1)}, {"begin", begin}, {"end", end}}));
  };
  drag(-3, true, false);
  EXPECT_EQ(state["message"], "");
  drag(0.55, false, false);
  EXPECT_EQ(state["network"]["stations"][0]["status"], "clash");
  EXPECT_NEAR(head(0).x, 0.55, 1e-6);
  drag(0.2, false, true);  // where there is no ground at all
  EXPECT_EQ(state["network"]["stations"][0]["status"], "ok");
  EXPECT_NEAR(head(0).x, 0.6, 0.02);
  EXPECT_NE(state["message"].get<std::string>().find("S1 may not stand there"), std::string::npos);
  state = hall.change({{"do", "undo"}});
  EXPECT_NEAR(head(0).x, -0.6, 0.02) << "a drag and its end are one step";
  // Off the floor too, if a place is near; not if none is.
  state = hall.add(10.4, 0);
  EXPECT_NEAR(head(1).x, 9.5, 0.02);
  EXPECT_THROW(hall.add(40, 0), Error);
  EXPECT_EQ(hall.session.state()["ids"].size(), 2u);
}

TEST(EditSession, NamesStations) {
  Hall hall({.voxels = 300, .cells = 200, .attainable_voxels = 0});
  hall.add(-6, -2);
  hall.add(6, 2);
  const auto names = [&](const State& state) {
    return state["network"]["stations"][0]["name"].get<std::string>() + " " +
           state["network"]["stations"][1]["name"].get<std::string>();
  };
  EXPECT_EQ(names(hall.change({{"do", "rename"}, {"id", 1}, {"name", " Lobby "}})), "Lobby S2");
  EXPECT_EQ(hall.kept[0].name, "Lobby");
  EXPECT_EQ(names(hall.change({{"do", "move"}, {"id", 1}, {"to", Hall::place(-5, 0)}})), "Lobby S2");
  EXPECT_EQ(names(hall.change({{"do", "undo"}})), "Lobby S2");
  EXPECT_EQ(names(hall.change({{"do", "undo"}})), "S1 S2");
  EXPECT_EQ(names(hall.change({{"do", "redo"}})), "Lobby S2");
  EXPECT_EQ(names(hall.change({{"do", "rename"}, {"id", 2}, {"name", "Lobby"}})), "Lobby Lobby (2)");
  EXPECT_EQ(names(hall.change({{"do", "rename"}, {"id", 1}, {"name", ""}})), "S1 Lobby");
  for (const json& name : {json(3), json("a\nb"), json(std::string(61, 'x')), json()})
    EXPECT_THROW(hall.session.change({{"do", "rename"}, {"id", 1}, {"name", name}}), Error) << name;
}

TEST(EditSession, ImprovingMendsLinksFirst) {
  Hall hall({.voxels = 2000, .link_voxels = 2000, .cells = 200, .improve_seconds = 2, .attainable_voxels = 0});
  hall.add(-6, -2);
  const State before = hall.add(6, -2);
  ASSERT_EQ(before["network"]["parts"], 2);
  State after = hall.change({{"do", "improve"}});
  EXPECT_EQ(after["network"]["parts"], 1);
  EXPECT_EQ(after["message"].get<std::string>().find("all stations are linked now"), 0u) << after["message"];
  EXPECT_EQ(hall.change({{"do", "undo"}})["network"], before["network"]);
  // One that is locked stays.
  hall.change({{"do", "lock"}, {"id", 1}, {"locked", true}});
  after = hall.change({{"do", "improve"}});
  EXPECT_EQ(after["network"]["parts"], 1);
  EXPECT_EQ(after["network"]["stations"][0]["position"], before["network"]["stations"][0]["position"]);
}

TEST(EditSession, AScanMakesItsStationATakenOne) {
  Bench bench;
  bench.add(2, -1);
  const State before = bench.add(-2, 1);
  const auto scan_at = [&](double x, double y) {
    TakenScan scan{.name = "morning", .head = {1000 + x, 2000 + y, 50}};
    for (const Vec3& p : bench.simulator.scan_points({.position = scan.head}).position) {
      const Vec3 o = p - scan.head;
      scan.thinned.push_back({{static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z)}, 1});
    }
    scan.points = scan.thinned.size(), scan.fit.fitted = true, scan.fit.shift_m = 0.012;
    return scan;
  };
  const TakenScan near = scan_at(-1.7, 1.2), far = scan_at(0, -3);
  ASSERT_TRUE(bench.session.take(std::span(&near, 1)));
  State state = bench.session.state();
  EXPECT_EQ(state["ids"], json({2, 1}));  // existing ones come first
  const auto& taken = state["network"]["stations"][0];
  EXPECT_EQ(taken["name"], "S2");
  EXPECT_EQ(taken["existing"], true);
  EXPECT_EQ(taken["position"], json({998.3, 2001.2, 50.0}));
  EXPECT_EQ(state["network"]["stations"][1]["name"], "S1");
  EXPECT_EQ(state["locked"], json({true, false}));
  EXPECT_EQ(state["undo"], false);
  EXPECT_EQ(state["network"]["visit"]["order"].size(), 1u) << "the round is of what is still to do";
  EXPECT_EQ(state["message"].get<std::string>().find("S2 is taken, "), 0u) << state["message"];
  EXPECT_NE(state["message"].get<std::string>().find("moved by 1.2 cm"), std::string::npos) << state["message"];
  EXPECT_EQ(bench.last_kept.size(), 2u);
  EXPECT_THROW(bench.session.change({{"do", "lock"}, {"id", 2}, {"locked", false}}), Error);
  EXPECT_THROW(bench.session.change({{"do", "remove"}, {"id", 2}}), Error);
  EXPECT_THROW(bench.session.change({{"do", "undo"}}), Error);

  ASSERT_TRUE(bench.session.take(std::span(&far, 1)));
  state = bench.session.state();
  EXPECT_EQ(state["ids"], json({2, 3, 1}));
  EXPECT_EQ(state["network"]["stations"][1]["name"], "morning");
  TakenScan other = scan_at(3, 3);
  other.name = "S1";
  ASSERT_TRUE(bench.session.take(std::span(&other, 1)));
  state = bench.session.state();
  EXPECT_EQ(state["network"]["stations"][2]["name"], "S1, taken");
  EXPECT_EQ(state["network"]["stations"][3]["name"], "S1");
}

TEST(EditSession, ARealScanCountsByItsPoints) {
  Bench bench;
  EXPECT_GT(bench.add(2, -1)["network"]["coverage"], 0.5);
  // A scan that met nothing, as in fog.
  const TakenScan fog{.name = "fog", .head = {1002, 1999, 50}};
  ASSERT_TRUE(bench.session.take(std::span(&fog, 1)));
  const State state = bench.session.state();
  EXPECT_EQ(state["ids"].size(), 1u);
  EXPECT_EQ(state["network"]["coverage"], 0);
  bench.session.change({{"do", "exact"}});
  const State exact = bench.finished();
  EXPECT_EQ(exact["message"], "every ray is simulated, also where scans were taken");
  EXPECT_GT(exact["network"]["coverage"], 0.5);
}

TEST(EditSession, BeginsWithNothing) {
  Bench bench;
  const State state = bench.session.state();
  EXPECT_EQ(state["network"]["stations"].size(), 0u);
  EXPECT_EQ(state["network"]["coverage"], 0);
  bench.session.change({{"do", "exact"}});
  EXPECT_EQ(bench.finished()["message"], "there is no station to trace");
}

TEST(EditSession, ShowsTheSameWhereMeshesAreShared) {
  std::vector<std::string> shown;
  for (const SharedMeshes shared : {SharedMeshes::always, SharedMeshes::never}) {
    const Scene scene = load(test::boxes_on_ground(), {.surveyed = {"ground", "box 1"}, .shared_meshes = shared});
    ASSERT_EQ(scene.data().shares(), shared == SharedMeshes::always);
    Site site = test::site_of(Simulator(scene, noisy_scanner(), {.engine = Engine::embree, .user_size_m = 0.2}));
    EditSession session{site,
                        {},
                        {.voxels = 300, .cells = 200, .attainable_voxels = 0},
                        [](const auto&) {},
                        [](const auto&, const Progress&) { return std::string(); }};
    session.change({{"do", "add"}, {"to", {2.1, 1.2, 0}}});
    session.change({{"do", "add"}, {"to", {-2, 2.3, 0}}});
    session.change({{"do", "move"}, {"id", 1}, {"to", {-1.7, -2.2, 0}}});
    session.change({{"do", "exact"}});
    const State state = finished(session);
    EXPECT_EQ(state["network"]["stations"].size(), 2u);
    shown.push_back(state["network"].dump() + state["coverage"].dump() + state["only"].dump());
  }
  EXPECT_EQ(shown[0], shown[1]);
}

}  // namespace
}  // namespace vantage
