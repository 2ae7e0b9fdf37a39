// SPDX-License-Identifier: Apache-2.0
// Units and axes by format, given what assimp 5.2 already applies: it turns Z to Y for 3DS, and leaves FBX unchanged.
#include "import/mesh/declared_units.hpp"

#include <assimp/scene.h>

#include <cmath>

namespace vantage::importer {
namespace {

void scale(Declared& declared, double metres) {
  if (!(metres > 0) || !std::isfinite(metres)) return;
  for (int c = 0; c < 3; ++c) declared.gltf_from_file[c] = declared.gltf_from_file[c] * metres;
  declared.unit = true;
}

Declared of_fbx(const aiScene& scene) {
  Declared declared;
  std::int32_t axis = 1;
  if (scene.mMetaData && scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2) {
    declared.up = true;
    declared.gltf_from_file = axis == 2 ? from_z_up() : axis == 0 ? from_x_up() : glm::dmat4(1);
  }
  double centimetres = 0;  // assimp has two types for it
  float narrow = 0;
  if (scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", centimetres))
    scale(declared, centimetres * 0.01);
  else if (scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", narrow))
    scale(declared, static_cast<double>(narrow) * 0.01);
  return declared;
}

}  // namespace

Declared declared_units(const aiScene& scene, const std::string& format) {
  if (format == "fbx") return of_fbx(scene);
  Declared declared;
  declared.up = true;
  return declared;
}

}  // namespace vantage::importer
