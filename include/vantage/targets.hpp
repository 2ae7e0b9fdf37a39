// SPDX-License-Identifier: Apache-2.0
/// Targets and control points: spheres or checkerboards that scans are registered by where surfaces do not hold them
/// together, and points that tie a survey to the site's frame. Placing them after Jia and Lichti, A Model-Based Design
/// System for Terrestrial Laser Scanning Networks in Complex Sites, 2019.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Levels of accuracy (U.S. Institute of Building Documentation, Level of Accuracy Specification Guide, 2016): a bound
/// of the error at 95 %.
enum class AccuracyClass {
  loa20,  ///< 50 mm.
  loa30,  ///< 15 mm.
  loa40,  ///< 5 mm.
  loa50,  ///< 1 mm.
};
std::string to_string(AccuracyClass);  ///< "LOA30"
/// Throws Error invalid_argument for any other text; case is ignored.
AccuracyClass accuracy_class_from_string(const std::string& text);
double largest_error_m(AccuracyClass) noexcept;  ///< At 95 %: 0.05, 0.015, 0.005 and 0.001.
/// Error at 95 % of a registered surface whose root mean square error is `rms_m`: 1.96 times that, as of one axis.
double error_at_95_percent(double rms_m) noexcept;

/// A target on its stand or mark. Lengths in metres, survey frame.
struct Target {
  std::string name = {};  ///< For tables, pictures and the crew.
  Vec3 centre = {};       ///< Centre of the sphere or the checkerboard.
  double control_m = 0;   ///< Standard deviation of known coordinates, in each axis; 0: no control point.
  bool proposed = false;  ///< True if `propose_targets()` proposed it; false: it was given.
  /// Stations that measure it, ascending, by their places in the network.
  std::vector<std::size_t> stations = {};
  /// A place on a surveyed surface for a check of the vertical index: two stations or more see it steeply. It ties no
  /// scans in any prediction.
  bool check = false;
};
/// Returns true if any of them ties scans, and is not for checks alone.
bool any_ties(std::span<const Target> targets) noexcept;

/// Needs of a scan that measures a target, and places for new ones.
struct TargetOptions {
  double diameter_m = 0.145;  ///< Diameter of a sphere, or width of a checkerboard; above 0.
  double height_m = 1.5;      ///< Centre of a proposed one above the ground.
  /// Standard deviation of a fitted centre in each axis, above 0, besides range noise and what a calibration leaves.
  /// Empty: 0.2 mm by a scanner that states its accuracy of angles and of ranges, 1 mm by one that does not.
  std::optional<double> sigma_m = {};
  std::size_t least_points = 60;     ///< A scan with fewer points on a target does not measure it.
  std::size_t least = 0, most = 40;  ///< Number of proposed targets.
  /// Accuracy class that judges the predicted registration error. Proposals end once it is met. Empty: the class that
  /// the site's scans are for (`SiteOptions::deliverable`), if any, and else LOA30.
  std::optional<AccuracyClass> accuracy_class = {};
  std::optional<double> largest_rms_m = {};  ///< Proposals go on while the error is above this; above 0.
  bool exact = false;  ///< Trace every ray, as evaluations and plans do, in place of a sample of the voxels.
};
/// `accuracy_class`, or LOA30.
AccuracyClass wanted_class(const TargetOptions& options) noexcept;
/// Largest root mean square error that `wanted_class()` and `largest_rms_m` allow.
double allowed_rms_m(const TargetOptions& options);
/// Its members as named values, for results and configuration files.
Settings settings(const TargetOptions& options);
/// One row for each setting that users give, and its bounds.
const SettingTable<TargetOptions>& target_settings();
/// Throws Error invalid_argument with the member and its value.
void check(const TargetOptions& options);

/// Largest distance at which a scanner measures a target of its own height.
double target_reach_m(const Scanner& scanner, const TargetOptions& options = {});

/// Reads targets from a table as `read_stations_csv()` does, with columns name, x, y, z of the centre, and for control
/// points sigma, in metres. Throws Error: io, malformed_file.
std::vector<Target> read_targets_csv(const std::filesystem::path& file);
/// Writes name, x, y, z, sigma, and the names of the stations that measure each. Throws Error io.
void write_targets_csv(const std::filesystem::path& file, std::span<const Target> targets,
                       std::span<const std::string> station_names);

}  // namespace vantage
