// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/deadline.hpp"
#include "cli/folder_lock.hpp"
#include "cli/missed.hpp"
#include "cli/options.hpp"
#include "cli/problem.hpp"
#include "cli/prove.hpp"
#include "cli/report.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/station_scanners.hpp"
#include "cli/stations.hpp"
#include "core/atomic_file.hpp"

namespace vantage::cli {
namespace {

// What a sampled search needs for errors of .002 in coverage, and of .007 in overlap, on large sites
// (docs/benchmarks.md).
constexpr std::uint64_t sample_for_coverage = 20'000, sample_for_overlap = 100'000;
// A front is searched with fewer, others after every so many iterations: so nothing is kept for its luck, which no
// fixed sample keeps out, and every ray judges what is kept (docs/cases.md).
constexpr std::uint64_t sample_drawn_anew = 5'000;
constexpr std::size_t iterations_of_a_sample = 20;
// Where every candidate is looked at: errors of .004, which the choice keeps as a margin and every ray then judges.
constexpr std::uint64_t sample_for_fewest = 5'000;

struct PlanOptions {
  SiteOptions site;
  ProblemOptions problem;
  PlanConfig config;
  bool exact = false, resume = false, force = false, prove = false, no_report = false, json = false;
  double max_seconds = 0, seed_seconds = ExactConfig().max_seconds;
  std::string seed_with;  // nothing, greedy or exact
  std::optional<SampleSize> sample, sample_from;
  std::vector<StationText> start;
  std::optional<std::string> output;

  PlanOptions() { config.iterations = 0; }  // until it is given or the problem is known

  void add(CLI::App& command) {
    site.add(command);
    problem.add(command);
    add_value(command, "--algorithm", "NAME",
              "Optimiser of several objectives: mo_cma_es, or a baseline: nsga2, random_search",
              [this](const std::string& text, const std::string& what) {
                try {
                  config.algorithm = algorithm_from_string(text);
                } catch (const Error& error) {
                  throw Error(error.code(), what + ": " + error.what());
                }
              })
        ->group("Search");
    add_size(command, "--population", "M",
             "Networks per iteration; with one objective 10, or 20 where it searches the number; else 100",
             config.population, 2, 100'000);
    add_size(command, "--iterations", "K", "Iterations of M networks each; by the site, or 100 for problems by name",
             config.iterations, 1, 100'000'000);
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
    add_value(command, "--seed-with", "greedy|exact",
              "Start from a choice among candidates: a greedy one, or the best by branch and bound",
              [this](const std::string& text, const std::string& what) {
                if (text != "greedy" && text != "exact")
                  throw Error(Errc::invalid_argument, what + ": '" + text + "' is neither greedy nor exact");
                seed_with = text;
              })
        ->group("Search");
    add_value(command, "--seed-time", "T", "Time for the exact choice: 90, 90s or 2min; 1min otherwise",
              [this](const std::string& text, const std::string& what) { seed_seconds = parse_duration(text, what); })
        ->group("Search");
    add_value(command, "--max-time", "T", "Be done after so long, with all that a plan takes: 90, 90s, 15min or 2h",
              [this](const std::string& text, const std::string& what) { max_seconds = parse_duration(text, what); })
        ->group("Search");
    add_value(command, "--target-hypervolume", "V", "Stop when the front has this hypervolume, 0 to 1",
              [this](const std::string& text, const std::string& what) {
                config.target_hypervolume = parse_number(text, what, {.low = 0, .high = 1});
              })
        ->group("Search");
    auto* exact_flag =
        command.add_flag("--exact", exact, "Search with every ray instead of a sample of voxels")->group("Search");
    add_value(
        command, "--sample", "N|P%",
        "Search with so many voxels all along; otherwise 20000 for coverage alone, 100000 with overlap, and for a "
        "front 5000, others every 20 iterations",
        [this](const std::string& text, const std::string& what) { sample = parse_sample(text, what); })
        ->group("Search")
        ->excludes(exact_flag);
    add_value(
        command, "--sample-from", "N|P%",
        "Look at networks with so many voxels first, and with more at those that might be kept; otherwise all are "
        "measured with the whole sample",
        [this](const std::string& text, const std::string& what) { sample_from = parse_sample(text, what); })
        ->group("Search")
        ->excludes(exact_flag);
    add_value(command, "--renew", "K",
              "Draw other voxels every K iterations, so that nothing is kept for its luck, and choose the front by "
              "every ray from all that is kept at the end",
              [this](const std::string& text, const std::string& what) {
                config.renew_iterations = parse_count(text, what, 1, 100'000'000);
              })
        ->group("Search")
        ->excludes(exact_flag);
    add_text(command, "-o,--output", "DIR", "Folder for the results; the scene's name and -plan otherwise", output)
        ->group("Results");
    add_value(command, "--save-every", "T", "Time between checkpoints, which --resume goes on from; 1min otherwise",
              [this](const std::string& text, const std::string& what) {
                config.checkpoint_seconds = parse_duration(text, what);
              })
        ->group("Results");
    auto* resumes = command.add_flag("--resume", resume, "Go on from the folder's checkpoint")->group("Results");
    command.add_flag("--force", force, "Overwrite the results of another run")->group("Results")->excludes(resumes);
    command
        .add_flag("--prove", prove, "Bound what any network of as many stations captures: how near does the plan come?")
        ->group("Results");
    command.add_flag("--no-report", no_report, "Leave out report.html and report.pdf")->group("Results");
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

// On small sites a quarter of the voxels does; but some thousands it should be.
std::uint64_t default_sample(const SurveyProblem& problem, bool drawn_anew, std::uint64_t voxels) {
  const auto pairs = [](const Objective& objective) { return objective.needs.pairs; };
  const bool overlap = std::ranges::any_of(problem.objectives, pairs) ||
                       std::ranges::any_of(problem.requirements, pairs, &Requirement::objective);
  if (problem.fewest) return std::min(sample_for_fewest, voxels);
  if (drawn_anew) return std::min(sample_drawn_anew, voxels);
  const std::uint64_t enough = std::max<std::uint64_t>(voxels / 4, 5'000);
  return std::min({overlap ? sample_for_overlap : sample_for_coverage, enough, voxels});
}

std::vector<PlacedStation> heads_of(LoadedSite& site, const std::vector<StationText>& stations,
                                    const std::string& what) {
  std::vector<PlacedStation> heads;
  for (const auto& station : place(site, stations)) {
    if (station.placed.status == StationStatus::hole)
      throw Error(Errc::invalid_argument,
                  fmt::format("{}: no ground under u,v = {:g},{:g}", what, station.placed.uv.u, station.placed.uv.v));
    if (station.placed.status != StationStatus::ok)
      spdlog::warn("{}: the station at {:.6g},{:.6g},{:.6g} {}", what, station.placed.position.x,
                   station.placed.position.y, station.placed.position.z, explain(station.placed.status));
    heads.push_back(station.placed);
  }
  return heads;
}

void keep(SurveyProblem& problem, std::span<const PlacedStation> stations) {
  for (const PlacedStation& station : stations) problem.kept.push_back(station.position);
  if (std::ranges::all_of(stations, [](const PlacedStation& s) { return s.setup == StationSetup(); })) return;
  for (const PlacedStation& station : stations) problem.kept_setups.push_back(station.setup);
}

// As --keep takes it.
std::string typed(const Vec3& head, const StationSetup& setup, const Scanner& scanner) {
  return fmt::format("x={},y={},z={},heading={},tilt={},step={},scanner={}", head.x, head.y, head.z,
                     setup.heading.in_degrees(), setup.tilt.in_degrees(), scanner.azimuth_step.in_degrees(),
                     scanner.name);
}

nlohmann::json as_options(const LoadedSite& site, const PlanOptions& given, const SurveyProblem& problem,
                          const PlanConfig& config) {
  nlohmann::json options = options_of(settings(problem));
  if (!problem.kept_setups.empty()) {
    options["keep"] = nlohmann::json::array();
    for (std::size_t k = 0; k < problem.kept.size(); ++k) {
      const StationSetup& setup = problem.kept_setups[k];
      options["keep"].push_back(typed(problem.kept[k], setup, site.scanners[setup.scanner]));
    }
  }
  if (!given.problem.search_steps.empty())
    options["search-step"] = fmt::format("{}", fmt::join(given.problem.search_steps, ","));
  if (given.problem.surveyors()) {
    // The requirements that this question has by itself go by their own options, so that 0 can take one away.
    nlohmann::json further = nlohmann::json::array();
    for (const char* own : {"capture", "link", "apart"}) options[own] = 0;
    for (const Requirement& requirement : problem.requirements) {
      const std::string& name = requirement.objective.name;
      if (options.contains(name) && requirement.bound == Requirement::Bound::at_least)
        options[name] = requirement.limit;
      else
        further.push_back(to_string(requirement));
    }
    options["require"] = std::move(further);
    options["problem"] = problem.name;
  }
  options.update(options_of(settings(config)));
  if (given.max_seconds > 0) options["max-time"] = given.max_seconds;
  if (config.sample_voxels == 0) options["exact"] = true;
  if (given.problem.fitness) {
    const FitnessWeights& weights = *given.problem.fitness;
    options["fitness"] = {weights.coverage, weights.station_count, weights.visibility};
  }
  nlohmann::json all = site.as_options();
  all["plan"] = std::move(options);
  return all;
}

// Heads of a greedy choice for the largest network; empty where it was stopped.
std::vector<Vec3> greedy_start(LoadedSite& site, Simulator& simulator, const SurveyProblem& problem,
                               const PlanConfig& config, Program& program, std::stop_token stop) {
  ProgressLine line(program.console, "greedy");
  const GreedyResult greedy =
      greedy_network(simulator, site.area(), site.clash(),
                     {.stations = problem.stations_max,
                      .sample_voxels = std::min<std::uint64_t>(config.sample_voxels, sample_for_coverage),
                      .fixed = problem.kept,
                      .fixed_setups = problem.kept_setups},
                     {.report = [&](double done) { line.update(done); }, .stop = std::move(stop)});
  std::vector<Vec3> heads;
  if (greedy.cancelled) return heads;
  for (const auto& station : greedy.stations) heads.push_back(station.position);
  spdlog::info("greedy: {} stations cover {:.4f}", heads.size(), greedy.coverage.back());
  return heads;
}

// Heads of the best choice for the largest network that was found in time; empty where none was.
std::vector<Vec3> exact_start(LoadedSite& site, Simulator& simulator, const SurveyProblem& problem,
                              const PlanConfig& config, double seconds, Program& program, std::stop_token stop) {
  const auto least = [&](std::string_view name) {
    double limit = 0;
    for (const Requirement& requirement : problem.requirements)
      if (requirement.objective.name == name && requirement.bound == Requirement::Bound::at_least)
        limit = requirement.limit;
    return limit;
  };
  const double link = least("link");
  ProgressLine line(program.console, "exact");
  const ExactResult exact =
      exact_network(simulator, site.area(), site.clash(),
                    {.stations = problem.stations_max,
                     .sample_voxels = std::min<std::uint64_t>(config.sample_voxels, sample_for_coverage),
                     .link = link,
                     .apart_m = least("apart"),
                     .max_seconds = seconds,
                     .fixed = problem.kept},
                    {.report = [&](double done) { line.update(done); }, .stop = std::move(stop)});
  std::vector<Vec3> heads;
  if (exact.cancelled) return heads;
  for (const auto& station : exact.stations) heads.push_back(station.position);
  if (heads.empty())
    spdlog::warn("exact: no network of {} stations was found that hangs together by overlaps of {:g}",
                 problem.stations_max, link);
  else
    spdlog::info("exact: {} stations cover {:.4f}, within {:.1f} % of the best that any of the candidates can do",
                 heads.size(), exact.choice.reached.value, 100 * exact.choice.gap());
  return heads;
}

// What a folder holds already.
struct Before {
  bool another_run = false;
  std::uint64_t evaluations = 0, confirmed = 0;  // of the results; 0: there are none
};

Before look_into(const std::filesystem::path& folder, const nlohmann::json& options) {
  Before before;
  std::error_code ignored;
  const auto read = [](const std::filesystem::path& file) {
    try {
      return read_json(file.string());
    } catch (const Error&) {
      return nlohmann::json();  // damaged, or none of ours: nothing to go by
    }
  };
  if (std::filesystem::exists(folder / "config.json", ignored))
    before.another_run = read(folder / "config.json") != options;
  if (std::filesystem::exists(folder / "front.json", ignored)) {
    const nlohmann::json results = read(folder / "front.json");
    if (!results.is_object()) return before;
    before.evaluations = results.value("evaluations", std::uint64_t{0});
    for (const auto& entry : results.value("front", nlohmann::json::array()))
      if (entry.is_object() && entry.contains("exact") && !entry["exact"].is_null()) ++before.confirmed;
  }
  return before;
}

// What it misses, and where it does not hang together.
std::string remarks(const PlanEntry& entry, const PlanResult& result) {
  std::string text;
  const auto pairs = [](const Objective& objective) { return objective.needs.pairs; };
  if (entry.exact && std::ranges::any_of(result.problem.objectives, pairs)) {
    const std::size_t parts = connectivity(entry.overlap_matrix, result.problem.link_overlap).parts;
    if (parts > 1) text += fmt::format("  in {} parts", parts);
  }
  for (const Requirement& requirement : result.problem.requirements) {
    const double value = entry.value(requirement.objective.name);
    if (requirement.missed_by(value) > 0) text += fmt::format("  misses {} ({:.4g})", to_string(requirement), value);
  }
  return text;
}

std::string summary(const PlanResult& result, std::size_t chosen, const std::string& folder) {
  std::string text = unmet_text(result);
  std::vector<const Objective*> told;
  for (const Objective& measure : result.measures)
    if (!measure.by_alpha) told.push_back(&measure);
  for (const Objective* measure : told)
    text += fmt::format("{:>9}", measure->unit.empty() ? measure->name : measure->name + " " + measure->unit) + " ";
  text += "stations\n";
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    const PlanEntry& entry = result.front[k];
    for (const Objective* measure : told) text += fmt::format("{:9.4f} ", entry.value(measure->name));
    text += fmt::format("{:>8}{}{}\n", entry.stations.size(),
                        k == chosen       ? "  <- answer"
                        : entry.dominated ? "  dominated"
                                          : "",
                        remarks(entry, result));
  }
  text += fmt::format("{} evaluations, hypervolume {:.4f}", result.evaluations, result.hypervolume);
  if (result.config.sample_voxels > 0 && !std::isnan(result.exact_hypervolume))
    text += fmt::format(" ({:.4f} by every ray)", result.exact_hypervolume);
  if (result.spared > 0) text += fmt::format(", {} networks not worth every ray", result.spared);
  text += fmt::format(", stopped: {}\n", to_string(result.stop_reason));
  const PlanEntry& entry = result.front[chosen];
  text +=
      "\n" +
      station_table(entry.stations, station_names(entry.stations), entry.counts.points_on_surveyed, result.scanners) +
      "\n";
  text += summary_text(entry, result.problem.requirements);
  for (const std::string& help : what_would_help(result)) text += fmt::format("{:<11}{}\n", "would help", help);
  return text + "results in " + folder + "\n";
}

// The site's coordinate system, where stations can be put on a map by it; else nothing, and a line that says why.
std::string map_system(const LoadedSite& site) {
  const std::string crs = site.crs_text();
  if (crs.empty()) return crs;
  try {
    const Box box = site.scene.bounds();
    to_wgs84(crs, std::vector<Vec3>{box.min, box.max, {box.min.x, box.max.y, 0}, {box.max.x, box.min.y, 0}});
    return crs;
  } catch (const Error& error) {
    spdlog::warn("no stations.geojson and stations.kml: {}", error.what());
    return "";
  }
}

// Every voxel's count under the network that is shown; empty where it was stopped.
std::optional<VoxelField> cartography(Simulator& simulator, const PlanEntry& entry, Program& program,
                                      std::stop_token abort) {
  ProgressLine line(program.console, "cartography");
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(to_network(entry.stations), {.overlap = true, .field = &field},
                                                  {.report = [&](double done) { line.update(done); }, .stop = abort});
  if (counts.cancelled) return std::nullopt;
  return field;
}

std::string told(const PlanProgress& now) {
  if (now.phase == "look" || now.phase == "choose")
    return now.evaluations > 0 ? fmt::format("{} stations", now.evaluations) : "";
  return fmt::format("hypervolume {:.4f}, {} networks, {:.3g} a second", now.hypervolume, now.evaluations,
                     now.evaluations_per_second);
}

PlanResult run_plan(LoadedSite& site, Simulator& simulator, const SurveyProblem& problem, const PlanConfig& config,
                    Program& program, const Deadline& deadline) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds soon{3};  // before that, what a part of it takes is a guess
  constexpr double kWithResults = 1.1;     // what is missed and the files take about a tenth of the search
  ProgressLine line(program.console, "search");
  std::string phase, told_phase;
  Clock::time_point begun;
  const auto report = [&](const PlanProgress& now) {
    line.set_label(now.phase);
    if (now.phase != phase) phase = now.phase, begun = Clock::now();
    if (now.visible)
      spdlog::info("{:.1f} % of the site can be seen from {} places all over the ground together", 100 * *now.visible,
                   now.evaluations);
    // What it will take is told as soon as it is known, of the whole, and of each part that takes long.
    if (now.whole_seconds_left) {
      const double limit = deadline.seconds_to_search(), left = kWithResults * *now.whole_seconds_left;
      spdlog::info("about {} more, in all", duration_text(limit > 0 ? std::min(limit, left) : left));
    }
    if (phase != told_phase && now.seconds_left > 1 && Clock::now() - begun > soon) {
      told_phase = phase;
      spdlog::info("{}: about {}", phase, duration_text(now.seconds_left));
    }
    const double done =
        now.iterations > 0 ? static_cast<double>(now.iteration) / static_cast<double>(now.iterations) : 0;
    line.update(done, told(now), now.seconds_left);
  };
  PlanResult result = plan(simulator, site.area(), site.clash(), problem, config,
                           {.report = report, .stop = deadline.stop(), .abort = deadline.abort()});
  if (result.stop_reason == StopReason::cancelled && deadline.passed()) result.stop_reason = StopReason::max_time;
  return result;
}

int plan_survey(CLI::App& command, PlanOptions& options, Program& program) {
  const Deadline deadline(options.max_seconds, program.stop, program.abort);
  LoadedSite site = open_site(command, options.site);
  weigh_ground(site);
  SurveyProblem problem = options.problem.settle(length_scale(site.scene.bounds()));
  problem.on_site = options.problem.on_site.settle(site);
  const std::filesystem::path folder =
      options.output ? std::filesystem::path(*options.output)
                     : std::filesystem::path(std::filesystem::path(options.site.scene).stem().string() + "-plan");

  PlanConfig& config = options.config;
  for (const PlacedStation& station : heads_of(site, options.start, "--start"))
    config.start.push_back(station.position);
  keep(problem, heads_of(site, options.problem.keep, "--keep"));
  problem.scanners = scanners_with(site, options.site.scanner.value_or(""), options.problem.search_steps);
  config.seed = site.config.seed;
  config.resume = options.resume;
  config.checkpoint = folder / "checkpoint.bin";
  if (config.iterations == 0 && !problem.fewest) config.iterations = PlanConfig().iterations;
  const SearchArea& area = site.area();

  std::shared_ptr<void> shared;
  if (program.ranks)
    shared = program.ranks->share([](const std::string& line) { spdlog::info("{}", line); },
                                  [](const std::string& line) { spdlog::warn("{}", line); });
  Simulator simulator = build_simulator(site, site.scanners, program);
  if (program.ranks && !program.ranks->first()) program.ranks->serve(simulator);
  tell_engine(simulator);
  tell_grid(simulator);
  if (!options.exact) {
    const bool front = problem.objectives.size() > 1 && !problem.fewest && config.algorithm == Algorithm::mo_cma_es;
    if (front && !options.sample && !options.sample_from && config.renew_iterations == 0)
      config.renew_iterations = iterations_of_a_sample;
    config.sample_voxels = options.sample
                               ? options.sample->of(simulator.voxel_count())
                               : default_sample(problem, config.renew_iterations > 0, simulator.voxel_count());
  }
  if (options.sample_from) config.sample_from = options.sample_from->of(simulator.voxel_count());
  if (!options.seed_with.empty()) {
    if (!options.start.empty())
      throw Error(Errc::invalid_argument, "--seed-with and --start both say where to start: give one");
    if (problem.fewest)
      throw Error(Errc::invalid_argument,
                  "--seed-with: the question for the fewest stations starts from its own "
                  "choice; give --stations and --objectives, or another --problem");
    config.start = options.seed_with == "greedy"
                       ? greedy_start(site, simulator, problem, config, program, deadline.stop())
                       : exact_start(site, simulator, problem, config, options.seed_seconds, program, deadline.stop());
  }
  const nlohmann::json as_given = as_options(site, options, problem, config);
  make_folder(folder);  // an hour's search must not end at a folder that cannot be written
  const FolderLock lock(folder);
  AtomicFile::remove_leftovers_in(folder);
  const Before before = look_into(folder, as_given);
  if (before.another_run && !options.resume && !options.force)
    throw Error(Errc::invalid_argument, "plan: " + folder.string() +
                                            " holds the results of another run; give another folder with -o, --resume "
                                            "to go on with it, or --force to overwrite it");
  if (!options.resume) write_text(folder / "config.json", as_given.dump(2) + "\n");
  if (options.resume) {
    if (std::filesystem::exists(config.checkpoint) || std::filesystem::exists(config.checkpoint.string() + ".before"))
      spdlog::info("resuming from {}", config.checkpoint.string());
    else
      spdlog::info("{} holds nothing to resume: beginning", folder.string());
  }

  const std::string crs = map_system(site);
  // A search stops by its own clock too, so that it can say so.
  config.max_seconds = deadline.seconds_to_search();
  PlanResult result = run_plan(site, simulator, problem, config, program, deadline);
  config.max_seconds = result.config.max_seconds = options.max_seconds;
  if (result.front.empty())
    throw Error(Errc::invalid_argument,
                "there is nothing to write: the search ended before its first networks were evaluated");
  if (options.resume) {
    const auto confirmed = static_cast<std::uint64_t>(std::ranges::count(result.front, true, &PlanEntry::exact));
    if (result.evaluations < before.evaluations || (confirmed == 0 && before.confirmed > 0)) {
      spdlog::warn("{} holds better results, of {} evaluations; these of {} are not written", folder.string(),
                   before.evaluations, result.evaluations);
      program.console.print(options.json ? front_json(result, simulator) + "\n"
                                         : summary(result, answer(result), folder.string()));
      return result.problem.requirements.empty() || met(result) ? exit_ok : exit_unmet;
    }
  }
  make_folder(folder);  // it may have been removed meanwhile
  write_text(folder / "config.json", as_given.dump(2) + "\n");
  const auto field = cartography(simulator, result.front[answer(result)], program, deadline.abort());
  if (!field) spdlog::warn("stopped: {} is not written", (folder / "coverage.ply").string());
  spdlog::info("writing {}", folder.string());
  const std::size_t chosen = write_plan(folder, result, simulator, area, field ? &*field : nullptr, crs);
  std::optional<MissedVoxels> judged;
  if (field && !deadline.passed()) judged = judge_missed(site, simulator, *field, program);
  if (judged)
    write_missed(
        std::vector<std::filesystem::path>{folder / "missed.csv", folder / "missed.ply", folder / "missed.png"},
        *judged, simulator, result.front[chosen].stations);
  if (!options.no_report && !why_no_report().empty()) spdlog::warn("no report: {}", why_no_report());
  if (!options.no_report && why_no_report().empty())
    write_reports(std::vector<std::filesystem::path>{folder / "report.html", folder / "report.pdf"}, result, simulator,
                  area,
                  {.title = std::filesystem::path(options.site.scene).stem().string(),
                   .field = field ? &*field : nullptr,
                   .missed = judged ? &*judged : nullptr},
                  program, deadline.abort());
  if (options.prove)
    prove(folder / "bound.json", site, simulator, result.front[chosen].stations, problem.kept.size(), program);
  if (options.json)
    program.console.print(front_json(result, simulator) + "\n");
  else
    program.console.print(summary(result, chosen, folder.string()));
  return result.problem.requirements.empty() || met(result) ? exit_ok : exit_unmet;
}

}  // namespace

void add_plan(CLI::App& app, Program& program) {
  add_command<PlanOptions>(app, program, "plan", "Search for the best networks of stations", plan_survey);
}

}  // namespace vantage::cli
