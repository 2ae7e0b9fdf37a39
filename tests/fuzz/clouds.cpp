// SPDX-License-Identifier: Apache-2.0
// Readers of point clouds, through the conversion to surfaces, without the sandbox of their importer.
#include <algorithm>
#include <cmath>
#include <new>

#include "core/crc32c.hpp"
#include "fuzz/target.hpp"
#include "import/cloud/convert.hpp"
#include "import/program.hpp"

namespace vantage::fuzz {
namespace {

// Runs a reader, which may refuse with a sentence, or want more memory than there is.
template <class Read>
void reads(Read&& read) {
  try {
    std::forward<Read>(read)();
  } catch (const std::bad_alloc&) {
  } catch (const importer::Refused& why) {
    require(!std::string_view(why.what()).empty(), "a refusal says why");
  }
}

void converts(const std::filesystem::path& file, const std::string& format) {
  reads([&] { require(!importer::convert_cloud({file}, format).empty(), "surfaces are written"); });
  reads([&] {
    const auto source = importer::open_source({file}, format);
    source->want_cells();
    source->read([&](const importer::PointBlock& block) {
      require(block.scan < source->scans().size(), "points are of a scan");
      require(block.normals.empty() || block.normals.size() == block.positions.size(), "each point has its normal");
      require(block.cells.empty() || block.cells.size() == block.positions.size(), "each point has its cell");
      for (const auto& p : block.positions) require(p.allFinite(), "points are finite");
    });
  });
}

}  // namespace

// Checksums are set right, since a fuzzer never finds them.
void e57(Bytes bytes) {
  constexpr std::size_t kPage = 1024, kData = kPage - 4;
  std::vector<std::uint8_t> file(bytes.begin(), bytes.end());
  for (std::size_t at = 0; at + kPage <= file.size(); at += kPage) {
    const std::uint32_t sum = crc32c(file.data() + at, kData);
    for (std::size_t k = 0; k < 4; ++k) file[at + kData + k] = static_cast<std::uint8_t>(sum >> (24 - 8 * k));
  }
  const auto path = file_of(file, "scan.e57");
  converts(path, "e57");
  reads([&] { importer::list_scans(path); });
  reads([&] { importer::thin_scans({path}, "e57", 0.02); });
}
void las(Bytes bytes) { converts(file_of(bytes, "cloud.las"), "las"); }
void ply(Bytes bytes) { converts(file_of(bytes, "cloud.ply"), "ply"); }
void pcd(Bytes bytes) { converts(file_of(bytes, "cloud.pcd"), "pcd"); }
void xyz(Bytes bytes) { converts(file_of(bytes, "cloud.xyz"), "xyz"); }

}  // namespace vantage::fuzz
