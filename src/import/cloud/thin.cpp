// SPDX-License-Identifier: Apache-2.0
// Thins the points of each scan to one for each small cell around its scanner, with the number of points that this one
// stands for.
#include <algorithm>
#include <cstring>
#include <optional>

#include "import/cloud/cell_grid.hpp"
#include "import/cloud/convert.hpp"
#include "import/cloud/points.hpp"
#include "import/glb_bytes.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

constexpr std::size_t kRecord = 4 * sizeof(std::uint32_t);  // x, y, z, count

// Thins all scans with cells of one size. The result is empty if they would take more than `memory` bytes.
class ThinScans {
 public:
  ThinScans(PointSource& source, double cell_m, double memory) : source_(source), cell_m_(cell_m), memory_(memory) {}

  std::optional<std::string> run() {
    const auto all = static_cast<double>(source_.announced());
    double done = 0;
    source_.read([&](const PointBlock& block) {
      done += static_cast<double>(block.positions.size());
      if (all > 0) tell_progress(done / all);
      if (too_many_) return;
      if (block.scan != scan_ || !grid_) {
        flush();
        scan_ = block.scan;
        grid_.emplace(source_.scans()[scan_].position, cell_m_);
      }
      total_ += block.positions.size();
      if (!source_.scans()[scan_].posed) return;
      for (const Eigen::Vector3d& p : block.positions) grid_->add(p, 0, Eigen::Vector3d::Zero());
      // Records count twice, since writing copies them.
      too_many_ =
          grid_->size() * (CellGrid::kBytesEach + 2 * kRecord) + 2.0 * static_cast<double>(records_.size()) > memory_;
    });
    if (too_many_) return {};
    flush();
    if (scans_.empty()) throw Refused("it does not say from where its scans were taken; export it with their poses");
    json buffers{{"asset",
                  {{"version", "2.0"},
                   {"generator", "vantage-import-cloud"},
                   {"extras", {{"scans", scans_}, {"cell", cell_m_}}}}}};
    return glb_bytes(std::move(buffers), records_);
  }

 private:
  void flush() {
    if (!grid_) return;
    const CloudScan& scan = source_.scans()[scan_];
    if (scan.posed) {
      json entry = scan_json(scan);
      entry["points"] = total_, entry["first"] = records_.size() / kRecord, entry["count"] = grid_->size();
      scans_.push_back(std::move(entry));
      for (std::uint32_t k = 0; k < grid_->size(); ++k) add((*grid_)[k]);
    }
    grid_.reset();
    total_ = 0;
  }

  // Adds the cell's mean point, relative to the scanner's head.
  void add(const Cell& cell) {
    const Eigen::Vector3d mean = CellGrid::middle_of(CellGrid::index_of(cell)) + cell.moments().mean();
    std::array<char, kRecord> record;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<float>(mean[axis] * cell_m_);
      std::memcpy(record.data() + 4 * axis, &value, sizeof value);
    }
    std::memcpy(record.data() + 12, &cell.count, sizeof cell.count);
    records_.append(record.data(), record.size());
  }

  PointSource& source_;
  double cell_m_, memory_;
  std::optional<CellGrid> grid_;
  std::uint32_t scan_ = 0;
  std::uint64_t total_ = 0;  // points of the scan
  bool too_many_ = false;
  json scans_ = json::array();
  std::string records_;
};

}  // namespace

std::string thin_scans(const Files& files, const std::string& format, double cell_m) {
  const std::unique_ptr<PointSource> source = open_source(files, format);
  for (;; cell_m *= 2)
    if (auto glb = ThinScans(*source, cell_m, memory_for_cells()).run()) return std::move(*glb);
}

}  // namespace vantage::importer
