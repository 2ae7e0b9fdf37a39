// SPDX-License-Identifier: Apache-2.0
// vantage-import-plan dxf [SETTING=VALUE]... FILE...: raises the floor plans that the files draw, one for each storey,
// and writes them to standard output, as GLB. Settings come before the first path with a slash.
#include <cstdio>
#include <string_view>

#include "import/floor_plan/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  if (argc < 3) {
    std::fprintf(
        stderr,
        "usage: vantage-import-plan dxf [unit=mm] [wall-layer=PATTERN]... [wall-height=2.7] FILE... >site.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] {
    vantage::floor_plan::Settings settings;
    int first = 2;
    const auto is_setting = [](std::string_view word) { return word.find('=') < word.find('/'); };
    for (; first + 1 < argc && is_setting(argv[first]); ++first)
      vantage::floor_plan::read_setting(settings, argv[first]);
    return vantage::floor_plan::convert({argv + first, argv + argc}, settings);
  });
}
