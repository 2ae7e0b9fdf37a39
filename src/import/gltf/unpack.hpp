// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importer {

// The bytes of a GLB with all that the glTF says, but nothing compressed and nothing outside: gzip around the file,
// KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression. Throws Refused; what a broken file
// makes of the JSON's types is an nlohmann::json::exception.
std::string unpack(const std::filesystem::path& file);

}  // namespace vantage::importer
