// SPDX-License-Identifier: Apache-2.0
// Writing of reports, shared by commands.
#pragma once

#include <spdlog/spdlog.h>

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/options.hpp"
#include "vantage/image.hpp"
#include "vantage/report.hpp"
#include "vantage/site.hpp"

namespace vantage::cli {

// Options for the head of reports.
struct ReportHead {
  std::optional<std::string> logo, date;

  void add(CLI::App& command) {
    add_text(command, "--report-logo", "FILE", "Picture at the head of the report: .png or .jpg", logo)
        ->group("Results");
    add_text(command, "--report-date", "TEXT", "Date at the head of the report, as it is to be read", date)
        ->group("Results");
  }
  // Throws Error io or malformed_file for a logo that cannot be read: before the work, not behind it.
  void check() const {
    if (logo) read_image(*logo);
  }
  ReportOptions with(ReportOptions options) const {
    if (logo) options.logo = *logo;
    if (date) options.date = *date;
    return options;
  }
};

// Writes each file by its extension, with a progress line. `shown`: a PlanResult or an Evaluation. Tells which file a
// stop left out, and returns those that are written.
template <class Shown>
std::vector<std::filesystem::path> write_reports(std::span<const std::filesystem::path> files, const Shown& shown,
                                                 Site& site, ReportOptions options, Program& program,
                                                 std::stop_token stop) {
  options.command = program.command;
  ProgressLine line(program.console, "writing the report");
  std::vector<std::filesystem::path> written;
  for (const std::filesystem::path& file : files) {
    if (write_report(file, shown, site, options, {.report = [&](double done) { line.update(done); }, .stop = stop})) {
      written.push_back(file);
      continue;
    }
    std::error_code ignored;
    std::filesystem::remove(file, ignored);  // that of an earlier run is not this one's
    spdlog::warn("stopped: {} is not written", file.string());
  }
  return written;
}

}  // namespace vantage::cli
