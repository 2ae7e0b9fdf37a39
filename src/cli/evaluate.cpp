// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <filesystem>

#include "cli/command.hpp"
#include "cli/dropped_points.hpp"
#include "cli/missed.hpp"
#include "cli/options.hpp"
#include "cli/report.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"

namespace vantage::cli {
namespace {

// Of voxels, for what can be seen at all: known to .004.
constexpr std::uint64_t visible_sample = 20'000;

struct EvaluateCommandOptions {
  SiteArguments site;
  StationOptions stations;
  RegistrationOptions registration;
  OnSiteOptions on_site;
  bool exact = false, skip = false, no_overlap = false, with_registration = false, visible = false;
  std::optional<SampleSize> sample;
  std::optional<double> error, link, link_overlap;
  std::optional<std::string> cartography, matrix, picture;
  std::vector<std::string> station_files, registration_files, reports;
  MissedFiles missed;
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
    command.add_flag("--no-overlap", no_overlap, "Coverage only")->group("Evaluation");
    command.add_flag("--registration", with_registration, "Predict the error of the registered scans")
        ->group("Registration");
    add_settings(command, registration_settings(), registration);
    add_texts(command, "--registration-map", "FILE",
              "Write the predicted error on the surface, in false colours: .ply, or .png or .svg from above; may be "
              "repeated",
              registration_files)
        ->group("Registration");
    command
        .add_flag("--visible", visible,
                  "Tell it as a share of what can be seen at all, too: takes as long as some hundred sampled stations")
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
    add_text(command, "--overlap-csv", "FILE", "Write the overlap matrix: .csv", matrix)->group("Results");
    add_text(command, "--picture", "FILE", "Draw the stations and their overlaps from above: .png or .svg", picture)
        ->group("Results");
    add_texts(command, "--write-stations", "FILE",
              "Write the stations for the crew: .dxf, and where --crs is given .geojson or .kml; may be repeated",
              station_files)
        ->group("Results");
    add_texts(command, "--report", "FILE",
              "Write all of it as a page for a browser, .html, or on paper, .pdf; may be repeated", reports)
        ->group("Results");
    add_number(command, "--link-overlap", "W",
               "Draw as links overlaps (equation 11) of at least W, 0 to 1, in place of scan overlaps", link_overlap,
               {.low = 0, .high = 1})
        ->group("Results");
    command.add_flag("--json", json, "Print one JSON object");
  }

  std::optional<RegistrationModel> model() const {
    return with_registration ? std::optional(registration.model) : std::nullopt;
  }
};

// As `plan` looks at it before it searches.
Estimate visible_share(Site& site, Simulator& simulator, std::uint64_t sample, Program& program) {
  ProgressLine line(program.console, "look");
  return find_candidates(simulator, site.area(), site.clash(), {.most = 512, .sample_voxels = sample},
                         {.report = [&](double done) { line.update(done); }, .stop = program.stop})
      .visible();
}

NetworkCounts evaluate_sample(Simulator& simulator, const Network& network, const EvaluateCommandOptions& options,
                              const Progress& progress) {
  const bool overlap = !options.no_overlap;
  const std::optional<RegistrationModel> model = options.model();
  const std::uint64_t voxels =
      options.error ? voxels_for_standard_error(simulator, {&network, 1}, *options.error, overlap, progress)
                    : options.sample->of(simulator.voxel_count());
  return simulator
      .evaluate_sampled({&network, 1}, {.voxels = voxels, .overlap = overlap, .registration = model}, progress)
      .front();
}

// Over all surfaces, surveyed or not, by every ray of a coarser pattern: scan overlaps and, where it goes by them,
// registration.
struct Surroundings {
  NetworkCounts counts;
  std::uint64_t voxels = 0;
};
Surroundings surroundings(const Simulator& simulator, const Network& network,
                          const std::optional<RegistrationModel>& registration, std::stop_token stop) {
  Simulator all = surroundings_of(simulator);
  return {
      all.evaluate(network, {.overlap = true, .registration = registration}, {.report = {}, .stop = std::move(stop)}),
      all.voxel_count()};
}

// Millimetres; axes of the standard ellipsoid of each head, longest first, in the survey frame.
nlohmann::json registration_json(const RegistrationError& error, const Estimate& whole) {
  const auto mm = [](const Vec3& v) { return nlohmann::json{1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; };
  nlohmann::json stations = nlohmann::json::array();
  for (const StationError& station : error.stations)
    stations.push_back({{"error_mm", 1e3 * station.rms_m},
                        {"head_axes_mm", {mm(station.axes[0]), mm(station.axes[1]), mm(station.axes[2])}}});
  return {{"error_mm", 1e3 * whole.value},
          {"standard_error_mm", 1e3 * whole.standard_error},
          {"worst_mm", 1e3 * error.worst_m},
          {"worst_station", error.worst_station + 1},
          {"stations", std::move(stations)}};
}

nlohmann::json matrix_json(const OverlapMatrix& overlap) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < overlap.size(); ++i) rows.push_back(overlap.row(i));
  return rows;
}

nlohmann::json lines_json(const SurveySummary& summary) {
  nlohmann::json lines = nlohmann::json::array();
  for (const auto& [heading, text] : summary_lines(summary)) lines.push_back({{"heading", heading}, {"text", text}});
  return lines;
}

int evaluate(CLI::App& command, EvaluateCommandOptions& options, Program& program) {
  const Stopwatch watch;
  Site site = open_site(command, options.site);
  const auto stations = place(site, options.stations.read(max_stations));
  warn_of_unusable(stations);
  const auto placed = placed_of(stations);
  const auto names = names_of(stations);
  const bool sampled = options.sample || options.error;
  const bool overlap = !options.no_overlap;
  const auto must_end = [](const std::optional<std::string>& file, const char* what, auto... endings) {
    if (file && (!file->ends_with(endings) && ...))
      throw Error(Errc::invalid_argument, std::string(what) + ": '" + *file + "' must end with" +
                                              (std::string() + ... + (std::string(" ") + endings)));
  };
  must_end(options.cartography, "--cartography", ".ply");
  must_end(options.picture, "--picture", ".png", ".svg");
  must_end(options.matrix, "--overlap-csv", ".csv");
  for (const std::string& file : options.station_files) {
    must_end(file, "--write-stations", ".dxf", ".geojson", ".kml");
    if (!file.ends_with(".dxf")) to_wgs84(crs_text(site), {});  // an error now, not behind the rays
  }
  if (options.cartography && sampled)
    throw Error(Errc::invalid_argument, "--cartography: shows every voxel, and so needs --exact");
  for (const std::string& file : options.reports) must_end(file, "--report", ".html", ".pdf");
  if (!options.reports.empty() && !why_no_report().empty())
    throw Error(Errc::invalid_argument, "--report: " + why_no_report());
  options.missed.check();
  if (!options.missed.files.empty() && sampled)
    throw Error(Errc::invalid_argument, "--missed: looks at every voxel, and so needs --exact");
  if ((options.matrix || options.picture) && !overlap)
    throw Error(Errc::invalid_argument, "--overlap-csv and --picture show overlaps, which --no-overlap leaves out");

  for (const std::string& file : options.registration_files)
    must_end(file, "--registration-map", ".ply", ".png", ".svg");
  if (!options.registration_files.empty() && (sampled || !options.with_registration))
    throw Error(
        Errc::invalid_argument,
        "--registration-map: shows the error of --registration on every voxel, and so needs both it and --exact");
  if (options.with_registration && !overlap)
    throw Error(Errc::invalid_argument, "--registration: looks at what scans share, which --no-overlap leaves out");

  Simulator& simulator = build_simulator(site, program);
  tell_engine(simulator);
  tell_grid(simulator);
  const Network network = to_network(stations);
  ProgressLine line(program.console, "evaluate");
  const Progress progress{.report = [&](double done) { line.update(done); }, .stop = program.stop};
  VoxelField field;
  const bool with_field = options.cartography || !options.missed.files.empty() || !options.registration_files.empty() ||
                          !options.reports.empty();
  const NetworkCounts counts = sampled ? evaluate_sample(simulator, network, options, progress)
                                       : simulator.evaluate(network,
                                                            {.overlap = overlap,
                                                             .skip = options.skip,
                                                             .field = with_field ? &field : nullptr,
                                                             .registration = options.model()},
                                                            progress);
  if (counts.cancelled) throw Stopped{};
  const RegistrationOptions& registration = options.registration;
  const bool by_all = options.with_registration && registration.surfaces == RegistrationSurfaces::all;
  Surroundings around;
  if (overlap)
    around = surroundings(simulator, network, by_all ? std::optional(registration.model) : std::nullopt, program.stop);
  if (around.counts.cancelled) throw Stopped{};
  const std::uint64_t voxels = simulator.voxel_count();
  Estimate registered;
  RegistrationError error;
  if (options.with_registration) {
    registered = registration_estimate(counts, voxels, registration, &around.counts, around.voxels);
    error = registration_error(counts, voxels, registration, &around.counts, around.voxels);
  }
  const Estimate covered = coverage_estimate(counts, simulator.goal_density(), voxels);
  const Estimate overlapped = overlap ? overlap_estimate(counts, voxels) : Estimate{};
  const OverlapMatrix matrix = overlap ? overlap_matrix(counts) : OverlapMatrix{};

  if (options.cartography) write_coverage_ply(*options.cartography, simulator, field);
  std::optional<JudgedVoxels> judged;
  if (!options.missed.files.empty() || (!options.reports.empty() && !sampled)) {
    judged = judge_missed(site, simulator, field, program);
    if (!judged && program.abort.stop_requested()) return exit_failed;
  }
  if (judged)
    write_missed(std::vector<std::filesystem::path>(options.missed.files.begin(), options.missed.files.end()), *judged,
                 simulator, placed);
  if (options.matrix) write_overlap_csv(*options.matrix, matrix);
  for (const std::string& file : options.registration_files) {
    if (file.ends_with(".ply"))
      write_registration_ply(file, simulator, field, error);
    else
      draw_registration(file, simulator, field, error, placed, "Registration error on the surface (predicted)");
  }
  const OverlapMatrix scan_overlaps = overlap ? scan_overlap_matrix(around.counts) : OverlapMatrix{};
  const double link = options.link.value_or(default_link);
  // Pictures and drawings show the links of the summary, unless those of the method are asked for.
  const OverlapMatrix& drawn = options.link_overlap ? matrix : scan_overlaps;
  const double least_drawn = options.link_overlap.value_or(link);
  if (options.picture) {
    draw_plan_view(*options.picture, site.scene(), site.area(), placed, drawn,
                   fmt::format("{} station{}: coverage {:.3f}, overlap {:.3f}", placed.size(),
                               placed.size() == 1 ? "" : "s", covered.value, overlapped.value),
                   least_drawn, names, error.stations,
                   options.link_overlap ? "Overlap of two stations" : "Scan overlap of two stations");
  }

  for (const std::string& file : options.station_files)
    write_stations(file, {placed, names}, drawn, least_drawn, site.area(), crs_text(site));
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t k = 0; k < stations.size(); ++k) {
    auto row = to_json(stations[k], names[k], site.scanners());
    row["points"] = nullptr;
    row["points_on_surveyed"] = nullptr;
    if (!sampled && !counts.points.empty()) row["points"] = counts.points[k];
    if (!sampled && !counts.points_on_surveyed.empty()) row["points_on_surveyed"] = counts.points_on_surveyed[k];
    row["dropped"] = nullptr;
    if (!counts.dropped.empty()) row["dropped"] = dropped_json(counts.dropped[k]);
    rows.push_back(std::move(row));
  }
  SurveySummary summary{.names = names, .captured = covered.value, .captured_error = covered.standard_error};
  if (overlap) summary.links = scan_links(scan_overlaps, link, placed);
  std::optional<Estimate> visible;
  if (options.visible) {
    visible = visible_share(site, simulator, sampled ? counts.voxels : visible_sample, program);
    if (visible->value > 0) summary.of_visible = std::min(1.0, covered.value / visible->value);
  }
  if (options.with_registration) summary.registration_mm = 1e3 * registered.value;
  std::optional<Visit> visit;
  if (site.has_area()) {
    OnSiteOptions on_site = options.on_site;
    on_site.entrance = site.walkable().enter;  // rounds begin and end where one comes in
    visit = OnSite(site.area(), site.clash(), simulator.scanners(), on_site).visit(placed);
    summary.seconds_on_site = 60 * visit->minutes;
  }
  summary.faults = station_faults(placed, names);
  if (!options.reports.empty()) {
    write_reports(std::vector<std::filesystem::path>(options.reports.begin(), options.reports.end()),
                  {.stations = placed,
                   .names = names,
                   .counts = counts,
                   .scan_overlaps = scan_overlaps,
                   .link = link,
                   .registration = options.with_registration ? &error : nullptr,
                   .summary = &summary},
                  std::filesystem::path(options.site.scene).stem().string(),
                  {site, simulator, sampled ? nullptr : &field, judged ? &*judged : nullptr}, program, program.abort);
  }
  if (options.json) {
    nlohmann::json json{{"summary", lines_json(summary)},
                        {"coverage", covered.value},
                        {"coverage_se", covered.standard_error},
                        {"overlap", nullptr},
                        {"overlap_se", nullptr},
                        {"overlap_matrix", nullptr},
                        {"scan_overlap_matrix", nullptr},
                        {"visible", nullptr},
                        {"visible_se", nullptr},
                        {"minutes_on_site", nullptr},
                        {"stations", std::move(rows)},
                        {"dropped", nullptr},
                        {"voxels", voxels},
                        {"voxel_size", simulator.voxel_size_m()},
                        {"goal_density", simulator.goal_density()},
                        {"rays", counts.rays},
                        {"sample", nullptr},
                        {"seconds", seconds_json(watch, counts.trace_seconds)},
                        {"engine", to_string(simulator.engine().engine)},
                        {"device", simulator.engine().device},
                        {"seed", site.simulator_config().seed},
                        {"options", options_of(site.settings())},
                        {"version", version()}};
    if (overlap) {
      json["overlap"] = overlapped.value;
      json["overlap_se"] = overlapped.standard_error;
      json["overlap_matrix"] = matrix_json(matrix);
      json["scan_overlap_matrix"] = matrix_json(scan_overlaps);
    }
    if (visible) json["visible"] = visible->value, json["visible_se"] = visible->standard_error;
    if (visit) json["minutes_on_site"] = visit->minutes;
    if (options.with_registration) {
      json["registration"] = registration_json(error, registered);
      json["registration"]["surfaces"] = to_string(options.registration.surfaces);
    }
    if (sampled) json["sample"] = counts.voxels;
    if (!counts.dropped.empty()) json["dropped"] = dropped_json(all_dropped(counts));
    program.console.print(json);
  } else {
    std::string text =
        station_table(placed, names, sampled ? std::span<const std::uint64_t>() : std::span(counts.points_on_surveyed),
                      site.scanners());
    const auto with_error = [&](const Estimate& estimate) {
      return sampled ? fmt::format("{:.4f} ± {:.4f}", estimate.value, estimate.standard_error)
                     : fmt::format("{:.4f}", estimate.value);
    };
    text += "coverage " + with_error(covered) + "\n";
    if (overlap) text += "overlap  " + with_error(overlapped) + "\n";
    if (options.with_registration) {
      text += fmt::format("registration {:.2f}{} mm, worst station {}: {:.2f} mm\n", 1e3 * registered.value,
                          sampled ? fmt::format(" ± {:.2f}", 1e3 * registered.standard_error) : "",
                          names[error.worst_station], 1e3 * error.worst_m);
    }
    if (!counts.dropped.empty()) text += dropped_text(counts) + "\n";
    text += "\n" + summary_text(summary);
    program.console.print(text);
  }
  return exit_ok;
}

}  // namespace

void add_evaluate(CLI::App& app, Program& program) {
  add_command<EvaluateCommandOptions>(app, program, "evaluate", "Coverage and overlap of a network of stations",
                                      evaluate);
}

}  // namespace vantage::cli
