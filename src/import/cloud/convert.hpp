// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importer {

// A point cloud as surfaces, a GLB. `format`: e57, las, ply, xyz or pcd. Throws Refused.
std::string convert_cloud(const std::filesystem::path& file, const std::string& format);

// The scans of an E57 file, a GLB without meshes whose `asset.extras.scans` lists name, position (metres, Z up),
// rotation (quaternion w, x, y, z) and sensor of those with a pose. Throws Refused.
std::string list_scans(const std::filesystem::path& file);

}  // namespace vantage::importer
