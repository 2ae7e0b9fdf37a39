// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.hpp"
#include "report/report.hpp"
#include "report/station_pictures.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

bool write(const std::filesystem::path& file, const Report& report, Site& site, const Progress& progress) {
  if (progress.stop.stop_requested()) return false;
  if (file.extension() == ".pdf") return write_report_pdf(file, report, site, progress.stop);
  if (file.extension() != ".html")
    throw Error(Errc::invalid_argument, "report: " + file.string() + " ends with neither .html nor .pdf");
  if (!report.options.pictures) return write_report_html(file, report, site, progress);
  Report pictured = report;
  pictured.pictures = station_pictures(site.simulator(), report.shown().stations, progress.stop);
  return write_report_html(file, pictured, site, progress);
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

std::vector<std::string> write_reports(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                                       const ReportOptions& options, std::span<const PlanPage> plan,
                                       const Progress& progress) {
  Report report = report_of(result, site, options);
  report.plan = plan;
  bool page = false, sheets = false;
  parallel::beside([&] { sheets = write(folder / "report.pdf", report, site, {.stop = progress.stop}); },
                   [&] { page = write(folder / "report.html", report, site, progress); });
  std::vector<std::string> left_out;
  if (!page) left_out.emplace_back("report.html");
  if (!sheets) left_out.emplace_back("report.pdf");
  return left_out;
}

}  // namespace vantage
