// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"
#include "report/station_pictures.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

bool write(const std::filesystem::path& file, Report report, Site& site, const Progress& progress) {
  if (progress.stop.stop_requested()) return false;
  report.ground = ground_lines(site.scene(), site.area(), report.shown().stations);
  if (file.extension() == ".pdf") return write_report_pdf(file, report, site, progress.stop);
  if (file.extension() != ".html")
    throw Error(Errc::invalid_argument, "report: " + file.string() + " ends with neither .html nor .pdf");
  if (report.options.pictures)
    report.pictures = station_pictures(site.simulator(), report.shown().stations, progress.stop);
  return write_report_html(file, report, site, progress);
}

}  // namespace

std::string why_no_report() { return ""; }

bool write_report(const std::filesystem::path& file, const PlanResult& result, Site& site, const ReportOptions& options,
                  const Progress& progress) {
  return write(file, report_of(result, site, options), site, progress);
}

bool write_report(const std::filesystem::path& file, const Evaluation& evaluation, Site& site,
                  const ReportOptions& options, const Progress& progress) {
  return write(file, report_of(evaluation, site, options), site, progress);
}

}  // namespace vantage
