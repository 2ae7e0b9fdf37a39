// SPDX-License-Identifier: Apache-2.0
// LAS 1.0 to 1.4, point data record formats 0 to 10 (ASPRS: LAS Specification 1.4 R15, 2019).
#include <algorithm>
#include <array>
#include <cmath>

#include "core/utf8.hpp"
#include "import/cloud/byte_file.hpp"
#include "import/cloud/points.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::array<std::size_t, 11> kLeastRecord{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::uint8_t kNoise = 7, kHighNoise = 18;
constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937;

struct Head {
  std::size_t format = 0, record = 0;
  std::uint64_t first = 0, count = 0;
  Eigen::Vector3d scale, offset;
  double metres = 1;
};

class LasSource final : public PointSource {
 public:
  explicit LasSource(const std::filesystem::path& path) : file_(path) {
    constexpr std::size_t kOldHeader = 227, kNewHeader = 375;
    const std::string h(file_.take(kOldHeader), kOldHeader);
    const auto minor = static_cast<std::uint8_t>(h[25]);
    if (h[24] != 1 || minor > 4)
      throw Refused("it is LAS " + std::to_string(h[24]) + "." + std::to_string(minor) + ", and 1.0 to 1.4 are read");
    const auto format = static_cast<std::uint8_t>(h[104]);
    if (format & 0xC0)
      throw Refused("its points are compressed (LAZ); decompress them, e.g. with las2las or pdal translate, to .las");
    head_.format = format;
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
    if (minor >= 4) {
      file_.seek(0);
      head_.count = std::max(head_.count, value_at<std::uint64_t>(file_.take(kNewHeader) + 247));
    }
    if (head_.first > file_.size() || head_.count > (file_.size() - head_.first) / head_.record)
      throw Refused("it is truncated: its header announces " + std::to_string(head_.count) + " points of " +
                    std::to_string(head_.record) + " bytes, it has " + std::to_string(file_.size()) +
                    " bytes; copy or export it again");
    if (head_.count == 0) throw Refused("it holds no point; export it again");
    read_system(header, value_at<std::uint32_t>(h.data() + 100));
    scans_.push_back({});
  }

  std::uint64_t announced() const override { return head_.count; }

  void read(const PointSink& sink) override {
    BlockWriter points(sink, 0, false);
    file_.seek(head_.first);
    const bool late = head_.format >= 6;
    for (std::uint64_t k = 0; k < head_.count; ++k) {
      const char* bytes = file_.take(head_.record);
      const auto flags = static_cast<std::uint8_t>(bytes[15]);
      const auto kind = static_cast<std::uint8_t>(late ? bytes[16] : flags & 0x1F);
      const bool withheld = late ? (flags & 4) != 0 : (flags & 0x80) != 0;
      if (withheld || kind == kNoise || kind == kHighNoise) continue;
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = (value_at<std::int32_t>(bytes + 4 * axis) * head_.scale[axis] + head_.offset[axis]) * head_.metres;
      points.add(p);
    }
    points.flush();
  }

 private:
  // Unit and system, from records before the points.
  void read_system(std::uint64_t place, std::uint32_t records) {
    constexpr std::size_t kRecordHead = 54;
    for (std::uint32_t k = 0; k < records && place + kRecordHead <= head_.first; ++k) {
      file_.seek(place);
      const std::string head(file_.take(kRecordHead), kRecordHead);
      const auto id = value_at<std::uint16_t>(head.data() + 18), length = value_at<std::uint16_t>(head.data() + 20);
      place += kRecordHead + length;
      if (std::string_view(head).substr(2, 15) != "LASF_Projection" || place > head_.first) continue;
      const std::string body(file_.take(length), length);
      if (id == 2112) read_text(body.substr(0, body.find('\0')));
      if (id == 34735) read_keys(body);
    }
    if (head_.metres != 1)
      notes_.push_back("its coordinates are in feet, and are taken as metres times " + std::to_string(head_.metres));
  }

  void read_text(const std::string& text) {
    if (text.starts_with("GEOGC")) refuse_degrees();
    // The unit of length is the last one that the text names.
    constexpr std::string_view kUnit = "UNIT[\"";
    const std::size_t at = text.rfind(kUnit);
    const std::string unit =
        at == std::string::npos ? ""
                                : text.substr(at + kUnit.size(), text.find('"', at + kUnit.size()) - at - kUnit.size());
    const bool foot = unit.find("oot") != std::string::npos || unit == "ft" || unit == "US-ft";
    if (foot)
      head_.metres =
          unit.find("US") != std::string::npos || unit.find("urvey") != std::string::npos ? kSurveyFoot : kFoot;
    if (!foot && !text.starts_with("LOCAL_CS")) crs_ = to_utf8(text);
  }

  void read_keys(const std::string& keys) {
    for (std::size_t at = 8; at + 8 <= keys.size(); at += 8) {
      const auto key = value_at<std::uint16_t>(keys.data() + at), where = value_at<std::uint16_t>(keys.data() + at + 2),
                 value = value_at<std::uint16_t>(keys.data() + at + 6);
      if (where != 0) continue;
      if (key == 1024 && value == 2) refuse_degrees();
      if (key == 3076 && value == 9002) head_.metres = kFoot;
      if (key == 3076 && value == 9003) head_.metres = kSurveyFoot;
      if (key == 3072 && value >= 1024 && value < 32767 && crs_.empty()) crs_ = "EPSG:" + std::to_string(value);
    }
    if (head_.metres != 1) crs_.clear();  // no longer the system's coordinates
  }

  [[noreturn]] static void refuse_degrees() {
    throw Refused("its coordinates are degrees of latitude and longitude; project them to metres, e.g. UTM");
  }

  ByteFile file_;
  Head head_;
};

}  // namespace

std::unique_ptr<PointSource> open_las(const std::filesystem::path& file) { return std::make_unique<LasSource>(file); }

}  // namespace vantage::importer
