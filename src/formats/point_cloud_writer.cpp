// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "formats/point_sink.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

struct PointCloudWriter::Impl {
  std::unique_ptr<PointSink> sink;
  std::uint32_t outputs;
  bool open = true;
};

std::uint32_t point_cloud_outputs(const std::filesystem::path& file, std::uint32_t outputs) {
  const auto extension = file.extension();
  return extension == ".las" || extension == ".e57" ? outputs | scan_reflectivity : outputs;
}

PointCloudWriter::PointCloudWriter(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                   const std::string& crs, PlyCoordinates ply)
    : impl_(std::make_unique<Impl>()) {
  if (!(outputs & scan_position)) throw Error(Errc::invalid_argument, "a point cloud needs the output scan_position");
  impl_->outputs = outputs;
  const std::string extension = file.extension().string();
  if (extension == ".ply")
    impl_->sink = make_ply_sink(file, origin, outputs, crs, ply);
  else if (extension == ".las")
    impl_->sink = make_las_sink(file, origin, outputs, crs);
  else if (extension == ".e57")
    impl_->sink = make_e57_sink(file, origin, outputs, crs);
  else
    throw Error(Errc::invalid_argument, "unknown format of " + file.string() + " from its extension \"" + extension +
                                            "\"; use .ply, .las or .e57");
}

PointCloudWriter::PointCloudWriter(PointCloudWriter&&) noexcept = default;
PointCloudWriter& PointCloudWriter::operator=(PointCloudWriter&&) noexcept = default;
PointCloudWriter::~PointCloudWriter() = default;

void PointCloudWriter::begin_station(const StationScan& station) {
  if (!impl_->open) throw Error(Errc::invalid_argument, "the point cloud is closed");
  impl_->sink->begin_station(station);
}

void PointCloudWriter::write(const ScanChunk& chunk, std::uint16_t station) {
  if (!impl_->open) throw Error(Errc::invalid_argument, "the point cloud is closed");
  const auto has = [&](std::uint32_t output, std::size_t size) {
    if ((impl_->outputs & output) && size != chunk.ray_count)
      throw Error(Errc::invalid_argument, "a chunk of " + std::to_string(chunk.ray_count) +
                                              " rays lacks an output (bit " + std::to_string(output) +
                                              ") that the point cloud was opened with");
  };
  has(scan_position, chunk.position.size()), has(scan_range, chunk.range_m.size()),
      has(scan_normal, chunk.normal.size());
  has(scan_reflectivity, chunk.reflectivity.size()), has(scan_ids, chunk.mesh.size()),
      has(scan_ids, chunk.primitive.size());
  has(scan_colour, chunk.colour.size()), has(scan_voxel, chunk.voxel.size()), has(scan_ghost, chunk.ghost.size()),
      has(scan_returns, chunk.returns.size());
  impl_->sink->write(chunk, station);
}

void PointCloudWriter::close() {
  if (std::exchange(impl_->open, false)) impl_->sink->close();
}

std::uint64_t PointCloudWriter::points() const noexcept { return impl_->sink->points(); }

}  // namespace vantage
