// SPDX-License-Identifier: Apache-2.0
/// What a survey comes to, for people: report.html, a page that opens from disk in any browser, and report.pdf.
#pragma once

#include <filesystem>
#include <string>

#include "vantage/evaluation.hpp"
#include "vantage/missed.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Why this build writes no reports, and what to install for them; empty where it does.
std::string why_no_report();

/// What a report shows besides the network, or the networks of a front.
struct ReportOptions {
  std::string title = "Survey";          ///< What was surveyed.
  std::string command = {};              ///< How the report was asked for, as it was typed.
  const VoxelField* field = nullptr;     ///< Points of every voxel under the answer. Null: its own, or from a sample.
  const MissedVoxels* missed = nullptr;  ///< Why voxels of the answer are not captured. Null: left out.
  bool pictures = true;                  ///< Show in report.html what the answer's stations see.
};

/// Writes the front of a plan, its answer first, as a page (.html) or as four sheets A4 at most (.pdf). A page loads
/// nothing from anywhere. Borrows everything for the call. Throws Error: io; invalid_argument (an empty front, another
/// extension, a build that writes no reports) and what the simulator throws.
void write_report(const std::filesystem::path& file, const PlanResult& result, Simulator& simulator,
                  const SearchArea& area, const ReportOptions& options = {}, const Progress& progress = {});
/// Writes the report of one network that no plan found. Throws as above.
void write_report(const std::filesystem::path& file, const Evaluation& evaluation, Simulator& simulator,
                  const SearchArea& area, const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
