// SPDX-License-Identifier: Apache-2.0
#include "intervals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "networks.hpp"
#include "vantage/objective.hpp"
#include "vantage/registration.hpp"

namespace vantage::bench {
namespace {

constexpr double normal_975 = 1.959964;       // 95 % of a normal distribution lie within so many standard deviations
constexpr std::uint32_t fewest_stations = 3;  // fewer have no clustering coefficient

// One objective at one size of the sample, over all networks.
struct Tally {
  std::uint32_t held = 0;
  double squared_error = 0, squared_se = 0;
  void add(const Estimate& estimate, double truth) {
    const double error = estimate.value - truth;
    held += std::abs(error) <= normal_975 * estimate.standard_error;
    squared_error += error * error;
    squared_se += estimate.standard_error * estimate.standard_error;
  }
};

void print(const std::string& engine, std::uint64_t size, const char* objective, const Tally& tally, double n) {
  std::printf("%s,%llu,%s,%.3f,%.5f,%.5f\n", engine.c_str(), static_cast<unsigned long long>(size), objective,
              tally.held / n, std::sqrt(tally.squared_error / n), std::sqrt(tally.squared_se / n));
}

}  // namespace

void IntervalsOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--front", front, "A plan's front.json: its networks, over and over, in place of random ones");
  command.add_option("--networks", networks, "Random networks, or how often one of the front's is measured")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--most", stations, "Stations of a network at most; at least three")
      ->check(CLI::Range(fewest_stations, 64u))
      ->capture_default_str();
  command.add_option("--draws", draws, "Samples drawn, which the networks take in turn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--sizes", sizes, "Sizes of the sample")->delimiter(',')->capture_default_str();
}

void run_intervals(const IntervalsOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  const Scanner scanner = options.site.scanner();
  std::vector<Network> networks;
  if (options.front.empty()) {
    networks = networks_on_search_area(scene, options.networks, options.stations, scanner.height_m, 1);
    for (std::size_t k = 0; k < networks.size(); ++k)
      networks[k].resize(fewest_stations + k % (options.stations - fewest_stations + 1));
  } else {
    const std::vector<Network> front = networks_of_front(options.front, fewest_stations);
    // Neighbours of the front in turn within each draw, of which each begins one further.
    for (std::uint32_t k = 0; k < options.networks; ++k)
      networks.push_back(front[(k / options.draws + k % options.draws) % front.size()]);
  }
  const double n = static_cast<double>(networks.size());
  std::printf("engine,sample,objective,held,rms_error,rms_standard_error\n");
  for (const EngineInfo& info : options.site.engines_here()) {
    SimulatorConfig config = options.site.config();
    config.engine = info.engine;
    if (info.engine != Engine::embree) config.device_index = info.device_index;
    std::vector<Tally> of_coverage(options.sizes.size()), of_overlap(options.sizes.size()),
        of_registration(options.sizes.size());
    for (std::uint32_t draw = 0; draw < options.draws; ++draw) {
      config.seed = 1 + draw;  // of the noise too, so the truth is counted with the same
      Simulator simulator(scene, scanner, config);
      const double goal = simulator.goal_density();
      for (std::size_t k = draw; k < networks.size(); k += options.draws) {
        const NetworkCounts exact = simulator.evaluate(networks[k], {.registration = RegistrationModel{}});
        const double true_coverage = coverage(exact, goal),
                     true_overlap = clustering_coefficient(overlap_matrix(exact)),
                     true_registration = registration_estimate(exact, simulator.voxel_count()).value;
        for (std::size_t s = 0; s < options.sizes.size(); ++s) {
          const NetworkCounts counts = simulator
                                           .evaluate_sampled({&networks[k], 1}, {.voxels = options.sizes[s],
                                                                                 .registration = RegistrationModel{}})
                                           .front();
          of_coverage[s].add(coverage_estimate(counts, goal, simulator.voxel_count()), true_coverage);
          of_overlap[s].add(overlap_estimate(counts, simulator.voxel_count()), true_overlap);
          of_registration[s].add(registration_estimate(counts, simulator.voxel_count()), true_registration);
        }
      }
    }
    for (std::size_t s = 0; s < options.sizes.size(); ++s) {
      print(to_string(info.engine), options.sizes[s], "coverage", of_coverage[s], n);
      print(to_string(info.engine), options.sizes[s], "overlap", of_overlap[s], n);
      print(to_string(info.engine), options.sizes[s], "registration", of_registration[s], n);  // metres
    }
  }
}

}  // namespace vantage::bench
