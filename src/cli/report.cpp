// SPDX-License-Identifier: Apache-2.0
#include "cli/report.hpp"

#include <algorithm>

#include "cli/station_pictures.hpp"
#include "report/report.hpp"

namespace vantage::cli {

namespace {

// `report`: but for its title, command and what is missed.
void write(std::span<const std::filesystem::path> files, Report report, const std::string& title,
           const ReportSources& sources, Program& program, std::stop_token stop) {
  report.title = title;
  report.command = program.command;
  ReportMissed missed;
  if (sources.judged) {
    missed = {.ranks = sources.judged->ranks, .why = sources.judged->why};
    report.missed = sources.judged->shares;
  }
  const ReportSite site{.simulator = sources.simulator,
                        .area = sources.site.area(),
                        .field = sources.field,
                        .missed = sources.judged ? &missed : nullptr};
  ReportNetwork& shown = report.networks[report.answer];
  if (std::ranges::any_of(files, [](const auto& file) { return file.extension() != ".pdf"; }))
    shown.pictures = station_pictures(sources.site, shown.entry.stations, stop);
  ProgressLine line(program.console, "report");
  for (const std::filesystem::path& file : files) {
    if (file.extension() == ".pdf")
      write_report_pdf(file, report, site);
    else
      write_report_html(file, report, site, {.report = [&](double done) { line.update(done); }, .stop = stop});
  }
}

}  // namespace

std::string why_no_report() { return ""; }

void write_reports(std::span<const std::filesystem::path> files, const PlanResult& result, const std::string& title,
                   const ReportSources& sources, Program& program, std::stop_token stop) {
  write(files, report_of(result, sources.simulator), title, sources, program, std::move(stop));
}

void write_reports(std::span<const std::filesystem::path> files, const MeasuredStations& measured,
                   const std::string& title, const ReportSources& sources, Program& program, std::stop_token stop) {
  ReportNetwork network = measured_network(measured.stations, measured.names, measured.counts, sources.simulator,
                                           measured.scan_overlaps, measured.link);
  if (measured.registration) network.entry.registration = *measured.registration;
  if (measured.summary) network.summary = *measured.summary;
  write(files, report_of(std::move(network), sources.simulator), title, sources, program, std::move(stop));
}

}  // namespace vantage::cli
