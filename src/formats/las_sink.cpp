// SPDX-License-Identifier: Apache-2.0
// LAS 1.4, point data record format 7 (ASPRS: LAS Specification 1.4 R15, 2019): coordinates as multiples of 0.1 mm from
// an offset.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "formats/point_sink.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

constexpr double kScale = 1e-4;
constexpr std::size_t kHeaderBytes = 375, kVariableHeaderBytes = 54, kRecordBytes = 36;
constexpr std::uint16_t kWktBit = 1 << 4, kWktRecord = 2112;
// Point formats from 6 on have a system as well-known text, whatever is known of it; readers refuse files without.
constexpr const char* kLocalSystem =
    "LOCAL_CS[\"survey frame\",LOCAL_DATUM[\"survey "
    "frame\",32767],UNIT[\"metre\",1],AXIS[\"X\",EAST],AXIS[\"Y\",NORTH]]";

constexpr std::uint8_t kNoise = 7;  // class of ghosts; all other points are never classified

// Outputs that a record of format 7 can hold.
constexpr std::uint32_t kHeldByLas = scan_position | scan_reflectivity | scan_colour | scan_ghost | scan_returns;

std::string names_of(std::uint32_t outputs) {
  std::string names;
  for (const auto& [output, name] :
       {std::pair{scan_range, "range"}, {scan_normal, "normal"}, {scan_ids, "ids"}, {scan_voxel, "voxel"}})
    if (outputs & output) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

class LasSink final : public PointSink {
 public:
  LasSink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs, const std::string& crs)
      : file_(file), origin_(origin), outputs_(outputs), crs_(crs.empty() ? kLocalSystem : crs) {
    offset_ = {std::floor(origin.x), std::floor(origin.y), std::floor(origin.z)};
    low_.fill(std::numeric_limits<std::int32_t>::max());
    high_.fill(std::numeric_limits<std::int32_t>::min());
    file_.write(header());
  }

  void write(const ScanChunk& chunk, std::uint16_t station) override {
    bytes_.clear();
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      if (!hit(chunk, k)) continue;
      const auto& p = chunk.position[k];
      const std::array<double, 3> survey{origin_.x + double{p[0]}, origin_.y + double{p[1]}, origin_.z + double{p[2]}};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t step = steps(survey[axis], offset_[axis]);
        low_[axis] = std::min(low_[axis], step), high_[axis] = std::max(high_[axis], step);
        append(bytes_, step);
      }
      const double reflectivity = outputs_ & scan_reflectivity ? double{chunk.reflectivity[k]} : 0;
      append(bytes_, static_cast<std::uint16_t>(std::lround(std::clamp(reflectivity, 0.0, 1.0) * 65535)));  // intensity
      const auto number = static_cast<std::uint8_t>(chunk.return_number);
      const std::uint8_t of = chunk.returns.empty() ? std::uint8_t{1} : chunk.returns[k];
      append(bytes_, static_cast<std::uint8_t>(number | of << 4));
      ++points_by_return_[number - 1U];
      append(bytes_, std::uint8_t{0});                                                         // flags
      append(bytes_, !chunk.ghost.empty() && chunk.ghost[k] != 0 ? kNoise : std::uint8_t{0});  // class
      append(bytes_, std::uint8_t{0});                                                         // user data
      append(bytes_, std::int16_t{0});  // scan angle: airborne only
      append(bytes_, station);          // point source id
      append(bytes_, double{0});        // GPS time
      for (int shift = 0; shift < 24; shift += 8) {
        const std::uint32_t channel = outputs_ & scan_colour ? (chunk.colour[k] >> shift) & 255u : 0;
        append(bytes_, static_cast<std::uint16_t>(channel * 257));
      }
      ++points_;
    }
    file_.write(bytes_);
  }

  void close() override {
    const std::string text = header();
    file_.patch(0, text.data(), text.size());
    file_.commit();
  }

  std::uint64_t points() const override { return points_; }

 private:
  std::int32_t steps(double value, double offset) const {
    const double steps = std::round((value - offset) / kScale);
    if (!(std::abs(steps) <= std::numeric_limits<std::int32_t>::max()))
      throw Error(Errc::invalid_argument, "LAS cannot hold " + number(value) +
                                              " m: at 0.1 mm steps it reaches 214 km from the " +
                                              "scene's origin; write .ply");
    return static_cast<std::int32_t>(steps);
  }

  std::string header() const {
    std::string h;
    const auto text = [&h](std::string_view value, std::size_t width) {
      h.append(value.substr(0, width)).append(width - std::min(width, value.size()), '\0');
    };
    h += "LASF";
    append(h, std::uint16_t{0});  // file source id
    append(h, kWktBit);           // a coordinate system, as text
    text("", 16);                 // project id
    append(h, std::uint8_t{1}), append(h, std::uint8_t{4});
    text("simulated terrestrial scan", 32);
    text("vantage " + std::string(version()), 32);
    // creation day and year: unset, so equal runs give equal files
    append(h, std::uint16_t{0}), append(h, std::uint16_t{0});
    append(h, static_cast<std::uint16_t>(kHeaderBytes));
    append(h, static_cast<std::uint32_t>(kHeaderBytes + kVariableHeaderBytes + crs_.size() + 1));  // offset to points
    append(h, std::uint32_t{1});  // variable length records
    append(h, std::uint8_t{7}), append(h, static_cast<std::uint16_t>(kRecordBytes));
    append(h, std::uint32_t{0});  // legacy counts are 0 for formats 6 and up
    text("", 5 * 4);
    for (int axis = 0; axis < 3; ++axis) append(h, kScale);
    for (const double offset : offset_) append(h, offset);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      append(h, points_ == 0 ? 0.0 : high_[axis] * kScale + offset_[axis]);
      append(h, points_ == 0 ? 0.0 : low_[axis] * kScale + offset_[axis]);
    }
    append(h, std::uint64_t{0});                               // waveforms
    append(h, std::uint64_t{0}), append(h, std::uint32_t{0});  // extended records
    append(h, points_);
    for (const std::uint64_t points : points_by_return_) append(h, points);
    append(h, std::uint16_t{0});
    text("LASF_Projection", 16);
    append(h, kWktRecord), append(h, static_cast<std::uint16_t>(crs_.size() + 1));
    text("OGC WKT coordinate system", 32);
    text(crs_, crs_.size() + 1);
    return h;
  }

  AtomicFile file_;
  Vec3 origin_;
  std::array<double, 3> offset_{};
  std::uint32_t outputs_;
  std::string crs_;
  std::array<std::int32_t, 3> low_{}, high_{};
  std::uint64_t points_ = 0;
  std::array<std::uint64_t, 15> points_by_return_{};
  std::string bytes_;
};

}  // namespace

std::unique_ptr<PointSink> make_las_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs) {
  if (outputs & ~kHeldByLas)
    throw Error(Errc::invalid_argument, "LAS holds positions, reflectivity (as intensity) and colour, but no " +
                                            names_of(outputs & ~kHeldByLas) + ", as " + file.string() +
                                            " should; write .ply, or leave these outputs out");
  return std::make_unique<LasSink>(file, origin, outputs, crs);
}

}  // namespace vantage
