// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importer {

// The bytes of a GLB with the model's nodes, names, transforms, meshes and materials. `format` is
// the extension that files of its format have, without the point. Throws Refused.
std::string convert(const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::importer
