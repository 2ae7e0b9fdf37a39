// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importer {

// Returns the bytes of a GLB with the whole content of a glTF, uncompressed and without other files. Handles gzip
// around the file, KHR_draco_mesh_compression, EXT_meshopt_compression and KHR_meshopt_compression. Throws Refused, and
// nlohmann::json::exception if a broken file has JSON of unexpected types.
std::string unpack(const std::filesystem::path& file);

}  // namespace vantage::importer
