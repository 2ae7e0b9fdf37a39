// SPDX-License-Identifier: Apache-2.0
// PCD 0.6 and 0.7 of the Point Cloud Library (Rusu and Cousins, 3D is here, 2011): text, binary, and compressed binary.
// A viewpoint moves the points, as PCL's viewer has it, and is where the scanner stood.
#include <algorithm>
#include <array>
#include <cmath>

#include "import/cloud/lzf.hpp"
#include "import/cloud/points.hpp"
#include "import/cloud/scalar_field.hpp"

namespace vantage::importer {
namespace {

constexpr std::uint64_t kMostUnpacked = std::uint64_t{1} << 29;

class PcdSource final : public PointSource {
 public:
  explicit PcdSource(const std::filesystem::path& path) : file_(path) {
    read_header();
    for (const char* name : {"x", "y", "z"}) place_.push_back(index_of(name));
    normal_ = find_fields(fields_, {"normal_x", "normal_y", "normal_z"});
    used_ = place_;
    used_.insert(used_.end(), normal_.begin(), normal_.end());
    data_at_ = file_.place();
    CloudScan scan;
    // Writers put the default viewpoint if they know none, as for a merged cloud; it is no pose.
    scan.posed = moved_ = !place_of_view_.isZero(0) || std::abs(view_.w()) < view_.norm();
    scan.position = place_of_view_;
    if (moved_) scan.rotation = view_.normalized();
    turn_ = scan.rotation.toRotationMatrix();
    scans_.push_back(scan);
    if (moved_) notes_.emplace_back("its viewpoint moves its points, and is where the scanner stood");
  }

  std::uint64_t announced() const override { return count_; }
  bool metric() const override { return false; }
  bool floats() const override { return data_ != "ascii" && !moved_ && are_floats(fields_, place_); }

  void read(const PointSink& sink) override {
    file_.seek(data_at_);
    BlockWriter points(sink, 0, !normal_.empty());
    if (data_ == "ascii")
      read_text(points);
    else if (data_ == "binary")
      read_binary(points);
    else
      read_compressed(points);
    points.flush();
  }

 private:
  void read_header() {
    constexpr int kMostLines = 100;
    std::vector<std::string> sizes, types, counts;
    const auto words = [](std::string_view line) {
      std::vector<std::string> all;
      for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) all.emplace_back(word);
      return all;
    };
    std::vector<std::string> names;
    std::optional<std::uint64_t> width, height, points;
    for (int k = 0; k < kMostLines && data_.empty(); ++k) {
      const auto whole = file_.line();
      if (!whole) break;
      std::string_view line = *whole;
      const std::string_view key = next_word(line);
      if (key == "FIELDS" || key == "COLUMNS") names = words(line);
      if (key == "SIZE") sizes = words(line);
      if (key == "TYPE") types = words(line);
      if (key == "COUNT") counts = words(line);
      if (key == "WIDTH") width = count_of(next_word(line), "its width");
      if (key == "HEIGHT") height = count_of(next_word(line), "its height");
      if (key == "POINTS") points = count_of(next_word(line), "the number of its points");
      if (key == "VIEWPOINT") read_viewpoint(line);
      if (key == "DATA") data_ = next_word(line);
    }
    if (data_ != "ascii" && data_ != "binary" && data_ != "binary_compressed")
      throw Refused("its header names no data that PCD knows; copy or export it again");
    if (names.empty() || names.size() > 1000 || sizes.size() != names.size() || types.size() != names.size() ||
        (!counts.empty() && counts.size() != names.size()))
      throw Refused("its header has not a size, type and count for each field; export it again");
    constexpr std::uint64_t kLargest = std::uint64_t{1} << 32;
    if (!points && width.value_or(kLargest) < kLargest && height.value_or(kLargest) < kLargest)
      points = *width * *height;
    if (!points || *points == 0) throw Refused("it holds no point; export it again");
    count_ = *points;
    for (std::size_t k = 0; k < names.size(); ++k) {
      ScalarField field{names[k], types[k].front(), count_of(sizes[k], "a size"), record_};
      const std::uint64_t times = counts.empty() ? 1 : count_of(counts[k], "a count");
      const bool known = field.kind == 'F' ? field.bytes == 4 || field.bytes == 8
                                           : (field.kind == 'I' || field.kind == 'U') &&
                                                 std::has_single_bit(field.bytes) && field.bytes <= 8;
      if (!known || times > 100'000)
        throw Refused("its field " + names[k].substr(0, 40) + " has no type that PCD knows; export it again");
      record_ += field.bytes * times;
      fields_.push_back(field);
      times_.push_back(times);
    }
  }

  // Reads a position, and a rotation as a quaternion w, x, y, z.
  void read_viewpoint(std::string_view line) {
    std::array<double, 7> v{};
    for (double& value : v) {
      const auto number = number_of(next_word(line));
      if (!number || !std::isfinite(*number))
        throw Refused("its viewpoint has not seven numbers, place and turn; export it again");
      value = *number;
    }
    place_of_view_ = {v[0], v[1], v[2]};
    view_ = Eigen::Quaterniond(v[3], v[4], v[5], v[6]);
    if (!(view_.norm() > 0)) throw Refused("the turn of its viewpoint is no quaternion; export it again");
  }

  std::size_t index_of(const char* name) const {
    const std::size_t k = find_field(fields_, name);
    if (k == fields_.size() || times_[k] != 1)
      throw Refused("its points have no " + std::string(name) + "; export it again");
    return k;
  }
  [[noreturn]] void truncated() const {
    throw Refused("it is truncated: its header announces " + std::to_string(count_) +
                  " points; copy or export it again");
  }

  void add(BlockWriter& points, const std::vector<double>& values) const {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (!normal_.empty())
      normal = Eigen::Vector3d(values[normal_[0]], values[normal_[1]], values[normal_[2]]).cast<float>();
    Eigen::Vector3d p(values[place_[0]], values[place_[1]], values[place_[2]]);
    if (moved_) {
      p = turn_ * p + place_of_view_;
      normal = turn_.cast<float>() * normal;
    }
    points.add(p, normal);
  }

  void read_text(BlockWriter& points) {
    std::vector<double> values(fields_.size());
    for (std::uint64_t k = 0; k < count_; ++k) {
      auto line = file_.line();
      if (!line) truncated();
      for (std::size_t f = 0; f < values.size(); ++f)
        for (std::uint64_t t = 0; t < times_[f]; ++t) {
          const auto number = number_of(next_word(*line));
          if (!number)
            throw Refused("point " + std::to_string(k + 1) + " has no number where one belongs; export it again");
          values[f] = *number;
        }
      add(points, values);
    }
  }

  void read_binary(BlockWriter& points) {
    if (count_ > file_.left() / record_) truncated();
    std::vector<double> values(fields_.size());
    for (std::uint64_t k = 0; k < count_; ++k) {
      const char* record = file_.take(record_);
      for (const std::size_t f : used_) values[f] = fields_[f].value(record, false);
      add(points, values);
    }
  }

  // Reads all values of one field, then all of the next.
  void read_compressed(BlockWriter& points) {
    const std::string sizes(file_.take(8), 8);
    const std::uint64_t packed = value_at<std::uint32_t>(sizes.data()),
                        bytes = value_at<std::uint32_t>(sizes.data() + 4);
    if (bytes > kMostUnpacked)
      throw Refused("it holds " + std::to_string(bytes >> 20) +
                    " MiB of compressed points, and 512 are unpacked at once; export it as DATA binary");
    if (count_ > bytes / record_ || packed > file_.left() || packed > bytes + bytes / 16 + 64) truncated();
    const std::string columns = unpack_lzf({file_.take(packed), packed}, bytes);
    std::vector<double> values(fields_.size());
    for (std::uint64_t k = 0; k < count_; ++k) {
      for (const std::size_t f : used_) {
        const ScalarField& field = fields_[f];
        values[f] = field.read(columns.data() + count_ * field.at + k * field.bytes, false);
      }
      add(points, values);
    }
  }

  ByteFile file_;
  std::vector<ScalarField> fields_;
  std::vector<std::uint64_t> times_;
  std::vector<std::size_t> place_, normal_, used_;  // fields; used_: place_ and normal_
  std::string data_;
  std::uint64_t count_ = 0, data_at_ = 0;
  std::size_t record_ = 0;
  Eigen::Vector3d place_of_view_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond view_ = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  bool moved_ = false;
};

}  // namespace

std::unique_ptr<PointSource> open_pcd(const std::filesystem::path& file) { return std::make_unique<PcdSource>(file); }

}  // namespace vantage::importer
