// SPDX-License-Identifier: Apache-2.0
// Replaces the report in builds without its libraries.
#include "report/report.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::string why_no_report() {
  return "vantage was built without three.js, meshoptimizer or zlib (Debian: libjs-three, libmeshoptimizer-dev, "
         "zlib1g-dev)";
}

bool write_report(const std::filesystem::path&, const PlanResult&, Site&, const ReportOptions&, const Progress&) {
  throw Error(Errc::invalid_argument, "report: " + why_no_report());
}

bool write_report(const std::filesystem::path&, const Evaluation&, Site&, const ReportOptions&, const Progress&) {
  throw Error(Errc::invalid_argument, "report: " + why_no_report());
}

std::vector<std::string> write_reports(const std::filesystem::path&, const PlanResult&, Site&, const ReportOptions&,
                                       std::span<const PlanPage>, const Progress&) {
  throw Error(Errc::invalid_argument, "report: " + why_no_report());
}

}  // namespace vantage
