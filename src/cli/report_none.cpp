// SPDX-License-Identifier: Apache-2.0
// Where vantage was built without what a report takes.
#include <spdlog/spdlog.h>

#include "cli/report.hpp"

namespace vantage::cli {

std::string why_no_report() {
  return "vantage was built without three.js, meshoptimizer or zlib (Debian: libjs-three, libmeshoptimizer-dev, "
         "zlib1g-dev)";
}

void write_reports(std::span<const std::filesystem::path>, const PlanResult&, const std::string&, const ReportSources&,
                   Program&, std::stop_token) {
  spdlog::warn("no report: {}", why_no_report());
}

void write_reports(std::span<const std::filesystem::path>, Report, const ReportSources&, Program&, std::stop_token) {
  spdlog::warn("no report: {}", why_no_report());
}

}  // namespace vantage::cli
