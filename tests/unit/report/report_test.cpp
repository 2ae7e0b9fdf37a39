// SPDX-License-Identifier: Apache-2.0
// The report as files: content that must be there, and content that must not.
#include "report/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "core/text.hpp"
#include "report/report_json.hpp"
#include "report/station_facts.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"

namespace vantage {
namespace {

struct Survey {
  explicit Survey(const std::string& crs = "")
      : site(test::wall_and_floor().scene(),
             {.scanners = {test::coarse_scanner(2)},
              .user_size_m = 0.4,
              .spacing_m = 0.1,
              .engine = Engine::embree,
              .crs = crs},
             "A wall") {}
  Site site;
  PlanResult result =
      plan(site, coverage_overlap_fix(3), {.population = 6, .iterations = 3, .sample_voxels = 100, .seed = 2});
};

std::string read(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Report, HasTheNumbersOfThePlan) {
  Survey survey;
  const auto json = report_json(report_of(survey.result, survey.site, {}));
  EXPECT_EQ(json["answer"], answer(survey.result));
  ASSERT_EQ(json["networks"].size(), survey.result.front.size());
  for (std::size_t k = 0; k < survey.result.front.size(); ++k) {
    const PlanEntry& entry = survey.result.front[k];
    const auto& network = json["networks"][k];
    for (const char* name : {"coverage", "overlap"}) EXPECT_EQ(network["values"][name]["value"], entry.value(name));
    ASSERT_EQ(network["stations"].size(), entry.stations.size());
    for (std::size_t s = 0; s < entry.stations.size(); ++s)
      EXPECT_EQ(network["stations"][s]["position"][0], entry.stations[s].position.x);
    for (const auto& link : network["links"]) {
      const double overlap = entry.overlap_matrix(link["a"], link["b"]);
      EXPECT_EQ(link["value"], overlap);
      EXPECT_GE(overlap, survey.result.problem.link_overlap);
    }
  }
}

TEST(Report, ThePageNamesNoAddressToLoadFrom) {
  const test::TemporaryFolder folder;
  Survey survey;
  write_report(folder / "report.html", survey.result, survey.site,
               {.title = "a </title><script>alert(1)</script> & b", .command = "vantage plan '</script><!--.glb'"});
  const std::string page = read(folder / "report.html");
  EXPECT_LT(page.size(), 5'000'000u);
  for (const char* loads : {"src=\"", "<link rel=\"stylesheet", "@import", "url(", "{{"})
    EXPECT_EQ(count(page.substr(0, page.find("<script")), loads), 0u) << loads;
  EXPECT_EQ(count(page, "alert(1)</script>"), 0u);
  EXPECT_EQ(count(page, "<!--.glb"), 0u);
  // names in the content end no script
  EXPECT_EQ(count(page, "<script"), count(page, "</script>"));
}

// A word of a sheet, in points from its upper left corner.
struct Word {
  std::string text;
  double x0, y0, x1, y1;
};

// The words of each sheet of a PDF, as poppler finds them.
std::vector<std::vector<Word>> words_of(const std::filesystem::path& pdf, const std::filesystem::path& scratch) {
  const std::string program = VANTAGE_PDFTOTEXT;
  EXPECT_TRUE(std::filesystem::exists(program)) << "pdftotext is missing: install poppler-utils (setup.sh --tests)";
  if (std::system((program + " -bbox '" + pdf.string() + "' '" + scratch.string() + "'").c_str()) != 0) return {};
  const std::string text = read(scratch);
  const std::regex mark(
      "<page |<word xMin=\"([^\"]*)\" yMin=\"([^\"]*)\" xMax=\"([^\"]*)\" yMax=\"([^\"]*)\">([^<]*)<");
  std::vector<std::vector<Word>> sheets;
  for (std::sregex_iterator it(text.begin(), text.end(), mark), end; it != end; ++it) {
    if (!(*it)[1].matched)
      sheets.emplace_back();
    else
      sheets.back().push_back(
          {(*it)[5], std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]), std::stod((*it)[4])});
  }
  return sheets;
}

const Word* find(const std::vector<Word>& words, const std::string& text) {
  const auto found = std::ranges::find(words, text, &Word::text);
  return found == words.end() ? nullptr : &*found;
}

// A survey of a wall with two rooms before it, of which one has a station.
TEST(Report, TellsOfEachRoom) {
  const test::TemporaryFolder folder;
  test::QuadScene scene = test::wall_and_floor();
  for (const auto& [name, y] : {std::pair{"Kitchen", -3.0}, {"Hall", 0.0}})
    scene.data().rooms.push_back({.name = name, .storey = "Ground", .box = {{-2, y, -1.5}, {5, y + 3, 2}}});
  Site site(scene.scene(),
            {.scanners = {test::coarse_scanner(2)}, .user_size_m = 0.4, .spacing_m = 0.1, .engine = Engine::embree});
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {1, 1, 0.3}, .ground = {1, 1, -1.5}}};
  const Evaluation found = site.evaluate(stations, {.field = true});
  const MissedVoxels missed = missed_voxels(site, found.field);
  const auto rows = report_json(report_of(found, site, {.missed = &missed}))["rooms"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["name"], "Kitchen");
  EXPECT_EQ(rows[0]["storey"], "Ground");
  EXPECT_NEAR(rows[0]["floor_m2"].get<double>(), 21, 1e-9);
  EXPECT_EQ(rows[0]["stations"], "");
  EXPECT_EQ(rows[0]["why_no_station"], why_no_station(missed.rooms[0]));
  EXPECT_EQ(rows[1]["stations"], "S1");
  EXPECT_EQ(rows[1]["why_no_station"], "");
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(rows[k]["captured"], missed.rooms[k].share.share(WhyMissed::captured)) << k;
  EXPECT_TRUE(report_json(report_of(found, site, {}))["rooms"].empty()) << "not looked at";

  write_report(folder / "report.pdf", found, site, {.missed = &missed});
  const auto sheets = words_of(folder / "report.pdf", folder / "words.html");
  const auto told = [&](const std::vector<Word>& sheet) { return find(sheet, "Rooms") && find(sheet, "Kitchen"); };
  EXPECT_EQ(std::ranges::count_if(sheets, told), 1);
}

TEST(Report, SheetsNameEveryStationAndKeepTheirRatio) {
  const test::TemporaryFolder folder;
  Survey survey("EPSG:25832");
  // Stations on a grid of 2 m, in a round that begins at the last.
  std::vector<PlacedStation> stations;
  for (int k = 0; k < 40; ++k) {
    const Vec3 ground{-8 + 2.0 * (k % 8), -4 + 2.0 * static_cast<double>(k / 8), -1.5};
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  }
  Evaluation found = evaluate_stations({.simulator = survey.site.simulator()}, stations, {.field = true});
  found.visit = survey.site.on_site().visit(stations);
  std::ranges::reverse(found.visit->order);
  write_report(folder / "report.pdf", found, survey.site, {.date = "3 May"});
  const auto sheets = words_of(folder / "report.pdf", folder / "words.html");
  ASSERT_GE(sheets.size(), 3u) << "front, map and table";
  const auto on_some = [&](const std::string& text, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k)
      if (find(sheets[k], text)) return true;
    return false;
  };
  EXPECT_TRUE(find(sheets[0], "scanner"));
  EXPECT_TRUE(find(sheets[0], "EPSG:25832,"));
  EXPECT_TRUE(find(sheets[0], "May"));
  const std::vector<Word>& map = sheets[1];
  EXPECT_TRUE(find(map, "N"));
  const auto ratio = std::ranges::find_if(map, [](const Word& word) { return word.text.starts_with("1:"); });
  ASSERT_NE(ratio, map.end());
  // Beside the map, which ends 196 points before the ratio, names stand again.
  std::vector<Word> marks = map;
  std::erase_if(marks, [&](const Word& word) { return word.x1 > ratio->x1 - 190; });
  const double metre = 72 / 0.0254 / std::stod(ratio->text.substr(2));
  const auto middle = [](const Word& word) { return std::pair((word.x0 + word.x1) / 2, (word.y0 + word.y1) / 2); };
  for (int k = 0; k < 40; ++k) {
    const std::string name = "S" + std::to_string(k + 1);
    const Word* const word = find(marks, name);
    ASSERT_TRUE(word) << name << " is not on the map";
    EXPECT_TRUE(on_some(name, 2, sheets.size() - 1)) << name << " is not in the table";
    const auto [x, y] = middle(*word);
    const auto [x0, y0] = middle(*find(marks, "S1"));
    const Vec3 apart = stations[static_cast<std::size_t>(k)].ground - stations[0].ground;
    EXPECT_NEAR(x - x0, apart.x * metre, 0.6) << name;
    EXPECT_NEAR(y0 - y, apart.y * metre, 0.6) << name;
  }
  const auto overlap = [](const Word& a, const Word& b) {  // letters reach less far than their boxes
    return std::min(a.x1, b.x1) - std::max(a.x0, b.x0) > 0.5 &&
           std::min(a.y1, b.y1) - std::max(a.y0, b.y0) > 0.35 * std::min(a.y1 - a.y0, b.y1 - b.y0);
  };
  for (std::size_t s = 0; s < sheets.size(); ++s)
    for (std::size_t i = 0; i < sheets[s].size(); ++i)
      for (std::size_t j = i + 1; j < sheets[s].size(); ++j)
        EXPECT_FALSE(s > 0 && overlap(sheets[s][i], sheets[s][j]))
            << "sheet " << s + 1 << ": " << sheets[s][i].text << " lies on " << sheets[s][j].text;
  // The table follows the round.
  const Word *last = find(sheets[2], "S" + std::to_string(found.visit->order.back() + 1)),
             *first = find(sheets[2], "S" + std::to_string(found.visit->order.front() + 1));
  ASSERT_TRUE(first);
  EXPECT_TRUE(!last || last->y0 > first->y0);
}

TEST(Report, NationalCoordinatesAreWholeOnSheets) {
  const test::TemporaryFolder folder;
  const Vec3 place{456'789, 5'621'391, 1210};
  std::vector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto n = static_cast<std::uint32_t>(p.size());
    for (const Vec3& v : {a, b, c, d}) p.push_back(v + place);
    t.insert(t.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  };
  quad({0, 0, 0}, {14, 0, 0}, {14, 9, 0}, {0, 9, 0});
  quad({0, 9, 0}, {14, 9, 0}, {14, 9, 3}, {0, 9, 3});
  quad({0, 0, 0}, {0, 9, 0}, {0, 9, 3}, {0, 0, 3});
  Site site(Scene::from_triangles(p, t),
            {.scanners = {test::coarse_scanner(2)}, .user_size_m = 0.4, .spacing_m = 0.2, .engine = Engine::embree});
  std::vector<PlacedStation> stations;
  for (int k = 0; k < 6; ++k) {
    const Vec3 ground = place + Vec3{1.5 + 2.1 * k, 2.5 + 0.7 * k, 0};
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  }
  Evaluation found = site.evaluate(stations, {.field = true});
  ASSERT_TRUE(found.visit);
  found.visit->arrive_min.back() = 97;
  write_report(folder / "report.pdf", found, site, {});
  const auto sheets = words_of(folder / "report.pdf", folder / "words.html");
  ASSERT_GE(sheets.size(), 3u);
  for (const auto& sheet : sheets)
    for (const Word& word : sheet)
      EXPECT_FALSE(word.text.ends_with("…") && std::isdigit(static_cast<unsigned char>(word.text.front())))
          << word.text << " is cut";
  for (const PlacedStation& s : stations) {
    EXPECT_TRUE(find(sheets[1], fixed(s.ground.x, 2)) && find(sheets[1], fixed(s.ground.y, 2))) << "beside the map";
    EXPECT_TRUE(find(sheets[1], fixed(s.ground.z, 2)));
    EXPECT_TRUE(find(sheets[2], fixed(s.ground.x, 3)) && find(sheets[2], fixed(s.ground.y, 3))) << "in the table";
    EXPECT_TRUE(find(sheets[2], fixed(s.ground.z, 3)));
  }
  EXPECT_TRUE(find(sheets[2], "h")) << "the time when it is done";
}

// Three stations in a row of which the second has no link to the first.
TEST(Report, TellsWhatAScanIsRegisteredToIfNotToTheOneBefore) {
  Survey survey;
  Evaluation found = evaluate_stations({.simulator = survey.site.simulator()},
                                       std::vector<PlacedStation>(4, survey.result.front.front().stations.front()));
  found.scan_overlap_matrix = ScanOverlapMatrix(4);
  found.scan_overlap_matrix.set(0, 1, 0.6), found.scan_overlap_matrix.set(0, 2, 0.4);
  found.link = 0.3;
  Visit visit;
  visit.order = {0, 1, 2, 3}, visit.legs_m = {0, 1, 1, 1, 1};
  visit.arrive_min = {0, 4, 8, 12}, visit.stay_min = {3, 3, 3, 3};
  found.visit = visit;
  const Report report = report_of(found, survey.site, {});
  const auto facts = station_facts(report, survey.site.simulator());
  EXPECT_EQ(facts[0].register_to, "");
  EXPECT_EQ(facts[1].register_to, "");
  EXPECT_EQ(facts[2].register_to, "register to S1");
  EXPECT_EQ(facts[3].register_to, "no link to a station before it");
  // A session begins without the scan before.
  for (const std::size_t first : {0, 1}) {
    Session one;
    one.day = first + 1, one.order = {2 * first, 2 * first + 1}, one.legs_m = {1, 1, 1};
    one.arrive_min = {1, 5}, one.stay_min = {3, 3};
    found.visit->sessions.push_back(one);
  }
  found.scan_overlap_matrix.set(2, 3, 0.5);
  const auto by_session = station_facts(report_of(found, survey.site, {}), survey.site.simulator());
  EXPECT_EQ(by_session[2].register_to, "register to S1");
  EXPECT_EQ(by_session[3].register_to, "");
  EXPECT_EQ(by_session[2].visit, 3u);
  EXPECT_EQ(by_session[2].stop, 1u);
  EXPECT_EQ(by_session[3].done_min, 8);
}

TEST(Report, EachSessionHasItsMapAndItsList) {
  const test::TemporaryFolder folder;
  Survey survey;
  std::vector<PlacedStation> stations;
  for (int k = 0; k < 12; ++k) {
    const Vec3 ground{-8 + 1.4 * k, -2 + 0.3 * k, -1.5};
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  }
  const Evaluation found = survey.site.evaluate(stations, {.field = true}, {.day_min = 14, .crews = 2});
  ASSERT_TRUE(found.visit);
  const std::vector<Session>& sessions = found.visit->sessions;
  ASSERT_EQ(sessions.size(), 3u) << "four stations each";
  write_report(folder / "report.pdf", found, survey.site, {});
  const auto sheets = words_of(folder / "report.pdf", folder / "words.html");
  const auto has = [&](const std::vector<Word>& sheet, const std::vector<std::string>& words) {
    return std::ranges::all_of(words, [&](const std::string& word) { return find(sheet, word) != nullptr; });
  };
  // A sheet for each session, after the front page, with its own stations alone in its list.
  ASSERT_GE(sheets.size(), 5u);
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const auto& sheet = sheets[1 + s];
    EXPECT_TRUE(has(sheet, {"Day", std::to_string(sessions[s].day) + ",", "crew"})) << s;
    for (std::size_t k = 0; k < stations.size(); ++k) {
      std::size_t stop = 0;  // "2. S7 …": its line in the list
      for (std::size_t w = 1; w < sheet.size(); ++w)
        if (sheet[w].text == "S" + std::to_string(k + 1) && sheet[w - 1].text.ends_with("."))
          stop = std::stoul(sheet[w - 1].text);
      const auto at = std::ranges::find(sessions[s].order, k);
      const auto place = static_cast<std::size_t>(at - sessions[s].order.begin());
      EXPECT_EQ(stop, at == sessions[s].order.end() ? 0 : place + 1)
          << "sheet of session " << s + 1 << ", station " << k + 1;
    }
    EXPECT_TRUE(find(sheet, "1.") && find(sheet, std::to_string(sessions[s].order.size()) + ".")) << "its own stops";
  }
  EXPECT_TRUE(std::ranges::any_of(sheets, [&](const auto& sheet) { return has(sheet, {"Sessions", "Walking"}); }));
  const auto told = [&](const std::vector<std::vector<Word>>& all, const std::vector<std::string>& words) {
    return std::ranges::count_if(all, [&](const auto& sheet) { return has(sheet, words); });
  };
  EXPECT_EQ(told(sheets, {"Batteries"}), 0) << "it is not known how long they last";

  const auto visit = report_json(report_of(found, survey.site, {}))["networks"][0]["visit"];
  ASSERT_EQ(visit["sessions"].size(), 3u);
  EXPECT_TRUE(visit["ways"].empty()) << "nobody walks the whole round";
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    EXPECT_EQ(visit["sessions"][s]["order"].size(), sessions[s].order.size());
    EXPECT_EQ(visit["sessions"][s]["ways"].size(), sessions[s].paths.size());
    EXPECT_EQ(visit["sessions"][s]["batteries"], "");
  }

  Evaluation powered = found;
  for (Session& session : powered.visit->sessions)
    session.batteries = {{.instrument = "Mine", .battery_scans = 3, .scans = 4, .batteries = 2, .in_a_day = 2}};
  write_report(folder / "powered.pdf", powered, survey.site, {});
  const auto with = words_of(folder / "powered.pdf", folder / "words.html");
  EXPECT_EQ(told(with, {"Sessions", "Batteries"}), 1) << "in their table";
  EXPECT_GE(told(with, {"charged", "batteries:", "2"}), 1) << "and over each session's stations";
  EXPECT_EQ(report_json(report_of(powered, survey.site, {}))["networks"][0]["visit"]["sessions"][1]["batteries"], "2");

  // If hours keep stations out of all sessions, times are those of the others.
  Evaluation fewer = found;
  fewer.visit->sessions.pop_back();
  const Report of_fewer = report_of(fewer, survey.site, {});
  const auto in_all = std::ranges::find(of_fewer.facts, "in all", &std::pair<std::string, std::string>::first);
  ASSERT_NE(in_all, of_fewer.facts.end());
  const double scanned = sessions[0].scan_min + sessions[1].scan_min, set_up = 8 * 3;
  EXPECT_TRUE(in_all->second.starts_with("scans " + minutes_text(scanned) + ", setting up " + minutes_text(set_up)))
      << in_all->second;
}

TEST(Report, ListsElementsWithMostUncapturedSurfaceFirst) {
  Survey survey;
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {-2, 0, 0.3}, .ground = {-2, 0, -1.5}}};
  const Evaluation found = survey.site.evaluate(stations, {});
  const std::vector<ElementShare> elements{{.name = "small", .area_m2 = 1, .voxels = 9, .captured = 0.1},
                                           {.name = "not surveyed", .area_m2 = 100},
                                           {.name = "large",
                                            .area_m2 = 50,
                                            .voxels = 400,
                                            .captured = 0.9,
                                            .incidence = Angle::degrees(31),
                                            .point_distance_m = 0.0123,
                                            .deviation_m = 0.0012}};
  const auto table = report_json(report_of(found, survey.site, {.elements = elements}))["elements"];
  EXPECT_EQ(table["all"], 2);
  ASSERT_EQ(table["rows"].size(), 2u);
  EXPECT_EQ(table["rows"][0]["name"], "large");
  EXPECT_NEAR(table["rows"][0]["point_distance_mm"].get<double>(), 12.3, 1e-9);
  EXPECT_NEAR(table["rows"][0]["deviation_mm"].get<double>(), 1.2, 1e-9);
  EXPECT_TRUE(table["rows"][1]["incidence"].is_null());
  EXPECT_EQ(report_json(report_of(found, survey.site, {}))["elements"]["rows"].size(), 0u);
}

TEST(Report, SheetsHoldAsManyStationsAsThereMayBe) {
  const test::TemporaryFolder folder;
  Survey survey;
  // All linked, and a long list of meshes.
  PlanEntry& entry = survey.result.front[answer(survey.result)];
  const PlacedStation station = entry.stations.front();
  entry.stations.assign(max_stations, station);
  for (std::size_t k = 0; k < max_stations; ++k) {
    PlacedStation& s = entry.stations[k];
    s.ground.x = s.position.x = -9 + 18.0 * static_cast<double>(k % 32) / 31;
    s.ground.y = s.position.y = -9 + 18.0 * static_cast<double>(k / 32) / 31;
  }
  entry.counts.points_on_surveyed.assign(max_stations, 123'456'789);
  entry.overlap_matrix = OverlapMatrix(max_stations);
  for (std::size_t i = 0; i < max_stations; ++i)
    for (std::size_t j = i + 1; j < max_stations; ++j) entry.overlap_matrix.set(i, j, 0.5);
  MissedVoxels missed;
  missed.shares.assign(200,
                       {.node = "a mesh with a name that is far too long for its column", .voxels = 10, .shares = {1}});
  write_report(folder / "report.pdf", survey.result, survey.site, {.missed = &missed});
  const auto sheets = words_of(folder / "report.pdf", folder / "words.html");
  std::set<std::string> names;
  for (const auto& sheet : sheets)
    for (const Word& word : sheet)
      if (word.text.starts_with("S")) names.insert(word.text);
  for (std::size_t k = 0; k < max_stations; ++k) EXPECT_TRUE(names.contains("S" + std::to_string(k + 1))) << k + 1;
  EXPECT_LT(sheets.size(), 60u);
  std::stop_source stop;
  stop.request_stop();
  for (const char* name : {"stopped.pdf", "stopped.html"}) {
    EXPECT_FALSE(
        write_report(folder / name, survey.result, survey.site, {.missed = &missed}, {.stop = stop.get_token()}));
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
  write_report(folder / "report.html", survey.result, survey.site, {.pictures = false});
  EXPECT_LT(std::filesystem::file_size(folder / "report.html"), 5'000'000u);
}

TEST(Report, OfANetworkThatNoPlanFoundHasItsFigures) {
  const test::TemporaryFolder folder;
  Survey survey;
  const Evaluation found =
      evaluate_stations({.simulator = survey.site.simulator()}, survey.result.front.front().stations, {.field = true});
  const auto json = report_json(report_of(found, survey.site, {}));
  ASSERT_EQ(json["networks"].size(), 1u);
  EXPECT_EQ(json["networks"][0]["coverage"], found.value("coverage"));
  EXPECT_EQ(json["question"], "3 stations, as given");
  EXPECT_TRUE(json["axes"].empty());
  write_report(folder / "a.html", found, survey.site, {.pictures = false});
  EXPECT_EQ(count(read(folder / "a.html"), "<title>A wall – survey plan</title>"), 1u);
  EXPECT_THROW(write_report(folder / "a.txt", found, survey.site), Error);
  EXPECT_TRUE(why_no_report().empty());
}

}  // namespace
}  // namespace vantage
