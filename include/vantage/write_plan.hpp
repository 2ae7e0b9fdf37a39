// SPDX-License-Identifier: Apache-2.0
/// The result folder of a plan: tables, drawings, pictures and reports.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "vantage/export.hpp"
#include "vantage/missed.hpp"
#include "vantage/planner.hpp"
#include "vantage/report.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Settings of `write_plan()`.
struct FolderOptions {
  ReportOptions report = {};  ///< Head of the reports. Their field and missed surface are the answer's.
  bool reports = true;        ///< Write report.html and report.pdf, if this build can.
  PlyCoordinates ply = PlyCoordinates::floats;  ///< Coordinates of PLY files.
  /// Time for all of it, in seconds. A part that is not done by then is left out, unless two seconds do for it; tables,
  /// drawings and plan.png are always written. Empty: no limit.
  std::optional<double> max_seconds = std::nullopt;
};

/// Snapshot of the writing.
struct FolderProgress {
  std::string part;  ///< "map" (every voxel's count under the answer), "draw", "missed" or "report".
  double done = 0;   ///< Share of the part, in [0, 1].
  double whole = 0;  ///< About that of all.
};

/// As `Progress`, for a result folder.
struct FolderWatch {
  std::function<void(const FolderProgress&)> report = {};  ///< Called between chunks of work, on the calling thread.
  std::stop_token stop = {};                               ///< Leaves out what a time limit leaves out.
};

/// Result of `write_plan()`.
struct WrittenFolder {
  std::vector<std::string> left_out = {};  ///< Names of the files that the time or a stop left out, sorted.
  std::optional<MissedVoxels> missed =
      std::nullopt;  ///< Why voxels are missed; empty: left out, or nothing is surveyed.
};

/// Writes the result folder of a plan and makes it if needed; the files of an earlier plan there are removed or
/// replaced. Files:
/// - front.csv, front.json, history.csv, fronts.csv (every iteration's front);
/// - of the answer: stations.csv, overlap.csv (if confirmed), coverage.ply, stations.dxf, and stations.geojson and
/// stations.kml if the site has a coordinate system by which stations can be put on WGS 84 (else `SiteOptions::warn` is
/// told why), targets.csv if it has targets, sessions.csv if its round is split, and waypoints.csv and
/// waypoints.json if it has one;
/// - what it captures of each element: elements.csv; what it does not, and why: missed.csv, missed.ply, missed.png,
/// missed.bcf if the scene is of IFC, and rooms.csv if it has rooms;
/// - the pictures front, hypervolume, history (with several objectives) and plan, each as .png and .svg; for several
/// floors also plan-level-1.png and so on;
/// - if the registration error is known, ellipses in the plan, and registration.ply, .png and .svg;
/// - report.html and report.pdf.
///
/// Counts the answer with every ray, unless `Evaluation::field` has its points. Throws Error: io; invalid_argument (an
/// empty front), malformed_file (a logo that is no picture); and as the simulator does.
WrittenFolder write_plan(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                         const FolderOptions& options = {}, const FolderWatch& watch = {});

/// Tells about how many seconds `write_plan()` takes for a plan of this site, by the number of stations and the seconds
/// that one takes with every ray: a `PlanWatch::seconds_after`. Draws the site and judges some voxels, to know how long
/// that takes. Borrows the site.
std::function<double(std::size_t stations, double seconds_a_station)> seconds_to_write(Site& site);

}  // namespace vantage
