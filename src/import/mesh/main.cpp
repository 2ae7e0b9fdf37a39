// SPDX-License-Identifier: Apache-2.0
// vantage-import-mesh FORMAT FILE: reads FILE with assimp and writes it to standard output, as GLB. FORMAT is the
// extension of such files: obj, stl, ply, fbx, dae, 3ds, x3d or dxf.
#include <cstdio>

#include "import/mesh/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  if (argc != 3) {
    std::fprintf(stderr, "usage: vantage-import-mesh obj|stl|ply|fbx|dae|3ds|x3d|dxf FILE >site.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] { return vantage::importer::convert(argv[2], argv[1]); });
}
