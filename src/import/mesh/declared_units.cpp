// SPDX-License-Identifier: Apache-2.0
// Units and axes by format, given what assimp 5.2 already applies: it turns Z to Y for DXF and 3DS, and leaves FBX
// unchanged.
#include "import/mesh/declared_units.hpp"

#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <fstream>

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

// $INSUNITS of a DXF's header, a group 70 after its name; 0 if there is none.
int insertion_units(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line, code, value;
  const auto next = [&](std::string& out) {
    if (!std::getline(stream, out)) return false;
    out.erase(0, out.find_first_not_of(" \t"));
    while (!out.empty() && (out.back() == '\r' || out.back() == ' ')) out.pop_back();
    return true;
  };
  while (next(line) && line != "ENTITIES")
    if (line == "$INSUNITS" && next(code) && next(value) && code == "70") return std::atoi(value.c_str());
  return 0;
}

}  // namespace

Declared declared_units(const aiScene& scene, const std::filesystem::path& file, const std::string& format) {
  if (format == "fbx") return of_fbx(scene);
  Declared declared;
  if (format == "3ds") {
    declared.up = true;
  } else if (format == "dxf") {
    declared.up = true;
    struct Code {
      int code;
      double metres;
    };
    constexpr std::array kCodes{Code{1, 0.0254}, Code{2, 0.3048}, Code{4, 0.001}, Code{5, 0.01}, Code{6, 1.0}};
    const int given = insertion_units(file);
    for (const Code& known : kCodes)
      if (known.code == given) scale(declared, known.metres);
  }
  return declared;
}

}  // namespace vantage::importer
