// SPDX-License-Identifier: Apache-2.0
// A point cloud file format behind PointCloudWriter.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vantage/export.hpp"

namespace vantage {

static_assert(std::endian::native == std::endian::little, "the point cloud writers copy little-endian values");

class PointSink {
 public:
  virtual ~PointSink() = default;
  virtual void begin_station(const StationScan&) {}  // used by formats that keep stations apart
  virtual void write(const ScanChunk& chunk, std::uint16_t station) = 0;
  virtual void close() = 0;
  virtual std::uint64_t points() const = 0;
};

// `crs`: well-known text in one line, or empty.
std::unique_ptr<PointSink> make_ply_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs, PlyCoordinates coordinates);
// Throws Error invalid_argument for outputs that LAS cannot hold.
std::unique_ptr<PointSink> make_las_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs);
// Throws Error invalid_argument for outputs that E57 cannot hold.
std::unique_ptr<PointSink> make_e57_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs);

// Appends the bytes of a value to a record.
template <class T>
void append(std::string& record, T value) {
  record.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// True if ray k of the chunk hit. The first array that the chunk has decides: range, ids, or the position, which is
// finite for hits only.
inline bool hit(const ScanChunk& chunk, std::size_t k) {
  const auto finite = [](float value) { return value - value == 0; };
  if (!chunk.range_m.empty()) return finite(chunk.range_m[k]);
  if (!chunk.mesh.empty()) return chunk.mesh[k] >= 0;
  const auto& p = chunk.position[k];
  return finite(p[0]) && finite(p[1]) && finite(p[2]);
}

}  // namespace vantage
