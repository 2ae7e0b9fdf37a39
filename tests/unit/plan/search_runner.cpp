// SPDX-License-Identifier: Apache-2.0
// Runs a toy search slowly enough to be killed half way: search_runner PROBLEM CHECKPOINT OUTPUT. It goes on from the
// checkpoint where there is one, and writes what it found to OUTPUT.
#include <chrono>
#include <cstdio>
#include <thread>

#include "core/atomic_file.hpp"
#include "unit/plan/toy_survey.hpp"

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  const vantage::SurveyProblem problem = vantage::test::toy_problem(argv[1]);
  vantage::PlanConfig config = vantage::test::toy_config();
  config.checkpoint = argv[2];
  config.checkpoint_seconds = 0.002;
  config.resume = true;
  vantage::test::ToyEvaluator evaluator;
  evaluator.before_each = [](const vantage::PlacedNetwork&) {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  };
  vantage::write_atomically(argv[3], vantage::test::bits_of(vantage::test::toy_search(problem, config, evaluator)));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
