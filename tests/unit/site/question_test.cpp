// SPDX-License-Identifier: Apache-2.0
#include "vantage/question.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/member_count.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

Site small_site() {
  const std::vector<Vec3> corners{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  SiteOptions options;
  options.engine = Engine::embree;
  options.user_size_m = 0.5, options.spacing_m = 0.2;
  return Site(Scene::from_triangles(corners, triangles), options);
}

std::vector<std::string> required(const SurveyProblem& problem) {
  std::vector<std::string> texts;
  for (const Requirement& requirement : problem.requirements) texts.push_back(to_string(requirement));
  return texts;
}

std::string refused(const SurveyQuestion& question) {
  Site site = small_site();
  try {
    survey_problem(site, question);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SurveyQuestion, AsksForTheStationsThatPayWhereNothingIsSaid) {
  Site site = small_site();
  const SurveyProblem problem = survey_problem(site);
  EXPECT_TRUE(problem.fewest);
  EXPECT_EQ(problem.name, "survey");
  EXPECT_EQ(problem.pays_m2, 25);
  EXPECT_EQ(required(problem), (std::vector<std::string>{"capture >= 0", "link >= 0.3", "apart >= 1"}));
  EXPECT_EQ(problem.stations_max, max_stations);
  SurveyQuestion same;
  same.pays_m2 = 25;
  EXPECT_EQ(required(survey_problem(site, same)), required(problem));
  EXPECT_EQ(survey_problem(site, same).pays_m2, problem.pays_m2);
}

TEST(SurveyQuestion, AShareOrANumberOfStationsTakesThePlaceOfWhatPays) {
  Site site = small_site();
  const auto asked = [&](auto set) {
    SurveyQuestion question;
    set(question);
    return survey_problem(site, question);
  };
  const SurveyProblem share = asked([](SurveyQuestion& q) { q.capture = 0.9; });
  EXPECT_EQ(share.pays_m2, std::nullopt);
  EXPECT_EQ(required(share).front(), "capture >= 0.9");
  const SurveyProblem in_words = asked([](SurveyQuestion& q) { q.requirements = {"capture>=0.8"}; });
  EXPECT_EQ(in_words.pays_m2, std::nullopt);
  EXPECT_EQ(required(in_words).front(), "capture >= 0.8");
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.stations = {5, 5}; }).pays_m2, std::nullopt);
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.problem = "coverage-fix", q.stations = {5, 5}; }).pays_m2, std::nullopt);
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.objectives = {"coverage"}, q.stations = {5, 5}; }).pays_m2, std::nullopt);
  // Other objectives and requirements, and a range, leave the number open.
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.stations = {2, 9}; }).pays_m2, 25);
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.objectives = {"time"}; }).pays_m2, 25);
  EXPECT_EQ(asked([](SurveyQuestion& q) { q.requirements = {"coverage>=0.5"}; }).pays_m2, 25);
  const SurveyProblem both = asked([](SurveyQuestion& q) { q.pays_m2 = 40, q.requirements = {"capture>=0.8"}; });
  EXPECT_EQ(both.pays_m2, 40);
  EXPECT_EQ(required(both).front(), "capture >= 0.8");
}

TEST(SurveyQuestion, IsAProblemByNameOrByObjectives) {
  Site site = small_site();
  SurveyQuestion question;
  question.problem = "coverage-overlap-fix", question.stations = {4, 4};
  EXPECT_FALSE(survey_problem(site, question).fewest);
  EXPECT_TRUE(survey_problem(site, question).requirements.empty());
  question.problem.reset(), question.objectives = {"coverage", "registration"};
  const SurveyProblem problem = survey_problem(site, question);
  EXPECT_EQ(problem.objectives.size(), 2u);
  EXPECT_EQ(required(problem), (std::vector<std::string>{"apart >= 1"}));
}

// All that a problem says, names of existing stations included.
std::string text_of(const SurveyProblem& problem) {
  std::string text;
  for (const Setting& setting : settings(problem)) text += setting.name + " " + setting.json + "\n";
  for (const std::string& name : problem.existing_names) text += name + "\n";
  return text;
}

// A member of a question, set to another value than it has in the question before.
struct QuestionChange {
  std::string member;
  std::function<void(SurveyQuestion&)> make, before = [](SurveyQuestion&) {};
};
void keep_a_station(SurveyQuestion& q) { q.existing = {{4, 4, 1.8}}; }
const std::vector<QuestionChange> kQuestion{
    {"problem", [](SurveyQuestion& q) { q.problem = "coverage-min"; },
     [](SurveyQuestion& q) {
       q.problem = "coverage-overlap-min", q.stations = {2, 3};
     }},
    {"capture", [](SurveyQuestion& q) { q.capture = 0.8; }},
    {"pays_m2", [](SurveyQuestion& q) { q.pays_m2 = 40; }},
    {"link", [](SurveyQuestion& q) { q.link = 0.2; }},
    {"apart_m", [](SurveyQuestion& q) { q.apart_m = 2; }},
    {"minutes_on_site", [](SurveyQuestion& q) { q.minutes_on_site = 90; }},
    {"on_site", [](SurveyQuestion& q) { q.on_site.set_up_min = 7; }},
    {"objectives", [](SurveyQuestion& q) { q.objectives = {"coverage"}; }},
    {"requirements", [](SurveyQuestion& q) { q.requirements = {"coverage>=0.5"}; }},
    {"stations",
     [](SurveyQuestion& q) {
       q.stations = {2, 3};
     }},
    {"existing", keep_a_station},
    {"existing_setups", [](SurveyQuestion& q) { q.existing_setups = {{.heading = Angle::degrees(30)}}; },
     keep_a_station},
    {"existing_names", [](SurveyQuestion& q) { q.existing_names = {"gate"}; }, keep_a_station},
    {"search_steps", [](SurveyQuestion& q) { q.search_steps = {"0.5"}; }},
    {"heights_m",
     [](SurveyQuestion& q) {
       q.heights_m = {1.5, 2.0};
     }},
    {"link_overlap", [](SurveyQuestion& q) { q.link_overlap = 0.07; }},
    {"min_overlap", [](SurveyQuestion& q) { q.min_overlap = 0.2; }},
    {"fitness", [](SurveyQuestion& q) { q.fitness = FitnessWeights{.coverage = 0.6}; },
     [](SurveyQuestion& q) {
       q.problem = "fitness-min", q.stations = {2, 3};
     }},
    {"registration", [](SurveyQuestion& q) { q.registration.position_m = 0.2; }},
    {"targets", [](SurveyQuestion& q) { q.targets = 4; }},
    {"existing_targets",
     [](SurveyQuestion& q) {
       q.existing_targets = {{.name = "C1", .centre = {1, 2, 1}}};
     }},
    {"target", [](SurveyQuestion& q) { q.target.diameter_m = 0.2; }}};
static_assert(test::member_count<SurveyQuestion>() == 22);

TEST(SurveyQuestion, HasNoMemberThatItsProblemForgets) {
  EXPECT_EQ(kQuestion.size(), test::member_count<SurveyQuestion>());
  const Site site = small_site();
  for (const QuestionChange& change : kQuestion) {
    SurveyQuestion question;
    change.before(question);
    const std::string before = text_of(survey_problem(site, question));
    change.make(question);
    EXPECT_NE(text_of(survey_problem(site, question)), before) << change.member;
  }
}

TEST(SurveyQuestion, TakesRequirementsInPlaceOfItsOwn) {
  Site site = small_site();
  SurveyQuestion question;
  question.requirements = {"capture>=0.8", "stations<=9"};
  question.minutes_on_site = 90;
  EXPECT_EQ(required(survey_problem(site, question)),
            (std::vector<std::string>{"capture >= 0.8", "link >= 0.3", "apart >= 1", "time <= 90", "stations <= 9"}));
}

TEST(SurveyQuestion, ChoosesAmongStepsOfTheSitesScanner) {
  Site site = small_site();
  SurveyQuestion question;
  question.search_steps = {"0.2", "0.1"};
  EXPECT_EQ(survey_problem(site, question).scanners.size(), 2u);
  question.search_steps = {"6mm", "12mm"};  // of the usual scanner
  EXPECT_EQ(survey_problem(site, question).scanners.size(), 2u);
  question.search_steps = {"7mm"};
  EXPECT_NE(refused(question).find("has no setting \"7mm\""), std::string::npos);
}

TEST(SurveyQuestion, RefusesWhatContradictsItself) {
  SurveyQuestion question;
  question.problem = "coverage-fix";
  EXPECT_NE(refused(question).find("stations: how many?"), std::string::npos);
  question = {}, question.min_overlap = 0.1, question.link_overlap = 0.2;
  EXPECT_NE(refused(question).find("differ"), std::string::npos);
  question = {}, question.problem = "coverage-fix", question.stations = {4, 4}, question.objectives = {"coverage"};
  EXPECT_NE(refused(question).find("has its own"), std::string::npos);
}

TEST(SettledPlan, ChoosesSampleAndIterationsByTheProblem) {
  const PlanConfig fewest = settled({}, fewest_stations(), 1'000'000, 7);
  EXPECT_EQ(fewest.sample_voxels, 5'000u);
  EXPECT_EQ(fewest.iterations, 0u);  // by the site
  EXPECT_EQ(fewest.seed, 7u);
  const PlanConfig front = settled({}, coverage_overlap_fix(4), 1'000'000, 7);
  EXPECT_EQ(front.sample_voxels, 5'000u);
  EXPECT_EQ(front.renew_iterations, 20u);
  EXPECT_EQ(front.iterations, 100u);
  const PlanConfig single = settled({.seed = 3}, coverage_fix(4), 1'000'000, 7);
  EXPECT_EQ(single.sample_voxels, 20'000u);
  EXPECT_EQ(single.renew_iterations, 0u);
  EXPECT_EQ(single.seed, 3u);
  EXPECT_EQ(settled({}, coverage_fix(4), 900, 1).sample_voxels, 900u);
}

TEST(SettledPlan, KeepsWhatIsGivenAndIsSettledOnce) {
  const PlanConfig share = settled({.sample_share = 0.05}, coverage_overlap_fix(4), 100'000, 1);
  EXPECT_EQ(share.sample_voxels, 5'000u);
  EXPECT_EQ(share.renew_iterations, 0u);
  const PlanConfig exact = settled({.exact = true}, coverage_overlap_fix(4), 100'000, 1);
  EXPECT_EQ(exact.sample_voxels, 0u);
  EXPECT_EQ(exact.renew_iterations, 0u);
  for (const PlanConfig& config : {share, exact}) {
    const PlanConfig again = settled(config, coverage_overlap_fix(4), 100'000, 9);
    EXPECT_EQ(again.sample_voxels, config.sample_voxels);
    EXPECT_EQ(again.seed, config.seed);
  }
  EXPECT_THROW(settled({.exact = true, .sample_voxels = 10}, coverage_fix(4), 100, 1), Error);
}

TEST(PlanOfASite, IsThatOfItsPartsAndProblem) {
  const PlanConfig config{.population = 4, .iterations = 2, .sample_voxels = 100, .seed = 3};
  SurveyQuestion question;
  question.objectives = {"coverage"}, question.stations = {2, 2};
  Site site = small_site();
  const PlanResult whole = plan(site, question, config);
  Site parts(Simulator(site.scene(), site.scanners(), site.simulator_config()),
             SearchArea::build(site.scene(), site.walkable()), ClashChecker(site.scene(), site.security()));
  const PlanResult by_parts = plan(parts, survey_problem(parts, question), config);
  ASSERT_EQ(whole.front.size(), by_parts.front.size());
  EXPECT_EQ(whole.front[0].x, by_parts.front[0].x);
  EXPECT_EQ(whole.front[0].value("coverage"), by_parts.front[0].value("coverage"));
}

}  // namespace
}  // namespace vantage
