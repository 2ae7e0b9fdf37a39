// SPDX-License-Identifier: Apache-2.0
// vantage-import-gltf gltf FILE: writes a glTF that is compressed, as a whole or in its meshes, to standard output, as
// a GLB that is not.
#include <cstdio>

#include "import/gltf/unpack.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  if (argc != 3) {
    std::fprintf(stderr, "usage: vantage-import-gltf gltf FILE >site.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] { return vantage::importer::unpack(argv[2]); });
}
