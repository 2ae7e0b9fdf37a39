// SPDX-License-Identifier: Apache-2.0
// Plans two stations: the part `plan`.
#include <cstdio>
#include <vantage/planner.hpp>
#include <vantage/question.hpp>
#include <vantage/site.hpp>

int main(int, char** argv) {
  using namespace vantage;
  Site site = Site::open(argv[1], {.user_size_m = 0.5, .spacing_m = 0.3, .engine = Engine::embree});
  SurveyQuestion question;
  question.problem = "coverage-fix";
  question.stations = {2, 2};
  const PlanResult result = plan(site, question, {.population = 4, .iterations = 2});
  std::printf("%zu networks\n", result.front.size());
  return result.front.empty() ? 1 : 0;
}
