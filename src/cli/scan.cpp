// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"
#include "core/options_json.hpp"
#include "formats/run_json.hpp"

namespace vantage::cli {
namespace {

const std::map<std::string, std::uint32_t> output_bits{{"range", scan_range},
                                                       {"normal", scan_normal},
                                                       {"reflectivity", scan_reflectivity},
                                                       {"ids", scan_ids},
                                                       {"colour", scan_colour}};

Panorama load_panorama(const std::string& text, const std::string& what) {
  const auto comma = text.rfind(',');
  if (comma == std::string::npos) return Panorama::load(text);
  return Panorama::load(text.substr(0, comma), Angle::degrees(parse_number(text.substr(comma + 1), what)));
}

struct ScanCommandOptions {
  SiteArguments site;
  StationOptions stations;
  std::optional<std::string> output;
  std::vector<Panorama> panoramas;
  std::uint32_t outputs = scan_position | scan_reflectivity | scan_colour;
  std::optional<BeamOptions> beam;
  std::optional<std::uint64_t> instrument;  // seed of its errors
  PlyCoordinates ply = PlyCoordinates::floats;
  bool json = false;

  void add(CLI::App& command) {
    site.add(command);
    stations.add(command);
    add_text(command, "-o,--output", "FILE", "File for the points: .ply, .las or .e57; none otherwise", output);
    add_value(command, "--outputs", "LIST",
              "Attributes of points: any of range,normal,reflectivity,ids,colour; reflectivity,colour otherwise",
              [this](const std::string& text, const std::string& what) {
                outputs = scan_position;
                for (const auto part : split(text, ',')) {
                  const auto bit = output_bits.find(std::string(part));
                  if (bit == output_bits.end())
                    throw Error(Errc::invalid_argument, what + ": '" + std::string(part) +
                                                            "' is none of range, normal, reflectivity, ids, colour");
                  outputs |= bit->second;
                }
              });
    add_values(
        command, "--panorama", "FILE[,DEG]",
        "Panoramic photograph that colours a station's points, with the azimuth of its middle; the k-th is the k-th "
        "station's",
        [this](const std::string& text, const std::string& what) { panoramas.push_back(load_panorama(text, what)); });
    add_settings(command, beam_settings(), beam);
    add_value(command, "--instrument-errors", "SEED",
              "Draw the errors that the scanner's calibration leaves, the same in all scans, and move the points by "
              "them; none otherwise",
              [this](const std::string& text, const std::string& what) { instrument = parse_count(text, what, 0); });
    add_ply_doubles(command, ply);
    command.add_flag("--json", json, "Print one JSON object");
  }
};

nlohmann::json instrument_json(const InstrumentErrors& errors) {
  return {{"vertical_index_arcsec", errors.vertical_index.in_degrees() * 3600},
          {"collimation_arcsec", errors.collimation.in_degrees() * 3600},
          {"trunnion_arcsec", errors.trunnion.in_degrees() * 3600},
          {"range_offset_mm", errors.range_offset_m * 1e3},
          {"range_scale_ppm", errors.range_scale_ppm}};
}

std::string instrument_text(const nlohmann::json& errors) {
  const auto number = [&](const char* name) { return errors[name].get<double>(); };
  return fmt::format(
      "errors of the instrument: vertical index {:+.1f}″, collimation {:+.1f}″, trunnion axis {:+.1f}″, ranges {:+.2f} "
      "mm {:+.1f} ppm\n",
      number("vertical_index_arcsec"), number("collimation_arcsec"), number("trunnion_arcsec"),
      number("range_offset_mm"), number("range_scale_ppm"));
}

// Stations and sums of all scans.
struct Scans {
  ScanSummary sum;  // cancelled: one was stopped
  nlohmann::json rows = nlohmann::json::array();
};

Scans scan_each(const std::vector<SiteStation>& stations, const std::vector<std::string>& names,
                const ScanCommandOptions& options, Site& site, PointCloudWriter* writer, Program& program) {
  Simulator& simulator = site.simulator();
  Scans all;
  ProgressLine line(program.console, "scanning");
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const Progress progress{
        .report =
            [&](double done) { line.update((static_cast<double>(k) + done) / static_cast<double>(stations.size())); },
        .stop = program.stop};
    ScanOptions what{.outputs = writer ? options.outputs : 0, .place = static_cast<std::uint32_t>(k)};
    what.beam = options.beam;
    const StationSetup& setup = stations[k].placed.setup;
    if (options.instrument)
      what.instrument = draw_instrument_errors(simulator.scanners()[setup.scanner], *options.instrument);
    if (k < options.panoramas.size())
      what.colour = [&panorama = options.panoramas[k]](Angle zenith, Angle azimuth) {
        return panorama.colour(zenith, azimuth);
      };
    if (writer)
      writer->begin_station({.name = names[k],
                             .head = stations[k].placed.position,
                             .scanner = simulator.scanners()[setup.scanner],
                             .setup = setup});
    const ScanSummary one = simulator.scan(
        {.position = stations[k].placed.position, .setup = setup}, what,
        [&](const ScanChunk& chunk) {
          if (writer) writer->write(chunk, static_cast<std::uint16_t>(k + 1));
        },
        progress);
    if (one.cancelled) {
      all.sum.cancelled = true;
      break;
    }
    all.sum.rays += one.rays;
    all.sum.points += one.points;
    all.sum.points_on_surveyed += one.points_on_surveyed;
    all.sum.ghosts += one.ghosts;
    all.sum.mixed = all.sum.mixed + one.mixed;
    all.sum.trace_seconds += one.trace_seconds;
    auto row = to_json(stations[k], names[k], site.scanners());
    row["points"] = one.points;
    row["points_on_surveyed"] = one.points_on_surveyed;
    row["hits_on_surveyed"] = one.hits_on_surveyed;
    if (one.ghosts > 0) row["ghosts"] = one.ghosts;
    if (options.beam) row["mixed"] = nlohmann::json(mixed_json(one.mixed));
    if (what.instrument) row["instrument_errors"] = instrument_json(*what.instrument);
    all.rows.push_back(std::move(row));
  }
  return all;
}

nlohmann::json scans_json(Scans scans, const ScanCommandOptions& options, Site& site, const Stopwatch& watch) {
  const Simulator& simulator = site.simulator();
  nlohmann::json json{{"rays", scans.sum.rays},
                      {"points", scans.sum.points},
                      {"points_on_surveyed", scans.sum.points_on_surveyed},
                      {"stations", std::move(scans.rows)},
                      {"seconds", seconds_json(watch, scans.sum.trace_seconds)},
                      {"engine", to_string(simulator.engine().engine)},
                      {"device", simulator.engine().device},
                      {"seed", site.simulator_config().seed},
                      {"options", options_json(site.settings())},
                      {"version", version()}};
  if (scans.sum.ghosts > 0) json["ghosts"] = scans.sum.ghosts;
  if (options.beam) json["mixed"] = nlohmann::json(mixed_json(scans.sum.mixed));
  if (options.output) json["file"] = *options.output;
  return json;
}

std::string scans_text(const Scans& scans, const ScanCommandOptions& options, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < scans.rows.size(); ++k) {
    const auto& row = scans.rows[k];
    text += fmt::format("{} at {:.3f},{:.3f},{:.3f}: {} points, {} on surveyed meshes\n", names[k],
                        row["position"][0].get<double>(), row["position"][1].get<double>(),
                        row["position"][2].get<double>(), row["points"].get<std::uint64_t>(),
                        row["points_on_surveyed"].get<std::uint64_t>());
  }
  text += fmt::format("{} rays, {} points, {} on surveyed meshes\n", scans.sum.rays, scans.sum.points,
                      scans.sum.points_on_surveyed);
  if (scans.sum.ghosts > 0)
    text +=
        fmt::format("{} of the points are ghosts, seen in mirrors: they stand where nothing is\n", scans.sum.ghosts);
  if (options.beam) text += mixed_text(scans.sum.mixed, scans.sum.points) + "\n";
  if (options.instrument && !scans.rows.empty()) text += instrument_text(scans.rows[0]["instrument_errors"]);
  if (options.output) text += "written to " + *options.output + "\n";
  return text;
}

int scan(CLI::App& command, ScanCommandOptions& options, Program& program) {
  const Stopwatch watch;
  options.site.given.weigh_ground = false;  // nothing here measures coverage
  Site site = open_site(command, options.site);
  const auto typed = options.stations.read(65535);  // range of a LAS point source id, from 1
  const auto stations = place(site, typed);
  const auto names = names_of(stations);
  if (options.panoramas.size() > stations.size())
    throw Error(Errc::invalid_argument,
                fmt::format("--panorama: {} pictures for {} stations", options.panoramas.size(), stations.size()));
  for (const auto& station : stations)
    if (station.placed.status == StationStatus::hole)
      throw Error(Errc::invalid_argument, fmt::format("no ground under u,v = {:g},{:g}: a scan needs a place to stand",
                                                      station.placed.uv.u, station.placed.uv.v));
    else if (station.placed.status != StationStatus::ok)
      spdlog::warn("the station at {:.6g},{:.6g},{:.6g} {}", station.placed.position.x, station.placed.position.y,
                   station.placed.position.z, fault_text(site, station.placed, "it is scanned all the same"));

  Simulator& simulator = build_simulator(site, program);
  tell_engine(simulator);
  tell_grid(simulator);

  std::optional<PointCloudWriter> writer;
  if (options.output) {
    options.outputs = point_cloud_outputs(*options.output, options.outputs);
    if (std::ranges::any_of(simulator.scene().meshes(), &MeshInfo::mirror)) options.outputs |= scan_ghost;
    if (options.beam) options.outputs |= scan_returns;
    writer.emplace(*options.output, simulator.origin(), options.outputs, crs_text(site), options.ply);
  }
  Scans scans = scan_each(stations, names, options, site, writer ? &*writer : nullptr, program);
  if (scans.sum.cancelled) {
    spdlog::error("stopped; no file was written");
    return exit_failed;
  }
  if (writer) writer->close();

  if (options.json)
    program.console.print(scans_json(std::move(scans), options, site, watch));
  else
    program.console.print(scans_text(scans, options, names));
  return exit_ok;
}

}  // namespace

void add_scan(CLI::App& app, Program& program) {
  add_command<ScanCommandOptions>(app, program, "scan", "Simulate stations and write their points", scan,
                                  {"vantage scan site.glb --stations hall/stations.csv --output hall.e57"});
}

}  // namespace vantage::cli
