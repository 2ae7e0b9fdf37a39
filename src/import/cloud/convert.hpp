// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "import/cloud/points.hpp"

namespace vantage::importer {

using Files = std::vector<std::filesystem::path>;

// Settings of a cloud that the user gives.
struct CloudSettings {
  std::optional<double> cell_m = {};  // size of the cells; empty: chosen
  std::optional<double> unit_m = {};  // metres in a unit; empty: as the file tells, else recognised
  char up = 'z';                      // the file's axis that points up: x, y or z
  std::string columns = {};           // of a text, see columns_of()
};
// Sets one of them by a word NAME=VALUE of cell, unit, up and columns; returns false for other words. Throws Refused.
bool take_setting(CloudSettings& settings, const std::string& word);

// Opens the reader of a format: e57, las, ply, xyz or pcd. Several files are read one after the other. Throws Refused.
std::unique_ptr<PointSource> open_source(const Files& files, const std::string& format,
                                         const CloudSettings& settings = {});

// Returns the bytes that cells may take: 60 % of this process's memory limit, or of 2 GB without a limit.
double memory_for_cells();

// Converts a point cloud to surfaces, a GLB. `format`: e57, las, ply, xyz or pcd. The GLB declares its unit if the
// files or the user tell it; else all lengths, the cells' too, are in the files' own unit. Throws Refused.
std::string convert_cloud(const Files& files, const std::string& format, const CloudSettings& settings = {});

// Lists the scans of an E57 file that have a pose, as a GLB without meshes. `asset.extras.scans` holds their name,
// position (metres, Z up), rotation (quaternion w, x, y, z), sensor and settings (ScanSettings). Throws Refused.
std::string list_scans(const std::filesystem::path& file);
// Returns the entry of one scan.
nlohmann::json scan_json(const CloudScan& scan);

// Returns a GLB with the points of each scan that has a pose, thinned to one for each cell of `cell_m`. Its scans, as
// above, also hold the number of `points`, and the `first` and `count` of their records in the binary chunk. A record
// is the mean point in metres from the head, along the axes of the file, as three floats, and the number of points as
// uint32 (at most 16 384). Cells are two or four times as large if memory is short. Throws Refused.
std::string thin_scans(const Files& files, const std::string& format, double cell_m);

}  // namespace vantage::importer
