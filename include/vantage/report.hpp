// SPDX-License-Identifier: Apache-2.0
/// Reports of a survey for people: report.html, a page that opens from disk in any browser, and report.pdf, sheets for
/// the crew.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "vantage/evaluation.hpp"
#include "vantage/export.hpp"
#include "vantage/missed.hpp"
#include "vantage/planner.hpp"
#include "vantage/progress.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Why this build writes no reports, and what to install for them; empty if it does.
std::string why_no_report();

/// Content of a report besides the networks.
struct ReportOptions {
  std::string title = {};    ///< Empty: the site's name.
  std::string command = {};  ///< The command that made the report, as it was typed.
  /// Points of every voxel under the answer. Null: the answer's own, or from a sample.
  const VoxelField* field = nullptr;
  const MissedVoxels* missed = nullptr;         ///< Why voxels of the answer are not captured. Null: left out.
  std::span<const ElementShare> elements = {};  ///< For a table in report.html, of the answer; empty: left out.
  bool pictures = true;                         ///< Show the views of the answer's stations in report.html.
  std::filesystem::path logo = {};              ///< Picture at the head, .png or .jpg; empty: none.
  std::string date = {};                        ///< Date at the head, as it is to be read; empty: none.
};

/// Writes the front of a plan, its answer first, as a page (.html), or the answer as sheets A4 or A3 (.pdf): its
/// summary, each storey at a round ratio with stations, their distances to corners and the round, a table of all
/// stations, links, missed surface. A page loads nothing from anywhere. A stop before the file is complete leaves it
/// out and returns false. Borrows everything for the call. Throws Error: io; invalid_argument (an empty front, another
/// extension, a build that writes no reports), malformed_file (a logo that is no picture); and as the simulator does.
bool write_report(const std::filesystem::path& file, const PlanResult& result, Site& site,
                  const ReportOptions& options = {}, const Progress& progress = {});
/// Writes the report of a single network, without a plan. Throws as above.
bool write_report(const std::filesystem::path& file, const Evaluation& evaluation, Site& site,
                  const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
