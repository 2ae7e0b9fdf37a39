// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importer {

// Returns the bytes of a GLB with the model's nodes, names, transforms, meshes and materials. `format`: extension of
// the format, without the dot. Throws Refused.
std::string convert(const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::importer
