// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/progress.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage::importers {

// Settings of a scan, estimated from its points. Fields of view are in whole degrees, rounded outwards.
struct TakenSettings {
  std::optional<std::array<Angle, 2>> steps;        // of azimuth and zenith
  bool steps_by_grid = false;                       // false: by the density of points
  Angle sweep_middle, sweep = Angle::degrees(360);  // azimuths of the scan, in the scanner's frame
  std::array<Angle, 2> zeniths;                     // first and last
  std::array<double, 2> range_m;                    // nearest and farthest point, without lone ones
};

// A scan that was taken, as its file describes it.
struct TakenScan {
  std::string name, sensor;
  Vec3 head;                                   // frame of the file, Z up, metres
  StationSetup setup;                          // heading and tilt; a tilt below 3° counts as 0
  std::optional<TakenSettings> settings = {};  // from taken_scans() only; none without points
};

// Reads the scans of an E57 file that have a pose, with the importer of point clouds. Throws Error as as_glb() does,
// and malformed_file if the file is no E57. Empty if stopped.
std::vector<TakenScan> taken_scans(const std::filesystem::path& file, const Progress& progress = {});

// A point that represents all points of a scan in a small cell.
struct ThinPoint {
  std::array<float, 3> offset;  // mean of the points, from the head, along the axes of the file
  std::uint32_t points;         // number of points, at most 16 384
};

struct ThinScan {
  TakenScan scan;
  std::uint64_t points = 0;  // before thinning
  std::vector<ThinPoint> thinned;
};

// Reads the scans with a pose of an E57 or PTX file, thinned to one point for each cell of `cell_m`. Throws Error as
// as_glb() does, and malformed_file for another format. Empty if stopped.
std::vector<ThinScan> thin_scans(const std::filesystem::path& file, double cell_m, const Progress& progress = {});

// Returns heading and tilt of a scanner from the rotation of its frame into the survey's, a quaternion w, x, y, z.
StationSetup setup_of(const std::array<double, 4>& rotation);

}  // namespace vantage::importers
