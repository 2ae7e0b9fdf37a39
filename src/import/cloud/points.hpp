// SPDX-License-Identifier: Apache-2.0
// Points of a cloud, a block at a time, and the scans that they belong to.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vantage::importer {

// One scan of a cloud. Frame of the file, Z up, in metres (or the file's unit, see PointSource::metric()).
struct CloudScan {
  std::string name;
  bool posed = false;  // whether the file says from where it was taken
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // from the scanner's frame
  std::string sensor = {};
};

struct PointBlock {
  std::span<const Eigen::Vector3d> positions;  // finite
  std::span<const Eigen::Vector3f> normals;    // none, or one each; 0 if unknown
  std::uint32_t scan = 0;
  std::span<const std::array<std::uint32_t, 2>> cells = {};  // row and column in the scan's grid; none, or one each
};

using PointSink = std::function<void(const PointBlock&)>;

class PointSource {
 public:
  virtual ~PointSource() = default;
  // Reads all points, in the same order each time. Throws Refused.
  virtual void read(const PointSink& sink) = 0;
  // Returns the number of points that the file announces; 0: it does not say.
  virtual std::uint64_t announced() const { return 0; }
  // Returns true if lengths are metres, by the format or as the file says; false if in the file's own unit.
  virtual bool metric() const { return true; }
  // Returns true if the file holds coordinates as floats without an origin, which are coarse in national grids.
  virtual bool floats() const { return false; }
  // Requests `PointBlock::cells` of those scans that have them.
  void want_cells() { cells_ = true; }
  // Complete after the first read().
  const std::vector<CloudScan>& scans() const { return scans_; }
  const std::string& crs() const { return crs_; }  // well-known text; empty if unknown
  const std::vector<std::string>& notes() const { return notes_; }

 protected:
  std::vector<CloudScan> scans_;
  std::string crs_;
  std::vector<std::string> notes_;
  bool cells_ = false;
};

// Passes points on in blocks, without non-finite ones.
class BlockWriter {
 public:
  BlockWriter(const PointSink& sink, std::uint32_t scan, bool normals) : sink_(sink), scan_(scan), normals_(normals) {
    positions_.reserve(kPoints);
    if (normals_) directions_.reserve(kPoints);
  }
  void add(const Eigen::Vector3d& position, const Eigen::Vector3f& normal = Eigen::Vector3f::Zero(),
           std::optional<std::array<std::uint32_t, 2>> cell = {}) {
    if (!position.allFinite()) return;
    positions_.push_back(position);
    if (cell) cells_.push_back(*cell);
    if (normals_) directions_.push_back(normal.allFinite() ? normal : Eigen::Vector3f::Zero());
    if (positions_.size() == kPoints) flush();
  }
  void flush() {
    if (!positions_.empty()) sink_({positions_, directions_, scan_, cells_});
    positions_.clear(), directions_.clear(), cells_.clear();
  }

 private:
  static constexpr std::size_t kPoints = 4096;
  const PointSink& sink_;
  std::uint32_t scan_;
  bool normals_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector3f> directions_;
  std::vector<std::array<std::uint32_t, 2>> cells_;
};

// Returns a source of all points of several sources, one after the other.
std::unique_ptr<PointSource> joined(std::vector<std::unique_ptr<PointSource>> sources);

// Returns a source of all points, turned and then multiplied by `factor`, without the coordinate system.
std::unique_ptr<PointSource> moved(std::unique_ptr<PointSource> source, const Eigen::Matrix3d& turn, double factor);

// Settings for files that do not describe themselves.
struct Reading {
  bool own_unit = true;      // converts lengths by the unit that the file tells; false: passes them on as they are
  std::string columns = {};  // of a text, see columns_of()
};

// Readers, one for each format. Each reads the file's head. Throw Refused.
std::unique_ptr<PointSource> open_e57(const std::filesystem::path& file);
std::unique_ptr<PointSource> open_las(const std::filesystem::path& file, const Reading& reading = {});  // and LAZ
std::unique_ptr<PointSource> open_ply(const std::filesystem::path& file);
std::unique_ptr<PointSource> open_pcd(const std::filesystem::path& file);
std::unique_ptr<PointSource> open_text(const std::filesystem::path& file,
                                       const Reading& reading = {});  // XYZ, PTS, CSV, PTX

}  // namespace vantage::importer
