// SPDX-License-Identifier: Apache-2.0
// vantage-import-plan dxf [SETTING=VALUE]... FILE: raises the floor plan that FILE draws and writes it to standard
// output, as GLB.
#include <cstdio>

#include "import/floor_plan/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  if (argc < 3) {
    std::fprintf(stderr,
                 "usage: vantage-import-plan dxf [unit=mm] [wall-layer=PATTERN]... [wall-height=2.7] FILE >site.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] {
    vantage::floor_plan::Settings settings;
    for (int i = 2; i + 1 < argc; ++i) vantage::floor_plan::read_setting(settings, argv[i]);
    return vantage::floor_plan::convert(argv[argc - 1], settings);
  });
}
