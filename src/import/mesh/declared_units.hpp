// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/matrix4x4.h>

#include <filesystem>
#include <string>

struct aiScene;

namespace vantage::importer {

// What a file says of its own lengths and axes.
struct Declared {
  bool unit = false, up = false;  // whether it says so
  aiMatrix4x4 gltf_from_file;     // to metres and Y up, where they are declared
};

// `format` by its extension: "fbx", "dae".
Declared declared_units(const aiScene& scene, const std::filesystem::path& file, const std::string& format);

}  // namespace vantage::importer
