// SPDX-License-Identifier: Apache-2.0
#include "error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "core/text.hpp"
#include "error_picture.hpp"
#include "networks.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/objective.hpp"

namespace vantage::bench {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

struct Estimates {
  double coverage = 0, overlap = 0, coverage_se = 0, overlap_se = 0;
};

// A line of the table: a method, its setting, its cost and its result.
struct Trial {
  Way way = Way::exact;
  double amount = 1;    // size of the sample, or how many times coarser
  bool overlap = true;  // with station masks
  Simulator* simulator = nullptr;
  std::vector<double> best_ms =
      {};  // per network where each is timed alone, else one entry: a candidate of the population
  std::vector<double> best_cpu_ms = {};  // likewise, of all threads: what others do on the machine hardly shows in it
  std::uint32_t rounds = 0;
  bool tired = false;
  double rays = 0;  // a candidate
  std::vector<Estimates> values = {};

  double milliseconds() const { return mean(best_ms); }
  double cpu_milliseconds() const { return mean(best_cpu_ms); }

  static double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

// Milliseconds of this process on all cores.
double cpu_ms() { return static_cast<double>(std::clock()) * 1e3 / CLOCKS_PER_SEC; }

const char* name_of(Way way) {
  switch (way) {
    case Way::every_ray: return "exact-every-ray";
    case Way::exact: return "exact";
    case Way::sampled: return "sampled";
    case Way::coarser_steps: return "coarser-steps";
    case Way::coarser_steps_and_voxels: return "coarser-steps-and-voxels";
    case Way::coarser_voxels: return "coarser-voxels";
  }
  return "";
}

Estimates estimate(const NetworkCounts& counts, const Simulator& simulator, bool overlap) {
  const Estimate c = coverage_estimate(counts, simulator.goal_density(), simulator.voxel_count());
  const Estimate o = overlap ? overlap_estimate(counts, simulator.voxel_count()) : Estimate{};
  return {c.value, o.value, c.standard_error, o.standard_error};
}

// Each network on its own, as exact evaluation does it.
void time_alone(Trial& trial, std::span<const Network> networks) {
  trial.best_ms.resize(networks.size(), kForever);
  trial.best_cpu_ms.resize(networks.size(), kForever);
  trial.values.resize(networks.size());
  double rays = 0;
  for (std::size_t k = 0; k < networks.size(); ++k) {
    const Stopwatch watch;
    const double cpu = cpu_ms();
    const NetworkCounts counts =
        trial.simulator->evaluate(networks[k], {.overlap = trial.overlap, .skip = trial.way != Way::every_ray});
    trial.values[k] = {coverage(counts, trial.simulator->goal_density()),
                       trial.overlap ? clustering_coefficient(overlap_matrix(counts)) : 0};
    trial.best_ms[k] = std::min(trial.best_ms[k], watch.seconds() * 1e3);
    trial.best_cpu_ms[k] = std::min(trial.best_cpu_ms[k], cpu_ms() - cpu);
    rays += static_cast<double>(counts.rays);
  }
  trial.rays = rays / static_cast<double>(networks.size());
}

// All in one submission, as a search does it. Errors are of the first `compared`.
void time_together(Trial& trial, std::span<const Network> population, std::size_t compared) {
  const SampleOptions sample{.voxels = static_cast<std::uint64_t>(trial.amount),
                             .overlap = trial.overlap,
                             .count_to = trial.overlap ? CountTo::all : CountTo::goal};
  trial.simulator->evaluate_sampled(population.first(1), sample);  // draws the sample, which a search does once
  const Stopwatch watch;
  const double cpu = cpu_ms();
  const std::vector<NetworkCounts> counts = trial.simulator->evaluate_sampled(population, sample);
  std::vector<Estimates> values;
  for (const NetworkCounts& c : counts) values.push_back(estimate(c, *trial.simulator, trial.overlap));
  const double ms = watch.seconds() * 1e3 / static_cast<double>(population.size());
  const double cpu_spent = (cpu_ms() - cpu) / static_cast<double>(population.size());
  trial.best_ms.resize(1, kForever);
  trial.best_cpu_ms.resize(1, kForever);
  trial.best_cpu_ms[0] = std::min(trial.best_cpu_ms[0], cpu_spent);
  trial.best_ms[0] = std::min(trial.best_ms[0], ms);
  trial.rays = 0;
  for (const NetworkCounts& c : counts)
    trial.rays += static_cast<double>(c.rays) / static_cast<double>(population.size());
  values.resize(compared);
  trial.values = std::move(values);
}

struct Rms {
  double rms = 0, bias = 0;
};

template <class Get>
Rms error_of(const Trial& trial, const std::vector<Estimates>& truth, Get get) {
  Rms error;
  const double n = static_cast<double>(trial.values.size());
  for (std::size_t k = 0; k < trial.values.size(); ++k) {
    const double e = get(trial.values[k]) - get(truth[k % truth.size()]);
    error.bias += e / n;
    error.rms += e * e / n;
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

template <class Get>
double rms_of(const Trial& trial, Get get) {
  double sum = 0;
  for (const Estimates& value : trial.values) sum += get(value) * get(value);
  return std::sqrt(sum / static_cast<double>(trial.values.size()));
}

std::string short_count(double count) {
  if (count >= 1e6) return number(std::round(count / 1e4) / 100) + " M";
  if (count >= 1e3) return number(std::round(count / 100) / 10) + " k";
  return number(count);
}

class EngineRun {
 public:
  EngineRun(const ErrorOptions& options, const Scene& scene, const EngineInfo& info,
            std::span<const Network> population)
      : options_(options), scene_(scene), info_(info), population_(population) {
    compared_ = std::min<std::size_t>(options.networks, population.size());
    plan();
  }

  void measure() {
    for (std::uint32_t round = 0; round < options_.site.repeats; ++round)
      for (Trial& trial : trials_) {
        if (trial.tired) continue;
        const Stopwatch watch;
        if (trial.way == Way::sampled) {
          time_together(trial, population_, compared_);
        } else {
          // Warms up: the device makes its buffers.
          if (round == 0) trial.simulator->evaluate({population_[0].front()}, {.overlap = trial.overlap});
          time_alone(trial, population_.first(compared_));
        }
        ++trial.rounds;
        trial.tired = watch.seconds() > options_.patience_s;
        std::fprintf(stderr, "%s, round %u: %s %s, %.1f s\n", to_string(info_.engine).c_str(), round + 1,
                     name_of(trial.way), number(trial.amount).c_str(), watch.seconds());
      }
    more_samples();
  }

  std::string table() const {
    const std::vector<Estimates>& truth = trial_of(Way::every_ray, true).values;
    std::string text;
    for (const Trial& trial : trials_) {
      const Rms c = error_of(trial, truth, [](const Estimates& o) { return o.coverage; });
      const Rms o = trial.overlap ? error_of(trial, truth, [](const Estimates& v) { return v.overlap; }) : Rms{};
      const double c_se = rms_of(trial, [](const Estimates& v) { return v.coverage_se; });
      const double o_se = rms_of(trial, [](const Estimates& v) { return v.overlap_se; });
      char line[400];
      std::snprintf(line, sizeof line, "%s,%s,%s,%s,%.4f,%.4f,%.2f,%.2f,%.0f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%u\n",
                    to_string(info_.engine).c_str(), name_of(trial.way), number(trial.amount).c_str(),
                    trial.overlap ? "coverage+overlap" : "coverage", trial.milliseconds(), trial.cpu_milliseconds(),
                    time_of(trial_of(Way::exact, trial.overlap)) / time_of(trial),
                    time_of(trial_of(Way::every_ray, true)) / time_of(trial), trial.rays, c.rms, c.bias, c_se, o.rms,
                    o.bias, o_se, trial.rounds);
      text += line;
    }
    return text;
  }

  std::unique_ptr<Canvas> picture() const {
    const std::vector<Estimates>& truth = trial_of(Way::every_ray, true).values;
    std::vector<ErrorDot> dots;
    for (const Trial& trial : trials_) {
      if (!trial.overlap) continue;
      const bool sampled = trial.way == Way::sampled;
      dots.push_back({.way = trial.way,
                      .label = sampled ? short_count(trial.amount) : "\u00d7" + number(trial.amount),
                      .milliseconds = time_of(trial),
                      .coverage_rms = error_of(trial, truth, [](const Estimates& o) { return o.coverage; }).rms,
                      .overlap_rms = error_of(trial, truth, [](const Estimates& o) { return o.overlap; }).rms,
                      .coverage_se = rms_of(trial, [](const Estimates& o) { return o.coverage_se; }),
                      .overlap_se = rms_of(trial, [](const Estimates& o) { return o.overlap_se; })});
    }
    const Simulator& full = *simulators_.front();
    std::size_t fewest = population_[0].size(), most = fewest;
    for (const Network& network : population_.first(compared_))
      fewest = std::min(fewest, network.size()), most = std::max(most, network.size());
    const std::string title = "Run time against error: " + std::filesystem::path(options_.site.scene).stem().string() +
                              ", " + to_string(info_.engine);
    const std::string subtitle = grouped(scene_.triangle_count()) + " triangles, " + std::to_string(compared_) +
                                 " networks of " + std::to_string(fewest) + " to " + std::to_string(most) +
                                 " stations with " + short_count(static_cast<double>(full.scanner().rays())) +
                                 " rays each, " + grouped(full.voxel_count()) + " voxels of " +
                                 fixed(full.voxel_size_m() * 1000, 1) + " mm, goal " + fixed(full.goal_density(), 1) +
                                 (options_.site.noise ? ", with noise" : "") + ". On " + info_.device;
    return error_picture(dots, title, subtitle,
                         options_.cpu_time ? "CPU milliseconds a candidate, all cores" : "Milliseconds a candidate");
  }

 private:
  Simulator* add_simulator(double step, double voxel, std::uint64_t seed = 1) {
    Scanner scanner = options_.site.scanner();
    scanner.azimuth_step = scanner.zenith_step = Angle::degrees(options_.site.step_deg * step);
    SimulatorConfig config = options_.site.config();
    config.engine = info_.engine;
    if (info_.engine != Engine::embree) config.device_index = info_.device_index;
    config.user_size_m *= voxel;
    config.point_spacing_m *= step;
    config.seed = seed;
    // A goal below one point is reached by one point, as a goal of one is.
    if (step > 1) {
      const double size = voxel_size_ * voxel;
      config.point_spacing_m = std::min(config.point_spacing_m, size * (1 - 1e-9));
    }
    simulators_.push_back(std::make_unique<Simulator>(scene_, scanner, config));
    return simulators_.back().get();
  }

  void plan() {
    Simulator* full = add_simulator(1, 1);
    voxel_size_ = full->voxel_size_m();
    trials_.push_back({.way = Way::every_ray, .simulator = full});
    trials_.push_back({.way = Way::exact, .simulator = full});
    trials_.push_back({.way = Way::exact, .overlap = false, .simulator = full});
    std::vector<std::uint64_t> sizes = options_.sizes;
    for (std::uint64_t& size : sizes) size = std::min(size, full->voxel_count());
    std::sort(sizes.begin(), sizes.end());
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    for (const bool overlap : {true, false})
      for (const std::uint64_t size : sizes)
        trials_.push_back(
            {.way = Way::sampled, .amount = static_cast<double>(size), .overlap = overlap, .simulator = full});
    for (const double factor : options_.coarser) {
      if (factor == 1) continue;
      trials_.push_back({.way = Way::coarser_steps, .amount = factor, .simulator = add_simulator(factor, 1)});
      trials_.push_back(
          {.way = Way::coarser_steps_and_voxels, .amount = factor, .simulator = add_simulator(factor, factor)});
      trials_.push_back({.way = Way::coarser_voxels, .amount = factor, .simulator = add_simulator(1, factor)});
    }
  }

  // Errors of one sample are correlated between networks, so several samples are drawn. With noise another seed would
  // be another truth as well.
  void more_samples() {
    if (options_.site.noise) return;
    for (std::uint32_t seed = 2; seed <= options_.seeds; ++seed) {
      Simulator* simulator = add_simulator(1, 1, seed);
      for (Trial& trial : trials_) {
        if (trial.way != Way::sampled || trial.amount >= static_cast<double>(simulator->voxel_count())) continue;
        if (!trial.overlap) continue;
        const auto alone = std::find_if(trials_.begin(), trials_.end(), [&](const Trial& t) {
          return t.way == Way::sampled && !t.overlap && t.amount == trial.amount;
        });
        const SampleOptions sample{.voxels = static_cast<std::uint64_t>(trial.amount)};
        for (const NetworkCounts& counts : simulator->evaluate_sampled(population_.first(compared_), sample)) {
          trial.values.push_back(estimate(counts, *simulator, true));
          const Estimates& both = trial.values.back();  // coverage is the same with masks and without
          alone->values.push_back({.coverage = both.coverage, .coverage_se = both.coverage_se});
        }
      }
      simulators_.pop_back();
    }
  }

  double time_of(const Trial& trial) const {
    return options_.cpu_time ? trial.cpu_milliseconds() : trial.milliseconds();
  }

  const Trial& trial_of(Way way, bool overlap) const {
    return *std::find_if(trials_.begin(), trials_.end(),
                         [&](const Trial& t) { return t.way == way && t.overlap == overlap; });
  }

  const ErrorOptions& options_;
  const Scene& scene_;
  const EngineInfo& info_;
  std::span<const Network> population_;
  std::size_t compared_ = 0;
  double voxel_size_ = 0;
  std::vector<std::unique_ptr<Simulator>> simulators_;
  std::vector<Trial> trials_;
};

}  // namespace

void ErrorOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("-o,--output", folder, "Where the table and the pictures go")->capture_default_str();
  command.add_option("--networks", networks, "Networks on which errors are measured")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--population", population, "Networks sampled in one submission, where more than those compared")
      ->capture_default_str();
  command.add_option("--drawn", drawn, "Stations drawn on the search area where none are given")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_option("--seeds", seeds, "Samples drawn of every size")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--spread", spread_m, "How far stations move from where they are given, metres")
      ->capture_default_str();
  command.add_flag(
      "--cpu-time", cpu_time,
      "Compare and draw CPU time, in which other work on the machine hardly shows; for engines on the CPU");
  command.add_option("--patience", patience_s, "A way that takes more seconds than these is timed once only")
      ->capture_default_str();
  command.add_option("--sizes", sizes, "Sizes of the voxel sample")->delimiter(',')->capture_default_str();
  command.add_option("--coarser", coarser, "How many times coarser the naive ways are; 1: leave them out")
      ->delimiter(',')
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
}

void run_error(const ErrorOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  const bool given = !options.site.station_file.empty() || !options.site.typed.empty();
  const Network stations =
      given ? options.site.stations()
            : networks_on_search_area(scene, 1, options.drawn, options.site.scanner().height_m, 1).front();
  const std::vector<Network> population =
      networks_like(stations, ClashChecker(scene), std::max(options.networks, options.population), options.spread_m, 1);
  std::filesystem::create_directories(options.folder);
  const std::filesystem::path folder = options.folder;
  std::string table =
      "engine,way,sample_or_factor,objectives,milliseconds_a_candidate,cpu_milliseconds_a_candidate,times_faster_than_"
      "exact,times_faster_than_every_"
      "ray,rays_a_candidate,coverage_rms,coverage_bias,coverage_se,overlap_rms,overlap_bias,overlap_se,rounds\n";
  std::fputs(table.c_str(), stdout);
  for (const EngineInfo& info : options.site.engines_here()) {
    EngineRun run(options, scene, info, population);
    run.measure();
    const std::string lines = run.table();
    std::fputs(lines.c_str(), stdout);
    std::fflush(stdout);
    table += lines;
    write_text(folder / "error.csv", table);
    for (const char* suffix : {".svg", ".png"})
      run.picture()->save(folder / ("error_" + to_string(info.engine) + suffix));
  }
}

}  // namespace vantage::bench
