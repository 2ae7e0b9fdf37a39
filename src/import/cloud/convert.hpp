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

// What the user says of a cloud.
struct CloudSettings {
  std::optional<double> cell_m = {};  // size of the cells; empty: chosen
  std::optional<double> unit_m = {};  // metres in a unit; empty: as the file tells, else recognised
  char up = 'z';                      // the file's axis that points up: x, y or z
  std::string columns = {};           // of a text, see columns_of()
};
// Sets one of them by a word NAME=VALUE of cell, unit, up and columns; false if it is none. Throws Refused.
bool take_setting(CloudSettings& settings, const std::string& word);

// The reader of a format: e57, las, ply, xyz or pcd; of several files it reads one after the other. Throws Refused.
std::unique_ptr<PointSource> open_source(const Files& files, const std::string& format,
                                         const CloudSettings& settings = {});

// Bytes that cells may take: most of what this process may.
double memory_for_cells();

// A point cloud as surfaces, a GLB. `format`: e57, las, ply, xyz or pcd. Its unit is declared unless neither the files
// nor the user tell it: lengths, the cells' included, are then in the files' own unit. Throws Refused.
std::string convert_cloud(const Files& files, const std::string& format, const CloudSettings& settings = {});

// The scans of an E57 file, a GLB without meshes whose `asset.extras.scans` lists name, position (metres, Z up),
// rotation (quaternion w, x, y, z), sensor and settings (ScanSettings) of those with a pose. Throws Refused.
std::string list_scans(const std::filesystem::path& file);
// One of them.
nlohmann::json scan_json(const CloudScan& scan);

// The points of each scan with a pose, one for each cell of `cell_m`: a GLB whose scans, as above, also tell their
// `points` and which records of the binary chunk are theirs, `first` and `count`. A record is the mean point in metres
// from the head, along the axes of the file, as three floats, and the number of points as uint32 (at most 16 384).
// Cells are twice as large, or four times, if memory is short. Throws Refused.
std::string thin_scans(const Files& files, const std::string& format, double cell_m);

}  // namespace vantage::importer
