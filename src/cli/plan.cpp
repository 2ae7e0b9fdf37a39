// SPDX-License-Identifier: Apache-2.0
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/folder_lock.hpp"
#include "cli/missed.hpp"
#include "cli/options.hpp"
#include "cli/plan_folder.hpp"
#include "cli/plan_text.hpp"
#include "cli/prove.hpp"
#include "cli/report.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/station_scanners.hpp"
#include "cli/stations.hpp"
#include "core/atomic_file.hpp"
#include "core/deadline.hpp"
#include "core/json_text.hpp"
#include "plan/limits.hpp"

namespace vantage::cli {
namespace {

// Largest sample for the choice of a first network.
constexpr std::uint64_t kStartSample = 20'000;
// Least share of the remaining time for the search.
constexpr double kStartTimeShare = 0.5;

struct PlanOptions {
  SiteArguments site;
  SurveyQuestion question;
  PlanConfig config;
  ReportHead report_head;
  PlyCoordinates ply = PlyCoordinates::floats;
  bool force = false, prove = false, no_report = false, json = false;
  double seed_seconds = ExactConfig().max_seconds;
  std::string seed_with;  // nothing, greedy or exact
  std::vector<StationText> keep, start;
  std::optional<std::string> keep_from, targets_from;
  std::optional<std::string> output;

  void add(CLI::App& command) {
    site.add(command);
    add_settings(command, question_settings(), question);
    add_values(command, "--keep", "X,Y,Z|U,V", "A station that is there already, on top of --stations; may be repeated",
               [this](const std::string& text, const std::string& what) { keep.push_back(parse_station(text, what)); })
        ->group("Problem");
    add_text(command, "--keep-from", "FILE", "Stations that are there already: the scans of an E57 file", keep_from)
        ->group("Problem");
    add_text(
        command, "--targets-from", "FILE",
        "Targets and control points that are there: a table of name, x, y, z, and of those that are known sigma in "
        "metres",
        targets_from)
        ->group("Targets");
    add_settings(command, plan_settings(), config);
    const auto advanced = [&command](CLI::Option* option) { set_advanced(command, option->group("Search")); };
    advanced(add_values(
        command, "--start", "X,Y,Z|U,V", "A station of the network to start from; repeat it for each",
        [this](const std::string& text, const std::string& what) { start.push_back(parse_station(text, what)); }));
    advanced(add_value(command, "--seed-with", "greedy|exact",
                       "Start from a choice among candidates: a greedy one, or the best by branch and bound",
                       [this](const std::string& text, const std::string& what) {
                         if (text != "greedy" && text != "exact")
                           throw Error(Errc::invalid_argument, what + ": '" + text + "' is neither greedy nor exact");
                         seed_with = text;
                       }));
    advanced(add_value(
        command, "--seed-time", "T", "Time for the exact choice: 90, 90s or 2min; 1min otherwise",
        [this](const std::string& text, const std::string& what) { seed_seconds = parse_duration(text, what); }));
    add_text(command, "-o,--output", "DIR", "Folder for the results; the scene's name and -plan otherwise", output)
        ->group("Results");
    command.add_flag("--force", force, "Overwrite the results of another run")
        ->group("Results")
        ->excludes(command.get_option("--resume"));
    command
        .add_flag("--prove", prove, "Bound what any network of as many stations captures: how near does the plan come?")
        ->group("Results");
    report_head.add(command);
    command.add_flag("--no-report", no_report, "Leave out report.html and report.pdf")->group("Results");
    add_ply_doubles(command, ply)->group("Results");
    command.add_flag("--json", json, "Print one JSON object, the same as front.json");
  }
};

std::vector<PlacedStation> heads_of(Site& site, const std::vector<StationText>& stations, const std::string& what) {
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

void keep(SurveyQuestion& question, std::span<const PlacedStation> stations) {
  for (const PlacedStation& station : stations) question.existing.push_back(station.position);
  if (std::ranges::all_of(stations, [](const PlacedStation& s) { return s.setup == StationSetup(); })) return;
  for (const PlacedStation& station : stations) question.existing_setups.push_back(station.setup);
}

// Sample size for the choice of a start.
std::uint64_t start_sample(const PlanConfig& config) {
  return config.exact ? every_voxel : std::min<std::uint64_t>(config.sample_voxels, kStartSample);
}

// Heads of a greedy choice for the largest network; empty where it was stopped.
std::vector<Vec3> greedy_start(Site& site, const SurveyProblem& problem, const PlanConfig& config, Program& program,
                               std::stop_token stop) {
  ProgressLine line(program.console, "choosing a start");
  const GreedyResult greedy =
      greedy_network(site,
                     {.stations = problem.stations_max,
                      .sample_voxels = start_sample(config),
                      .existing = problem.existing,
                      .existing_setups = problem.existing_setups},
                     {.report = [&](double done) { line.update(done); }, .stop = std::move(stop)});
  std::vector<Vec3> heads;
  if (greedy.cancelled) return heads;
  for (const auto& station : greedy.stations) heads.push_back(station.position);
  spdlog::info("greedy: {} stations cover {:.4f}", heads.size(), greedy.coverage.back());
  return heads;
}

// Heads of the best choice for the largest network that was found in time; empty if none was.
std::vector<Vec3> exact_start(Site& site, const SurveyProblem& problem, const PlanConfig& config, double seconds,
                              Program& program, std::stop_token stop) {
  const auto least = [&](Objective::Kind kind) {
    return limit_of(problem, kind, Requirement::Bound::at_least).value_or(0);
  };
  const double link = least(Objective::Kind::link);
  ProgressLine line(program.console, "choosing the best start");
  const ExactResult exact = exact_network(site,
                                          {.stations = problem.stations_max,
                                           .sample_voxels = start_sample(config),
                                           .link = link,
                                           .apart_m = least(Objective::Kind::distance),
                                           .max_seconds = seconds,
                                           .existing = problem.existing,
                                           .existing_setups = problem.existing_setups},
                                          {.report = [&](double done) { line.update(done); }, .stop = std::move(stop)});
  std::vector<Vec3> heads;
  if (exact.cancelled) return heads;
  for (const auto& station : exact.stations) heads.push_back(station.position);
  if (heads.empty())
    spdlog::warn("exact: no network of {} stations was found that is connected by overlaps of {:g}",
                 problem.stations_max, link);
  else
    spdlog::info("exact: {} stations cover {:.4f}, within {:.1f} % of the best that any of the candidates can do",
                 heads.size(), exact.choice.coverage, 100 * exact.choice.gap());
  return heads;
}

// Returns what a phase does, in words.
const char* doing(const std::string& phase) {
  if (phase == "look") return "looking at what can be captured";
  if (phase == "choose") return "choosing stations";
  if (phase == "confirm") return "counting every ray";
  return "searching";
}

std::string told(const PlanProgress& now, const SurveyProblem& problem) {
  if (now.phase == "confirm" || now.evaluations == 0) return "";
  if (now.phase != "search") return fmt::format("{} places tried", now.evaluations);
  std::string text = fmt::format("{} networks tried, {:.3g} a second", now.evaluations, now.evaluations_per_second);
  if (problem.objectives.size() > 1 && !problem.fewest) text += fmt::format(", hypervolume {:.4f}", now.hypervolume);
  return text;
}

PlanResult run_plan(Site& site, const SurveyProblem& problem, PlanConfig config, Program& program,
                    const Deadline& all_by) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kSoon{3};  // before that, what a part of it takes is a guess
  constexpr double kWithResults = 1.1;      // what is missed and the files take about a tenth of the search
  ProgressLine line(program.console, doing("search"));
  std::string phase, told_phase;
  Clock::time_point begun;
  const auto report = [&](const PlanProgress& now) {
    line.set_label(doing(now.phase));
    if (now.phase != phase) phase = now.phase, begun = Clock::now();
    if (now.attainable)
      spdlog::info("{:.1f} % of the site is attainable, by the best of {} places all over the ground for each surface",
                   100 * *now.attainable, now.evaluations);
    // Tells the remaining time as soon as it is known, of the whole plan and of each long part.
    if (now.whole_seconds_left) {
      const double left = std::min(kWithResults * *now.whole_seconds_left, all_by.seconds_left());
      spdlog::info("the number of stations is nearly known; about {} left in all", duration_text(left));
    }
    if (phase != told_phase && now.seconds_left > 1 && Clock::now() - begun > kSoon) {
      told_phase = phase;
      spdlog::info("{}: about {} left", doing(phase), duration_text(now.seconds_left));
    }
    if (now.iterations > 0)
      line.update(now.done.value_or(static_cast<double>(now.iteration) / static_cast<double>(now.iterations)),
                  told(now, problem), now.seconds_left);
    else
      line.update(std::nullopt, told(now, problem), now.seconds_left);
  };
  PlanWatch watch{.report = report, .stop = program.stop, .abort = program.abort};
  if (config.max_seconds > 0) {
    constexpr double kMoment_s = 1e-3;  // 0 would be no limit
    if (!all_by.passed()) watch.seconds_after = seconds_to_write(site);
    config.max_seconds = std::max(kMoment_s, all_by.seconds_left());
  }
  return plan(site, problem, config, watch);
}

// Computes a start for the search if --seed-with asks for one.
void choose_start(Site& site, PlanOptions& options, const SurveyProblem& problem, PlanConfig& config, Program& program,
                  const Deadline& start_by) {
  if (options.seed_with.empty()) return;
  if (!options.start.empty())
    throw Error(Errc::invalid_argument, "--seed-with and --start both say where to start: give one");
  if (problem.fewest)
    throw Error(Errc::invalid_argument,
                "--seed-with: the question for the fewest stations starts from its own "
                "choice; give --stations and --objectives, or another --problem");
  config.start = options.seed_with == "greedy"
                     ? greedy_start(site, problem, config, program, start_by.stop())
                     : exact_start(site, problem, config, options.seed_seconds, program, start_by.stop());
}

// Returns what is at work on the folder, in words.
const char* writing(const std::string& part) {
  if (part == "map") return "mapping what is captured";
  if (part == "missed") return "finding why surface is missed";
  if (part == "report") return "writing the report";
  return "drawing";
}

void write_results(const std::filesystem::path& folder, Site& site, const PlanOptions& options,
                   const PlanResult& result, Program& program, const Deadline& all_by) {
  spdlog::info("writing {}", folder.string());
  remove_earlier(folder, {"bound.json"});
  if (!options.no_report && !why_no_report().empty()) spdlog::warn("no report: {}", why_no_report());
  FolderOptions wanted{.report = options.report_head.with({.command = program.command}),
                       .reports = !options.no_report,
                       .ply = options.ply};
  if (options.config.max_seconds > 0) wanted.max_seconds = all_by.seconds_left();
  WrittenFolder written;
  {
    ProgressLine line(program.console, writing("map"));
    const auto report = [&](const FolderProgress& now) {
      line.set_label(writing(now.part));
      line.update(now.done);
    };
    written = write_plan(folder, result, site, wanted, {.report = report, .stop = program.abort});
  }
  if (written.missed) tell_missed(*written.missed);
  if (!written.left_out.empty())
    spdlog::warn(
        "not written, since the {}: {}; vantage evaluate SITE --stations {} makes them, with --report report.html and "
        "the like",
        program.abort.stop_requested() ? "command was stopped" : "time was over", fmt::join(written.left_out, ", "),
        (folder / "front.json").string());
  if (options.prove) {
    const PlanEntry& chosen = result.front[answer(result)];
    prove(folder / "bound.json", site, chosen.stations, result.problem.existing.size(), result.attainable.has_value(),
          program);
  }
}

// Makes a locked folder this run's, unless it holds the results of another one. Throws Error invalid_argument.
EarlierResults take_over(const std::filesystem::path& folder, const nlohmann::json& as_given, const PlanConfig& config,
                         bool force) {
  AtomicFile::remove_leftovers_in(folder);
  const EarlierResults before = earlier_results(folder, as_given);
  if (before.another_run && !config.resume && !force)
    throw Error(Errc::invalid_argument, "plan: " + folder.string() +
                                            " holds the results of another run; give another folder with -o, --resume "
                                            "to go on with it, or --force to overwrite it");
  if (!config.resume) write_text(folder / "config.json", json_text(as_given, 2) + "\n");
  if (config.resume) {
    if (std::filesystem::exists(config.checkpoint) || std::filesystem::exists(config.checkpoint.string() + ".before"))
      spdlog::info("resuming from {}", config.checkpoint.string());
    else
      spdlog::info("{} holds no checkpoint: starting a new search", folder.string());
  }
  return before;
}

int plan_survey(CLI::App& command, PlanOptions& options, Program& program) {
  options.report_head.check();
  const double limit = options.config.max_seconds;
  const Deadline start_by(kStartTimeShare * limit, program.stop), all_by(limit, program.abort);
  Site site = open_site(command, options.site);
  const std::filesystem::path folder = options.output ? *options.output : site.name() + "-plan";
  for (const PlacedStation& station : heads_of(site, options.start, "--start"))
    options.config.start.push_back(station.position);
  if (options.keep_from)
    std::ranges::copy(stations_of_scans(site, *options.keep_from, program), std::back_inserter(options.keep));
  keep(options.question, heads_of(site, options.keep, options.keep_from ? "--keep, --keep-from" : "--keep"));
  if (options.targets_from) options.question.existing_targets = read_targets_csv(*options.targets_from);
  for (const StationText& station : options.keep) options.question.existing_names.push_back(station.name);
  const SurveyProblem problem = by_option(command, [&] { return survey_problem(site, options.question); });
  equip(site, problem);
  site.area();  // an error now, not behind the voxels

  if (program.ranks)
    site.share(program.ranks->share([](const std::string& line) { spdlog::info("{}", line); },
                                    [](const std::string& line) { spdlog::warn("{}", line); }));
  Simulator& simulator = build_simulator(site, program);
  if (program.ranks && !program.ranks->first()) program.ranks->serve(simulator);
  tell_engine(simulator);
  tell_grid(simulator);
  PlanConfig config = settled(options.config, problem, simulator.voxel_count(), site.simulator_config().seed);
  config.checkpoint = folder / "checkpoint.bin";
  choose_start(site, options, problem, config, program, start_by);

  nlohmann::json as_given = plan_options(site, options.question, problem, config);
  if (options.targets_from) as_given["plan"]["targets-from"] = *options.targets_from;
  make_folder(folder);  // an hour's search must not end at a folder that cannot be written
  const FolderLock lock(folder);
  const EarlierResults before = take_over(folder, as_given, config, options.force);
  PlanResult result = run_plan(site, problem, config, program, all_by);
  result.config.max_seconds = limit;
  if (result.front.empty())
    throw Error(Errc::invalid_argument,
                "there is nothing to write: the search ended before its first networks were evaluated");
  // Ground that is made up, and floor that is left out, are for the surveyor to decide on.
  const bool whole = !result.area || (!result.area->on_plane() &&
                                      std::ranges::none_of(result.area->not_entered(), &ClosedPart::to_decide));
  const bool in_windows = closed_stations(result.front[answer(result)]) == 0;
  const int code = whole && in_windows && (result.problem.requirements.empty() || met(result)) ? exit_ok : exit_unmet;
  const auto show = [&] {
    program.console.print(options.json ? front_json(result, simulator) + "\n" : plan_text(result, folder.string()));
    return code;
  };
  if (config.resume) {
    const auto confirmed = static_cast<std::uint64_t>(std::ranges::count(result.front, true, &PlanEntry::exact));
    if (result.evaluations < before.evaluations || (confirmed == 0 && before.confirmed > 0)) {
      spdlog::warn("{} holds better results, of {} evaluations; these of {} are not written", folder.string(),
                   before.evaluations, result.evaluations);
      return show();
    }
  }
  make_folder(folder);  // it may have been removed meanwhile
  write_text(folder / "config.json", json_text(as_given, 2) + "\n");
  write_results(folder, site, options, result, program, all_by);
  return show();
}

}  // namespace

void add_plan(CLI::App& app, Program& program) {
  add_command<PlanOptions>(
      app, program, "plan",
      "Find where to stand: the linked stations that pay, the fewest for a share of a site, or a front of networks",
      plan_survey,
      {"vantage plan site.ifc --scanner x7@11mm --for 1:50",
       "vantage plan site.glb --capture 0.95 --max-time 10min -o hall",
       "vantage plan site.glb --stations 12    the most that twelve stations can capture"});
}

}  // namespace vantage::cli
