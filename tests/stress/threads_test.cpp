// SPDX-License-Identifier: Apache-2.0
// Simulators on several threads and in a caller's own tasks, callbacks that throw, and stops at any moment. A call's
// result never depends on other calls.
#include <sys/wait.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <random>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "stress/engine_suite.hpp"
#include "stress/moved_scene.hpp"
#include "support/expect_counts.hpp"

namespace vantage::test {
namespace {

using Threads = EngineSuite;

const Scene& site() {
  static const Scene scene = yard({});
  return scene;
}

Simulator simulator(const EngineInfo& engine, std::uint64_t max_rays = 0) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(2);
  return {site(),
          scanner,
          {.engine = engine.engine,
           .device_index = engine.device_index,
           .user_size_m = 0.3,
           .point_spacing_m = 0.05,
           .max_rays_per_dispatch = max_rays}};
}

// A different network for each k, of three stations.
Network network(std::size_t k) {
  const double at = 0.1 * static_cast<double>(k);
  return {{{3.5 - at, 0.2, 1.2}}, {{-1 + at, 3.1, 1.4}}, {{-0.6, -3 + at, 1.3}}};
}

// All results of a simulator for one network.
struct Outcome {
  VoxelField field;
  NetworkCounts exact, sampled;
  std::vector<std::uint32_t> voxels;  // of the rays of its first station
};

Outcome outcome(Simulator& engine, std::size_t k) {
  Outcome o;
  const std::vector<Network> networks{network(k)};
  o.exact = engine.evaluate(networks[0], {.field = &o.field});
  o.sampled = engine.evaluate_sampled(networks, {.voxels = 150}).front();
  engine.scan(networks[0][0], {.outputs = scan_voxel},
              [&](const ScanChunk& chunk) { o.voxels.insert(o.voxels.end(), chunk.voxel.begin(), chunk.voxel.end()); });
  return o;
}

void expect_same(const Outcome& got, const Outcome& expected) {
  EXPECT_EQ(got.field.count, expected.field.count);
  EXPECT_EQ(got.field.stations, expected.field.stations);
  expect_equal_counts(got.exact, expected.exact);
  expect_equal_counts(got.sampled, expected.sampled);
  EXPECT_EQ(got.voxels, expected.voxels);
}

std::vector<Outcome> outcomes(Simulator& engine, std::size_t many) {
  std::vector<Outcome> all;
  for (std::size_t k = 0; k < many; ++k) all.push_back(outcome(engine, k));
  return all;
}

TEST_P(Threads, TwoSimulatorsOnTwoDoNotMeet) {
  constexpr std::size_t many = 4;
  Simulator alone = simulator(GetParam());
  const std::vector<Outcome> expected = outcomes(alone, many);
  std::vector<Outcome> got[2];
  {
    std::vector<std::jthread> threads;
    for (auto& into : got)
      threads.emplace_back([&into] {
        Simulator own = simulator(GetParam());  // made and destroyed beside the other, too
        into = outcomes(own, many);
      });
  }
  for (const auto& of : got)
    for (std::size_t k = 0; k < many; ++k) expect_same(of[k], expected[k]);
}

TEST_P(Threads, ConstCallsOfOneSimulatorFromMany) {
  const Simulator engine = simulator(GetParam());
  const auto asked = [&](std::uint64_t k) {
    const std::vector<std::uint32_t> sample = engine.sampled_voxels(20 + k % 7);
    double sum = 0;
    for (const VoxelPatch& patch : engine.voxel_patches(sample)) sum += patch.point.x + patch.area_m2;
    for (const std::uint32_t voxel_index : sample)
      sum += engine.voxel_centre(voxel_index).z * engine.voxel_weight(voxel_index);
    return sum + engine.goal_density() + static_cast<double>(engine.voxel_count() + engine.engine().device.size());
  };
  constexpr std::uint64_t calls = 40;
  std::vector<double> expected;
  for (std::uint64_t k = 0; k < calls; ++k) expected.push_back(asked(k));
  std::vector<double> got[4];
  {
    std::vector<std::jthread> threads;
    for (auto& into : got)
      threads.emplace_back([&] {
        for (std::uint64_t k = 0; k < calls; ++k) into.push_back(asked(k));
      });
  }
  for (const auto& of : got) EXPECT_EQ(of, expected);
}

struct Thrown : std::runtime_error {
  Thrown() : std::runtime_error("thrown by a callback") {}
};

// Runs it repeatedly with the n-th callback throwing, for every n until none throws.
int throw_at_each(const std::function<void(const std::function<void()>& callback)>& run) {
  for (int n = 0;; ++n) {
    int left = n;
    bool thrown = false;
    try {
      run([&] {
        if (left-- > 0) return;
        thrown = true;
        throw Thrown();
      });
    } catch (const Thrown&) {
    }
    if (!thrown) return n;
  }
}

TEST_P(Threads, CallbacksThatThrowLeaveTheSimulatorWell) {
  Simulator engine = simulator(GetParam(), 2'000);
  const Outcome expected = outcome(engine, 1);
  const std::vector<Network> networks{network(1), network(2), network(3)};
  const auto report = [](const std::function<void()>& callback) {
    return Progress{[callback](double) { callback(); }, {}};
  };
  EXPECT_GT(
      throw_at_each([&](const auto& callback) { engine.evaluate(networks[0], {.skip = false}, report(callback)); }), 0);
  EXPECT_GT(throw_at_each([&](const auto& callback) { engine.evaluate_each(networks, {}, report(callback)); }), 0);
  EXPECT_GT(throw_at_each(
                [&](const auto& callback) { engine.evaluate_sampled(networks, {.voxels = 150}, report(callback)); }),
            0);
  EXPECT_EQ(throw_at_each([&](const auto& callback) {
              engine.evaluate_sampled(networks, {.voxels = 150, .points = [&](auto&&...) { callback(); }});
            }),
            3);
  EXPECT_GT(throw_at_each([&](const auto& callback) {
              engine.scan(
                  networks[0][0], {}, [&](const ScanChunk&) { callback(); }, report(callback));
            }),
            1);
  const ScanOptions coloured{.outputs = scan_colour, .colour = [](Angle, Angle) -> std::uint32_t { throw Thrown(); }};
  EXPECT_THROW(engine.scan(networks[0][0], coloured, {}), Thrown);
  expect_same(outcome(engine, 1), expected);
}

// A thousand times in all, mostly on the fast engine.
TEST_P(Threads, StopsAtAnyMomentAreSaidOrTooLate) {
  const int times = GetParam().engine == Engine::embree ? 800 : 100;
  Simulator engine = simulator(GetParam(), 2'000);
  const Outcome expected = outcome(engine, 0);
  const std::vector<Network> networks{network(0)};
  std::mt19937_64 rng(5);
  int cancelled = 0;
  using Clock = std::chrono::steady_clock;
  std::uint64_t whole = 1'000'000;  // nanoseconds of the last call that was not stopped in time
  for (int k = 0; k < times; ++k) {
    std::stop_source stop;
    const auto wait = std::chrono::nanoseconds(static_cast<std::int64_t>(rng() % whole));
    const std::jthread stopper([&] {
      std::this_thread::sleep_for(wait);
      stop.request_stop();
    });
    const Progress progress{{}, stop.get_token()};
    const auto start = Clock::now();
    const NetworkCounts counts = k % 2 == 0 ? engine.evaluate(networks[0], {.skip = false}, progress)
                                            : engine.evaluate_sampled(networks, {.voxels = 150}, progress).front();
    cancelled += counts.cancelled;
    if (counts.cancelled) continue;
    whole = 1 + static_cast<std::uint64_t>(std::chrono::nanoseconds(Clock::now() - start).count());
    expect_equal_counts(counts, k % 2 == 0 ? expected.exact : expected.sampled);
  }
  std::stop_source before;
  before.request_stop();
  EXPECT_TRUE(engine.evaluate(networks[0], {}, {{}, before.get_token()}).cancelled);
  EXPECT_TRUE(engine.evaluate_sampled(networks, {}, {{}, before.get_token()}).front().cancelled);
  RecordProperty("cancelled", cancelled);
  expect_same(outcome(engine, 0), expected);
}

TEST_P(Threads, WorksInTasksOfTheCaller) {
  constexpr std::size_t many = 4;
  Simulator alone = simulator(GetParam());
  const std::vector<Outcome> expected = outcomes(alone, many);
  std::vector<Outcome> got(many), held(many);
  tbb::parallel_for(std::size_t{0}, many, [&](std::size_t k) {
    Simulator own = simulator(GetParam());
    got[k] = outcome(own, k);
  });
  tbb::task_arena one(1);
  one.execute([&] {
    for (std::size_t k = 0; k < many; ++k) held[k] = outcome(alone, k);
  });
  for (std::size_t k = 0; k < many; ++k) expect_same(got[k], expected[k]), expect_same(held[k], expected[k]);
}

// A child has none of its parent's threads. It exits, or becomes another program, and the parent is unaffected.
TEST_P(Threads, AForkedChildMayLeaveOrRunAnother) {
  Simulator engine = simulator(GetParam());
  const Outcome expected = outcome(engine, 2);
  for (const bool other : {false, true}) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      if (other) execl("/bin/sh", "sh", "-c", "exit 7", static_cast<char*>(nullptr));
      _exit(7);
    }
    expect_same(outcome(engine, 2), expected);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7);
    expect_same(outcome(engine, 2), expected);
  }
}
VANTAGE_EVERY_ENGINE(Threads);

}  // namespace
}  // namespace vantage::test
