// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"
#include "report/station_pictures.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

void write(const std::filesystem::path& file, Report report, Simulator& simulator, const SearchArea& area,
           const Progress& progress) {
  report.ground = ground_lines(area);
  if (file.extension() == ".pdf") return write_report_pdf(file, report, simulator, area);
  if (file.extension() != ".html")
    throw Error(Errc::invalid_argument, "report: " + file.string() + " ends with neither .html nor .pdf");
  if (report.options.pictures) report.pictures = station_pictures(simulator, report.shown().stations, progress.stop);
  write_report_html(file, report, simulator, area, progress);
}

}  // namespace

std::string why_no_report() { return ""; }

void write_report(const std::filesystem::path& file, const PlanResult& result, Simulator& simulator,
                  const SearchArea& area, const ReportOptions& options, const Progress& progress) {
  write(file, report_of(result, simulator, options), simulator, area, progress);
}

void write_report(const std::filesystem::path& file, const Evaluation& evaluation, Simulator& simulator,
                  const SearchArea& area, const ReportOptions& options, const Progress& progress) {
  write(file, report_of(evaluation, simulator, options), simulator, area, progress);
}

}  // namespace vantage
