// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"
#include "report/station_pictures.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

void write(const std::filesystem::path& file, Report report, Site& site, const Progress& progress) {
  report.ground = ground_lines(site.scene(), site.area(), report.shown().stations);
  if (file.extension() == ".pdf") return write_report_pdf(file, report, site);
  if (file.extension() != ".html")
    throw Error(Errc::invalid_argument, "report: " + file.string() + " ends with neither .html nor .pdf");
  if (report.options.pictures)
    report.pictures = station_pictures(site.simulator(), report.shown().stations, progress.stop);
  write_report_html(file, report, site, progress);
}

}  // namespace

std::string why_no_report() { return ""; }

void write_report(const std::filesystem::path& file, const PlanResult& result, Site& site, const ReportOptions& options,
                  const Progress& progress) {
  write(file, report_of(result, site, options), site, progress);
}

void write_report(const std::filesystem::path& file, const Evaluation& evaluation, Site& site,
                  const ReportOptions& options, const Progress& progress) {
  write(file, report_of(evaluation, site, options), site, progress);
}

}  // namespace vantage
