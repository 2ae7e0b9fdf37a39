// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "import/mesh/model.hpp"

struct aiScene;

namespace vantage::importer {

// Units and axes that a file declares.
struct Declared {
  bool unit = false, up = false;  // whether it declares them
  glm::dmat4 gltf_from_file{1};   // to metres and Y up, as far as declared
};

// `format` by its extension: "fbx" or "3ds".
Declared declared_units(const aiScene& scene, const std::string& format);

}  // namespace vantage::importer
