// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "cli/command.hpp"
#include "cli/dropped_points.hpp"
#include "cli/missed.hpp"
#include "cli/options.hpp"
#include "cli/report.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"
#include "core/options_json.hpp"
#include "formats/run_json.hpp"
#include "formats/station_json.hpp"
#include "map/shown_links.hpp"

namespace vantage::cli {
namespace {

struct EvaluateCommandOptions {
  SiteArguments site;
  StationOptions stations;
  RegistrationOptions registration;
  OnSiteOptions on_site;
  TargetOptions target;
  std::optional<std::string> targets, proposed_targets;
  bool exact = false, skip = false, no_overlap = false, with_registration = false, attainable = false;
  std::optional<SampleSize> sample, registration_sample;
  std::optional<double> error, link, link_overlap;
  std::optional<BeamOptions> beam;
  std::optional<std::string> cartography, rooms, elements, matrix, picture, sessions;
  std::vector<std::string> station_files, waypoint_files, registration_files, reports;
  MissedFiles missed;
  ReportHead report_head;
  PlyCoordinates ply = PlyCoordinates::floats;
  bool json = false;

  void add(CLI::App& command) {
    site.add(command);
    stations.add(command);
    auto* exact_flag = command.add_flag("--exact", exact, "Trace every ray; the default")->group("Evaluation");
    auto* skip_flag =
        command
            .add_flag("--skip", skip,
                      "Leave out rays that cannot change a count; points off the surveyed meshes are not counted then")
            ->group("Evaluation");
    auto* sample_option =
        add_value(command, "--sample", "N|P%", "Estimate from so many surveyed voxels, or that share of them",
                  [this](const std::string& text, const std::string& what) { sample = parse_sample(text, what); })
            ->group("Evaluation");
    auto* error_option =
        add_number(command, "--error", "E", "Estimate with as many voxels as this standard error takes", error,
                   {.low = 1e-6, .high = 1})
            ->group("Evaluation");
    sample_option->excludes(exact_flag)->excludes(skip_flag);
    error_option->excludes(exact_flag)->excludes(skip_flag)->excludes(sample_option);
    add_settings(command, beam_settings(), beam);
    command.add_flag("--no-overlap", no_overlap, "Coverage only")->group("Evaluation");
    command.add_flag("--registration", with_registration, "Predict the error of the registered scans")
        ->group("Registration");
    add_settings(command, registration_settings(), registration);
    add_value(
        command, "--registration-voxels", "N|P%",
        "Predict it from so many surveyed voxels, or that share of them; 100% is every voxel. Otherwise from a "
        "sample that grows until the error is known to 2 %, or to 0.02 mm",
        [this](const std::string& text, const std::string& what) { registration_sample = parse_sample(text, what); })
        ->group("Registration")
        ->excludes(sample_option)
        ->excludes(error_option);
    add_texts(command, "--registration-map", "FILE",
              "Write the predicted error on the surface, in false colours: .ply, or .png or .svg from above; may be "
              "repeated",
              registration_files)
        ->group("Registration");
    add_text(command, "--targets-from", "FILE",
             "Targets that tie scans together, and control points: a table of name, x, y, z, and of those that are "
             "known sigma in metres; takes --registration",
             targets)
        ->group("Targets");
    add_text(command, "--propose-targets", "FILE",
             "Propose targets where surfaces do not register the scans well enough, and write all to this .csv; takes "
             "--registration",
             proposed_targets)
        ->group("Targets");
    add_settings(command, target_settings(), target);
    command
        .add_flag("--attainable", attainable,
                  "Tell what is captured as a share of what is attainable, too: takes as long as some hundred sampled "
                  "stations")
        ->group("Evaluation");
    add_number(
        command, "--link", "SHARE",
        fmt::format("Scan overlap from which on two stations count as linked, 0 to 1; {} otherwise", default_link),
        link, {.low = 0, .high = 1})
        ->group("Evaluation");
    add_settings(command, on_site_settings(), on_site, "Evaluation");
    add_text(command, "--cartography", "FILE", "Write every surveyed voxel with its count, in false colours: .ply",
             cartography)
        ->group("Results");
    missed.add(command);
    add_text(command, "--rooms", "FILE",
             "Write what is captured of each room that the model names, and why one has no station: .csv", rooms)
        ->group("Results");
    add_text(
        command, "--elements", "FILE",
        "Write for each element of the model what is captured of it, how flatly and how densely, and its predicted "
        "deviation: .csv",
        elements)
        ->group("Results");
    add_text(command, "--overlap-csv", "FILE", "Write the overlap matrix: .csv", matrix)->group("Results");
    add_text(
        command, "--sessions", "FILE",
        "Write the sessions that --day splits the round into, with the stations of each in order and their times: .csv",
        sessions)
        ->group("Results");
    add_text(command, "--picture", "FILE", "Draw the stations and their overlaps from above: .png or .svg", picture)
        ->group("Results");
    add_texts(command, "--write-stations", "FILE",
              "Write the stations for the crew: .dxf, and where --crs is given .geojson or .kml; may be repeated",
              station_files)
        ->group("Results");
    add_texts(command, "--waypoints", "FILE",
              "Write the round for a robot, with poses and times at each station: .csv or .json; may be repeated",
              waypoint_files)
        ->group("Results");
    add_texts(command, "--report", "FILE",
              "Write all of it as a page for a browser, .html, or on paper, .pdf; may be repeated", reports)
        ->group("Results");
    report_head.add(command);
    add_ply_doubles(command, ply)->group("Results");
    add_number(command, "--link-overlap", "W",
               "Draw as links overlaps (equation 11) of at least W, 0 to 1, in place of scan overlaps", link_overlap,
               {.low = 0, .high = 1})
        ->group("Results");
    command.add_flag("--json", json, "Print one JSON object");
  }

  bool sampled() const { return sample || error; }
  bool wants_field() const {
    return !sampled() && (cartography || rooms || elements || !missed.files.empty() || !registration_files.empty() ||
                          !reports.empty());
  }
};

// Finds what is attainable, as `plan` does before its search.
Candidates attainable_by(Site& site, std::uint64_t sample, Program& program) {
  ProgressLine line(program.console, "looking at what can be captured");
  return find_candidates(site, {.sample_voxels = sample},
                         {.report = [&](double done) { line.update(done); }, .stop = program.stop});
}

// Throws Error invalid_argument for options that do not go together, and files that no writer has.
void check(const EvaluateCommandOptions& options, const Site& site) {
  const auto refuse = [](const std::string& why) { throw Error(Errc::invalid_argument, why); };
  const auto must_end = [&](const std::optional<std::string>& file, const char* what, auto... endings) {
    if (file && (!file->ends_with(endings) && ...))
      refuse(std::string(what) + ": '" + *file + "' must end with" +
             (std::string() + ... + (std::string(" ") + endings)));
  };
  must_end(options.cartography, "--cartography", ".ply");
  must_end(options.picture, "--picture", ".png", ".svg");
  must_end(options.matrix, "--overlap-csv", ".csv");
  must_end(options.rooms, "--rooms", ".csv");
  must_end(options.elements, "--elements", ".csv");
  must_end(options.sessions, "--sessions", ".csv");
  if (options.sessions && !options.on_site.day_min)
    refuse("--sessions: a round is split by --day, which was not given");
  if (options.rooms && site.scene().rooms().empty())
    refuse("--rooms: the model names no rooms, as IFC and floor plans do");
  must_end(options.proposed_targets, "--propose-targets", ".csv");
  if ((options.targets || options.proposed_targets) && !options.with_registration)
    refuse("--targets-from and --propose-targets: targets are for --registration, which was not asked for");
  for (const std::string& file : options.station_files) {
    must_end(file, "--write-stations", ".dxf", ".geojson", ".kml");
    if (!file.ends_with(".dxf") && site.crs().empty())
      refuse("--write-stations: longitude and latitude need the coordinate system of the site: give --crs");
  }
  for (const std::string& file : options.waypoint_files) must_end(file, "--waypoints", ".csv", ".json");
  for (const std::string& file : options.reports) must_end(file, "--report", ".html", ".pdf");
  if (!options.reports.empty() && !why_no_report().empty()) refuse("--report: " + why_no_report());
  options.missed.check();
  options.report_head.check();
  for (const std::string& file : options.registration_files)
    must_end(file, "--registration-map", ".ply", ".png", ".svg");

  if (options.beam && (options.sampled() || options.attainable))
    refuse("--returns: a beam with a width takes every ray; leave out --sample, --error and --attainable");
  if (options.cartography && options.sampled()) refuse("--cartography: shows every voxel, and so needs --exact");
  if ((!options.missed.files.empty() || options.rooms) && options.sampled())
    refuse("--missed and --rooms: look at every voxel, and so need --exact");
  if (options.elements && options.sampled()) refuse("--elements: looks at every voxel, and so needs --exact");
  if (options.elements && options.no_overlap)
    refuse("--elements: tells which stations see an element, which --no-overlap leaves out");
  if ((options.matrix || options.picture) && options.no_overlap)
    refuse("--overlap-csv and --picture show overlaps, which --no-overlap leaves out");
  if (!options.registration_files.empty() && (options.sampled() || !options.with_registration))
    refuse("--registration-map: shows the error of --registration on every voxel, and so needs both it and --exact");
  if (options.registration_sample && !options.with_registration)
    refuse("--registration-voxels: says how --registration is predicted, which was not asked for");
  if (options.with_registration && options.no_overlap)
    refuse("--registration: looks at what scans share, which --no-overlap leaves out");
}

// Options for the evaluation, except for names and attainable coverage.
EvaluationOptions evaluation_options(const EvaluateCommandOptions& options, Simulator& simulator,
                                     const Network& network, const Progress& progress) {
  EvaluationOptions chosen{.overlap = !options.no_overlap,
                           .skip = options.skip,
                           .field = options.wants_field(),
                           .beam = options.beam,
                           .link = options.link.value_or(default_link)};
  if (options.sample) chosen.sample_voxels = options.sample->of(simulator.voxel_count());
  if (options.error)
    chosen.sample_voxels =
        voxels_for_standard_error(simulator, {&network, 1}, *options.error, chosen.overlap, progress);
  if (options.with_registration) chosen.registration = options.registration;
  if (options.registration_sample) {
    const std::uint64_t voxels = simulator.voxel_count(), some = options.registration_sample->of(voxels);
    chosen.registration_voxels = some < voxels ? some : every_voxel;
  }
  return chosen;
}

// Pictures and drawings show the links of the summary, unless those of the method are asked for.
StationLinks drawn_links(const EvaluateCommandOptions& options, const Evaluation& found) {
  if (options.link_overlap) return station_links(found.overlap_matrix, *options.link_overlap, found.stations);
  return links_to_draw(found);
}

std::vector<SummaryLine> lines_on_site(Site& site, const Evaluation& found) {
  std::vector<SummaryLine> lines = ground_lines(site.scene(), site.area(), found.stations);
  std::ranges::move(again_lines(site.scene(), found), std::back_inserter(lines));
  return lines;
}

// `judged`: where it was looked at.
void write_files(const EvaluateCommandOptions& options, Site& site, Simulator& simulator, const Evaluation& found,
                 const std::vector<std::string>& names, const MissedVoxels* judged, Program& program) {
  if (options.cartography) write_coverage_ply(*options.cartography, simulator, found.field, options.ply);
  std::vector<ElementShare> elements;
  if (options.elements || (judged && (options.missed.with_elements() || !options.reports.empty())))
    elements = element_shares(simulator, found, found.field);
  if (judged)
    write_missed(std::vector<std::filesystem::path>(options.missed.files.begin(), options.missed.files.end()), *judged,
                 site, found.stations, elements, options.ply);
  if (judged && options.rooms)
    write_rooms_csv(*options.rooms, site.scene().rooms(), judged->rooms, found.stations, names);
  if (options.elements) write_elements_csv(*options.elements, elements);
  if (options.sessions) write_sessions_csv(*options.sessions, found);
  if (options.matrix) write_overlap_csv(*options.matrix, found.overlap_matrix);
  if (options.proposed_targets) write_targets_csv(*options.proposed_targets, found.targets, names);
  for (const std::string& file : options.registration_files) {
    if (file.ends_with(".ply"))
      write_registration_ply(file, simulator, found.field, *found.registration, options.ply);
    else
      draw_registration(file, site, found.field, *found.registration, found.stations,
                        "Registration error on the surface (predicted)");
  }
  const StationLinks links = drawn_links(options, found);
  if (options.picture) {
    const std::vector<StationError> errors =
        found.registration ? found.registration->stations : std::vector<StationError>();
    draw_plan_view(*options.picture, site, found.stations, links,
                   fmt::format("{} station{}: coverage {:.3f}, overlap {:.3f}", names.size(),
                               names.size() == 1 ? "" : "s", found.value("coverage"), found.value("overlap")),
                   names, errors, found.targets);
  }
  for (const std::string& file : options.station_files)
    write_stations(file, found.stations, names, links, site, found.targets);
  for (const std::string& file : options.waypoint_files) write_waypoints(file, found, site.scanners(), site.crs());
  if (!options.reports.empty())
    write_reports(std::vector<std::filesystem::path>(options.reports.begin(), options.reports.end()), found, site,
                  options.report_head.with({.missed = judged, .elements = elements}), program, program.abort);
}

// `traced`: with every ray, also where a sample has all voxels.
nlohmann::json stations_json(const std::vector<SiteStation>& stations, const Evaluation& found,
                             const std::vector<std::string>& names, bool traced, std::span<const Scanner> scanners) {
  const NetworkCounts& counts = found.counts;
  nlohmann::json rows = nlohmann::json::array();
  const std::vector<KnownPoints> known_points = vantage::known_points(found);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    auto row = to_json(stations[k], names[k], scanners);
    row["points"] = nullptr;
    row["points_on_surveyed"] = nullptr;
    if (traced && !counts.points.empty()) row["points"] = counts.points[k];
    if (traced && !counts.points_on_surveyed.empty()) row["points_on_surveyed"] = counts.points_on_surveyed[k];
    const auto move = std::ranges::find(found.moves, k, &StationMove::station);
    row["move_to"] = nullptr;
    if (move != found.moves.end() && move->to) {
      const Vec3& to = move->to->position;
      row["move_to"] = {to.x, to.y, to.z};
    }
    if (!known_points.empty()) add_set_up(row, known_points[k], found);
    row["dropped"] = row["mixed"] = nullptr;
    if (!counts.dropped.empty()) row["dropped"] = dropped_json(counts.dropped[k]);
    if (!counts.mixed.empty()) row["mixed"] = nlohmann::json(mixed_json(counts.mixed[k]));
    rows.push_back(std::move(row));
  }
  return rows;
}

nlohmann::json json_of(const EvaluateCommandOptions& options, const Site& site, const Simulator& simulator,
                       const Evaluation& found) {
  nlohmann::json json = nlohmann::json::parse(evaluation_json(found));
  if (found.registration) json["registration"]["surfaces"] = to_string(options.registration.surfaces);
  if (options.sampled()) json["sample"] = found.counts.voxels;
  json["voxel_size"] = simulator.voxel_size_m();
  json["engine"] = to_string(simulator.engine().engine);
  json["device"] = simulator.engine().device;
  json["seed"] = site.simulator_config().seed;
  json["options"] = options_json(site.settings());
  json["version"] = version();
  return json;
}

std::string evaluation_text(const Evaluation& found, const std::vector<std::string>& names, bool traced,
                            std::span<const Scanner> scanners) {
  std::string text = station_table(
      found.stations, names,
      traced ? std::span<const std::uint64_t>(found.counts.points_on_surveyed) : std::span<const std::uint64_t>(),
      scanners, set_ups_of(found));
  const auto with_error = [&](const char* measure) {
    const Estimate& estimate = found.values.at(measure);
    return traced ? fmt::format("{:.4f}", estimate.value)
                  : fmt::format("{:.4f} ± {:.4f}", estimate.value, estimate.standard_error);
  };
  text += "coverage " + with_error("coverage") + "\n";
  if (found.values.contains("overlap")) text += "overlap  " + with_error("overlap") + "\n";
  if (found.registration) {
    const Estimate& error_mm = found.values.at("registration");
    text += fmt::format("registration {:.2f}{} mm, worst station {}: {:.2f} mm\n", error_mm.value,
                        error_mm.standard_error > 0 ? fmt::format(" ± {:.2f}", error_mm.standard_error) : "",
                        names[found.registration->worst_station], 1e3 * found.registration->worst_m);
  }
  if (std::ranges::any_of(found.counts.dropped, [](const DroppedPoints& lost) { return lost.points > 0; }))
    text += dropped_text(found.counts) + "\n";
  return text + "\n" + summary_text(found);
}

// "7 targets proposed: predicted error 28.5 mm without them, 2.1 mm with them"
std::string proposal_text(const TargetProposal& proposal, AccuracyClass wanted) {
  const auto many = std::ranges::count_if(proposal.targets, &Target::proposed);
  const double without = 1e3 * proposal.without.rms_m;
  if (many > 0)
    return fmt::format("{} target{} proposed: predicted error {:.2f} mm without, {:.2f} mm with {}", many,
                       many == 1 ? "" : "s", without, 1e3 * proposal.with.rms_m, many == 1 ? "it" : "them");
  if (error_at_95_percent(proposal.without.rms_m) <= largest_error_m(wanted))
    return fmt::format("no target is needed: predicted error {:.2f} mm", without);
  return fmt::format(
      "no target would help: predicted error {:.2f} mm. A target must lie within {:.1f} m of two stations, in free "
      "view "
      "of both. Put stations closer together, or take finer steps or larger targets",
      without, proposal.reach_m);
}

int evaluate(CLI::App& command, EvaluateCommandOptions& options, Program& program) {
  const Stopwatch watch;
  Site site = open_site(command, options.site);
  const auto stations = place(site, options.stations.read(max_stations));
  warn_of_unusable(site, stations);
  const auto placed = placed_of(stations);
  const auto names = names_of(stations);
  check(options, site);

  Simulator& simulator = build_simulator(site, program);
  tell_engine(simulator);
  tell_grid(simulator);
  ProgressLine line(program.console, "counting every ray");
  const Progress progress{.report = [&](double done) { line.update(done); }, .stop = program.stop};
  EvaluationOptions chosen = evaluation_options(options, simulator, to_network(stations), progress);
  chosen.names = names;
  chosen.target = with_class_of(site.options(), options.target);
  if (options.targets) chosen.targets = read_targets_csv(*options.targets);
  if (options.proposed_targets) {
    TargetOptions wanted = chosen.target;
    wanted.exact = !options.sampled();
    std::optional<TargetProposal> proposal =
        propose_targets(site, placed, options.registration, wanted, chosen.targets, progress);
    if (!proposal) throw Stopped{};
    spdlog::info("{}", proposal_text(*proposal, wanted_class(chosen.target)));
    chosen.targets = std::move(proposal->targets);
  }
  Candidates candidates;
  if (options.attainable) {
    candidates = attainable_by(
        site, std::min(chosen.sample_voxels.value_or(CandidateConfig().sample_voxels), simulator.voxel_count()),
        program);
    chosen.attainable = &candidates.attainable_counts(), chosen.attainable_growth = candidates.growth();
  }
  Evaluation found = site.evaluate(placed, chosen, options.on_site, progress);
  if (found.counts.cancelled) throw Stopped{};

  std::optional<MissedVoxels> judged;
  if (!options.missed.files.empty() || options.rooms || (!options.reports.empty() && !options.sampled())) {
    judged = judge_missed(site, found.field, program);
    if (!judged && program.abort.stop_requested()) return exit_failed;
  }
  write_files(options, site, simulator, found, names, judged ? &*judged : nullptr, program);
  if (options.json) {
    nlohmann::json json = json_of(options, site, simulator, found);
    if (site.has_area()) {
      json["floor"] = nlohmann::json::parse(floor_json(site.scene(), site.area(), placed).dump());
      for (const auto& [heading, line] : lines_on_site(site, found))
        json["summary"].push_back({{"heading", heading}, {"text", line}});
    }
    json["stations"] = stations_json(stations, found, names, !options.sampled(), site.scanners());
    json["seconds"] = seconds_json(watch, found.counts.trace_seconds);
    program.console.print(json);
  } else {
    std::string text = evaluation_text(found, names, !options.sampled(), site.scanners());
    if (site.has_area()) text += lines_text(lines_on_site(site, found));
    program.console.print(text);
  }
  return closed_stations(found) == 0 ? exit_ok : exit_unmet;
}

}  // namespace

void add_evaluate(CLI::App& app, Program& program) {
  add_command<EvaluateCommandOptions>(
      app, program, "evaluate", "Coverage and overlap of a network of stations", evaluate,
      {"vantage evaluate site.glb --stations hall/front.json --exact --picture hall.png",
       "vantage evaluate site.glb --station 2,3,1.6 --station 9,3,1.6 --attainable"});
}

}  // namespace vantage::cli
