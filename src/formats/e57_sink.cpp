// SPDX-License-Identifier: Apache-2.0
// E57 (ASTM E2807, Standard Specification for 3D Imaging Data Exchange, 2011): a Data3D a station, in the scanner's own
// frame, with its pose in the header.
#include <cmath>
#include <optional>
#include <utility>

#include "formats/e57_paged_file.hpp"
#include "formats/e57_points.hpp"
#include "formats/e57_xml.hpp"
#include "formats/point_sink.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

// Singles round coordinates of up to so much by at most 8 micrometres.
constexpr double kSinglesReach_m = 256;
// Ghosts are points as any, since the format has no mark for them.
constexpr std::uint32_t kHeldByE57 =
    scan_position | scan_normal | scan_reflectivity | scan_colour | scan_ghost | scan_returns;

std::vector<E57Field> fields_of(std::uint32_t outputs, const Scanner& scanner) {
  using Type = E57Field::Type;
  std::vector<E57Field> fields;
  const bool fine = scanner.max_range_m > kSinglesReach_m;
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
    fields.push_back({name, fine ? Type::double_precision : Type::single_precision, fine ? 8u : 4u});
  for (const auto& [name, count] : {std::pair{"rowIndex", scanner.rows()}, {"columnIndex", scanner.columns()}})
    fields.push_back({name, Type::integer, count > 65'536 ? 4u : 2u});
  if (outputs & scan_returns)
    for (const char* name : {"returnIndex", "returnCount"}) fields.push_back({name, Type::integer, 1});
  if (outputs & scan_reflectivity) fields.push_back({"intensity", Type::single_precision, 4, true});
  if (outputs & scan_colour)
    for (const char* name : {"colorRed", "colorGreen", "colorBlue"}) fields.push_back({name, Type::integer, 1});
  if (outputs & scan_normal)
    for (const char* name : {"nor:normalX", "nor:normalY", "nor:normalZ"})
      fields.push_back({name, Type::single_precision, 4});
  return fields;
}

std::vector<std::size_t> bytes_of(const std::vector<E57Field>& fields) {
  std::vector<std::size_t> bytes;
  for (const E57Field& field : fields) bytes.push_back(field.bytes);
  return bytes;
}

// From the survey's axes to the scanner's: those of its pose, turned about its own axis by its heading.
class IntoScanner {
 public:
  IntoScanner() = default;
  IntoScanner(const StationSetup& setup, Angle own_heading)
      : rows_(setup.survey_from_scanner()),
        c_(std::cos(own_heading.in_radians())),
        s_(std::sin(own_heading.in_radians())) {}
  std::array<double, 3> operator()(double x, double y, double z) const {
    const Vec3 d = rows_[0] * x + rows_[1] * y + rows_[2] * z;
    return {c_ * d.x + s_ * d.y, c_ * d.y - s_ * d.x, d.z};
  }

 private:
  std::array<Vec3, 3> rows_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double c_ = 1, s_ = 0;
};

// Quaternion (w, x, y, z) of Rz(heading) · Ry(tilt) · Rz(own heading).
std::array<double, 4> quaternion_of(const StationSetup& setup, Angle own_heading) {
  const double heading = setup.heading.in_radians(), own = own_heading.in_radians();
  const double sum = (heading + own) / 2, difference = (own - heading) / 2, half = setup.tilt.in_radians() / 2;
  if (half == 0) return {std::cos(sum), 0, 0, std::sin(sum)};
  return {std::cos(half) * std::cos(sum), std::sin(half) * std::sin(difference), std::sin(half) * std::cos(difference),
          std::cos(half) * std::sin(sum)};
}

std::uint64_t hash_of(const E57Scan& scan, std::uint64_t points, std::uint64_t salt) {
  Hash hash;
  hash.add(salt), hash.add(points), hash.add(scan.records);
  for (const std::string* text : {&scan.name, &scan.sensor_model}) hash.add_bytes(text->data(), text->size());
  for (const double value : {scan.translation.x, scan.translation.y, scan.translation.z}) hash.add(value);
  for (const double value : scan.rotation) hash.add(value);
  for (const E57Field& field : scan.fields) hash.add_bytes(field.name.data(), field.name.size());
  return hash.value();
}

class E57Sink final : public PointSink {
 public:
  E57Sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs, std::string crs)
      : file_(file), origin_(origin), outputs_(outputs), crs_(std::move(crs)) {}

  void begin_station(const StationScan& station) override {
    end_station();
    E57Scan scan;
    scan.name = station.name, scan.sensor_model = station.scanner.name;
    scan.translation = station.head;
    scan.rotation = quaternion_of(station.setup, station.scanner.heading);
    scan.fields = fields_of(outputs_, station.scanner);
    columns_ = station.scanner.columns();
    into_scanner_ = IntoScanner(station.setup, station.scanner.heading);
    shift_ = origin_ - station.head;
    points_.emplace(file_, bytes_of(scan.fields));
    scans_.push_back(std::move(scan));
  }

  void write(const ScanChunk& chunk, std::uint16_t) override {
    if (!points_)
      throw Error(Errc::invalid_argument, "an E57 file keeps stations apart: call begin_station() before write()");
    const std::vector<E57Field>& fields = scans_.back().fields;
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      if (!hit(chunk, k)) continue;
      std::size_t field = 0;
      const auto& p = chunk.position[k];
      put_position(into_scanner_(shift_.x + double{p[0]}, shift_.y + double{p[1]}, shift_.z + double{p[2]}), fields);
      field = 3;
      const std::uint64_t ray = chunk.first_ray + k;
      put_index(field, static_cast<std::uint32_t>(ray / columns_), fields[field].bytes), ++field;
      put_index(field, static_cast<std::uint32_t>(ray % columns_), fields[field].bytes), ++field;
      extend_indices(static_cast<std::uint32_t>(ray / columns_), static_cast<std::uint32_t>(ray % columns_));
      if (outputs_ & scan_returns) {
        points_->put(field++, static_cast<std::uint8_t>(chunk.return_number - 1));
        points_->put(field++, chunk.returns[k]);
      }
      if (outputs_ & scan_reflectivity) points_->put(field++, chunk.reflectivity[k]);
      if (outputs_ & scan_colour)
        for (int shift = 0; shift < 24; shift += 8)
          points_->put(field++, static_cast<std::uint8_t>(chunk.colour[k] >> shift));
      if (outputs_ & scan_normal) {
        const auto& n = chunk.normal[k];
        for (const double c : into_scanner_(n[0], n[1], n[2])) points_->put(field++, static_cast<float>(c));
      }
      points_->next();
      ++total_;
    }
  }

  void close() override {
    end_station();
    Hash high, low;
    high.add(std::uint64_t{1}), low.add(std::uint64_t{2});
    for (Hash* hash : {&high, &low}) {
      hash->add_bytes(crs_.data(), crs_.size());
      for (const E57Scan& scan : scans_) hash->add_bytes(scan.guid.data(), scan.guid.size());
    }
    const std::string xml = e57_xml(e57_guid(high.value(), low.value()), crs_, scans_);
    const std::uint64_t address = file_.physical();
    file_.write(xml);
    std::string header = "ASTM-E57";
    append(header, std::uint32_t{1}), append(header, std::uint32_t{0});  // version of the format
    append(header, file_.physical_length());
    append(header, address);
    append(header, static_cast<std::uint64_t>(xml.size()));
    append(header, static_cast<std::uint64_t>(E57PagedFile::kPageBytes));
    file_.close(header);
  }

  std::uint64_t points() const override { return total_; }

 private:
  void end_station() {
    if (!points_) return;
    points_->close();
    E57Scan& scan = scans_.back();
    scan.records = points_->records(), scan.section = points_->section();
    const std::uint64_t content = points_->fingerprint();
    // The hash includes the scan's number, since two stations may stand, and see, alike.
    scan.guid = e57_guid(hash_of(scan, content, 2 * scans_.size()), hash_of(scan, content, 2 * scans_.size() + 1));
    points_.reset();
  }

  void put_position(const std::array<double, 3>& position, const std::vector<E57Field>& fields) {
    E57Bounds& bounds = scans_.back().bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double stored = position[axis];
      if (fields[axis].type == E57Field::Type::double_precision) {
        points_->put(axis, stored);
      } else {
        const auto single = static_cast<float>(stored);
        points_->put(axis, single);
        stored = double{single};
      }
      bounds.low[axis] = std::min(bounds.low[axis], stored), bounds.high[axis] = std::max(bounds.high[axis], stored);
    }
  }

  void put_index(std::size_t field, std::uint32_t index, std::size_t bytes) {
    if (bytes == 2)
      points_->put(field, static_cast<std::uint16_t>(index));
    else
      points_->put(field, index);
  }

  void extend_indices(std::uint32_t row, std::uint32_t column) {
    E57Bounds& b = scans_.back().bounds;
    b.row_low = std::min(b.row_low, row), b.row_high = std::max(b.row_high, row);
    b.column_low = std::min(b.column_low, column), b.column_high = std::max(b.column_high, column);
  }

  E57PagedFile file_;
  Vec3 origin_, shift_;
  std::uint32_t outputs_;
  std::string crs_;
  std::vector<E57Scan> scans_;
  std::optional<E57Points> points_;  // of the last of them, until it ends
  IntoScanner into_scanner_;
  std::uint64_t columns_ = 1, total_ = 0;
};

}  // namespace

std::unique_ptr<PointSink> make_e57_sink(const std::filesystem::path& file, const Vec3& origin, std::uint32_t outputs,
                                         const std::string& crs) {
  if (outputs & ~kHeldByE57)
    throw Error(
        Errc::invalid_argument,
        "E57 holds positions, normals, reflectivity (as intensity) and colour, but no range, ids or voxels, as " +
            file.string() + " should; write .ply, or leave these outputs out");
  return std::make_unique<E57Sink>(file, origin, outputs, crs);
}

}  // namespace vantage
