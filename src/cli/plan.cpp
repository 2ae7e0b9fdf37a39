// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"

namespace vantage::cli {
namespace {

// What a sampled search needs for errors of .002 in coverage, and of .007 in overlap, on large sites
// (docs/benchmarks.md).
constexpr std::uint64_t sample_for_coverage = 20'000, sample_for_overlap = 100'000;

struct PlanOptions {
  SiteOptions site;
  std::optional<Problem> problem;
  std::optional<CountRange> stations;
  PlanConfig config;
  bool exact = false, greedy = false, resume = false, json = false;
  std::optional<SampleSize> sample;
  std::vector<StationText> start, keep;
  std::optional<std::string> output;

  void add(CLI::App& command) {
    site.add(command);
    add_value(command, "--problem", "PROBLEM",
              "coverage-fix, coverage-overlap-fix, coverage-min or coverage-overlap-min; by --stations otherwise",
              [this](const std::string& text, const std::string& what) {
                try {
                  problem = problem_from_string(text);
                } catch (const Error& error) {
                  throw Error(error.code(), what + ": " + error.what());
                }
              })
        ->group("Problem");
    add_value(command, "--stations", "N|A..B",
              "How many stations: N for the fix problems, A to B for the min problems, up to 64",
              [this](const std::string& text, const std::string& what) {
                stations = parse_count_range(text, what, 1, max_stations);
              })
        ->group("Problem");
    add_values(command, "--keep", "X,Y,Z|U,V", "A station that is there already, on top of --stations; may be repeated",
               [this](const std::string& text, const std::string& what) { keep.push_back(parse_station(text, what)); })
        ->group("Problem");
    add_value(command, "--heights", "LOW,HIGH", "Search each station's height between these, in metres",
              [this](const std::string& text, const std::string& what) {
                const auto heights = parse_numbers(text, what, 2, 2, not_negative);
                config.heights_m = {heights[0], heights[1]};
              })
        ->group("Problem");
    add_value(command, "--min-overlap", "W",
              "Want every station linked to the others by overlaps of at least W, 0 to 1",
              [this](const std::string& text, const std::string& what) {
                config.min_link_overlap = parse_number(text, what, {.low = 0, .high = 1});
              })
        ->group("Problem");
    add_value(command, "--fitness", "L1,L2,L3",
              "With coverage-min: one network by a fitness of coverage, number and visibility with these weights, as "
              "0.4,0.4,0.2",
              [this](const std::string& text, const std::string& what) {
                const auto weights = parse_numbers(text, what, 3, 3, not_negative);
                config.fitness = FitnessWeights{weights[0], weights[1], weights[2]};
              })
        ->group("Problem");

    add_value(command, "--algorithm", "NAME",
              "Optimiser of several objectives: mo_cma_es, or a baseline: nsga2, random_search",
              [this](const std::string& text, const std::string& what) {
                try {
                  config.algorithm = mo_algorithm_from_string(text);
                } catch (const Error& error) {
                  throw Error(error.code(), what + ": " + error.what());
                }
              })
        ->group("Search");
    add_size(command, "--population", "M", "Networks per iteration; 10 for coverage-fix, 20 for a fitness, else 100",
             config.population, 2, 100'000);
    add_size(command, "--iterations", "K", "Iterations of M networks each; 100 otherwise", config.iterations, 1,
             100'000'000);
    add_size(command, "--batch", "B", "Networks asked for at once by the steady state; by the engine otherwise",
             config.batch, 1, 100'000);
    add_size(command, "--redraws", "N", "How often stations in holes or clashes are drawn again; 8 otherwise",
             config.redraws, 0, 10'000);
    add_size(command, "--stagnation", "K", "Stop when nothing has improved for K iterations",
             config.stagnation_iterations, 1, 100'000'000);
    add_value(command, "--sigma", "S", "First step, as a share of the search area; 0.2 otherwise",
              [this](const std::string& text, const std::string& what) {
                config.sigma0 = parse_number(text, what, {.low = 0, .high = 10, .low_included = false});
              })
        ->group("Search");
    add_value(command, "--scheme", "SCHEME", "steady-state or generational",
              [this](const std::string& text, const std::string& what) {
                if (text != "steady-state" && text != "generational")
                  throw Error(Errc::invalid_argument,
                              what + ": '" + text + "' is neither steady-state nor generational");
                config.scheme =
                    text == "generational" ? MoCmaEsConfig::Scheme::generational : MoCmaEsConfig::Scheme::steady_state;
              })
        ->group("Search");
    add_values(command, "--start", "X,Y,Z|U,V", "A station of the network to start from; repeat it for each",
               [this](const std::string& text, const std::string& what) { start.push_back(parse_station(text, what)); })
        ->group("Search");
    add_value(command, "--seed-with", "greedy", "Start from a greedy choice of stations",
              [this](const std::string& text, const std::string& what) {
                if (text != "greedy") throw Error(Errc::invalid_argument, what + ": '" + text + "' is not greedy");
                greedy = true;
              })
        ->group("Search");
    add_value(
        command, "--max-time", "T", "Stop searching after so long: 90, 90s, 15min or 2h",
        [this](const std::string& text, const std::string& what) { config.max_seconds = parse_duration(text, what); })
        ->group("Search");
    add_value(command, "--target-hypervolume", "V", "Stop when the front has this hypervolume, 0 to 1",
              [this](const std::string& text, const std::string& what) {
                config.target_hypervolume = parse_number(text, what, {.low = 0, .high = 1});
              })
        ->group("Search");
    auto* exact_flag =
        command.add_flag("--exact", exact, "Search with every ray instead of a sample of voxels")->group("Search");
    add_value(command, "--sample", "N|P%",
              "Search with so many voxels; 20000 for coverage alone, 100000 with overlap otherwise",
              [this](const std::string& text, const std::string& what) { sample = parse_sample(text, what); })
        ->group("Search")
        ->excludes(exact_flag);
    add_text(command, "-o,--output", "DIR", "Folder for the results", output)->group("Results");
    command.add_flag("--resume", resume, "Go on from the folder's checkpoint")->group("Results");
    command.add_flag("--json", json, "Print one JSON object, the same as front.json");
  }

 private:
  static void add_size(CLI::App& command, const std::string& name, const std::string& unit, const std::string& help,
                       std::size_t& target, std::size_t low, std::size_t high) {
    add_value(command, name, unit, help, [&target, low, high](const std::string& text, const std::string& what) {
      target = parse_count(text, what, low, high);
    })->group("Search");
  }
};

bool minimises_stations(Problem problem) {
  return problem == Problem::coverage_min || problem == Problem::coverage_overlap_min;
}
bool wants_overlap(Problem problem) {
  return problem == Problem::coverage_overlap_fix || problem == Problem::coverage_overlap_min;
}

// On small sites a quarter of the voxels does; but some thousands it should be.
std::uint64_t default_sample(const PlanConfig& config, std::uint64_t voxels) {
  const bool overlap = wants_overlap(config.problem) || config.min_link_overlap > 0;
  const std::uint64_t enough = std::max<std::uint64_t>(voxels / 4, 5'000);
  return std::min({overlap ? sample_for_overlap : sample_for_coverage, enough, voxels});
}

// Problem and number of stations say much about each other; what is missing follows from what is there.
void settle_problem(PlanOptions& options) {
  if (!options.stations)
    throw Error(Errc::invalid_argument, "--stations: how many? Give N, or A..B to search the number too");
  const auto [low, high] = *options.stations;
  PlanConfig& config = options.config;
  config.problem =
      options.problem.value_or(low == high ? Problem::coverage_overlap_fix : Problem::coverage_overlap_min);
  if (minimises_stations(config.problem) && low == high)
    throw Error(Errc::invalid_argument,
                fmt::format("--stations {}: {} searches the number of stations, so give a range A..B", low,
                            to_string(config.problem)));
  if (!minimises_stations(config.problem) && low != high)
    throw Error(Errc::invalid_argument,
                fmt::format("--stations {}..{}: {} takes one number", low, high, to_string(config.problem)));
  if (high + options.keep.size() > max_stations)
    throw Error(Errc::invalid_argument,
                fmt::format("--stations {} and {} kept ones are more than the {} that can be simulated together", high,
                            options.keep.size(), max_stations));
  config.stations_min = low;
  config.stations_max = high;
}

std::vector<Vec3> heads_of(LoadedSite& site, const std::vector<StationText>& stations, const std::string& what) {
  std::vector<Vec3> heads;
  for (const auto& station : place(site, stations)) {
    if (station.placed.status == StationStatus::hole)
      throw Error(Errc::invalid_argument,
                  fmt::format("{}: no ground under u,v = {:g},{:g}", what, station.placed.uv.u, station.placed.uv.v));
    heads.push_back(station.placed.position);
  }
  return heads;
}

nlohmann::json as_options(const LoadedSite& site, const PlanConfig& config) {
  nlohmann::json options;
  options["problem"] = to_string(config.problem);
  options["stations"] = config.stations_min == config.stations_max
                            ? std::to_string(config.stations_min)
                            : fmt::format("{}..{}", config.stations_min, config.stations_max);
  if (config.population > 0) options["population"] = config.population;
  options["iterations"] = config.iterations;
  options["sigma"] = config.sigma0;
  options["scheme"] = config.scheme == MoCmaEsConfig::Scheme::generational ? "generational" : "steady-state";
  options["algorithm"] = to_string(config.algorithm);
  if (config.fitness)
    options["fitness"] = {config.fitness->coverage, config.fitness->station_count, config.fitness->visibility};
  if (config.batch > 0) options["batch"] = config.batch;
  options["redraws"] = config.redraws;
  if (config.sample_voxels > 0)
    options["sample"] = config.sample_voxels;
  else
    options["exact"] = true;
  if (config.heights_m) options["heights"] = *config.heights_m;
  if (config.min_link_overlap > 0) options["min-overlap"] = config.min_link_overlap;
  if (config.max_seconds > 0) options["max-time"] = config.max_seconds;
  if (config.target_hypervolume) options["target-hypervolume"] = *config.target_hypervolume;
  if (config.stagnation_iterations > 0) options["stagnation"] = config.stagnation_iterations;
  const auto add_heads = [&](const char* key, const std::vector<Vec3>& heads) {
    for (const auto& head : heads) options[key].push_back({head.x, head.y, head.z});
  };
  add_heads("start", config.start);
  add_heads("keep", config.fixed);
  nlohmann::json all = site.as_options();
  all["plan"] = std::move(options);
  return all;
}

// What the search calls its progress by.
const char* value_name(const PlanConfig& config) {
  return !has_one_objective(config) ? "hypervolume" : config.fitness ? "fitness" : "coverage";
}

// Heads of a greedy choice for the largest network; empty where it was stopped.
std::vector<Vec3> greedy_start(LoadedSite& site, Simulator& simulator, const PlanConfig& config, Program& program) {
  ProgressLine line(program.console, "greedy");
  const GreedyResult greedy =
      greedy_network(simulator, site.area(), site.clash(),
                     {.stations = config.stations_max,
                      .sample_voxels = std::min<std::uint64_t>(config.sample_voxels, sample_for_coverage),
                      .fixed = config.fixed},
                     {.report = [&](double done) { line.update(done); }, .stop = program.stop});
  std::vector<Vec3> heads;
  if (greedy.cancelled) return heads;
  for (const auto& station : greedy.stations) heads.push_back(station.position);
  spdlog::info("greedy: {} stations cover {:.4f}", heads.size(), greedy.coverage.back());
  return heads;
}

// Says where a network does not hang together.
std::string parts_of(const PlanEntry& entry, const PlanConfig& config) {
  if (!entry.confirmed || !wants_overlap(config.problem)) return "";
  const std::size_t parts = connectivity(entry.exact_overlap_matrix, link_overlap(config)).parts;
  return parts > 1 ? fmt::format("  in {} parts", parts) : "";
}

std::string summary(const PlanResult& result, const PlanConfig& config, std::size_t chosen, const std::string& folder) {
  std::string text = "coverage  overlap  stations\n";
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    const PlanEntry& entry = result.front[k];
    text += fmt::format("  {:.4f}   {:.4f}  {:>4}{}{}\n", entry.confirmed ? entry.exact_coverage : entry.coverage,
                        entry.confirmed ? entry.exact_overlap : entry.overlap, entry.stations.size(),
                        k == chosen       ? "  <- compromise"
                        : entry.dominated ? "  dominated"
                                          : "",
                        parts_of(entry, config));
  }
  text += fmt::format("{} evaluations, {} {:.4f}", result.evaluations, value_name(config), result.hypervolume);
  if (config.sample_voxels > 0 && !std::isnan(result.exact_hypervolume))
    text += fmt::format(" ({:.4f} by every ray)", result.exact_hypervolume);
  text += fmt::format(", stopped: {}\n", to_string(result.stop_reason));
  return text + "results in " + folder + "\n";
}

int plan_survey(CLI::App& command, PlanOptions& options, Program& program) {
  LoadedSite site = open_site(command, options.site);
  settle_problem(options);
  if (!options.output) throw Error(Errc::invalid_argument, "plan: say where the results go with -o DIR");
  const std::filesystem::path folder = *options.output;
  make_folder(folder);  // an hour's search must not end at a folder that cannot be written

  PlanConfig& config = options.config;
  config.start = heads_of(site, options.start, "--start");
  config.fixed = heads_of(site, options.keep, "--keep");
  config.seed = site.config.seed;
  config.resume = options.resume;
  config.checkpoint = folder / "checkpoint.bin";
  const SearchArea& area = site.area();
  if (area.derived())
    spdlog::info("no search area is marked: stations may stand on {} walkable triangles", area.mesh().triangles.size());

  Simulator simulator(site.scene, site.scanner, site.config);
  tell_engine(simulator);
  tell_grid(simulator);
  if (!options.exact)
    config.sample_voxels =
        options.sample ? options.sample->of(simulator.voxel_count()) : default_sample(config, simulator.voxel_count());
  if (options.greedy) {
    if (!options.start.empty())
      throw Error(Errc::invalid_argument, "--seed-with and --start both say where to start: give one");
    config.start = greedy_start(site, simulator, config, program);
  }
  write_text(folder / "config.json", as_options(site, config).dump(2) + "\n");

  PlanResult result;
  {
    ProgressLine line(program.console, "search");
    result = plan(
        simulator, area, site.clash(), config,
        [&](const PlanProgress& now) {
          line.set_label(now.phase);
          const double done =
              now.iterations > 0 ? static_cast<double>(now.iteration) / static_cast<double>(now.iterations) : 0;
          line.update(done,
                      fmt::format("{} {:.4f}, {} networks, {:.3g} a second", value_name(config), now.hypervolume,
                                  now.evaluations, now.evaluations_per_second),
                      now.seconds_left);
        },
        program.stop, program.abort);
  }
  spdlog::info("writing {}", folder.string());
  const std::size_t chosen = write_plan(folder, result, config, simulator, area);
  if (options.json)
    program.console.print(front_json(result, config, simulator) + "\n");
  else
    program.console.print(summary(result, config, chosen, folder.string()));
  return exit_ok;
}

}  // namespace

void add_plan(CLI::App& app, Program& program) {
  add_command<PlanOptions>(app, program, "plan", "Search for the best networks of stations", plan_survey);
}

}  // namespace vantage::cli
