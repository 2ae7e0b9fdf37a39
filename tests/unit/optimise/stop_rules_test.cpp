// SPDX-License-Identifier: Apache-2.0
// Properties of every optimiser and baseline, mainly when it stops.
#include "optimise/stop_rules.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "bench/baselines.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using bench::Algorithm;

constexpr std::size_t kDimension = 3;

struct Made {
  Algorithm algorithm;
  std::size_t objectives;
  std::size_t batch = 1;
};

void PrintTo(const Made& made, std::ostream* out) { *out << to_string(made.algorithm) << " of " << made.objectives; }

// Tells squared distances to (0.3, …), and to (0.6, …).
void tell(Optimiser& optimiser) {
  const auto points = optimiser.ask();
  std::vector<double> values;
  for (std::size_t k = 0; k < points.size(); k += kDimension) {
    for (std::size_t m = 0; m < optimiser.objectives(); ++m) {
      double f = 0;
      for (const double v : points.subspan(k, kDimension))
        f += (v - 0.3 * static_cast<double>(m + 1)) * (v - 0.3 * static_cast<double>(m + 1));
      values.push_back(f);
    }
  }
  optimiser.tell(values);
}

StopReason run(Optimiser& optimiser) {
  while (optimiser.stop_reason() == StopReason::running && optimiser.evaluations() < 20000) tell(optimiser);
  return optimiser.stop_reason();
}

class AnyOptimiser : public testing::TestWithParam<Made> {
 protected:
  std::unique_ptr<Optimiser> make(const OptimiserConfig& config) const {
    return make_optimiser(GetParam().algorithm, kDimension, GetParam().objectives, config);
  }
  OptimiserConfig config() const {
    return {.population = 10, .bounds = Bounds::uniform(kDimension, 0, 1), .mo = {.batch = GetParam().batch}};
  }
  static std::string saved(const Optimiser& optimiser) {
    std::ostringstream out;
    optimiser.save(out);
    return std::move(out).str();
  }
  std::unique_ptr<Optimiser> loaded(const OptimiserConfig& config, const std::string& state) const {
    auto optimiser = make(config);
    std::istringstream in(state);
    optimiser->load(in);
    return optimiser;
  }
};
INSTANTIATE_TEST_SUITE_P(, AnyOptimiser,
                         testing::Values(Made{Algorithm::cma_es, 1}, Made{Algorithm::mo_cma_es, 1},
                                         Made{Algorithm::mo_cma_es, 2}, Made{Algorithm::mo_cma_es, 2, 4},
                                         Made{Algorithm::mo_cma_es, 2, 35}, Made{Algorithm::nsga2, 2},
                                         Made{Algorithm::random_search, 2}),
                         [](const auto& test) {
                           return to_string(test.param.algorithm) + "_of_" + std::to_string(test.param.objectives) +
                                  (test.param.batch > 1 ? "_batch_" + std::to_string(test.param.batch) : "");
                         });

TEST_P(AnyOptimiser, TellsWhatItWasMadeFor) {
  const auto optimiser = make(config());
  EXPECT_EQ(optimiser->dimension(), kDimension);
  EXPECT_EQ(optimiser->objectives(), GetParam().objectives);
  EXPECT_EQ(optimiser->stop_reason(), StopReason::running);
}

TEST_P(AnyOptimiser, HypervolumeIsThatOfItsFrontAndPopulation) {
  const auto optimiser = make(config());
  const std::size_t m = GetParam().objectives;
  EXPECT_EQ(optimiser->hypervolume(), 0);
  for (int i = 0; i < 30; ++i) {
    tell(*optimiser);
    std::vector<double> front, population;
    for (const ParetoPoint& p : optimiser->front()) front.insert(front.end(), p.f.begin(), p.f.end());
    for (const ParetoPoint& p : optimiser->population()) population.insert(population.end(), p.f.begin(), p.f.end());
    const std::vector<double> reference(m, 1.0);
    EXPECT_EQ(optimiser->hypervolume(), hypervolume(population, m, reference));
    EXPECT_DOUBLE_EQ(optimiser->hypervolume(), hypervolume(front, m, reference));
  }
}

TEST_P(AnyOptimiser, StopsAtItsTargetAsSoonAsItIsReached) {
  OptimiserConfig c = config();
  const double target = 0.93 - 0.3 * static_cast<double>(GetParam().objectives - 1);
  const auto free = make(c);
  c.target_hypervolume = target;
  const auto optimiser = make(c);
  while (free->evaluations() == 0 || free->hypervolume() < target) {
    ASSERT_LT(free->evaluations(), 20000u);
    ASSERT_EQ(optimiser->stop_reason(), StopReason::running);
    tell(*free), tell(*optimiser);
  }
  EXPECT_EQ(optimiser->stop_reason(), StopReason::target_reached);
  EXPECT_EQ(optimiser->evaluations(), free->evaluations());
  // If a limit ends the search at the same tell(), the limit is reported.
  c.max_evaluations = free->evaluations();
  EXPECT_EQ(run(*make(c)), StopReason::max_evaluations);
}

TEST_P(AnyOptimiser, StagnatesWhenTheHypervolumeHasNotGrown) {
  OptimiserConfig c = config();
  c.restarts = 1'000'000;  // they do not circumvent it
  c.x_tolerance = 0.1;
  const auto free = make(c);
  c.stagnation_iterations = 4;
  c.stagnation_tolerance = 0.01;
  const auto optimiser = make(c);
  std::vector<std::pair<std::size_t, double>> history;
  for (bool stagnated = false; !stagnated;) {
    ASSERT_LT(free->evaluations(), 20000u);
    ASSERT_EQ(optimiser->stop_reason(), StopReason::running);
    tell(*free), tell(*optimiser);
    const std::size_t now = free->iterations();
    if (!history.empty() && history.back().first == now) continue;
    history.emplace_back(now, free->hypervolume());
    for (const auto& [iteration, hypervolume] : history)  // the last that is old enough counts
      if (iteration + 4 <= now) stagnated = history.back().second - hypervolume <= 0.01 * history.back().second;
  }
  EXPECT_EQ(optimiser->stop_reason(), StopReason::stagnated);
  EXPECT_EQ(optimiser->evaluations(), free->evaluations());
}

// A search that continues under other rules ends as one that always had them.
TEST_P(AnyOptimiser, IsJudgedByTheRulesThatItGoesOnWith) {
  const OptimiserConfig plain = config();
  std::vector<OptimiserConfig> ruled(4, plain);
  ruled[0].max_iterations = 12;
  ruled[1].max_evaluations = 145;
  ruled[2].target_hypervolume = 0.93 - 0.3 * static_cast<double>(GetParam().objectives - 1);
  ruled[3].stagnation_iterations = 3, ruled[3].stagnation_tolerance = 0.03;
  for (const OptimiserConfig& rules : ruled) {
    const auto whole = make(rules);
    const StopReason reason = run(*whole);
    ASSERT_NE(reason, StopReason::running);
    const std::string end = saved(*whole);
    for (const OptimiserConfig& before : ruled) {
      auto optimiser = make(before);
      while (optimiser->stop_reason() == StopReason::running && optimiser->evaluations() < whole->evaluations())
        tell(*optimiser);
      optimiser = loaded(rules, saved(*optimiser));
      EXPECT_EQ(run(*optimiser), reason);
      EXPECT_EQ(saved(*optimiser), end);
    }
    EXPECT_EQ(loaded(plain, end)->stop_reason(), StopReason::running);
  }
}

}  // namespace
}  // namespace vantage
