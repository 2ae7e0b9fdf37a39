// SPDX-License-Identifier: Apache-2.0
#include "cli/report.hpp"

namespace vantage::cli {

std::string why_no_report() { return ""; }

void write_reports(std::span<const std::filesystem::path> files, const PlanResult& result, const std::string& title,
                   const ReportSources& sources, Program& program, std::stop_token stop) {
  Report report = report_of(result, sources.simulator);
  report.title = title;
  report.command = program.command;
  write_reports(files, std::move(report), sources, program, std::move(stop));
}

void write_reports(std::span<const std::filesystem::path> files, Report report, const ReportSources& sources,
                   Program& program, std::stop_token stop) {
  ReportMissed missed;
  if (sources.judged) {
    missed = {.ranks = sources.judged->ranks, .why = sources.judged->why};
    report.missed = sources.judged->shares;
  }
  const ReportSite site{.simulator = sources.simulator,
                        .area = sources.site.area(),
                        .field = sources.field,
                        .missed = sources.judged ? &missed : nullptr};
  ProgressLine line(program.console, "report");
  for (const std::filesystem::path& file : files) {
    if (file.extension() == ".pdf")
      write_report_pdf(file, report, site);
    else
      write_report_html(file, report, site, {.report = [&](double done) { line.update(done); }, .stop = stop});
  }
}

}  // namespace vantage::cli
