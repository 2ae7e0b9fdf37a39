// SPDX-License-Identifier: Apache-2.0
// Points as lines of numbers: XYZ; PTS, which counts them first; and PTX, scans with a head of ten lines each: columns,
// rows, the scanner's place, its axes, and the matrix that moves its points (row vectors; Leica, Cyclone pointcloud
// export format).
#include <array>

#include "import/cloud/points.hpp"
#include "import/cloud/scalar_field.hpp"

namespace vantage::importer {
namespace {

// Numbers at the start of a line, as many as there are up to `most`.
std::size_t numbers(std::string_view line, double* to, std::size_t most) {
  std::size_t n = 0;
  for (; n < most; ++n) {
    const auto value = number_of(next_word(line));
    if (!value) break;
    to[n] = *value;
  }
  return n;
}

class TextSource final : public PointSource {
 public:
  explicit TextSource(const std::filesystem::path& path) : file_(path) {
    const std::array first{next_counts(), next_counts()};
    ptx_ = first[0] == 1 && first[1] == 1;
    if (!ptx_) scans_.push_back({});
  }

  void read(const PointSink& sink) override {
    file_.seek(0);
    line_ = 0;
    if (ptx_)
      read_ptx(sink);
    else
      read_xyz(sink);
  }

 private:
  // How many words the next line has, if all are whole numbers; else 0.
  std::size_t next_counts() {
    auto line = file_.line();
    std::size_t n = 0;
    if (line)
      for (std::string_view word = next_word(*line); !word.empty(); word = next_word(*line), ++n)
        if (word.find_first_not_of("0123456789") != std::string_view::npos) return 0;
    return n;
  }

  std::optional<std::string_view> next_line() {
    ++line_;
    return file_.line();
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw Refused("line " + std::to_string(line_) + " " + what + "; copy or export it again");
  }

  void read_xyz(const PointSink& sink) {
    // Titles, counts and comments stand between points; more of them than points are no cloud.
    BlockWriter points(sink, 0, false);
    std::uint64_t found = 0, others = 0;
    while (const auto line = next_line()) {
      std::array<double, 3> p{};
      if (numbers(*line, p.data(), 3) == 3) {
        points.add({p[0], p[1], p[2]});
        ++found;
      } else if (!line->empty() && !line->starts_with('#') && !line->starts_with("//") && ++others > 100 + found) {
        refuse("and most others are no points, which begin with three numbers");
      }
    }
    points.flush();
    notes_.clear();
    if (others > 2) notes_.push_back(std::to_string(others) + " lines that are no points are passed over");
  }

  void read_ptx(const PointSink& sink) {
    scans_.clear();
    while (auto first = next_line()) {
      if (first->find_first_not_of(" \t") == std::string_view::npos) continue;
      std::string_view words = *first;
      const std::uint64_t columns = count_of(next_word(words), "its columns");
      auto second = next_line();
      if (!second) refuse("ends the head of a scan");
      words = *second;
      const std::uint64_t rows = count_of(next_word(words), "its rows");
      if (columns > UINT32_MAX || rows > UINT32_MAX) refuse("has more rows than there can be");
      std::array<double, 3> skipped{};
      for (int k = 0; k < 4; ++k) {  // place and axes, which the matrix has, too
        const auto line = next_line();
        if (!line || numbers(*line, skipped.data(), 3) != 3) refuse("has not three numbers, as the head of a scan has");
      }
      Eigen::Matrix4d matrix;
      for (int row = 0; row < 4; ++row) {
        const auto line = next_line();
        std::array<double, 4> v{};
        if (!line || numbers(*line, v.data(), 4) != 4) refuse("has not four numbers, as the matrix of a scan has");
        for (int column = 0; column < 4; ++column) matrix(column, row) = v[static_cast<std::size_t>(column)];
      }
      if (!matrix.allFinite()) refuse("ends a matrix that is not finite");
      CloudScan scan;
      scan.name = "scan " + std::to_string(scans_.size() + 1);
      scan.posed = true;
      scan.position = matrix.block<3, 1>(0, 3);
      scan.rotation = Eigen::Quaterniond(Eigen::Matrix3d(matrix.block<3, 3>(0, 0))).normalized();
      scans_.push_back(scan);
      BlockWriter points(sink, static_cast<std::uint32_t>(scans_.size() - 1), false);
      for (std::uint64_t k = 0; k < columns * rows; ++k) {
        const auto line = next_line();
        std::array<double, 3> p{};
        if (!line) refuse("is missing: a scan of " + std::to_string(columns * rows) + " points ends before");
        if (numbers(*line, p.data(), 3) != 3) refuse("has not three numbers, as a point has");
        if (p[0] == 0 && p[1] == 0 && p[2] == 0) continue;  // no return
        points.add((matrix * Eigen::Vector4d(p[0], p[1], p[2], 1)).head<3>());
      }
      points.flush();
    }
  }

  ByteFile file_;
  bool ptx_ = false;
  std::uint64_t line_ = 0;
};

}  // namespace

std::unique_ptr<PointSource> open_text(const std::filesystem::path& file) { return std::make_unique<TextSource>(file); }

}  // namespace vantage::importer
