// SPDX-License-Identifier: Apache-2.0
// vantage-import-gltf gltf FILE: decompresses a glTF, compressed as a whole or in its meshes, and writes it to standard
// output as GLB.
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
