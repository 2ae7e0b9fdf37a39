// SPDX-License-Identifier: Apache-2.0
// LAS 1.0 to 1.5, point data record formats 0 to 10 (ASPRS: LAS Specification 1.4 R15, 2019, and 1.5, 2025), and LAZ.
#include <algorithm>
#include <array>
#include <optional>

#include "import/cloud/byte_file.hpp"
#include "import/cloud/las_system.hpp"
#include "import/cloud/laz_records.hpp"
#include "import/cloud/points.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::array<std::size_t, 11> kLeastRecord{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::uint8_t kNoise = 7, kHighNoise = 18;

struct Head {
  std::size_t format = 0, record = 0;
  std::uint64_t first = 0, count = 0;
  Eigen::Vector3d scale, offset, metres = Eigen::Vector3d::Ones();
};

// Records about the file: coordinate system, and how points are compressed.
struct Records {
  std::string text, keys, doubles;
  std::optional<std::string> laszip;
};

class LasSource final : public PointSource {
 public:
  // `own_unit`: coordinates are converted by the unit that the file declares.
  LasSource(const std::filesystem::path& path, bool own_unit) : path_(path), file_(path) {
    constexpr std::size_t kOldHeader = 227, kNewHeader = 375;
    constexpr std::uint8_t kCompressed = 0x80, kOtherFlag = 0x40;
    const std::string h(file_.take(kOldHeader), kOldHeader);
    const auto minor = static_cast<std::uint8_t>(h[25]);
    if (h[24] != 1 || minor > 5)
      throw Refused("it is LAS " + std::to_string(h[24]) + "." + std::to_string(minor) + ", and 1.0 to 1.5 are read");
    const auto format = static_cast<std::uint8_t>(h[104]);
    head_.format = format & static_cast<std::uint8_t>(~(kCompressed | kOtherFlag));
    if (head_.format >= kLeastRecord.size())
      throw Refused("its points are of format " + std::to_string(head_.format) +
                    ", and LAS has 0 to 10; export it again");
    head_.record = value_at<std::uint16_t>(h.data() + 105);
    if (head_.record < kLeastRecord[head_.format])
      throw Refused("its points of " + std::to_string(head_.record) + " bytes are too short for format " +
                    std::to_string(head_.format) + "; export it again");
    const auto header = value_at<std::uint16_t>(h.data() + 94);
    head_.first = value_at<std::uint32_t>(h.data() + 96);
    head_.count = value_at<std::uint32_t>(h.data() + 107);
    for (int axis = 0; axis < 3; ++axis) {
      head_.scale[axis] = value_at<double>(h.data() + 131 + 8 * axis);
      head_.offset[axis] = value_at<double>(h.data() + 155 + 8 * axis);
    }
    if (!head_.scale.allFinite() || !head_.offset.allFinite())
      throw Refused("the scale or offset of its coordinates is not finite; export it again");
    Records records;
    std::uint64_t extended = 0;
    std::uint32_t extended_count = 0;
    if (minor >= 4) {
      file_.seek(0);
      const char* more = file_.take(kNewHeader);
      head_.count = std::max(head_.count, value_at<std::uint64_t>(more + 247));
      extended = value_at<std::uint64_t>(more + 235), extended_count = value_at<std::uint32_t>(more + 243);
    }
    const bool compressed = (format & (kCompressed | kOtherFlag)) != 0;
    if (head_.first > file_.size() || (!compressed && head_.count > (file_.size() - head_.first) / head_.record))
      throw Refused("it is truncated: its header announces " + std::to_string(head_.count) + " points of " +
                    std::to_string(head_.record) + " bytes, it has " + std::to_string(file_.size()) +
                    " bytes; copy or export it again");
    if (head_.count == 0) throw Refused("it holds no point; export it again");
    read_records(records, header, value_at<std::uint32_t>(h.data() + 100), false);
    if (extended > 0) read_records(records, extended, extended_count, true);
    constexpr std::uint16_t kTextFlag = 16;
    take_system(records, (value_at<std::uint16_t>(h.data() + 6) & kTextFlag) != 0, own_unit);
    if (compressed) read_layout(records.laszip);
    scans_.push_back({});
  }

  std::uint64_t announced() const override { return head_.count; }
  bool metric() const override { return metric_; }

  void read(const PointSink& sink) override {
    if (laz_) {
      LazRecords records(path_, *laz_);
      read_points(sink, [&] { return records.next(); });
    } else {
      file_.seek(head_.first);
      read_points(sink, [&] { return file_.take(head_.record); });
    }
  }

 private:
  template <class Next>
  void read_points(const PointSink& sink, Next&& next) {
    BlockWriter points(sink, 0, false);
    const bool late = head_.format >= 6;
    const Eigen::Vector3d scale = head_.scale.cwiseProduct(head_.metres),
                          offset = head_.offset.cwiseProduct(head_.metres);
    for (std::uint64_t k = 0; k < head_.count; ++k) {
      const char* bytes = next();
      const auto flags = static_cast<std::uint8_t>(bytes[15]);
      const auto kind = static_cast<std::uint8_t>(late ? bytes[16] : flags & 0x1F);
      const bool withheld = late ? (flags & 4) != 0 : (flags & 0x80) != 0;
      if (withheld || kind == kNoise || kind == kHighNoise) continue;
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = value_at<std::int32_t>(bytes + 4 * axis) * scale[axis] + offset[axis];
      points.add(p);
    }
    points.flush();
  }

  // Reads variable length records before the points, or extended ones behind them.
  void read_records(Records& records, std::uint64_t place, std::uint32_t count, bool extended) {
    constexpr std::size_t kRecordHead = 54, kExtendedHead = 60, kMost = std::size_t{1} << 20;
    const std::size_t head_bytes = extended ? kExtendedHead : kRecordHead;
    const std::uint64_t end = extended ? file_.size() : head_.first;
    for (std::uint32_t k = 0; k < count && place <= end && end - place >= head_bytes; ++k) {
      file_.seek(place);
      const std::string head(file_.take(head_bytes), head_bytes);
      const auto id = value_at<std::uint16_t>(head.data() + 18);
      const std::uint64_t length = extended ? value_at<std::uint64_t>(head.data() + 20)
                                            : std::uint64_t{value_at<std::uint16_t>(head.data() + 20)};
      place += head_bytes;
      if (length > end - place) return;
      const std::string_view user(head.data() + 2, 16);
      const bool projection = user.starts_with("LASF_Projection");
      const bool wanted = projection || user.starts_with("laszip encoded");
      if (wanted && length <= kMost) {
        std::string body(file_.take(length), length);
        if (projection && id == 2112) records.text = body.substr(0, body.find('\0'));
        if (projection && id == 34735)
          records.keys = std::move(body);
        else if (projection && id == 34736)
          records.doubles = std::move(body);
        else if (!projection && id == 22204)
          records.laszip = std::move(body);
      }
      place += length;
    }
  }

  // Takes unit and system from the text or the keys, as a flag of the header says; else from the other of them.
  void take_system(const Records& records, bool by_text, bool own_unit) {
    DeclaredSystem system;
    if (!records.text.empty() && (by_text || records.keys.empty())) {
      system = system_of_text(records.text);
      if (!system.unit && !records.keys.empty()) system = system_of_keys(records.keys, records.doubles);
    } else if (!records.keys.empty()) {
      system = system_of_keys(records.keys, records.doubles);
      if (!system.unit && !records.text.empty()) system = system_of_text(records.text);
    }
    if (!own_unit) return;
    metric_ = system.unit;
    head_.metres = system.metres, crs_ = system.text, notes_ = system.notes;
  }

  // Reads from the record of LASzip how points are compressed.
  void read_layout(const std::optional<std::string>& record) {
    constexpr std::size_t kFixed = 34, kItem = 6;
    constexpr std::uint16_t kChunks = 2, kLayers = 3;
    constexpr const char* kOtherwise = "; decompress it to .las, e.g. with laszip or pdal translate";
    if (!record || record->size() < kFixed)
      throw Refused("its points are compressed, and it does not say how; copy or export it again");
    const char* bytes = record->data();
    const auto compressor = value_at<std::uint16_t>(bytes);
    const bool late = head_.format >= 6;
    if (compressor != (late ? kLayers : kChunks))
      throw Refused("its points are compressed in an old way (LASzip " + std::to_string(bytes[4]) + ", compressor " +
                    std::to_string(compressor) + ")" + kOtherwise);
    const auto items = value_at<std::uint16_t>(bytes + 32);
    for (std::size_t k = 0; k < items && kFixed + kItem * (k + 1) <= record->size(); ++k) {
      const auto version = value_at<std::uint16_t>(bytes + kFixed + kItem * k + 4);
      if (version < 2) throw Refused(std::string("its points are compressed in an old way") + kOtherwise);
    }
    if (head_.format == 4 || head_.format == 5)
      throw Refused("its compressed points are of format " + std::to_string(head_.format) +
                    ", with waveforms, which laz-perf does not read" + kOtherwise);
    laz_ = LazLayout{.first = head_.first,
                     .count = head_.count,
                     .format = head_.format,
                     .record = head_.record,
                     .chunk = value_at<std::uint32_t>(bytes + 12)};
  }

  std::filesystem::path path_;
  ByteFile file_;
  Head head_;
  bool metric_ = false;
  std::optional<LazLayout> laz_;  // if points are compressed
};

}  // namespace

std::unique_ptr<PointSource> open_las(const std::filesystem::path& file, const Reading& reading) {
  return std::make_unique<LasSource>(file, reading.own_unit);
}

}  // namespace vantage::importer
