// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/prove.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "core/options_json.hpp"
#include "core/text.hpp"
#include "vantage/candidates.hpp"

namespace vantage::cli {
namespace {

struct BoundOptions {
  SiteArguments site;
  std::vector<std::size_t> stations;
  std::vector<double> captures;
  CandidateConfig candidates{.most = 1024};
  std::optional<SampleSize> sample;
  BoundConfig bound;
  std::optional<double> link;
  bool json = false;

  void add(CLI::App& command) {
    site.add(command);
    add_values(command, "--stations", "N[,N]", "Number of stations: the most that they can capture; may be repeated",
               [this](const std::string& text, const std::string& what) {
                 for (const std::string_view one : split(text, ','))
                   stations.push_back(parse_count(one, what, 1, 1'000'000));
               })
        ->group("Bound");
    add_values(
        command, "--capture", "C[,C]",
        "Share of what is attainable: the least number of stations that captures it; may be repeated",
        [this](const std::string& text, const std::string& what) {
          for (const double one : parse_numbers(text, what, 1, 1000, {.low = 0, .high = 1, .low_included = false}))
            captures.push_back(one);
        })
        ->group("Bound");
    add_value(
        command, "--candidates", "N",
        "Largest number of positions, spread evenly over the ground; 1024 otherwise, fewer if they show all there is",
        [this](const std::string& text, const std::string& what) {
          candidates.most = parse_count(text, what, 1, 1'000'000);
          candidates.first = candidates.most;
        })
        ->group("Bound");
    add_value(command, "--sample", "N|P%", "Number or share of surveyed voxels to use; 20000 otherwise",
              [this](const std::string& text, const std::string& what) { sample = parse_sample(text, what); })
        ->group("Bound");
    add_value(
        command, "--max-time", "T", "Time limit of each linear program: 90, 90s, 2min; 2min otherwise",
        [this](const std::string& text, const std::string& what) { bound.max_seconds = parse_duration(text, what); })
        ->group("Bound");
    add_value(
        command, "--branch", "T", "Time for branch and bound towards the best choice itself; none otherwise",
        [this](const std::string& text, const std::string& what) { bound.exact_seconds = parse_duration(text, what); })
        ->group("Bound");
    add_number(command, "--link", "SHARE", "Least scan overlap of the links that connect the networks of --stations",
               link, {.low = 0, .high = 1, .low_included = false})
        ->group("Bound");
    command.add_flag("--json", json, "Print one JSON object");
  }
};

nlohmann::json heads_json(const Candidates& candidates, const std::vector<std::size_t>& chosen) {
  nlohmann::json heads = nlohmann::json::array();
  for (const std::size_t k : chosen) {
    const Vec3& head = candidates.stations()[k].position;
    heads.push_back({head.x, head.y, head.z});
  }
  return heads;
}

std::string text_of(const CoverSolution& best, std::size_t stations, const Estimate& captured) {
  const std::string at_most = fmt::format("{:>3} stations  capture at most {} of what is attainable", stations,
                                          percent(std::min(best.bound, 1.0)));
  if (best.chosen.empty()) return at_most + "; no connected network of them was found\n";
  return fmt::format(
      "{}; found {} ± {}, within {} of the best that any {} candidates can do\n"
      "              twice as many candidates raised the bound by {:.4f}{}\n",
      at_most, percent(captured.value), percent(captured.standard_error),
      percent(CoverSolution::relative_gap(best.bound, captured.value)), stations, best.spacing_term,
      best.complete ? "" : "; the linear program was cut short");
}

std::string text_of(const StationsBound& bound, double capture) {
  if (!bound.possible) return fmt::format("{:.4g} of what is attainable cannot be captured\n", capture);
  return fmt::format("{:.4g} of what is attainable takes at least {} stations among the candidates ({:.2f}){}\n",
                     capture, bound.at_least, bound.relaxation,
                     bound.chosen.empty() ? "" : fmt::format("; {} are enough", bound.chosen.size()));
}

// Lines for the terminal, and the same as JSON.
struct BoundLines {
  std::string text;
  nlohmann::json by_number = nlohmann::json::array(), by_capture = nlohmann::json::array();
};

void bound_numbers(BoundLines& bounds, const BoundOptions& options, const Candidates& candidates,
                   const StationGraph* graph, const Progress& progress) {
  const CoverageMatrix matrix = candidates.captured_matrix();
  for (const std::size_t stations : options.stations) {
    const CoverSolution found =
        max_cover({.matrix = matrix, .graph = graph, .most = stations, .link = options.link.value_or(0)}, options.bound,
                  progress);
    const Estimate reached = captured_by(candidates.attainable_counts(), matrix, found.chosen);
    bounds.text += text_of(found, stations, reached);
    bounds.by_number.push_back({{"stations", stations},
                                {"bound", found.bound},
                                {"relaxation", found.relaxation},
                                {"complete", found.complete},
                                {"half_bound", found.half_bound},
                                {"spacing_term", found.spacing_term},
                                {"reached", reached.value},
                                {"reached_se", reached.standard_error},
                                {"gap", CoverSolution::relative_gap(found.bound, reached.value)},
                                {"chosen", heads_json(candidates, found.chosen)}});
    if (progress.stopped()) break;
  }
}

void bound_captures(BoundLines& bounds, const BoundOptions& options, const Candidates& candidates,
                    const Progress& progress) {
  const CoverageMatrix matrix = candidates.captured_matrix();
  for (const double capture : options.captures) {
    if (progress.stopped()) break;
    const StationsBound found = min_cover({.matrix = matrix, .coverage = capture}, options.bound, progress);
    bounds.text += text_of(found, capture);
    bounds.by_capture.push_back({{"capture", capture},
                                 {"possible", found.possible},
                                 {"at_least", found.at_least},
                                 {"relaxation", found.possible ? nlohmann::json(found.relaxation) : nullptr},
                                 {"complete", found.complete},
                                 {"enough", heads_json(candidates, found.chosen)}});
  }
}

int bound(CLI::App& command, BoundOptions& options, Program& program) {
  const Stopwatch watch;
  Site site = open_site(command, options.site);
  if (options.stations.empty() && options.captures.empty())
    throw Error(Errc::invalid_argument, "bound: nothing to bound; give --stations N, --capture C or both");
  Simulator& simulator = build_simulator(site, program);
  tell_engine(simulator);
  tell_grid(simulator);
  if (options.sample) options.candidates.sample_voxels = options.sample->of(simulator.voxel_count());
  ProgressLine line(program.console, "tracing candidates");
  const Progress progress{.report = [&](double done) { line.update(done); }, .stop = program.stop};
  const Candidates candidates = find_candidates(site, options.candidates, progress);
  const Estimate attainable = candidates.attainable();
  if (program.stop.stop_requested() || !(attainable.value > 0)) {
    spdlog::error(attainable.value > 0 ? "stopped before the end"
                                       : "nothing that is surveyed can be captured from any candidate");
    return exit_failed;
  }
  BoundLines bounds;
  bounds.text = fmt::format(
      "attainable {:.4f} ± {:.4f} of what is surveyed, from {} candidates, no allowed position farther than "
      "{:.2f} m from one\n",
      attainable.value, attainable.standard_error, candidates.stations().size(), candidates.spacing_m());
  StationGraph graph;
  if (options.link) {
    line.set_label("links");
    graph = overlap_graph(site.surroundings(), candidates.stations(), 10'000, progress);
  }
  line.set_label("bound");
  bound_numbers(bounds, options, candidates, options.link ? &graph : nullptr, progress);
  bound_captures(bounds, options, candidates, progress);
  if (!options.json) {
    program.console.print(bounds.text);
    return exit_ok;
  }
  nlohmann::ordered_json parameters = settings_json(settings(options.candidates));
  parameters.update(settings_json(settings(options.bound)));
  program.console.print(nlohmann::json{{"attainable", attainable.value},
                                       {"attainable_se", attainable.standard_error},
                                       {"last_doubling", candidates.change()},
                                       {"candidates", candidates.stations().size()},
                                       {"candidates_ended", candidates.ended()},
                                       {"spacing", candidates.spacing_m()},
                                       {"stations", std::move(bounds.by_number)},
                                       {"captures", std::move(bounds.by_capture)},
                                       {"sample", candidates.coverage().voxels().size()},
                                       {"voxels", simulator.voxel_count()},
                                       {"seconds", seconds_json(watch, 0)},
                                       {"engine", to_string(simulator.engine().engine)},
                                       {"device", simulator.engine().device},
                                       {"seed", site.simulator_config().seed},
                                       {"options", options_json(site.settings())},
                                       {"parameters", parameters},
                                       {"version", version()}});
  return exit_ok;
}

}  // namespace

void add_bound(CLI::App& app, Program& program) {
  add_command<BoundOptions>(app, program, "bound",
                            "Bound the coverage of a number of stations, and the number for a coverage", bound,
                            {"vantage bound site.glb --stations 10,20 --capture 0.9"});
}

}  // namespace vantage::cli
