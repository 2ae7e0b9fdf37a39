// SPDX-License-Identifier: Apache-2.0
// Readers of formats, each of a whole file. All throw Refused.
#pragma once

#include <filesystem>
#include <string>

#include "import/mesh/model.hpp"

namespace vantage::importer {

Model read_ply(const std::filesystem::path& file);
Model read_stl(const std::filesystem::path& file);
Model read_obj(const std::filesystem::path& file);
Model read_x3d(const std::filesystem::path& file);
Model read_collada(const std::filesystem::path& file);
Model read_dxf(const std::filesystem::path& file);
// Reads FBX and 3DS; `format` is the extension without the dot.
Model read_with_assimp(const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::importer
