// SPDX-License-Identifier: Apache-2.0
#include "trace/rebuilding_tracer.hpp"

#include <gtest/gtest.h>

#include <map>

namespace vantage {
namespace {

// A device that fails on request; it counts the stations of a network.
struct Device {
  int made = 0, calls = 0, lose_calls = 0, lose_builds = 0;
  std::size_t most_networks = 1000;
};

class FragileTracer final : public Tracer {
 public:
  explicit FragileTracer(Device& device) : device_(device) {
    ++device_.made;
    if (device_.lose_builds-- > 0) throw DeviceFault(Errc::device_failure, "lost while it was built");
    info_.engine = Engine::compute_bvh;
  }
  const EngineInfo& info() const override { return info_; }
  std::uint64_t preferred_scan_rays(std::uint32_t) const override { return 1; }
  void scan(const TraceStation&, std::uint64_t, std::uint64_t, std::uint32_t, RawChunk&) override { work(); }
  NetworkCounts count(std::span<const TraceStation>, std::uint32_t stations, const CountOptions&,
                      const Progress&) override {
    work();
    return counts_of(stations);
  }
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override {
    if (networks.size() > device_.most_networks) throw DeviceFault(Errc::out_of_memory, "too many networks");
    const std::vector<std::uint32_t> points(job.sample.size());
    std::vector<NetworkCounts> all;
    for (std::size_t k = 0; k < networks.size(); ++k) {
      if (job.points) job.points(k, points);
      if (k == networks.size() / 2) work();
      all.push_back(counts_of(station_counts[k]));
      all.back().cancelled = progress.stopped();
    }
    return all;
  }

 private:
  void work() {
    ++device_.calls;
    if (device_.lose_calls-- > 0) throw DeviceFault(Errc::device_failure, "lost at work");
  }
  NetworkCounts counts_of(std::uint32_t stations) const {
    NetworkCounts counts;
    counts.stations = stations;
    counts.weight = static_cast<std::uint64_t>(goal_density_);
    return counts;
  }
  Device& device_;
  EngineInfo info_;
};

struct Rebuilding : testing::Test {
  Device device;
  std::vector<std::string> warned;
  RebuildingTracer make() {
    return {[this](const TraceScene&) { return std::make_unique<FragileTracer>(device); },
            {},
            [this](const std::string& line) { warned.push_back(line); }};
  }
};

TEST_F(Rebuilding, GoesOnOnADeviceThatWasLostOnce) {
  device.lose_builds = 1;
  RebuildingTracer tracer = make();
  EXPECT_EQ(device.made, 2);
  tracer.set_goal_density(7);
  device.lose_calls = 1;
  const NetworkCounts counts = tracer.count({}, 3, {}, {});
  EXPECT_EQ(counts.stations, 3u);
  EXPECT_EQ(counts.weight, 7u) << "the new one knows the goal";
  EXPECT_EQ(device.made, 3);
  ASSERT_EQ(warned.size(), 2u);
  EXPECT_NE(warned[1].find("lost at work"), std::string::npos);
}

TEST_F(Rebuilding, ThrowsWhatFailsTwice) {
  RebuildingTracer tracer = make();
  device.lose_calls = 2;
  EXPECT_THROW(tracer.count({}, 3, {}, {}), DeviceFault);
  EXPECT_EQ(device.calls, 2);
  EXPECT_EQ(tracer.count({}, 3, {}, {}).stations, 3u) << "and works for whoever tries again";
  device.lose_calls = 1, device.lose_builds = 5;
  EXPECT_THROW(tracer.count({}, 3, {}, {}), DeviceFault);
  EXPECT_THROW(tracer.count({}, 3, {}, {}), Error);
}

TEST_F(Rebuilding, CountsFewerNetworksAtOnceWhereMemoryIsShort) {
  RebuildingTracer tracer = make();
  device.most_networks = 3, device.lose_calls = 2;
  const std::vector<std::vector<TraceStation>> networks(13);
  std::vector<std::uint32_t> stations;
  for (std::uint32_t k = 0; k < 13; ++k) stations.push_back(k + 1);
  const std::vector<std::uint32_t> sample(5);
  std::map<std::size_t, int> told;
  Tracer::SampleJob job{.sample = sample};
  job.points = [&](std::size_t network, std::span<const std::uint32_t>) { ++told[network]; };
  // The first piece that fits fails, and fails again.
  EXPECT_THROW(tracer.count_sampled(networks, stations, job, {}), DeviceFault);
  told.clear();
  device.lose_calls = 1;
  const auto counts = tracer.count_sampled(networks, stations, job, {});
  ASSERT_EQ(counts.size(), 13u);
  for (std::uint32_t k = 0; k < 13; ++k) {
    EXPECT_EQ(counts[k].stations, k + 1);
    EXPECT_EQ(told[k], 1) << k;
  }
}

TEST_F(Rebuilding, SaysWhatAStoppedCountDidNotReach) {
  RebuildingTracer tracer = make();
  device.most_networks = 2;
  std::stop_source stop;
  stop.request_stop();
  const std::vector<std::vector<TraceStation>> networks(5);
  const std::vector<std::uint32_t> stations(5, 1), sample(2);
  const auto counts = tracer.count_sampled(networks, stations, {.sample = sample}, {.stop = stop.get_token()});
  ASSERT_EQ(counts.size(), 5u);
  for (const NetworkCounts& each : counts) EXPECT_TRUE(each.cancelled);
}

}  // namespace
}  // namespace vantage
