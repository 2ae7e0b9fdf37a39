// SPDX-License-Identifier: Apache-2.0
#include "population.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/philox.hpp"
#include "vantage/objective.hpp"
#include "vantage/placement.hpp"
#include "vantage/registration.hpp"

namespace vantage::bench {
namespace {

std::vector<Network> population_around(const Network& stations, const ClashChecker& checker, std::size_t count,
                                       double spread_m) {
  RandomStream random(1);
  const auto draw = [&] { return (random.bits() * 0x1p-32 * 2 - 1) * spread_m; };
  std::vector<Network> networks(count, stations);
  for (std::size_t n = 1; n < count; ++n)
    for (Station& station : networks[n]) {
      // A crowded place keeps its station after some tries.
      for (int attempt = 0; attempt < 64; ++attempt) {
        const Vec3 moved{station.position.x + draw(), station.position.y + draw(), station.position.z};
        if (checker.distance(moved, 0.5) < 0.5) continue;
        station.position = moved;
        break;
      }
    }
  return networks;
}

// Kind of evaluation that a search needs.
struct Kind {
  bool overlap, registration;
};

struct Objectives {
  double coverage = 0, overlap = 0, coverage_se = 0, overlap_se = 0;
};

double rms(const std::vector<double>& errors) {
  double sum = 0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

}  // namespace

void PopulationOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--networks", networks, "Networks of the population")->capture_default_str();
  command.add_option("--against", against, "Networks that are evaluated exactly too")->capture_default_str();
  command.add_option("--spread", spread_m, "How far stations move from where they are given, metres")
      ->capture_default_str();
  command.add_option("--sizes", sizes, "Sizes of the voxel sample")->delimiter(',')->capture_default_str();
}

void run_population(const PopulationOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  const ClashChecker checker(scene);
  const std::vector<Network> networks =
      population_around(options.site.stations(), checker, options.networks, options.spread_m);
  const std::size_t compared = std::min<std::size_t>(options.against, networks.size());
  std::printf(
      "engine,sample,overlap,milliseconds_a_candidate,device_milliseconds,rays_a_candidate,coverage_rms,overlap_rms,"
      "coverage_se,overlap_se,"
      "times_faster_than_exact,registration\n");
  for (const EngineInfo& info : options.site.engines_here()) {
    SimulatorConfig config = options.site.config();
    config.engine = info.engine;
    if (info.engine != Engine::embree) config.device_index = info.device_index;
    Simulator simulator(scene, options.site.scanner(), config);
    const double goal = simulator.goal_density();
    const std::uint64_t population = simulator.voxel_count();
    const std::string name = to_string(info.engine);

    std::vector<Objectives> exact(compared);
    double exact_ms = 0, exact_best = std::numeric_limits<double>::infinity(), device = 0, rays = 0;
    // A graphics card's first run is slow; a CPU's takes long enough to bury that.
    if (compared > 0 && !info.software && info.engine != Engine::embree) simulator.evaluate(networks[0]);
    for (std::size_t k = 0; k < compared; ++k) {
      const Stopwatch watch;
      const NetworkCounts counts = simulator.evaluate(networks[k]);
      exact[k] = {coverage(counts, goal), clustering_coefficient(overlap_matrix(counts))};
      const double ms = watch.seconds() * 1e3;
      exact_ms += ms / static_cast<double>(compared);
      exact_best = std::min(exact_best, ms);
      device += counts.trace_seconds * 1e3 / static_cast<double>(compared);
      rays += static_cast<double>(counts.rays) / static_cast<double>(compared);
    }
    if (compared > 0) std::printf("%s,exact,1,%.3f,%.3f,%.0f,0,0,0,0,1,0\n", name.c_str(), exact_ms, device, rays);

    for (const std::uint64_t size : options.sizes)
      for (const auto [overlap, registration] : {Kind{false, false}, {true, false}, {true, true}}) {
        SampleOptions sample{.voxels = size, .overlap = overlap, .count_to = CountTo::goal};
        if (registration) sample.registration = RegistrationModel{};
        double best = std::numeric_limits<double>::infinity(), device_ms = 0;
        std::vector<NetworkCounts> counts;
        std::vector<Objectives> objectives(networks.size());
        const auto estimates = simulator.evaluate_sampled(networks, sample);
        for (std::size_t k = 0; k < networks.size(); ++k) {
          objectives[k].coverage_se = coverage_estimate(estimates[k], goal, population).standard_error;
          if (overlap) objectives[k].overlap_se = overlap_estimate(estimates[k], population).standard_error;
        }
        // From stations to objectives, as in a search, which asks for no standard errors.
        sample.groups = false;
        for (std::uint32_t round = 0; round < options.site.repeats; ++round) {
          const Stopwatch watch;
          counts = simulator.evaluate_sampled(networks, sample);
          std::vector<double> errors(counts.size());
          tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t k) {
            objectives[k].coverage = coverage(counts[k], goal);
            if (overlap) objectives[k].overlap = clustering_coefficient(overlap_matrix(counts[k]));
            if (registration) errors[k] = registration_error(counts[k], population).rms_m;
          });
          const double ms = watch.seconds() * 1e3;
          if (ms < best) {
            best = ms;
            device_ms = 0;
            for (const auto& c : counts) device_ms += c.trace_seconds * 1e3;
          }
        }
        std::vector<double> coverage_error, overlap_error, coverage_se, overlap_se;
        double sampled_rays = 0;
        for (const auto& c : counts) sampled_rays += static_cast<double>(c.rays) / static_cast<double>(counts.size());
        for (std::size_t k = 0; k < compared; ++k) {
          coverage_error.push_back(objectives[k].coverage - exact[k].coverage);
          overlap_error.push_back(overlap ? objectives[k].overlap - exact[k].overlap : 0);
          coverage_se.push_back(objectives[k].coverage_se);
          overlap_se.push_back(objectives[k].overlap_se);
        }
        const double n = static_cast<double>(networks.size());
        std::printf("%s,%llu,%d,%.4f,%.4f,%.0f,%.5f,%.5f,%.5f,%.5f,%.1f,%d\n", name.c_str(),
                    static_cast<unsigned long long>(size), overlap, best / n, device_ms / n, sampled_rays,
                    compared ? rms(coverage_error) : 0, compared ? rms(overlap_error) : 0,
                    compared ? rms(coverage_se) : 0, compared ? rms(overlap_se) : 0, exact_ms / (best / n),
                    registration);
        std::fflush(stdout);
      }
  }
}

}  // namespace vantage::bench
