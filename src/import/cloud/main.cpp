// SPDX-License-Identifier: Apache-2.0
// vantage-import-cloud FORMAT FILE: fits surfaces to the points of FILE and writes them to standard output, as GLB.
// FORMAT is e57, las, ply, xyz (also for PTS and PTX) or pcd; e57-scans lists the scans of an E57 file.
#include <cstdio>
#include <string_view>

#include "import/cloud/convert.hpp"
#include "import/program.hpp"

int main(int argc, char** argv) {
  constexpr int kUsage = 64;
  if (argc != 3) {
    std::fprintf(stderr, "usage: vantage-import-cloud e57|las|ply|xyz|pcd|e57-scans FILE >site.glb\n");
    return kUsage;
  }
  return vantage::importer::run([&] {
    return std::string_view(argv[1]) == "e57-scans" ? vantage::importer::list_scans(argv[2])
                                                    : vantage::importer::convert_cloud(argv[2], argv[1]);
  });
}
