// SPDX-License-Identifier: Apache-2.0
// The report, as commands write it: where this build has one.
#pragma once

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/missed.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// Why there is none, in a line that says what to install; empty where there is.
std::string why_no_report();

// What a command knows of a network besides the report itself; null: not looked at.
struct ReportSources {
  Site& site;
  Simulator& simulator;
  const VoxelField* field = nullptr;
  const JudgedVoxels* judged = nullptr;
};
// Each file by its extension: .html or .pdf. A line says where this build has none.
void write_reports(std::span<const std::filesystem::path> files, const PlanResult& result, const std::string& title,
                   const ReportSources& sources, Program& program, std::stop_token stop);
// Of stations that were measured without a plan.
struct MeasuredStations {
  std::span<const PlacedStation> stations;
  const std::vector<std::string>& names;
  const NetworkCounts& counts;
  const OverlapMatrix& scan_overlaps;               // of all surfaces; empty: not looked at
  double link = default_link;                       // from which on two stations count as linked
  const RegistrationError* registration = nullptr;  // null: not predicted
  const SurveySummary* summary = nullptr;           // as the command tells it; null: of these numbers alone
};
void write_reports(std::span<const std::filesystem::path> files, const MeasuredStations& measured,
                   const std::string& title, const ReportSources& sources, Program& program, std::stop_token stop);

}  // namespace vantage::cli
