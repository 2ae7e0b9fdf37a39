// SPDX-License-Identifier: Apache-2.0
// vantage-import-cloud FORMAT [SETTING=VALUE...] FILE...: fits surfaces to the points of all files together and writes
// them to standard output, as GLB. FORMAT is e57, las (also for LAZ), ply, xyz (also for PTS, CSV and PTX) or pcd.
// e57-scans lists the scans of an E57 file. e57-points and xyz-points thin scans to one point for each cell, of 0.02 m
// by default.
#include <cstdio>
#include <string_view>

#include "import/cloud/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  constexpr std::string_view kPoints = "-points";
  if (argc < 3) {
    std::fprintf(stderr,
                 "usage: vantage-import-cloud e57|las|ply|xyz|pcd [cell=METRES] [unit=m|cm|mm|in|ft] [up=x|y|z] "
                 "[columns=x,y,z] FILE... >site.glb\n"
                 "       vantage-import-cloud e57-scans FILE >scans.glb\n"
                 "       vantage-import-cloud e57-points|xyz-points [cell=0.02] FILE >scans.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] {
    namespace importer = vantage::importer;
    const std::string format = argv[1];
    importer::CloudSettings settings;
    int first = 2;
    while (first + 1 < argc && importer::take_setting(settings, argv[first])) ++first;
    const importer::Files files(argv + first, argv + argc);
    if (format == "e57-scans") return importer::list_scans(files.front());
    if (format.ends_with(kPoints))
      return importer::thin_scans(files, format.substr(0, format.size() - kPoints.size()),
                                  settings.cell_m.value_or(0.02));
    return importer::convert_cloud(files, format, settings);
  });
}
