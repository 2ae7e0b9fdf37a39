// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/matrix4x4.h>

#include <filesystem>
#include <string>

struct aiScene;

namespace vantage::importer {

// Units and axes that a file declares.
struct Declared {
  bool unit = false, up = false;  // whether it declares them
  aiMatrix4x4 gltf_from_file;     // to metres and Y up, as far as declared
};

// `format` by its extension: "fbx", "dae".
Declared declared_units(const aiScene& scene, const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::importer
