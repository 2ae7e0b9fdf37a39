// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "core/text.hpp"
#include "import/scans.hpp"
#include "vantage/error.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

// Returns the files of scans in a folder, sorted by name; else the file itself.
std::vector<fs::path> scan_files(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) throw Error(Errc::io, path.string() + ": there is no such file or folder of scans");
  if (!fs::is_directory(path, failure)) return {path};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, failure)) {
    const std::string ending = lower_case(entry.path().extension().string());
    if (ending == ".e57" || ending == ".ptx") files.push_back(entry.path());
  }
  if (failure) throw Error(Errc::io, path.string() + ": the folder cannot be read: " + failure.message());
  if (files.empty())
    throw Error(Errc::malformed_file, path.string() + ": the folder has no scan, no file that ends with .e57 or .ptx");
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<TakenScan> read_taken_scans(const fs::path& path, double cell_m, const Progress& progress) {
  std::vector<TakenScan> scans;
  const std::vector<fs::path> files = scan_files(path);
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto all = static_cast<double>(files.size());
    progress(static_cast<double>(k) / all);
    const Progress part{[&](double done) { progress((static_cast<double>(k) + done) / all); }, progress.stop};
    for (importers::ThinScan& read : importers::thin_scans(files[k], cell_m, part)) {
      TakenScan scan{.name = std::move(read.scan.name),
                     .sensor = std::move(read.scan.sensor),
                     .head = read.scan.head,
                     .setup = read.scan.setup,
                     .points = read.points};
      scan.thinned.reserve(read.thinned.size());
      for (const importers::ThinPoint& point : read.thinned) scan.thinned.push_back({point.offset, point.points});
      scans.push_back(std::move(scan));
    }
    if (progress.stopped()) return {};
  }
  return scans;
}

}  // namespace vantage
