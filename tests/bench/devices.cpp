// SPDX-License-Identifier: Apache-2.0
#include "devices.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "core/philox.hpp"
#include "vantage/error.hpp"

namespace vantage::bench {
namespace {

// `networks` networks of `stations` stations around the given ones, which repeat if there are too few.
std::vector<Network> networks_around(const Network& given, std::size_t networks, std::size_t stations,
                                     double spread_m) {
  RandomStream random(1);
  const auto moved = [&](double x) { return x + (random.bits() * 0x1p-32 * 2 - 1) * spread_m; };
  std::vector<Network> all(networks);
  for (Network& network : all)
    for (std::size_t k = 0; k < stations; ++k) {
      const Vec3& from = given[k % given.size()].position;
      network.push_back({{moved(from.x), moved(from.y), from.z}});
    }
  return all;
}

// All that results are made of.
bool same(const NetworkCounts& a, const NetworkCounts& b) {
  return a.voxels == b.voxels && a.saturated == b.saturated && a.partial_points == b.partial_points &&
         a.seen == b.seen && a.shared == b.shared && a.points_on_surveyed == b.points_on_surveyed &&
         a.successive_difference_sum == b.successive_difference_sum && !a.cancelled && !b.cancelled &&
         std::equal(a.groups.begin(), a.groups.end(), b.groups.begin(), b.groups.end(), same);
}

using Counts = std::vector<NetworkCounts>;
struct Task {
  std::string name;
  std::size_t networks;
  std::function<Counts(Simulator&)> run;
};

std::vector<Task> tasks_of(const DevicesOptions& options) {
  const Network given = options.site.stations();
  std::vector<Task> tasks;
  for (const std::size_t population : options.populations)
    tasks.push_back({"sampled population of " + std::to_string(population), population,
                     [networks = networks_around(given, population, given.size(), options.spread_m),
                      voxels = options.sample](Simulator& simulator) {
                       // As a search asks.
                       return simulator.evaluate_sampled(
                           networks, {.voxels = voxels, .overlap = true, .count_to = CountTo::goal, .groups = false});
                     }});
  for (const std::size_t size : options.sizes)
    for (const std::size_t many : {options.exact, std::size_t{1}})
      tasks.push_back({"every ray of " + std::to_string(many) + " of " + std::to_string(size) + " stations", many,
                       [networks = networks_around(given, many, size, options.spread_m)](Simulator& simulator) {
                         return simulator.evaluate_each(networks);
                       }});
  return tasks;
}

}  // namespace

void DevicesOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--devices", devices, "Numbers of devices")->delimiter(',')->capture_default_str();
  command.add_option("--populations", populations, "Networks of a sampled evaluation")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--sizes", sizes, "Stations of a network of every ray")->delimiter(',')->capture_default_str();
  command.add_option("--exact", exact, "Networks of every ray that are evaluated together")->capture_default_str();
  command.add_option("--sample", sample, "Voxels of the sample")->capture_default_str();
  command.add_option("--spread", spread_m, "How far stations move from where they are given, metres")
      ->capture_default_str();
  command.add_flag("--software", software, "One device again and again, where there are not several");
}

void run_devices(const DevicesOptions& options) {
  const std::vector<EngineInfo> here = options.site.engines_here();
  const Engine engine = here.front().engine;
  std::vector<DeviceChoice> all = all_devices(engine);
  if (options.software) all.resize(*std::max_element(options.devices.begin(), options.devices.end()), all.front());
  const Scene scene = Scene::load(options.site.scene);
  const std::vector<Task> tasks = tasks_of(options);
  std::vector<Counts> alone(tasks.size());
  std::vector<double> alone_seconds(tasks.size());
  std::printf("engine,devices,task,seconds,networks_a_second,times_one_device,share_of_ideal,equal\n");
  for (const std::uint32_t many : options.devices) {
    if (many > all.size()) continue;
    SimulatorConfig config = options.site.config();
    config.devices.assign(all.begin(), all.begin() + many);
    config.warn = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    Simulator simulator(scene, options.site.scanner(), config);
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      Counts counts = tasks[t].run(simulator);  // warms up, and shows how fast each device is
      double best = std::numeric_limits<double>::infinity();
      for (std::uint32_t round = 0; round < options.site.repeats; ++round) {
        const Stopwatch watch;
        counts = tasks[t].run(simulator);
        best = std::min(best, watch.seconds());
      }
      if (alone[t].empty()) alone[t] = counts, alone_seconds[t] = best * many;
      const double times = alone_seconds[t] / best;
      const bool equal = std::equal(counts.begin(), counts.end(), alone[t].begin(), alone[t].end(), same);
      std::printf("%s,%u,%s,%.4f,%.1f,%.2f,%.2f,%s\n", to_string(engine).c_str(), many, tasks[t].name.c_str(), best,
                  static_cast<double>(tasks[t].networks) / best, times, times / many, equal ? "yes" : "NO");
      std::fflush(stdout);
      if (!equal) throw Error(Errc::device_failure, "several devices do not count what one counts");
    }
  }
}

}  // namespace vantage::bench
