// SPDX-License-Identifier: Apache-2.0
#include "vantage/next.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"
#include "core/read_json.hpp"
#include "core/text.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage::cli {
namespace {

// Share of points near the model below which a scan gets a warning.
constexpr double kSurelyNear = 0.6;
// Number of things that are listed singly. Further ones, and small ones that hide little, are listed together.
constexpr std::size_t kToldThings = 8;
constexpr double kLittle = 0.0005, kLargeThing_m = 1;
// Gain below which a planned station is no longer worth its time.
constexpr double kWorthless = 0.01;

struct NextOptions {
  SiteArguments site;
  StationOptions planned;
  NextConfig config;
  std::optional<std::string> scans, output;
  bool json = false;

  void add(CLI::App& command) {
    site.add(command);
    add_text(command, "--scans", "FILE|DIR",
             "Scans that were taken: an E57 or PTX file, or a folder of such files; their poses may be rough", scans)
        ->group("Next stations");
    planned.add(command);
    add_settings(command, next_settings(), config);
    add_text(command, "-o,--output", "DIR", "Folder for the results; next otherwise", output)->group("Results");
    command.add_flag("--json", json, "Print one JSON object, the same as next.json");
  }
};

std::string metres(const Vec3& p) { return fmt::format("{:.2f},{:.2f},{:.2f}", p.x, p.y, p.z); }

std::string in_words(const Box& box) {
  const Vec3 size = box.size(), at = box.centre();
  return fmt::format("{:.1f} × {:.1f} × {:.1f} m at {:.2f},{:.2f}", size.x, size.y, size.z, at.x, at.y);
}

std::string scans_text(const Day& day, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t s = 0; s < day.scans.size(); ++s) {
    const TakenScan& scan = day.scans[s];
    text += fmt::format("taken      {} at {}: {} points, alone {} of what is attainable", names[s], metres(scan.head),
                        grouped(scan.points), percent(day.answer.captured_by[s]));
    text += scan.fit.fitted ? fmt::format("; moved by {:.0f} mm and {:.2f}° onto the model, {:.0f} mm from it\n",
                                          1e3 * scan.fit.shift_m, scan.fit.turn.in_degrees(), 1e3 * scan.fit.residual_m)
                            : "; it " + scan.fit.why + "\n";
    if (scan.fit.fitted && scan.fit.near_share < kSurelyNear)
      text += fmt::format("{:11}only {} of its points are near the model: is its pose right?\n", "",
                          percent(scan.fit.near_share));
  }
  return text;
}

std::string missing_text(const Day& day) {
  const NextAnswer& answer = day.answer;
  std::string text = fmt::format("captured   {} ± {} of what is attainable{}\n", percent(answer.captured.value),
                                 percent(answer.captured.standard_error),
                                 day.config.unknown ? ", the edge of unknown space counted" : "");
  std::size_t told = 0, others = 0;
  double rest = 0;
  for (std::size_t k = 0; k < day.changes.things.size(); ++k) {
    const Box& box = day.changes.things[k].box;
    const Vec3 size = box.size();
    if (told >= kToldThings || (answer.hidden_by[k] < kLittle && std::max({size.x, size.y, size.z}) < kLargeThing_m)) {
      rest += answer.hidden_by[k], ++others;
      continue;
    }
    text += fmt::format("{:11}a thing of {} is not in the model and hides {}\n", told++ == 0 ? "found" : "",
                        in_words(box), percent(answer.hidden_by[k]));
  }
  if (others > 0)
    text += fmt::format("{:11}{} {}thing{} not in the model, {} hidden\n", told == 0 ? "found" : "", others,
                        told == 0 ? "small " : "smaller ", others == 1 ? " is" : "s are", percent(rest));
  bool first = true;
  for (const SeenThrough& opening : day.changes.seen_through) {
    text += fmt::format("{:11}\"{}\" is in the model, and scans saw through {} of it; {}\n", first ? "open" : "",
                        opening.mesh, in_words(opening.box),
                        opening.removed ? "it counts as open" : "it still counts as closed");
    first = false;
  }
  first = true;
  for (const FoundThing& thing : day.changes.passing) {
    text += fmt::format("{:11}a thing of {} was there in one scan, and another saw through it: it does not count\n",
                        first ? "passing" : "", in_words(thing.box));
    first = false;
  }
  text += fmt::format("missing    {} that no scan has seen well enough yet\n", percent(answer.not_seen));
  if (day.config.unknown)
    text += fmt::format("unknown    {} that is the edge of space which no scan saw\n", percent(answer.unknown));
  return text;
}

std::string planned_text(const Day& day) {
  std::string text;
  for (std::size_t k = 0; k < day.planned.size(); ++k) {
    const PlannedStation& one = day.answer.planned[k];
    const std::string head = fmt::format("{:11}{} ", k == 0 ? "plan" : "", day.planned_names[k]);
    if (one.taken_as)
      text += head + "is taken\n";
    else if (one.status != StationStatus::ok)
      text += head + explain(one.status) + ", as the site was found: leave it out\n";
    else if (one.chosen)
      text += head + fmt::format("is worth it: it adds {} now\n", percent(one.gain));
    else if (one.gain < kWorthless)
      text += head + fmt::format("is no longer worth it: it would add {}\n", percent(one.gain));
    else
      text += head + fmt::format("is not needed with the next stations: alone it would add {}\n", percent(one.gain));
  }
  return text;
}

std::string next_text(const Day& day, const std::vector<std::string>& names, Site& found) {
  const NextAnswer& answer = day.answer;
  const NextConfig& config = day.config;
  std::string text;
  for (std::size_t k = 0; k < answer.next.size(); ++k) {
    const NextStation& next = answer.next[k];
    text += fmt::format("{:11}{}. {} at {} adds {}, then {}", k == 0 ? "next" : "", k + 1, names[day.scans.size() + k],
                        metres(next.station.position), percent(next.gain), percent(next.captured));
    if (config.link > 0)
      text += next.linked_to && next.overlap >= config.link
                  ? fmt::format("; linked to {} by {:.2f}", names[*next.linked_to], next.overlap)
                  : fmt::format("; not linked, its best overlap is {:.2f}: use targets", next.overlap);
    if (next.ties) text += fmt::format("; ties {} to the others", names[*next.ties]);
    text += "\n";
  }
  if (answer.next.empty() && answer.enough)
    text += fmt::format("next       nothing: {} is captured, and all scans are linked\n", percent(config.capture));
  if (!answer.enough)
    text += fmt::format("to do      {}\n",
                        answer.linked ? fmt::format("no {} further stations reach {}: the best have {}", config.most,
                                                    percent(config.capture), percent(answer.captured_then))
                                      : fmt::format("no choice links all scans by an overlap of {:g}: use targets, or "
                                                    "ask for less with --link",
                                                    config.link));
  for (const SummaryLine& line : ground_lines(found.scene(), found.area(), day.stations()))
    text += fmt::format("{:11}{}\n", line.heading, line.text);
  if (!answer.next.empty())
    text += fmt::format("on site    about {:.0f} min for {} station{}\n", answer.visit.minutes, answer.next.size(),
                        answer.next.size() == 1 ? "" : "s");
  return text;
}

int next(CLI::App& command, NextOptions& options, Program& program) {
  if (options.site.config_file) apply_layer(command, read_json(*options.site.config_file), *options.site.config_file);
  if (!options.scans) throw Error(Errc::invalid_argument, "next: which scans were taken? Give --scans FILE_OR_DIR");
  if (options.site.scene.empty()) options.site.scene = *options.scans, options.config.unknown = true;
  Site site = open_site(command, options.site);
  Day day{.config = options.config};
  if (command.count("--station") == 0) options.planned.typed.clear();  // those of a scene are no plan
  if (options.planned.file || !options.planned.typed.empty()) {
    const std::vector<SiteStation> plan = place(site, options.planned.read(max_stations));
    day.planned = placed_of(plan), day.planned_names = names_of(plan);
  }
  site.area();  // an error now, not behind the scans

  ProgressLine line(program.console, "reading the scans");
  const Progress progress{.report = [&](double done) { line.update(done); }, .stop = program.stop};
  day.scans = read_taken_scans(*options.scans, 0.02, progress);
  if (program.stop.stop_requested()) throw Stopped{};
  spdlog::info("{}: {} scan{}", *options.scans, day.scans.size(), day.scans.size() == 1 ? "" : "s");
  line.set_label("comparing the scans with the model");
  if (!find_changes(site, day, progress)) throw Stopped{};

  Site found = changed_site(site, day.changes);
  Simulator& simulator = build_simulator(found, program);
  tell_engine(simulator);
  tell_grid(simulator);
  line.set_label("choosing the next stations");
  std::optional<NextAnswer> answer = next_stations(found, day.scans, day.changes, day.planned, day.config, progress);
  if (!answer) throw Stopped{};
  day.answer = std::move(*answer);

  const std::filesystem::path folder = options.output.value_or("next");
  make_folder(folder);
  write_next(folder, day, found);
  if (options.json) {
    program.console.print(nlohmann::json::parse(next_json(day, found)));
  } else {
    const std::vector<std::string> names = day.names();
    program.console.print(scans_text(day, names) + missing_text(day) + planned_text(day) +
                          next_text(day, names, found) + "results in " + folder.string() + "\n");
  }
  return day.answer.enough ? exit_ok : exit_unmet;
}

}  // namespace

void add_next(CLI::App& app, Program& program) {
  add_command<NextOptions>(app, program, "next", "Where to stand next, by the scans that were taken", next,
                           {"vantage next site.glb --scans day --stations hall/front.json"});
}

}  // namespace vantage::cli
