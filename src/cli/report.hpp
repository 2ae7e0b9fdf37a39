// SPDX-License-Identifier: Apache-2.0
// Writing of reports, shared by commands.
#pragma once

#include <filesystem>
#include <span>
#include <stop_token>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "vantage/report.hpp"

namespace vantage::cli {

// Writes each file by its extension, with a progress line. `shown`: a PlanResult or an Evaluation.
template <class Shown>
void write_reports(std::span<const std::filesystem::path> files, const Shown& shown, Simulator& simulator,
                   const SearchArea& area, ReportOptions options, Program& program, std::stop_token stop) {
  options.command = program.command;
  ProgressLine line(program.console, "report");
  for (const std::filesystem::path& file : files)
    write_report(file, shown, simulator, area, options,
                 {.report = [&](double done) { line.update(done); }, .stop = stop});
}

}  // namespace vantage::cli
