// SPDX-License-Identifier: Apache-2.0
// vantage-import-mesh FORMAT FILE: writes what assimp reads of FILE to standard output, as GLB. FORMAT is the extension
// of such files: obj, stl, ply, fbx, dae, 3ds, x3d or dxf. Exit codes are those of
// sysexits.h: 65 where the model is at fault, 71 where memory is short, each with a line that says so.
#include <cstdio>
#include <exception>
#include <new>

#include "import/mesh/convert.hpp"

int main(int argc, char** argv) {
  using namespace vantage::import_mesh;
  constexpr int kUsage = 64, kData = 65, kSystem = 71;
  if (argc != 3) {
    std::fprintf(stderr, "usage: vantage-import-mesh obj|stl|ply|fbx|dae|3ds|x3d|dxf FILE >site.glb\n");
    return kUsage;
  }
  try {
    const std::string glb = convert(argv[2], argv[1]);
    return std::fwrite(glb.data(), 1, glb.size(), stdout) == glb.size() && std::fflush(stdout) == 0 ? 0 : kSystem;
  } catch (const std::bad_alloc&) {
    return kSystem;
  } catch (const std::length_error&) {
    std::fprintf(stderr, "as glTF the model would take more than the 4 GiB that a GLB holds; export parts of it\n");
    return kData;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kData;
  }
}
