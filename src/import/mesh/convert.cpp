// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/convert.hpp"

#include "import/mesh/sources.hpp"

namespace vantage::importer {

std::string convert(const std::filesystem::path& file, const std::string& format) {
  Model model = format == "ply"   ? read_ply(file)
                : format == "stl" ? read_stl(file)
                : format == "obj" ? read_obj(file)
                : format == "x3d" ? read_x3d(file)
                : format == "dae" ? read_collada(file)
                : format == "dxf" ? read_dxf(file)
                                  : read_with_assimp(file, format);
  model.nodes[0].name = file.stem().string();
  return glb_of(model);
}

}  // namespace vantage::importer
