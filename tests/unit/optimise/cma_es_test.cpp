// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {
namespace cma_es_tests {  // for one objective; other files have helpers of the same names for several
namespace {

using Objective = std::function<double(std::span<const double>)>;

double sphere(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return sum;
}

double ellipsoid(std::span<const double> x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1)) * x[i] * x[i];
  return sum;
}

double rastrigin(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += v * v + 10 - 10 * std::cos(2 * 3.14159265358979 * v);
  return sum;
}

void step(CmaEs& optimiser, std::size_t n, const Objective& f) {
  const auto points = optimiser.ask();
  std::vector<double> values;
  for (std::size_t k = 0; k < points.size(); k += n) values.push_back(f(points.subspan(k, n)));
  optimiser.tell(values);
}

StopReason run(CmaEs& optimiser, std::size_t n, const Objective& f, std::size_t max_iterations = 100000) {
  for (std::size_t i = 0; i < max_iterations && optimiser.stop_reason() == StopReason::running; ++i)
    step(optimiser, n, f);
  return optimiser.stop_reason();
}

TEST(CmaEs, FindsMinimaWithoutBounds) {
  for (const auto& f : {Objective(sphere), Objective(ellipsoid)}) {
    CmaEs optimiser(6, {.sigma0 = 1, .start = {std::vector<double>(6, 3.0)}, .cma = {.target = 1e-10}});
    EXPECT_EQ(run(optimiser, 6, f, 2000), StopReason::target_reached);
    EXPECT_LE(optimiser.best().f[0], 1e-10);
    for (const double v : optimiser.best().x) EXPECT_NEAR(v, 0, 1e-4);
  }
}

TEST(CmaEs, ActiveUpdateNeedsFewerEvaluationsOnTheEllipsoid) {
  const auto evaluations = [](bool active) {
    std::size_t sum = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      CmaEs optimiser(8, {.sigma0 = 2,
                          .start = {std::vector<double>(8, 3.0)},
                          .seed = seed,
                          .cma = {.active = active, .target = 1e-8}});
      EXPECT_EQ(run(optimiser, 8, ellipsoid), StopReason::target_reached);
      sum += optimiser.evaluations();
    }
    return sum;
  };
  EXPECT_LT(evaluations(true), evaluations(false) * 9 / 10);
}

TEST(CmaEs, FindsAnOptimumOnTheBounds) {
  const std::size_t n = 5;
  CmaEs optimiser(n, {.bounds = Bounds::uniform(n, 2, 7), .cma = {.target = 4 * n + 1e-6}});
  EXPECT_EQ(run(optimiser, n, sphere, 2000), StopReason::target_reached);
  for (const double v : optimiser.best().x) EXPECT_NEAR(v, 2, 1e-6);
}

TEST(CmaEs, RestartsWithDoubledPopulationLeaveLocalMinima) {
  CmaEs optimiser(4, {.bounds = Bounds::uniform(4, -5, 5),
                      .start = {std::vector<double>(4, 3.0)},
                      .restarts = 8,
                      .seed = 3,
                      .cma = {.target = 1e-8}});
  const std::size_t first = optimiser.lambda();
  EXPECT_EQ(run(optimiser, 4, rastrigin), StopReason::target_reached);
  EXPECT_GT(optimiser.restarts(), 0u);
  EXPECT_EQ(optimiser.lambda(), first << optimiser.restarts());
}

RC_GTEST_PROP(CmaEs, AsksInsideTheBounds, ()) {
  const auto n = *rc::gen::inRange<std::size_t>(1, 6);
  OptimiserConfig config;
  config.seed = *rc::gen::arbitrary<std::uint64_t>();
  config.sigma0 = *rc::gen::element(1e-3, 0.2, 5.0);
  Bounds bounds;
  for (std::size_t i = 0; i < n; ++i) {
    bounds.lower.push_back(*rc::gen::inRange(-1000, 1000) / 7.0);
    bounds.upper.push_back(bounds.lower[i] + *rc::gen::inRange(1, 1000) / 13.0);
  }
  config.bounds = bounds;
  CmaEs optimiser(n, config);
  for (int i = 0; i < 30; ++i) {
    const auto points = optimiser.ask();
    std::vector<double> values;
    for (std::size_t k = 0; k < points.size(); ++k) {
      RC_ASSERT(points[k] >= bounds.lower[k % n] && points[k] <= bounds.upper[k % n]);
      if (k % n == 0) values.push_back(points[k]);  // leads to a bound
    }
    optimiser.tell(values);
  }
}

TEST(CmaEs, ReplacedPointsCountAsDrawn) {
  // The user moves every drawn point to an ever finer cloud around (0.3, …): the strategy must follow.
  const std::size_t n = 3;
  CmaEs optimiser(n, {.bounds = Bounds::uniform(n, 0, 1), .max_iterations = 60});
  std::vector<double> x(n), values;
  while (optimiser.stop_reason() == StopReason::running) {
    const auto points = optimiser.ask();
    values.clear();
    for (std::size_t k = 0; k * n < points.size(); ++k) {
      for (std::size_t i = 0; i < n; ++i) x[i] = 0.3 + 0.1 * (points[k * n + i] - 0.3);
      optimiser.replace(k, x);
      EXPECT_TRUE(std::ranges::equal(optimiser.ask().subspan(k * n, n), x));
      values.push_back(sphere(x));
    }
    optimiser.tell(values);
  }
  EXPECT_LT(optimiser.sigma(), 1e-3);
  EXPECT_THROW(optimiser.replace(0, x), Error);
  optimiser.ask();
  EXPECT_THROW(optimiser.replace(0, std::vector<double>{0.5, 0.5, 1.5}), Error);
  EXPECT_THROW(optimiser.replace(99, x), Error);
}

TEST(CmaEs, ResamplesOnlyWhatItIsTold) {
  const std::size_t n = 6;
  CmaEs optimiser(n, {.bounds = Bounds::uniform(n, -3, 3)});
  for (int i = 0; i < 20; ++i) step(optimiser, n, ellipsoid);
  const auto points = optimiser.ask();
  const std::vector<double> before(points.begin(), points.end());
  const std::vector<std::size_t> coordinates = {1, 4};
  const auto now = optimiser.resample(2, coordinates);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool drawn = i == 2 * n + 1 || i == 2 * n + 4;
    EXPECT_EQ(points[i] != before[i], drawn) << i;
  }
  EXPECT_EQ(now.data(), points.data() + 2 * n);
  EXPECT_THROW(optimiser.resample(2, std::vector<std::size_t>{6}), Error);
}

TEST(CmaEs, SameSeedSameBitsAndResumeToThem) {
  const std::size_t n = 7;
  const OptimiserConfig config{.bounds = Bounds::uniform(n, -5, 5),
                               .start = {std::vector<double>(n, 2.5)},
                               .restarts = 4,
                               .max_evaluations = 6000,
                               .seed = 11};
  CmaEs whole(n, config), parted(n, config);
  std::string state;
  while (whole.stop_reason() == StopReason::running) {
    const auto a = whole.ask(), b = parted.ask();
    ASSERT_TRUE(std::ranges::equal(a, b));
    step(whole, n, rastrigin);
    step(parted, n, rastrigin);
    if (whole.iterations() % 50 != 0) continue;
    std::stringstream file;
    parted.save(file);
    CmaEs resumed(n, config);
    resumed.load(file);
    parted = std::move(resumed);
  }
  EXPECT_GT(whole.restarts(), 0u);
  EXPECT_EQ(parted.stop_reason(), whole.stop_reason());
  EXPECT_EQ(parted.best().x, whole.best().x);
  EXPECT_EQ(parted.sigma(), whole.sigma());
}

TEST(CmaEs, StopsWithAReason) {
  const std::size_t n = 4;
  const auto reason = [&](OptimiserConfig config, const Objective& f) {
    CmaEs optimiser(n, config);
    const StopReason result = run(optimiser, n, f, 20000);
    for (const double v : optimiser.ask()) EXPECT_TRUE(std::isfinite(v));
    return result;
  };
  const auto nan = [](std::span<const double>) { return std::nan(""); };
  const auto flat = [](std::span<const double>) { return 7.0; };
  const auto linear = [](std::span<const double> x) { return x[0]; };
  const auto needle = [](std::span<const double> x) {
    return x[0] * x[0] + 1e16 * x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
  };
  const auto infinite = [](std::span<const double>) { return -std::numeric_limits<double>::infinity(); };
  std::size_t count = 0;
  const auto noise = [&](std::span<const double>) {
    return std::sin(static_cast<double>(++count) * 12.9898) * 43758.5453;
  };
  EXPECT_EQ(reason({}, nan), StopReason::invalid_objective);
  EXPECT_EQ(reason({}, infinite), StopReason::invalid_objective);
  EXPECT_EQ(reason({}, flat), StopReason::flat);
  EXPECT_EQ(reason({.bounds = Bounds::uniform(n, 0, 1)}, flat), StopReason::flat);
  EXPECT_EQ(reason({.restarts = 2}, flat), StopReason::flat);
  EXPECT_EQ(reason({}, linear), StopReason::diverged);
  EXPECT_EQ(reason({.start = {std::vector<double>(n, 1.0)}}, sphere), StopReason::converged);
  EXPECT_EQ(reason({.start = {std::vector<double>(n, 1.0)}, .x_tolerance = 0, .cma = {.f_tolerance = 0}}, needle),
            StopReason::ill_conditioned);
  EXPECT_EQ(reason({.max_iterations = 3}, sphere), StopReason::max_iterations);
  EXPECT_EQ(reason({.max_evaluations = 30}, sphere), StopReason::max_evaluations);
  EXPECT_EQ(reason({.cma = {.target = 1e-3}}, sphere), StopReason::target_reached);
  const auto noisy = reason({.bounds = Bounds::uniform(n, 0, 1)}, noise);
  EXPECT_TRUE(noisy == StopReason::stagnated || noisy == StopReason::converged || noisy == StopReason::ill_conditioned)
      << to_string(noisy);
  // Without both tolerances, the sphere ends when steps no longer change the mean, or at the smallest number.
  EXPECT_NE(reason({.start = {std::vector<double>(n, 1.0)}, .x_tolerance = 0, .cma = {.f_tolerance = 0}}, sphere),
            StopReason::running);
}

TEST(CmaEs, TakesNaNAsWorst) {
  const std::size_t n = 4;
  CmaEs optimiser(n, {.start = {std::vector<double>(n, 1.0)}, .cma = {.target = 1e-6}});
  const auto half = [](std::span<const double> x) { return x[0] < 0 ? std::nan("") : sphere(x); };
  EXPECT_EQ(run(optimiser, n, half, 5000), StopReason::target_reached);
}

TEST(CmaEs, RefusesWhatItCannotDo) {
  EXPECT_THROW(CmaEs(0), Error);
  EXPECT_THROW(CmaEs(2, {.reference = {1, 1}}), Error);
  EXPECT_THROW(CmaEs(2, {.cma = {.f_tolerance = -1}}), Error);
  EXPECT_THROW(CmaEs(2, {.population = 1}), Error);
  EXPECT_THROW(CmaEs(2, {.sigma0 = 0}), Error);
  EXPECT_THROW(CmaEs(2, {.sigma0 = std::nan("")}), Error);
  EXPECT_THROW(CmaEs(2, {.bounds = Bounds{{0, 1}, {1, 1}}}), Error);
  EXPECT_THROW(CmaEs(2, {.bounds = Bounds::uniform(3, 0, 1)}), Error);
  EXPECT_THROW(CmaEs(2, {.bounds = Bounds::uniform(2, 0, 1), .start = {{0.5, 2}}}), Error);
  CmaEs optimiser(2);
  EXPECT_THROW(optimiser.tell(std::vector<double>(6)), Error);
  optimiser.ask();
  EXPECT_THROW(optimiser.tell(std::vector<double>(5)), Error);
  std::stringstream file;
  EXPECT_THROW(optimiser.save(file), Error);
}

TEST(CmaEs, RefusesDamagedStatesAndStaysAsItWas) {
  const std::size_t n = 3;
  CmaEs optimiser(n);
  for (int i = 0; i < 5; ++i) step(optimiser, n, sphere);
  std::stringstream file;
  optimiser.save(file);
  const std::string good = file.str();
  const auto refuses = [&](const std::string& bytes) {
    std::stringstream in(bytes);
    try {
      optimiser.load(in);
    } catch (const Error& e) {
      return e.code() == Errc::malformed_file;
    }
    return false;
  };
  for (std::size_t i = 0; i < good.size(); i += 3) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_TRUE(refuses(bad)) << i;
  }
  for (std::size_t size = 0; size < good.size(); size += 17) EXPECT_TRUE(refuses(good.substr(0, size))) << size;
  CmaEs larger(n + 1);
  std::stringstream in(good);
  EXPECT_THROW(larger.load(in), Error);
  EXPECT_EQ(optimiser.iterations(), 5u);
  step(optimiser, n, sphere);
  std::stringstream again(good);
  optimiser.load(again);
  EXPECT_EQ(optimiser.iterations(), 5u);
}

TEST(CmaEs, HypervolumeIsWhatTheBestPointDominates) {
  const std::size_t n = 3;
  CmaEs optimiser(n, {.sigma0 = 1, .start = {std::vector<double>(n, 2.0)}, .reference = {5}});
  EXPECT_TRUE(optimiser.front().empty());
  EXPECT_EQ(optimiser.hypervolume(), 0);
  bool outside = false;
  for (int i = 0; i < 60; ++i) {
    step(optimiser, n, sphere);
    const auto front = optimiser.front();
    ASSERT_EQ(front.size(), 1u);
    EXPECT_EQ(front[0].x, optimiser.best().x);
    EXPECT_EQ(optimiser.hypervolume(), hypervolume(front[0].f, 1, std::vector{5.0}));
    EXPECT_EQ(optimiser.hypervolume(), std::max(0.0, 5 - front[0].f[0]));
    outside |= optimiser.hypervolume() == 0;
  }
  EXPECT_TRUE(outside);
  EXPECT_GT(optimiser.hypervolume(), 4.99);
}

TEST(CmaEs, RestartsAreNoWayRoundTheLimits) {
  // Converged every few iterations, and at the limit, too; the restarted run is continued.
  const std::size_t n = 4;
  OptimiserConfig c{.bounds = Bounds::uniform(n, -5, 5), .restarts = 1000, .x_tolerance = 0.8, .max_iterations = 100};
  CmaEs whole(n, c);
  EXPECT_EQ(run(whole, n, rastrigin), StopReason::max_iterations);
  EXPECT_EQ(whole.iterations(), 100u);
  EXPECT_GT(whole.restarts(), 2u);
  CmaEs parted(n, c);
  for (c.max_iterations = 1; c.max_iterations <= 100; ++c.max_iterations) {
    std::stringstream file;
    parted.save(file);
    parted = CmaEs(n, c);
    parted.load(file);
    EXPECT_EQ(run(parted, n, rastrigin), StopReason::max_iterations);
  }
  EXPECT_EQ(parted.restarts(), whole.restarts());
  EXPECT_EQ(parted.best().x, whole.best().x);
  EXPECT_TRUE(std::ranges::equal(parted.ask(), whole.ask()));
}

TEST(CmaEs, GoesOnFromRestWhereMoreRestartsAreAllowed) {
  const std::size_t n = 4;
  OptimiserConfig c{.bounds = Bounds::uniform(n, -5, 5), .restarts = 2, .seed = 5};
  CmaEs whole(n, c);
  const StopReason reason = run(whole, n, rastrigin);
  EXPECT_EQ(whole.restarts(), 2u);
  std::stringstream file;
  c.restarts = 0;
  CmaEs first(n, c);
  run(first, n, rastrigin);
  EXPECT_EQ(first.restarts(), 0u);
  first.save(file);
  c.restarts = 2;
  CmaEs resumed(n, c);
  resumed.load(file);
  EXPECT_EQ(run(resumed, n, rastrigin), reason);
  EXPECT_EQ(resumed.evaluations(), whole.evaluations());
  EXPECT_EQ(resumed.best().x, whole.best().x);
}

// Three stations and three targets, each seen only nearby: two stations at one target cannot reach the third.
double unseen(std::span<const double> x) {
  double sum = 0;
  for (const auto& [tx, ty] : {std::pair{0.1, 0.2}, std::pair{0.9, 0.1}, std::pair{0.5, 0.9}}) {
    double nearest = 0.2;
    for (std::size_t i = 0; i < 6; i += 2) nearest = std::min(nearest, std::hypot(x[i] - tx, x[i + 1] - ty));
    sum += nearest;
  }
  return sum;
}

OptimiserConfig block_config() {
  return {.population = 10,
          .bounds = Bounds::uniform(8, 0, 1),
          .blocks = {{0, 1}, {2, 3}, {4, 5}, {6, 7}},
          .blocks_in_use = [](std::span<const double>) { return std::size_t{3}; }};
}

TEST(CmaEs, SwappedBlocksLeaveLocalOptima) {
  std::size_t plain = 0, swapped = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const bool blocks : {false, true}) {
      OptimiserConfig c = block_config();
      if (!blocks) c.blocks.clear();
      c.seed = seed;
      c.max_evaluations = 3000;
      CmaEs optimiser(8, c);
      while (optimiser.stop_reason() == StopReason::running) {
        const auto points = optimiser.ask();
        std::vector<double> values;
        for (std::size_t k = 0; k < points.size(); k += 8) values.push_back(unseen(points.subspan(k, 8)));
        optimiser.tell(values);
      }
      (blocks ? swapped : plain) += optimiser.best().f[0] < 0.01;
    }
  }
  EXPECT_EQ(swapped, 10u);
  EXPECT_LT(plain, 8u);
}

TEST(CmaEs, AsksForPointsThatDifferFromTheMeanByABlock) {
  OptimiserConfig c = block_config();
  c.start.assign(1, std::vector<double>(8, 0.5));
  CmaEs optimiser(8, c);
  ASSERT_EQ(optimiser.ask().size(), 10u * 8);
  const auto x = optimiser.ask().subspan(72, 8);
  std::size_t moved = 0;
  for (std::size_t b = 0; b < 8; b += 2) moved += x[b] != 0.5 || x[b + 1] != 0.5;
  EXPECT_EQ(moved, 1u);
  EXPECT_EQ(x[6], 0.5);  // never the unused block
  const std::vector<std::size_t> coordinates{2, 3};
  const double before = x[2];
  EXPECT_NE(optimiser.resample(9, coordinates)[2], before);
  EXPECT_THROW(optimiser.tell(std::vector<double>(9, 1.0)), Error);
  // The best of all points is kept.
  std::vector<double> values(10, 1.0);
  for (std::size_t k = 0; k < 9; ++k) values[k] += static_cast<double>(k);
  values[9] = 0.5;
  optimiser.tell(values);
  EXPECT_EQ(optimiser.best().f[0], 0.5);
  EXPECT_EQ(optimiser.evaluations(), 10u);
}

TEST(CmaEs, ResumesSwapsToTheSameBits) {
  CmaEs whole(8, block_config());
  const auto step = [](CmaEs& optimiser) {
    const auto points = optimiser.ask();
    std::vector<double> values;
    for (std::size_t k = 0; k < points.size(); k += 8) values.push_back(unseen(points.subspan(k, 8)));
    optimiser.tell(values);
  };
  for (int i = 0; i < 30; ++i) step(whole);
  std::stringstream file;
  whole.save(file);
  CmaEs parted(8, block_config());
  parted.load(file);
  for (int i = 0; i < 30; ++i) step(whole), step(parted);
  EXPECT_EQ(whole.best().x, parted.best().x);
  EXPECT_TRUE(std::ranges::equal(whole.ask(), parted.ask()));
  OptimiserConfig other = block_config();
  other.blocks.pop_back();
  file.clear();
  file.seekg(0);
  EXPECT_THROW(CmaEs(8, other).load(file), Error);
}

TEST(CmaEs, TakesAnotherObjectiveOfItsBest) {
  CmaEs optimiser(3, {.population = 8, .bounds = Bounds::uniform(3, 0, 1)});
  EXPECT_THROW(optimiser.reassess(std::vector{1.0}), Error);  // there is none yet
  for (int round = 0; round < 5; ++round) {
    const auto points = optimiser.ask();
    std::vector<double> values;
    for (std::size_t k = 0; k < points.size(); k += 3) values.push_back(points[k] + points[k + 1] * points[k + 2]);
    optimiser.tell(values);
  }
  const ParetoPoint before = optimiser.best();
  optimiser.reassess(std::vector{before.f[0] + 0.25});
  EXPECT_EQ(optimiser.best().x, before.x);
  EXPECT_EQ(optimiser.best().f[0], before.f[0] + 0.25);
}

}  // namespace
}  // namespace cma_es_tests
}  // namespace vantage
