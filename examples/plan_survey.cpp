// SPDX-License-Identifier: Apache-2.0
// Plans a survey as `vantage plan` does, with the same settings, and writes the results:
// plan_survey SCENE FOLDER [SETTING=VALUE]..., as stations=4 capture=0.95
#include <algorithm>
#include <cstdio>
#include <string>
#include <vantage/vantage.hpp>

using namespace vantage;

// Sets `name` if the table has it.
template <class Options>
bool set(const SettingTable<Options>& table, Options& options, const std::string& name, const std::string& value) {
  const auto row = std::ranges::find(table, name, &SettingRow<Options>::name);
  if (row == table.end()) return false;
  row->set(options, value, name);
  return true;
}

int main(int argc, char** argv) try {
  if (argc < 3) return std::fprintf(stderr, "usage: plan_survey SCENE FOLDER [SETTING=VALUE]...\n"), 2;

  SiteOptions options;
  SurveyQuestion question;
  PlanConfig config;
  for (int k = 3; k < argc; ++k) {
    const std::string text = argv[k], name = text.substr(0, text.find('='));
    const std::string value = text.size() > name.size() ? text.substr(name.size() + 1) : "true";
    if (!set(site_settings(), options, name, value) && !set(question_settings(), question, name, value) &&
        !set(plan_settings(), config, name, value))
      throw Error(Errc::invalid_argument, "there is no setting \"" + name + "\"");
  }

  Site site = Site::open(argv[1], options);
  const PlanResult result =
      plan(site, question, config, {.report = [](const PlanProgress& now) {
             std::fprintf(stderr, "\r%s %zu of %zu  ", now.phase.c_str(), now.iteration, now.iterations);
           }});
  std::fprintf(stderr, "\n");
  write_plan(argv[2], result, site);
  std::printf("%s", summary_text(result.front[answer(result)], result.problem.requirements).c_str());
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
