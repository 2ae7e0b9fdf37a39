// SPDX-License-Identifier: Apache-2.0
// The report as files: what is in them, and what is not.
#include "report/report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "report/report_json.hpp"
#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

struct Survey {
  Scene scene = test::wall_and_floor().scene();
  SearchArea area = SearchArea::build(scene);
  ClashChecker clash{scene};
  Simulator simulator{
      scene, test::coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}};
  PlanResult result = plan(simulator, area, clash, coverage_overlap_fix(3),
                           {.population = 6, .iterations = 3, .sample_voxels = 100, .seed = 2});
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
  const auto json = report_json(report_of(survey.result, survey.simulator, {}));
  EXPECT_EQ(json["answer"], answer(survey.result));
  ASSERT_EQ(json["networks"].size(), survey.result.front.size());
  for (std::size_t k = 0; k < survey.result.front.size(); ++k) {
    const PlanEntry& entry = survey.result.front[k];
    const auto& network = json["networks"][k];
    for (const char* name : {"coverage", "overlap"}) EXPECT_EQ(network["values"][name]["value"], entry.value(name));
    ASSERT_EQ(network["stations"].size(), entry.stations.size());
    for (std::size_t s = 0; s < entry.stations.size(); ++s)
      EXPECT_EQ(network["stations"][s]["head"][0], entry.stations[s].position.x);
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
  write_report(folder / "report.html", survey.result, survey.simulator, survey.area,
               {.title = "a </title><script>alert(1)</script> & b", .command = "vantage plan '</script><!--.glb'"});
  const std::string page = read(folder / "report.html");
  EXPECT_LT(page.size(), 5'000'000u);
  for (const char* loads : {"src=\"", "<link rel=\"stylesheet", "@import", "url(", "{{"})
    EXPECT_EQ(count(page.substr(0, page.find("<script")), loads), 0u) << loads;
  EXPECT_EQ(count(page, "alert(1)</script>"), 0u);
  EXPECT_EQ(count(page, "<!--.glb"), 0u);
  // each script ends once: none by what a name holds
  EXPECT_EQ(count(page, "<script"), count(page, "</script>"));
}

TEST(Report, IsOnFourSheetsAtMost) {
  const test::TemporaryFolder folder;
  Survey survey;
  // As many stations as there may be, all linked, and a long list of meshes.
  PlanEntry& entry = survey.result.front[answer(survey.result)];
  const PlacedStation station = entry.stations.front();
  entry.stations.assign(max_stations, station);
  entry.counts.points_on_surveyed.assign(max_stations, 123'456'789);
  entry.overlap_matrix = OverlapMatrix(max_stations);
  for (std::size_t i = 0; i < max_stations; ++i)
    for (std::size_t j = i + 1; j < max_stations; ++j) entry.overlap_matrix.set(i, j, 0.5);
  MissedVoxels missed;
  missed.shares.assign(200,
                       {.node = "a mesh with a name that is far too long for its column", .voxels = 10, .count = {10}});
  write_report(folder / "report.pdf", survey.result, survey.simulator, survey.area, {.missed = &missed});
  const std::string pdf = read(folder / "report.pdf");
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  const std::size_t pages = count(pdf, "/Type /Page") - count(pdf, "/Type /Pages");
  EXPECT_GE(pages, 2u);
  EXPECT_LE(pages, 4u);
}

TEST(Report, OfANetworkThatNoPlanFoundHasItsFigures) {
  const test::TemporaryFolder folder;
  Survey survey;
  const Evaluation found =
      evaluate_stations({.simulator = survey.simulator}, survey.result.front.front().stations, {.field = true});
  const auto json = report_json(report_of(found, survey.simulator, {}));
  ASSERT_EQ(json["networks"].size(), 1u);
  EXPECT_EQ(json["networks"][0]["captured"], found.value("coverage"));
  EXPECT_EQ(json["question"], "3 stations, as given");
  EXPECT_TRUE(json["axes"].empty());
  write_report(folder / "a.html", found, survey.simulator, survey.area, {.title = "A wall", .pictures = false});
  EXPECT_EQ(count(read(folder / "a.html"), "<title>A wall – survey plan</title>"), 1u);
  EXPECT_THROW(write_report(folder / "a.txt", found, survey.simulator, survey.area), Error);
  EXPECT_TRUE(why_no_report().empty());
}

}  // namespace
}  // namespace vantage
