// SPDX-License-Identifier: Apache-2.0
#include "growth.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "core/text.hpp"
#include "networks.hpp"
#include "support/temporary_folder.hpp"
#include "trace/vulkan/abilities.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/objective.hpp"

namespace vantage::bench {
namespace {

struct Row {
  std::string varied;
  std::uint64_t triangles = 0;
  std::uint32_t stations = 0;
  double user_size_m = 0;
  std::uint64_t sample = 0;
};

// Runs `work` in a process of its own and returns its text. The parent starts no thread before, so that a fork is safe.
std::string in_child(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw Error(Errc::io, "cannot make a pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw Error(Errc::io, "cannot start a process");
  if (child == 0) {
    close(ends[0]);
    std::string text;
    int status = 0;
    try {
      text = work();
    } catch (const std::exception& error) {
      text = error.what();
      status = 1;
    }
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = write(ends[1], text.data() + at, text.size() - at);
      if (written <= 0) break;
      at += static_cast<std::size_t>(written);
    }
    _exit(status);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status))
    throw Error(Errc::device_failure, "a measuring process died, signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) throw Error(Errc::invalid_argument, text);
  return text;
}

// "VmHWM": the most this process ever held; MiB.
double process_mib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

// Device memory of this process, MiB; empty if the driver keeps no account. A software device uses the memory of the
// process.
double device_mib(const EngineInfo& info) {
  if (info.engine == Engine::embree || info.software) return 0;
  const auto instance = vulkan::Instance::get(false);
  const auto used = vulkan::memory_of(*instance, instance->physical_devices().at(info.device_index)).used;
  return static_cast<double>(used) / (1024 * 1024);
}

struct Cost {
  double ms = std::numeric_limits<double>::infinity(), cpu_ms = ms;  // the latter of all cores together
};

template <class Work>
Cost best_of(std::uint32_t repeats, Work work) {
  Cost best;
  for (std::uint32_t k = 0; k < repeats; ++k) {
    const Stopwatch watch;
    const std::clock_t cpu = std::clock();
    work();
    best.ms = std::min(best.ms, watch.seconds() * 1e3);
    best.cpu_ms = std::min(best.cpu_ms, static_cast<double>(std::clock() - cpu) * 1e3 / CLOCKS_PER_SEC);
  }
  return best;
}

// The fields of a line after its engine, comma-separated.
std::string measure(const GrowthOptions& options, const Row& row, const std::filesystem::path& file,
                    const std::string& engine) {
  SiteOptions site;
  site.engines = {engine};
  site.user_size_m = row.user_size_m;
  site.spacing_m = options.spacing_m;
  site.step_deg = options.step_deg;
  const EngineInfo info = site.engines_here().front();
  const Scene scene = Scene::load(file);
  const std::vector<Network> population =
      networks_on_search_area(scene, options.population, row.stations, site.scanner().height_m, 1);
  const Network& stations = population.front();

  SimulatorConfig config = site.config();
  config.engine = info.engine;
  if (info.engine != Engine::embree) config.device_index = info.device_index;
  const Stopwatch watch;
  Simulator simulator(scene, site.scanner(), config);
  const double ready = watch.seconds();
  double device = device_mib(info);
  const Progress progress{.report = [&](double) { device = std::max(device, device_mib(info)); }, .stop = {}};
  const double goal = simulator.goal_density();
  const SampleOptions sample{.voxels = row.sample};
  // Not counted: the device makes its buffers, the sample is drawn, and memory is watched.
  simulator.evaluate({stations.front()}, {}, progress);
  simulator.evaluate_sampled(population, sample, progress);
  device = std::max(device, device_mib(info));
  const Cost together = best_of(options.repeats, [&] {
    for (const NetworkCounts& counts : simulator.evaluate_sampled(population, sample)) {
      coverage_estimate(counts, goal, simulator.voxel_count());
      overlap_estimate(counts, simulator.voxel_count());
    }
  });
  const double networks = static_cast<double>(population.size());
  const Cost sampled{together.ms / networks, together.cpu_ms / networks};
  const Cost exact = best_of(options.repeats, [&] {
    const NetworkCounts counts = simulator.evaluate(stations);
    coverage(counts, goal);
    clustering_coefficient(overlap_matrix(counts));
  });
  // On the CPU, CPU time: other work on the machine hardly shows in it.
  const double ratio = info.engine == Engine::embree ? exact.cpu_ms / sampled.cpu_ms : exact.ms / sampled.ms;
  device = std::max(device, device_mib(info));
  char text[300];
  std::snprintf(text, sizeof text, "%s,%zu,%u,%llu,%.5f,%llu,%llu,%.2f,%.3f,%.3f,%.4f,%.4f,%.1f,%.0f,%.0f",
                row.varied.c_str(), scene.triangle_count(), row.stations,
                static_cast<unsigned long long>(simulator.voxel_count()), simulator.voxel_size_m(),
                static_cast<unsigned long long>(std::min(row.sample, simulator.voxel_count())),
                static_cast<unsigned long long>(simulator.scanner().rays() * row.stations), ready, exact.ms,
                exact.cpu_ms, sampled.ms, sampled.cpu_ms, ratio, process_mib("VmHWM"), device);
  return text;
}

std::vector<Row> rows_of(const GrowthOptions& o) {
  const Row base{"", o.base_triangles, o.base_stations, o.base_user_size_m, o.base_sample};
  std::vector<Row> rows;
  const auto vary = [&](const char* name, auto member, const auto& values) {
    for (const auto& value : values) {
      Row row = base;
      row.varied = name;
      row.*member = value;
      rows.push_back(row);
    }
  };
  vary("triangles", &Row::triangles, o.triangles);
  vary("stations", &Row::stations, o.stations);
  vary("voxels", &Row::user_size_m, o.user_sizes_m);
  vary("sample", &Row::sample, o.samples);
  return rows;
}

}  // namespace

void GrowthOptions::add(CLI::App& command) {
  command.add_option("-o,--output", folder, "Folder for growth.csv and growth.md");
  command.add_option("--engine", engines, "Engines to measure; all usable ones if absent");
  command.add_option("--base-triangles", base_triangles, "Triangles while another quantity varies")
      ->capture_default_str();
  command.add_option("--base-stations", base_stations, "Stations, likewise")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_option("--base-user-size", base_user_size_m, "Upper bound of the voxel size, metres, likewise")
      ->capture_default_str();
  command.add_option("--base-sample", base_sample, "Size of the sample, likewise")->capture_default_str();
  command.add_option("--triangles", triangles, "Triangles of the industrial site")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--stations", stations, "Stations of a network")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_option("--user-sizes", user_sizes_m, "Upper bounds of the voxel size, metres")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--samples", samples, "Sizes of the sample")->delimiter(',')->capture_default_str();
  command.add_option("--step", step_deg, "Step angle, degrees")->capture_default_str();
  command.add_option("--spacing", spacing_m, "Wanted spacing of points, metres")->capture_default_str();
  command.add_option("--population", population, "Networks sampled in one submission")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--repeats", repeats, "Runs of each kind; the best counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void run_growth(const GrowthOptions& options) {
  const test::TemporaryFolder scenes;
  const std::string listed = in_child([&] {
    SiteOptions site;
    site.engines = options.engines;
    std::string names;
    for (const EngineInfo& info : site.engines_here()) names += to_string(info.engine) + "\n";
    return names;
  });
  std::vector<std::string> engines;
  std::istringstream lines(listed);
  for (std::string line; std::getline(lines, line);)
    if (std::find(engines.begin(), engines.end(), line) == engines.end()) engines.push_back(line);

  std::string csv =
      "engine,varied,triangles,stations,voxels,voxel_size_m,sample,rays_a_candidate,ready_seconds,exact_milliseconds,"
      "exact_cpu_milliseconds,sampled_milliseconds,sampled_cpu_milliseconds,times_faster,process_mib,device_mib\n";
  std::string markdown =
      "| engine | varied | triangles | stations | voxels | voxel size, m | sample | rays | ready, s | exact, ms | "
      "exact, CPU ms | sampled, ms | sampled, CPU ms | times faster | process, MiB | device, MiB |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::fputs(markdown.c_str(), stdout);
  for (const std::string& engine : engines)
    for (const Row& row : rows_of(options)) {
      const std::filesystem::path file = scenes.path() / (std::to_string(row.triangles) + ".glb");
      if (!std::filesystem::exists(file))
        in_child([&] {
          write_built_in_scene("industrial", row.triangles, file);
          return std::string();
        });
      const std::string fields = engine + "," + in_child([&] { return measure(options, row, file, engine); });
      csv += fields + "\n";
      std::string line = "| " + fields + " |\n";
      for (std::size_t at = 0; (at = line.find(',', at)) != std::string::npos; at += 3) line.replace(at, 1, " | ");
      std::fputs(line.c_str(), stdout);
      std::fflush(stdout);
      markdown += line;
    }
  if (options.folder.empty()) return;
  std::filesystem::create_directories(options.folder);
  write_text(std::filesystem::path(options.folder) / "growth.csv", csv);
  write_text(std::filesystem::path(options.folder) / "growth.md", markdown);
}

}  // namespace vantage::bench
