// SPDX-License-Identifier: Apache-2.0
// PLY, binary little endian.
#include "core/atomic_file.hpp"
#include "formats/ply_header.hpp"
#include "formats/point_sink.hpp"

namespace vantage {
namespace {

std::vector<PlyProperty> attributes(std::uint32_t outputs) {
  std::vector<PlyProperty> p;
  if (outputs & scan_normal) p.insert(p.end(), {{"float", "nx"}, {"float", "ny"}, {"float", "nz"}});
  if (outputs & scan_colour) p.insert(p.end(), {{"uchar", "red"}, {"uchar", "green"}, {"uchar", "blue"}});
  if (outputs & scan_reflectivity) p.push_back({"float", "reflectivity"});
  if (outputs & scan_range) p.push_back({"float", "range"});
  if (outputs & scan_ids) p.insert(p.end(), {{"int", "mesh"}, {"uint", "primitive"}});
  if (outputs & scan_voxel) p.push_back({"uint", "voxel"});
  if (outputs & scan_ghost) p.push_back({"uchar", "ghost"});
  if (outputs & scan_returns) p.insert(p.end(), {{"uchar", "return"}, {"uchar", "returns"}});
  p.push_back({"ushort", "station"});
  return p;
}

class PlySink final : public PointSink {
 public:
  PlySink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs, const std::string& crs,
          PlyCoordinates coordinates)
      : file_(file), header_(coordinates, origin, attributes(outputs), crs), origin_(origin), outputs_(outputs) {
    file_.write(header_.text(0));
  }

  void write(const ScanChunk& chunk, std::uint16_t station) override {
    bytes_.clear();
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      if (!hit(chunk, k)) continue;
      const auto& p = chunk.position[k];
      header_.append_place(bytes_, {origin_.x + double{p[0]}, origin_.y + double{p[1]}, origin_.z + double{p[2]}});
      if (outputs_ & scan_normal)
        for (const float c : chunk.normal[k]) append(bytes_, c);
      if (outputs_ & scan_colour)
        for (int shift = 0; shift < 24; shift += 8) append(bytes_, static_cast<std::uint8_t>(chunk.colour[k] >> shift));
      if (outputs_ & scan_reflectivity) append(bytes_, chunk.reflectivity[k]);
      if (outputs_ & scan_range) append(bytes_, chunk.range_m[k]);
      if (outputs_ & scan_ids) append(bytes_, chunk.mesh[k]), append(bytes_, chunk.primitive[k]);
      if (outputs_ & scan_voxel) append(bytes_, chunk.voxel[k]);
      if (outputs_ & scan_ghost) append(bytes_, chunk.ghost[k]);
      if (outputs_ & scan_returns)
        append(bytes_, static_cast<std::uint8_t>(chunk.return_number)), append(bytes_, chunk.returns[k]);
      append(bytes_, station);
      ++points_;
    }
    file_.write(bytes_);
  }

  void close() override {
    const std::string header = header_.text(points_);
    file_.patch(0, header.data(), header.size());
    file_.commit();
  }

  std::uint64_t points() const override { return points_; }

 private:
  AtomicFile file_;
  PlyHeader header_;
  Vec3 origin_;
  std::uint32_t outputs_;
  std::uint64_t points_ = 0;
  std::string bytes_;
};

}  // namespace

std::unique_ptr<PointSink> make_ply_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs, PlyCoordinates coordinates) {
  return std::make_unique<PlySink>(file, origin, outputs, crs, coordinates);
}

}  // namespace vantage
