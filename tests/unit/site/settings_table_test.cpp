// SPDX-License-Identifier: Apache-2.0
// The tables of settings, which command line, configuration files, scenes and Python go by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "vantage/error.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

template <class Options>
const SettingRow<Options>& row(const SettingTable<Options>& table, const std::string& name) {
  return *std::ranges::find(table, name, &SettingRow<Options>::name);
}

template <class Options>
void expect_described(const SettingTable<Options>& table, std::set<std::string>& names) {
  for (const SettingRow<Options>& setting : table) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name << " is there twice";
    for (const char c : setting.name) EXPECT_TRUE(std::islower(c) || c == '-') << setting.name;
    EXPECT_FALSE(setting.help.empty() || setting.help.ends_with('.')) << setting.name;
    EXPECT_FALSE(setting.group.empty()) << setting.name;
    if (setting.given) {
      EXPECT_FALSE(setting.given(Options{})) << setting.name;
    }
    for (const std::string& other : setting.excludes)
      EXPECT_NE(std::ranges::find(table, other, &SettingRow<Options>::name), table.end()) << setting.name;
  }
}

TEST(SettingTables, DescribeEachSettingOnce) {
  std::set<std::string> names;
  expect_described(site_settings(), names);
  expect_described(question_settings(), names);
  expect_described(plan_settings(), names);
  expect_described(beam_settings(), names);
  std::set<std::string> others;
  expect_described(next_settings(), others);
}

TEST(SettingTables, NameASettingThatCannotBeRead) {
  const auto refused = [](const auto& table, const std::string& name, const std::string& text, auto options) {
    try {
      row(table, name).set(options, text, name);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(site_settings(), "height", "tall", SiteOptions()), "height: 'tall' is not a number");
  EXPECT_EQ(refused(site_settings(), "spacing", "0", SiteOptions()),
            "spacing: '0' must be at least 1e-06 and at most 1e+09");
  EXPECT_EQ(refused(question_settings(), "capture", "2", SurveyQuestion()),
            "capture: '2' must be at least 0 and at most 1");
  EXPECT_EQ(refused(plan_settings(), "exact", "perhaps", PlanConfig()), "exact: 'perhaps' is neither true nor false");
  EXPECT_NE(refused(site_settings(), "weight", "facade", SiteOptions()).find("\"facade*=5\""), std::string::npos);
}

TEST(SettingTables, ReadWhatTheyDescribe) {
  SiteOptions site;
  row(site_settings(), "step").set(site, "0.2", "step");
  row(site_settings(), "weight").set(site, "wall*=5", "weight");
  row(site_settings(), "weight").set(site, "roof=2", "weight");
  row(site_settings(), "device").set(site, "0,cpu", "device");
  EXPECT_NEAR((*site.steps)[1].in_degrees(), 0.2, 1e-12);
  EXPECT_EQ(site.scene.weights, (std::vector<std::pair<std::string, std::uint32_t>>{{"wall*", 5}, {"roof", 2}}));
  EXPECT_TRUE(site.devices.cpu);
  EXPECT_TRUE(row(site_settings(), "weight").given(site));

  SurveyQuestion question;
  row(question_settings(), "stations").set(question, "3,8", "stations");
  row(question_settings(), "objectives").set(question, "coverage,overlap", "objectives");
  row(question_settings(), "set-up").set(question, "5", "set-up");
  row(question_settings(), "registration-surfaces").set(question, "all", "registration-surfaces");
  EXPECT_EQ(question.stations, (std::array<std::size_t, 2>{3, 8}));
  EXPECT_EQ(question.objectives, (std::vector<std::string>{"coverage", "overlap"}));
  EXPECT_EQ(question.on_site.set_up_min, 5);
  EXPECT_EQ(question.registration.surfaces, RegistrationSurfaces::all);

  PlanConfig config;
  row(plan_settings(), "sample").set(config, "5%", "sample");
  EXPECT_NEAR(*config.sample_share, 0.05, 1e-12);
  EXPECT_EQ(config.sample_voxels, 0u);
}

// Settings listed in a result can be given again by the same name.
TEST(SettingTables, HaveTheOptionsOfResults) {
  const std::vector<Vec3> corners{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const Site site(Scene::from_triangles(corners, triangles));
  for (const Setting& setting : site.settings()) {
    if (setting.option.empty()) continue;
    EXPECT_NE(std::ranges::find(site_settings(), setting.option, &SettingRow<SiteOptions>::name), site_settings().end())
        << setting.option;
  }
}

template <class Options>
std::string section(const std::string& title, const SettingTable<Options>& table) {
  std::string text = "\n## " + title + "\n\n| option | value | in Python | meaning |\n| --- | --- | --- | --- |\n";
  const auto cell = [](std::string value) {
    for (std::size_t at = 0; (at = value.find('|', at)) != std::string::npos; at += 2) value.insert(at, "\\");
    return value;
  };
  for (const SettingRow<Options>& setting : table) {
    std::string keyword = setting.name;
    std::ranges::replace(keyword, '-', '_');
    if (keyword == "for") keyword += '_';  // a word of Python's
    text += "| `--" + setting.name + "` | " + cell(setting.unit.empty() ? "–" : setting.unit) + " | `" + keyword +
            "` | " + cell(setting.help) + " |\n";
  }
  return text;
}

// The tables make docs/settings.md. If it differs, the folder of the test has the page as it should be.
TEST(SettingTables, AreAPageOfTheDocumentation) {
  const std::string page =
      "# Settings\n\n"
      "Every setting of a site, of a question, of a search and of the next stations, as the program's option, as a key "
      "of\nconfiguration files (`-` or `_` between words), and as a keyword in Python. A test makes this page from the "
      "tables of the\nlibrary (`site_settings()`, `question_settings()`, `plan_settings()`, `next_settings()`). "
      "[command_line.md](command_line.md) explains them.\n" +
      section("The site: `Site.open`, all commands", site_settings()) +
      section("The question: `Site.plan`, `vantage plan`", question_settings()) +
      section("The search: `Site.plan`, `vantage plan`", plan_settings()) +
      section("The next stations: `Site.next`, `vantage next`", next_settings());
  std::ifstream file(VANTAGE_DOCS_FOLDER "/settings.md");
  const std::string written{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (written != page) std::ofstream("settings.md") << page;
  EXPECT_EQ(written, page) << "copy settings.md from " << std::filesystem::current_path();
}

}  // namespace
}  // namespace vantage
