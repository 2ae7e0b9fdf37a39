// SPDX-License-Identifier: Apache-2.0
// vantage-import-cloud FORMAT [SETTING=VALUE]... FILE: fits surfaces to the points of FILE and writes them to standard
// output, as GLB. FORMAT is e57, las, ply, xyz (also for PTS and PTX) or pcd; e57-scans lists the scans of an E57 file;
// e57-points and xyz-points thin their points to one for each cell, of cell=0.02 metres.
#include <cstdio>
#include <string_view>

#include "import/cloud/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  constexpr std::string_view kPoints = "-points";
  const std::string_view format = argc > 1 ? argv[1] : "";
  const bool thinned = format.ends_with(kPoints);
  if (argc < 3 || (argc > 3 && !thinned)) {
    std::fprintf(stderr,
                 "usage: vantage-import-cloud e57|las|ply|xyz|pcd|e57-scans FILE >site.glb\n"
                 "       vantage-import-cloud e57-points|xyz-points [cell=0.02] FILE >scans.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] {
    namespace importer = vantage::importer;
    const char* file = argv[argc - 1];
    if (format == "e57-scans") return importer::list_scans(file);
    if (!thinned) return importer::convert_cloud(file, std::string(format));
    double cell_m = 0.02;
    for (int i = 2; i + 1 < argc; ++i) cell_m = importer::thin_cell(argv[i]);
    return importer::thin_scans(file, std::string(format.substr(0, format.size() - kPoints.size())), cell_m);
  });
}
