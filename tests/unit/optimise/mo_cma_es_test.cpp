// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "bench/baselines.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {
namespace {

using bench::Algorithm;
using Scheme = MoScheme;
using Objectives = std::function<std::vector<double>(std::span<const double>)>;

// Distances to (0, …) and (1, …): the front is f1 = (1 − √f0)², with hypervolume 5/6 against (1, 1).
std::vector<double> two_spheres(std::span<const double> x) {
  double a = 0, b = 0;
  for (const double v : x) {
    a += v * v;
    b += (v - 1) * (v - 1);
  }
  const double n = static_cast<double>(x.size());
  return {a / n, b / n};
}

std::vector<double> three_spheres(std::span<const double> x) {
  auto f = two_spheres(x);
  double c = 0;
  for (std::size_t i = 0; i < x.size(); ++i) c += (x[i] - (i % 2 == 0 ? 0.2 : 0.8)) * (x[i] - (i % 2 == 0 ? 0.2 : 0.8));
  f.push_back(c / static_cast<double>(x.size()));
  return f;
}

void step(Optimiser& optimiser, std::size_t n, const Objectives& f) {
  const auto points = optimiser.ask();
  std::vector<double> values;
  for (std::size_t k = 0; k < points.size(); k += n) {
    const auto one = f(points.subspan(k, n));
    values.insert(values.end(), one.begin(), one.end());
  }
  optimiser.tell(values);
}

StopReason run(Optimiser& optimiser, std::size_t n, const Objectives& f, std::size_t max_evaluations = 200000) {
  while (optimiser.stop_reason() == StopReason::running && optimiser.evaluations() < max_evaluations)
    step(optimiser, n, f);
  return optimiser.stop_reason();
}

struct Variant {
  Algorithm algorithm;
  Scheme scheme;
  std::size_t batch;
  bool published = false;  // without guided parents, spread steps and recombination
  bool blocks = false;     // pairs of coordinates, the last block never in use
  bool apart = false;      // each block with its own covariance
};

class EveryOptimiser : public testing::TestWithParam<Variant> {
 protected:
  OptimiserConfig config(std::size_t n) const {
    OptimiserConfig c;
    c.mo.scheme = GetParam().scheme;
    c.mo.batch = GetParam().batch;
    c.population = 20;
    c.bounds = Bounds::uniform(n, -1, 2);
    if (GetParam().published) c.mo.guided = c.mo.spread = c.mo.recombined = 0;
    if (GetParam().blocks) {
      for (std::size_t i = 0; i + 1 < n; i += 2) c.blocks.push_back({i, i + 1});
      c.blocks_in_use = [n](std::span<const double>) { return n / 2 - 1; };  // none of two: then one
    }
    if (GetParam().apart) c.mo.full_covariance = 0;
    return c;
  }
  std::unique_ptr<Optimiser> make(std::size_t n, std::size_t m, const OptimiserConfig& c) const {
    return make_optimiser(GetParam().algorithm, n, m, c);
  }
};
INSTANTIATE_TEST_SUITE_P(, EveryOptimiser,
                         testing::Values(Variant{Algorithm::mo_cma_es, Scheme::generational, 1},
                                         Variant{Algorithm::mo_cma_es, Scheme::steady_state, 1},
                                         Variant{Algorithm::mo_cma_es, Scheme::steady_state, 1, true},
                                         Variant{Algorithm::mo_cma_es, Scheme::steady_state, 7},
                                         Variant{Algorithm::mo_cma_es, Scheme::steady_state, 3, false, true},
                                         Variant{Algorithm::mo_cma_es, Scheme::steady_state, 3, false, true, true},
                                         Variant{Algorithm::mo_cma_es, Scheme::generational, 1, false, true, true},
                                         Variant{Algorithm::nsga2, Scheme::generational, 1},
                                         Variant{Algorithm::random_search, Scheme::generational, 1}),
                         [](const auto& test) {
                           return to_string(test.param.algorithm) +
                                  (test.param.scheme == Scheme::generational
                                       ? ""
                                       : "_steady" + std::to_string(test.param.batch)) +
                                  (test.param.published ? "_published" : "") + (test.param.blocks ? "_blocks" : "") +
                                  (test.param.apart ? "_apart" : "");
                         });

TEST_P(EveryOptimiser, NearsAKnownFront) {
  const std::size_t n = 4;
  auto c = config(n);
  c.max_evaluations = 4000;
  auto optimiser = make(n, 2, c);
  EXPECT_EQ(run(*optimiser, n, two_spheres), StopReason::max_evaluations);
  EXPECT_GT(optimiser->hypervolume(), GetParam().algorithm == Algorithm::random_search ? 0.55 : 0.78);
  EXPECT_LT(optimiser->hypervolume(), 5.0 / 6);
  const auto front = optimiser->front();
  for (std::size_t i = 0; i < front.size(); ++i) {
    EXPECT_EQ(front[i].f, two_spheres(front[i].x));
    if (i == 0) continue;
    EXPECT_LE(front[i - 1].f[0], front[i].f[0]);
    EXPECT_GE(front[i - 1].f[1], front[i].f[1]);
  }
  EXPECT_EQ(optimiser->population().size(), 20u);
  EXPECT_EQ(optimiser->iterations(), optimiser->evaluations() / 20);
}

TEST_P(EveryOptimiser, TakesOtherObjectivesOfWhatItKeeps) {
  const std::size_t n = 4;
  auto optimiser = make(n, 2, config(n));
  for (int round = 0; round < 30; ++round) step(*optimiser, n, two_spheres);
  const auto before = optimiser->population();
  std::vector<double> values;
  for (std::size_t k = 0; k < before.size(); ++k) {
    values.push_back(before[k].f[0] + 0.01 * static_cast<double>(k % 3));
    values.push_back(k == 5 ? std::numeric_limits<double>::quiet_NaN() : before[k].f[1]);
  }
  optimiser->reassess(values);
  const auto after = optimiser->population();
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(after[k].x, before[k].x);
    if (k == 5)
      EXPECT_EQ(after[k].f, std::vector<double>(2, std::numeric_limits<double>::infinity()));
    else
      EXPECT_EQ(after[k].f, std::vector<double>(values.begin() + 2 * static_cast<std::ptrdiff_t>(k),
                                                values.begin() + 2 * static_cast<std::ptrdiff_t>(k) + 2));
  }
  std::vector<double> all;
  for (const ParetoPoint& point : after) all.insert(all.end(), point.f.begin(), point.f.end());
  EXPECT_EQ(optimiser->hypervolume(), hypervolume(all, 2, std::vector{1.0, 1.0}));
  // And continues with them, also from a saved state.
  std::stringstream file;
  optimiser->save(file);
  auto other = make(n, 2, config(n));
  other->load(file);
  for (int round = 0; round < 10; ++round) step(*optimiser, n, two_spheres), step(*other, n, two_spheres);
  EXPECT_EQ(optimiser->hypervolume(), other->hypervolume());
  values.pop_back();
  EXPECT_THROW(optimiser->reassess(values), Error);
  values.push_back(1);
  optimiser->ask();
  EXPECT_THROW(optimiser->reassess(values), Error);
}

// Newcomers that later samples rate badly do not outlive the members they replaced.
TEST(MoCmaEs, RecallsWhoHadToGoForSomebodyLucky) {
  const std::size_t n = 4, mu = 10;
  OptimiserConfig config{.population = mu, .bounds = Bounds::uniform(n, -1, 2), .mo = {.batch = 5, .recalls = true}};
  MoCmaEs optimiser(n, 2, config);
  for (int round = 0; round < 8; ++round) step(optimiser, n, two_spheres);
  EXPECT_EQ(optimiser.population().size(), mu) << "nothing was reassessed yet";
  const auto told = [](const std::vector<ParetoPoint>& points, const auto& f) {
    std::vector<double> values;
    for (const ParetoPoint& point : points)
      for (const double value : f(point)) values.push_back(value);
    return values;
  };
  const auto same = [](const ParetoPoint& point) { return point.f; };
  optimiser.reassess(told(optimiser.population(), same));
  std::vector<std::vector<double>> known;
  for (const ParetoPoint& point : optimiser.population()) known.push_back(point.x);
  const auto is_known = [&](const ParetoPoint& point) { return std::ranges::count(known, point.x) > 0; };

  for (int round = 0; round < 20; ++round) step(optimiser, n, two_spheres);
  std::stringstream file;
  optimiser.save(file);
  MoCmaEs other(n, 2, config);
  other.load(file);
  for (MoCmaEs* one : {&optimiser, &other}) {
    const auto kept = one->population();
    ASSERT_GT(kept.size(), mu);
    EXPECT_EQ(std::ranges::count_if(kept, is_known), static_cast<std::ptrdiff_t>(mu)) << "none is lost";
    one->reassess(told(kept, [&](const ParetoPoint& point) {
      return is_known(point) ? point.f : std::vector<double>{5, 5};
    }));
    const auto chosen = one->population();
    EXPECT_EQ(chosen.size(), mu);
    EXPECT_TRUE(std::ranges::all_of(chosen, is_known));
    for (int round = 0; round < 10; ++round) step(*one, n, two_spheres);
  }
  EXPECT_EQ(optimiser.hypervolume(), other.hypervolume());
  EXPECT_THROW(optimiser.reassess(std::vector<double>(2 * mu)), Error) << "all of population() are wanted";
}

TEST_P(EveryOptimiser, AsksInsideTheBounds) {
  EXPECT_TRUE(rc::check([&] {
    const auto n = *rc::gen::inRange<std::size_t>(1, 5);
    auto c = config(n);
    c.population = *rc::gen::inRange<std::size_t>(1, 12);
    c.seed = *rc::gen::arbitrary<std::uint64_t>();
    c.sigma0 = *rc::gen::element(1e-3, 0.2, 5.0);
    for (std::size_t i = 0; i < n; ++i) {
      c.bounds->lower[i] = *rc::gen::inRange(-1000, 1000) / 7.0;
      c.bounds->upper[i] = c.bounds->lower[i] + *rc::gen::inRange(1, 1000) / 13.0;
      if (c.blocks.empty() || i < 2) continue;
      c.bounds->lower[i] = c.bounds->lower[i - 2];
      c.bounds->upper[i] = c.bounds->upper[i - 2];
    }
    auto optimiser = make(n, 2, c);
    for (int round = 0; round < 20; ++round) {
      step(*optimiser, n, [&](std::span<const double> x) {
        for (std::size_t i = 0; i < n; ++i) RC_ASSERT(x[i] >= c.bounds->lower[i] && x[i] <= c.bounds->upper[i]);
        return std::vector{x[0], x[n - 1] - 2 * x[0]};  // leads to bounds
      });
    }
  }));
}

TEST_P(EveryOptimiser, SameSeedSameBitsAndResumeToThem) {
  const std::size_t n = 5;
  for (const std::size_t m : {2, 3}) {
    const Objectives f = m == 2 ? Objectives(two_spheres) : Objectives(three_spheres);
    auto c = config(n);
    c.max_evaluations = 600;
    c.stagnation_iterations = 1000;
    auto whole = make(n, m, c), parted = make(n, m, c);
    while (whole->stop_reason() == StopReason::running) {
      ASSERT_TRUE(std::ranges::equal(whole->ask(), parted->ask()));
      // Redrawn points must resume, too.
      const std::vector<std::size_t> coordinates = {3, 1};
      whole->resample(0, coordinates);
      parted->resample(0, coordinates);
      ASSERT_TRUE(std::ranges::equal(whole->ask(), parted->ask()));
      step(*whole, n, f);
      step(*parted, n, f);
      std::stringstream file;
      parted->save(file);
      parted = make(n, m, c);
      parted->load(file);
    }
    EXPECT_EQ(parted->stop_reason(), whole->stop_reason());
    EXPECT_EQ(parted->hypervolume(), whole->hypervolume());
    const auto a = whole->population(), b = parted->population();
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].x, b[i].x);
  }
}

TEST_P(EveryOptimiser, ResumesUnderRaisedLimits) {
  const std::size_t n = 3;
  auto c = config(n);
  c.max_iterations = 3;
  auto optimiser = make(n, 2, c);
  EXPECT_EQ(run(*optimiser, n, two_spheres), StopReason::max_iterations);
  std::stringstream file;
  optimiser->save(file);
  c.max_iterations = 5;
  auto resumed = make(n, 2, c);
  resumed->load(file);
  EXPECT_EQ(resumed->stop_reason(), StopReason::running);
  EXPECT_EQ(run(*resumed, n, two_spheres), StopReason::max_iterations);
  EXPECT_GE(resumed->iterations(), 5u);
}

TEST_P(EveryOptimiser, StopsWithAReason) {
  const std::size_t n = 3;
  const auto reason = [&](OptimiserConfig c, const Objectives& f) {
    auto optimiser = make(n, 2, c);
    const StopReason result = run(*optimiser, n, f);
    for (const double v : optimiser->ask()) EXPECT_TRUE(std::isfinite(v));
    return result;
  };
  auto c = config(n);
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(reason(c, [&](auto) { return std::vector{nan, 0.0}; }), StopReason::invalid_objective);
  EXPECT_EQ(reason(c, [&](auto) { return std::vector{-infinity, 0.0}; }), StopReason::invalid_objective);
  EXPECT_EQ(reason(c, [](auto) { return std::vector{0.5, 0.5}; }), StopReason::flat);
  EXPECT_EQ(reason(c, [](auto) { return std::vector{1.0, 2.0}; }), StopReason::flat);  // outside the reference
  c.max_evaluations = 100;
  EXPECT_EQ(reason(c, two_spheres), StopReason::max_evaluations);
  c = config(n);
  c.target_hypervolume = 0.4;
  EXPECT_EQ(reason(c, two_spheres), StopReason::target_reached);
  c = config(n);
  c.stagnation_iterations = 5;
  c.stagnation_tolerance = 1e-3;
  EXPECT_EQ(reason(c, two_spheres), StopReason::stagnated);
}

TEST_P(EveryOptimiser, LivesWithFailingObjectives) {
  const std::size_t n = 3;
  auto c = config(n);
  c.max_evaluations = 3000;
  auto optimiser = make(n, 2, c);
  run(*optimiser, n, [](std::span<const double> x) {
    return x[1] < 0.3 ? std::vector{std::nan(""), 1.0} : two_spheres(x);
  });
  EXPECT_GT(optimiser->hypervolume(), 0.5);
  for (const auto& p : optimiser->front())
    for (const double v : p.f) EXPECT_TRUE(std::isfinite(v));
}

TEST_P(EveryOptimiser, StartsFromGivenPoints) {
  const std::size_t n = 2;
  auto c = config(n);
  c.start = {{0.25, 0.5}, {0.75, 1}};
  auto optimiser = make(n, 2, c);
  const auto points = optimiser->ask();
  EXPECT_EQ(std::vector<double>(points.begin(), points.begin() + 4), (std::vector<double>{0.25, 0.5, 0.75, 1}));
}

TEST_P(EveryOptimiser, ReplacedPointsAreTheOnesKept) {
  const std::size_t n = 2;
  auto optimiser = make(n, 2, config(n));
  step(*optimiser, n, two_spheres);
  for (int round = 0; round < 40; ++round) {
    const std::size_t count = optimiser->ask().size() / n;
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) {
      const std::vector<double> x = {0.5, 0.125 * static_cast<double>(k % 8)};
      optimiser->replace(k, x);
      const auto f = two_spheres(x);
      values.insert(values.end(), f.begin(), f.end());
    }
    optimiser->tell(values);
  }
  for (const auto& p : optimiser->population()) EXPECT_EQ(p.f, two_spheres(p.x));
  optimiser->ask();
  EXPECT_THROW(optimiser->replace(0, std::vector<double>{0, 3}), Error);
  EXPECT_THROW(optimiser->replace(1000, std::vector<double>{0, 0}), Error);
}

TEST_P(EveryOptimiser, ResamplesOnlyWhatItIsTold) {
  const std::size_t n = 4;
  auto optimiser = make(n, 2, config(n));
  for (int round = 0; round < 30; ++round) {
    const auto points = optimiser->ask();
    const std::vector<double> before(points.begin(), points.end());
    const std::vector<std::size_t> coordinates = {2};
    const auto now = optimiser->resample(0, coordinates);
    for (const std::size_t i : {0, 1, 3}) EXPECT_EQ(now[i], before[i]);
    EXPECT_TRUE(now[2] >= -1 && now[2] <= 2);
    step(*optimiser, n, two_spheres);
  }
  optimiser->ask();
  EXPECT_THROW(optimiser->resample(0, std::vector<std::size_t>{4}), Error);
}

TEST_P(EveryOptimiser, RefusesDamagedStatesAndStaysAsItWas) {
  const std::size_t n = 3;
  auto optimiser = make(n, 2, config(n));
  for (int i = 0; i < 5; ++i) step(*optimiser, n, two_spheres);
  std::stringstream file;
  optimiser->save(file);
  const std::string good = file.str();
  const auto refuses = [&](const std::string& bytes) {
    std::stringstream in(bytes);
    try {
      optimiser->load(in);
    } catch (const Error& e) {
      return e.code() == Errc::malformed_file;
    }
    return false;
  };
  for (std::size_t i = 0; i < good.size(); i += 37) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_TRUE(refuses(bad)) << i;
  }
  for (std::size_t size = 0; size < good.size(); size += 97) EXPECT_TRUE(refuses(good.substr(0, size))) << size;
  auto other = make(n, 3, config(n));
  std::stringstream in(good), again(good);
  EXPECT_THROW(other->load(in), Error);
  const double hypervolume = optimiser->hypervolume();
  optimiser->load(again);
  EXPECT_EQ(optimiser->hypervolume(), hypervolume);
}

TEST_P(EveryOptimiser, RefusesWhatItCannotDo) {
  auto c = config(2);
  EXPECT_THROW(make(2, 0, c), Error);
  EXPECT_THROW(make(2, 7, c), Error);
  EXPECT_THROW(make(3, 2, c), Error);
  auto bad = c;
  bad.population = std::size_t{1} << 21;
  EXPECT_THROW(make(2, 2, bad), Error);
  bad = c;
  bad.reference = {1, 1, 1};
  EXPECT_THROW(make(2, 2, bad), Error);
  bad = c;
  bad.start = {{0, 5}};
  EXPECT_THROW(make(2, 2, bad), Error);
  if (GetParam().algorithm == Algorithm::mo_cma_es) {
    for (const double share : {-0.1, 1.1, std::nan("")}) {
      for (double MoCmaEsConfig::*of :
           {&MoCmaEsConfig::guided, &MoCmaEsConfig::spread, &MoCmaEsConfig::recombined, &MoCmaEsConfig::swapped}) {
        bad = c;
        bad.mo.*of = share;
        EXPECT_THROW(make(2, 2, bad), Error);
      }
    }
  }
  auto optimiser = make(2, 2, c);
  EXPECT_THROW(optimiser->tell({}), Error);
  optimiser->ask();
  std::stringstream file;
  EXPECT_THROW(optimiser->save(file), Error);
  EXPECT_THROW(optimiser->tell(std::vector<double>(3)), Error);
}

TEST(MoCmaEs, ConvergesToOnePoint) {
  // Both objectives agree, so the population shrinks to their minimum.
  OptimiserConfig c;
  c.population = 4;
  c.bounds = Bounds::uniform(2, 0, 1);
  c.mo.scheme = Scheme::generational;
  MoCmaEs optimiser(2, 2, c);
  const auto reason = run(optimiser, 2, [](std::span<const double> x) {
    const double f = (x[0] - 0.3) * (x[0] - 0.3) + (x[1] - 0.6) * (x[1] - 0.6);
    return std::vector{f, f};
  });
  EXPECT_TRUE(reason == StopReason::converged || reason == StopReason::flat) << to_string(reason);
  EXPECT_NEAR(optimiser.front().front().x[0], 0.3, 1e-6);
}

// Two objectives with a front between (0.2, 0.5) and (0.8, 0.5).
std::vector<double> two_wells(std::span<const double> x) {
  const double y = (x[1] - 0.5) * (x[1] - 0.5);
  return {(x[0] - 0.2) * (x[0] - 0.2) + y, (x[0] - 0.8) * (x[0] - 0.8) + y};
}

// Searched with steps no smaller than x_tolerance.
TEST(MoCmaEs, RestartsItsStepsWhereItWouldStop) {
  for (const Scheme scheme : {Scheme::generational, Scheme::steady_state}) {
    OptimiserConfig c;
    c.population = 10;
    c.bounds = Bounds::uniform(2, 0, 1);
    c.mo.scheme = scheme;
    c.x_tolerance = 0.1;
    MoCmaEs plain(2, 2, c);
    ASSERT_EQ(run(plain, 2, two_wells), StopReason::converged);
    EXPECT_EQ(plain.restarts(), 0u);

    c.restarts = 2;
    MoCmaEs optimiser(2, 2, c);
    ASSERT_EQ(run(optimiser, 2, two_wells), StopReason::converged);
    EXPECT_EQ(optimiser.restarts(), 2u);
    EXPECT_GT(optimiser.evaluations(), plain.evaluations());
    EXPECT_GT(optimiser.hypervolume(), plain.hypervolume() - 1e-3);  // truncation may lower it a little

    // A stopped optimiser continues when more restarts are allowed.
    std::stringstream file;
    plain.save(file);
    MoCmaEs resumed(2, 2, c);
    resumed.load(file);
    ASSERT_EQ(run(resumed, 2, two_wells), StopReason::converged);
    EXPECT_EQ(resumed.restarts(), 2u);
    EXPECT_EQ(resumed.evaluations(), optimiser.evaluations());
    EXPECT_EQ(resumed.hypervolume(), optimiser.hypervolume());
  }
}

TEST(MoCmaEs, WorksWithoutBounds) {
  OptimiserConfig c;
  c.population = 20;
  c.sigma0 = 1;
  c.start = {{5, 5, 5}};
  c.max_evaluations = 4000;
  MoCmaEs optimiser(3, 2, c);
  run(optimiser, 3, two_spheres);
  EXPECT_GT(optimiser.hypervolume(), 0.78);
}

// Distance to a line of points behind many local fronts, as in ZDT4: small steps alone stay on the first local front.
std::vector<double> rippled(std::span<const double> x) {
  double g = 1;
  for (std::size_t i = 1; i < x.size(); ++i) g += x[i] * x[i] + 1 - std::cos(6 * 3.14159265358979 * x[i]);
  return {x[0], g - std::sqrt(std::max(0.0, x[0]))};
}

TEST(MoCmaEs, RecombinationLeavesLocalFronts) {
  const std::size_t n = 6;
  const auto reached = [&](double recombined) {
    OptimiserConfig c;
    c.population = 20;
    c.bounds = Bounds::uniform(n, -2, 2);
    c.bounds->lower[0] = 0;
    c.bounds->upper[0] = 1;
    c.reference = {2, 5};
    c.mo.recombined = recombined;
    c.max_evaluations = 6000;
    double sum = 0;
    for (c.seed = 1; c.seed <= 3; ++c.seed) {
      MoCmaEs optimiser(n, 2, c);
      run(optimiser, n, rippled);
      sum += optimiser.hypervolume() / 3;
    }
    return sum;
  };
  const double best = 8 + 2.0 / 3 + 1;  // ∫ of 5 − 1 + √f over [0, 1], then 5 up to the reference
  EXPECT_GT(reached(0.15), 0.97 * best);
  EXPECT_LT(reached(0), 0.95 * best);
}

// Four stations of two coordinates and four targets that see a station only nearby. Stations are interchangeable, and a
// station at another's target cannot leave it gradually. The other objective is the distance between stations.
std::vector<double> targets(std::span<const double> x) {
  double missed = 0, apart = 0;
  for (const auto& [tx, ty] : {std::pair{0.1, 0.2}, std::pair{0.9, 0.1}, std::pair{0.8, 0.9}, std::pair{0.2, 0.8}}) {
    double nearest = 0.15;
    for (std::size_t i = 0; i < x.size(); i += 2) nearest = std::min(nearest, std::hypot(x[i] - tx, x[i + 1] - ty));
    missed += nearest / 0.15 / 4;
  }
  for (std::size_t i = 2; i < x.size(); i += 2) apart += std::hypot(x[i] - x[0], x[i + 1] - x[1]) / 4.5;
  return {missed, apart};
}

TEST(MoCmaEs, SwappedBlocksLeaveLocalFronts) {
  const std::size_t n = 8;
  const auto reached = [&](double swapped) {
    OptimiserConfig c;
    c.population = 20;
    c.bounds = Bounds::uniform(n, 0, 1);
    c.blocks = {{0, 1}, {2, 3}, {4, 5}, {6, 7}};
    c.mo.swapped = swapped;
    c.max_evaluations = 2000;
    double sum = 0;
    for (c.seed = 1; c.seed <= 5; ++c.seed) {
      MoCmaEs optimiser(n, 2, c);
      run(optimiser, n, targets);
      sum += optimiser.hypervolume() / 5;
    }
    return sum;
  };
  EXPECT_GT(reached(0.4), reached(0) + 0.03);
}

// A front on the diagonal, whose members have almost no steps of their own.
OptimiserConfig at_rest(std::vector<double> along) {
  OptimiserConfig c;
  c.population = along.size();
  c.sigma0 = 1e-6;
  c.bounds = Bounds::uniform(3, 0, 1);
  for (const double t : along) c.start.push_back(std::vector<double>(3, t));
  c.mo = {.batch = 256, .guided = 0, .spread = 0, .recombined = 0, .swapped = 0};
  return c;
}

TEST(MoCmaEs, StepsAlongTheFrontFollowItsMembers) {
  const std::vector<double> along{0.2, 0.4, 0.6, 0.8};
  OptimiserConfig c = at_rest(along);
  c.mo.spread = 1;
  MoCmaEs optimiser(3, 2, c);
  step(optimiser, 3, two_spheres);
  const auto points = optimiser.ask();
  std::size_t between = 0;
  for (std::size_t k = 0; k < points.size(); k += 3) {
    EXPECT_NEAR(points[k], points[k + 1], 1e-4);
    EXPECT_NEAR(points[k], points[k + 2], 1e-4);
    between += std::ranges::none_of(along, [&](double t) { return std::abs(points[k] - t) < 1e-3; });
  }
  EXPECT_GT(between, points.size() / 3 * 9 / 10);
}

// A member that adds nothing to the front, such as one of two in the same place, is a parent only if it is an extreme.
TEST(MoCmaEs, GuidedParentsAreDrawnByWhatTheyAddToTheFront) {
  OptimiserConfig c = at_rest({0.5, 0.5, 0.1, 0.9, 0.3});
  c.mo.guided = 1;
  MoCmaEs optimiser(3, 2, c);
  step(optimiser, 3, two_spheres);
  const auto points = optimiser.ask();
  const auto near = [&](double t) {
    std::size_t many = 0;
    for (std::size_t k = 0; k < points.size(); k += 3) many += std::abs(points[k] - t) < 1e-3;
    return many;
  };
  EXPECT_EQ(near(0.5), 0u);
  EXPECT_GT(near(0.3), 10u);
  EXPECT_EQ(near(0.1) + near(0.3) + near(0.9), points.size() / 3);
}

TEST(MoCmaEs, DrawsABlockFromAnywhereAgainFromAnywhere) {
  OptimiserConfig c;
  c.population = 4;
  c.mo.batch = 64;
  c.sigma0 = 1e-6;
  c.mo.swapped = 1;
  c.bounds = Bounds::uniform(4, 0, 1);
  c.blocks = {{0, 1}, {2, 3}};
  MoCmaEs optimiser(4, 2, c);
  step(optimiser, 4, two_spheres);
  const auto known = optimiser.population();
  const auto is_known = [&](double v, std::size_t d) {
    for (const ParetoPoint& p : known)
      if (std::abs(v - p.x[d]) < 1e-4 || std::abs(v - p.x[d + 2]) < 1e-4) return true;
    return false;
  };
  const auto points = optimiser.ask();
  std::size_t elsewhere = 0;
  for (std::size_t k = 0; k < 64; ++k) {
    for (std::size_t b = 0; b < 4; b += 2) {
      const bool fresh = !is_known(points[4 * k + b], 0) || !is_known(points[4 * k + b + 1], 1);
      elsewhere += fresh;
      const std::vector<std::size_t> coordinates{b, b + 1};
      const auto again = optimiser.resample(k, coordinates);
      // Beside another block or a member's block, it stays there.
      if (!fresh && is_known(points[4 * k + 2 - b], 0) && is_known(points[4 * k + 3 - b], 1)) {
        EXPECT_TRUE(is_known(again[b], 0) && is_known(again[b + 1], 1)) << k;
      }
    }
  }
  EXPECT_GT(elsewhere, 8u);  // a third of 64
  EXPECT_LT(elsewhere, 40u);
}

// It approaches the front as one covariance for all does, in a fraction of the state; neither loads the other's state.
TEST(MoCmaEs, NearsAFrontWithACovarianceForEachBlock) {
  const std::size_t n = 40;
  const auto reached = [&](std::size_t full) {
    OptimiserConfig c{
        .population = 20, .bounds = Bounds::uniform(n, -1, 2), .seed = 3, .mo = {.full_covariance = full}};
    for (std::size_t i = 0; i < n; i += 2) c.blocks.push_back({i, i + 1});
    c.max_evaluations = 4000;
    MoCmaEs optimiser(n, 2, c);
    while (optimiser.stop_reason() == StopReason::running) step(optimiser, n, two_spheres);
    std::stringstream file;
    optimiser.save(file);
    return std::pair{optimiser.hypervolume(), file.str()};
  };
  const auto [apart, small] = reached(n - 1);
  const auto [together, large] = reached(n);
  EXPECT_GT(apart, 0.95 * together);
  EXPECT_LT(small.size(), large.size() / 3);

  OptimiserConfig other{.population = 20, .bounds = Bounds::uniform(n, -1, 2), .seed = 3};
  for (std::size_t i = 0; i < n; i += 2) other.blocks.push_back({i, i + 1});
  other.max_evaluations = 4000;
  std::istringstream file(small);
  MoCmaEs full(n, 2, other);
  try {
    full.load(file);
    FAIL() << "a state with a covariance for each block was taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("number of covariances"), std::string::npos) << e.what();
  }
}

TEST(MoCmaEs, RefusesBlocksThatDoNotChangePlaces) {
  OptimiserConfig c;
  c.bounds = Bounds{{0, 0, 0, 0}, {1, 1, 1, 2}};
  for (const std::vector<std::vector<std::size_t>>& blocks :
       {std::vector<std::vector<std::size_t>>{{0}, {1, 2}}, {{0, 1}, {1, 2}}, {{0, 4}}, {{0}, {3}}, {{}}}) {
    c.blocks = blocks;
    EXPECT_THROW(MoCmaEs(4, 2, c), Error);
  }
  c.blocks = {{0, 1}, {2, 3}};
  EXPECT_THROW(MoCmaEs(4, 2, c), Error);
  c.blocks = {{0}, {2}};
  EXPECT_NO_THROW(MoCmaEs(4, 2, c));
}

}  // namespace
}  // namespace vantage
