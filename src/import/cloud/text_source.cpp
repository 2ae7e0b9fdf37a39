// SPDX-License-Identifier: Apache-2.0
// Points as lines of numbers: XYZ and CSV; PTS, which counts them first; and PTX, scans with a head of ten lines each:
// columns, rows, the scanner's place, its axes, and the matrix that moves its points (row vectors; Leica, Cyclone
// pointcloud export format).
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "import/cloud/points.hpp"
#include "import/cloud/scalar_field.hpp"
#include "import/cloud/text_columns.hpp"

namespace vantage::importer {
namespace {

// Reads the numbers at the start of a line, at most `most`; returns how many.
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
  TextSource(const std::filesystem::path& path, const Reading& reading) : file_(path) {
    const std::array first{next_counts(), next_counts()};
    ptx_ = first[0] == 1 && first[1] == 1;
    if (ptx_) return;
    scans_.push_back({});
    columns_ = columns_of(first_lines(), reading.columns);
    if (!reading.own_unit) columns_.metres = 0;
    file_.seek(0);
  }

  bool metric() const override { return ptx_ || columns_.metres > 0; }

  void read(const PointSink& sink) override {
    file_.seek(0);
    line_ = 0;
    if (ptx_)
      read_ptx(sink);
    else
      read_xyz(sink);
  }

 private:
  // Returns the number of words in the next line, if all are whole numbers; else 0.
  std::size_t next_counts() {
    auto line = file_.line();
    std::size_t n = 0;
    if (line)
      for (std::string_view word = next_word(*line); !word.empty(); word = next_word(*line), ++n)
        if (word.find_first_not_of("0123456789") != std::string_view::npos) return 0;
    return n;
  }

  // Returns enough lines, without empty ones, to recognise columns.
  std::vector<std::string> first_lines() {
    constexpr std::size_t kLines = 2000;
    std::vector<std::string> lines;
    file_.seek(0);
    while (lines.size() < kLines)
      if (const auto line = file_.line(); !line)
        break;
      else if (!line->empty())
        lines.emplace_back(lines.empty() && line->starts_with("\xEF\xBB\xBF") ? line->substr(3) : *line);
    return lines;
  }

  std::optional<std::string_view> next_line() {
    ++line_;
    return file_.line();
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw Refused("line " + std::to_string(line_) + " " + what + "; copy or export it again");
  }

  // Reads the coordinates of a line; returns false if it has none.
  bool coordinates(std::string_view line, std::array<double, 3>& p) {
    if (columns_.usual()) return numbers(line, p.data(), 3) == 3;
    columns_.split(line, words_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns_.place[axis] >= words_.size()) return false;
      const auto value = columns_.numbers.value(words_[columns_.place[axis]]);
      if (!value) return false;
      p[axis] = *value;
    }
    return true;
  }

  void read_xyz(const PointSink& sink) {
    // Titles, counts and comments may stand between points; a file with more of them than points is no cloud.
    BlockWriter points(sink, 0, false);
    std::uint64_t found = 0, others = 0;
    const double metres = columns_.metres > 0 ? columns_.metres : 1;
    while (const auto line = next_line()) {
      std::array<double, 3> p{};
      if (coordinates(*line, p)) {
        points.add({p[0] * metres, p[1] * metres, p[2] * metres});
        ++found;
      } else if (!line->empty() && !line->starts_with('#') && !line->starts_with("//") && ++others > 100 + found) {
        refuse("and most others are no points, which begin with three numbers");
      }
    }
    points.flush();
    notes_.clear();
    if (!columns_.note.empty()) notes_.push_back(columns_.note);
    if (metres != 1)
      notes_.push_back("its titles tell the unit, " + std::to_string(metres) +
                       " m, and coordinates are taken as metres");
    if (others > 2) notes_.push_back(std::to_string(others) + " lines that are no points are passed over");
  }

  void read_ptx(const PointSink& sink) {
    scans_.clear(), notes_.clear();
    while (auto first = next_line()) {
      if (first->find_first_not_of(" \t") == std::string_view::npos) continue;
      std::string_view words = *first;
      const std::uint64_t columns = count_of(next_word(words), "its columns");
      auto second = next_line();
      if (!second) refuse("ends the head of a scan");
      words = *second;
      const std::uint64_t rows = count_of(next_word(words), "its rows");
      if (columns > UINT32_MAX || rows > UINT32_MAX) refuse("has more rows than there can be");
      Eigen::Matrix4d head = Eigen::Matrix4d::Identity();  // position and axes, which the matrix mostly repeats
      for (const int column : {3, 0, 1, 2}) {
        const auto line = next_line();
        std::array<double, 3> v{};
        if (!line || numbers(*line, v.data(), 3) != 3) refuse("has not three numbers, as the head of a scan has");
        for (int row = 0; row < 3; ++row) head(row, column) = v[static_cast<std::size_t>(row)];
      }
      Eigen::Matrix4d matrix;
      for (int row = 0; row < 4; ++row) {
        const auto line = next_line();
        std::array<double, 4> v{};
        if (!line || numbers(*line, v.data(), 4) != 4) refuse("has not four numbers, as the matrix of a scan has");
        for (int column = 0; column < 4; ++column) matrix(column, row) = v[static_cast<std::size_t>(column)];
      }
      if (!matrix.allFinite()) refuse("ends a matrix that is not finite");
      if (!head.allFinite()) refuse("ends a head that is not finite");
      read_scan(columns, rows, head, matrix, sink);
    }
  }

  // Reads the points behind the head of a scan. Some writers leave the matrix at identity and tell the scanner's
  // position above it alone; points are then in the scanner's frame, or moved already. The grid decides: the points of
  // a column lie in one plane through the scanner.
  void read_scan(std::uint64_t columns, std::uint64_t rows, const Eigen::Matrix4d& head, const Eigen::Matrix4d& matrix,
                 const PointSink& sink) {
    CloudScan scan;
    scan.name = "scan " + std::to_string(scans_.size() + 1);
    scan.posed = true;
    const bool by_head = matrix.isIdentity() && !head.isIdentity();
    Eigen::Matrix4d moves = matrix;
    if (by_head) {
      const std::uint64_t place = file_.place(), line = line_;
      const bool moved = moved_already(columns, rows, head.block<3, 1>(0, 3));
      file_.seek(place), line_ = line;
      if (!moved) moves = head;
      const std::string note = moved ? "its scanners' places are those before matrices that move nothing"
                                     : "the matrices of its scans move nothing: the place and axes before them do";
      if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(note);
    }
    const Eigen::Matrix4d& pose = by_head ? head : matrix;
    scan.position = pose.block<3, 1>(0, 3);
    scan.rotation = Eigen::Quaterniond(Eigen::Matrix3d(pose.block<3, 3>(0, 0))).normalized();
    scans_.push_back(scan);
    BlockWriter points(sink, static_cast<std::uint32_t>(scans_.size() - 1), false);
    for (std::uint64_t k = 0; k < columns * rows; ++k) {
      Eigen::Vector3d p;
      if (read_point(columns * rows, p)) points.add((moves * p.homogeneous()).head<3>());
    }
    points.flush();
  }

  // Reads the point of the next line; returns false without a return.
  bool read_point(std::uint64_t all, Eigen::Vector3d& p) {
    const auto line = next_line();
    if (!line) refuse("is missing: a scan of " + std::to_string(all) + " points ends before");
    if (numbers(*line, p.data(), 3) != 3) refuse("has not three numbers, as a point has");
    return p != Eigen::Vector3d::Zero();
  }

  // Points leave the plane of their column less if seen from their scanner: the origin or the head. Angles would not
  // do, as all are small from far away. Without columns, the place with the smaller median range is the scanner's.
  bool moved_already(std::uint64_t columns, std::uint64_t rows, const Eigen::Vector3d& head) {
    constexpr std::uint64_t kMost = 200'000;
    constexpr std::size_t kLeast = 30;
    std::array<double, 2> astray{};
    std::array<std::vector<double>, 2> distances;
    std::size_t pairs = 0;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    bool follows = false;  // `last` is in the same column
    for (std::uint64_t k = 0; k < std::min(columns * rows, kMost); ++k) {
      follows = follows && k % rows != 0;
      Eigen::Vector3d p;
      if (!read_point(columns * rows, p)) continue;
      pairs += follows;
      for (std::size_t from = 0; from < 2; ++from) {
        const Eigen::Vector3d b = p - from * head;
        distances[from].push_back(b.norm());
        if (!follows) continue;
        const Eigen::Vector3d a = last - from * head;
        const double longer = std::max(a.head<2>().norm(), b.head<2>().norm());
        if (longer > 0) astray[from] += std::abs(a.x() * b.y() - a.y() * b.x()) / longer;
      }
      last = p, follows = true;
    }
    if (pairs >= kLeast) return astray[1] < astray[0];
    if (distances[0].empty()) return false;
    for (auto& all : distances)
      std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
    return distances[1][distances[1].size() / 2] < distances[0][distances[0].size() / 2];
  }

  ByteFile file_;
  bool ptx_ = false;
  std::uint64_t line_ = 0;
  TextColumns columns_;
  std::vector<std::string_view> words_;
};

}  // namespace

std::unique_ptr<PointSource> open_text(const std::filesystem::path& file, const Reading& reading) {
  return std::make_unique<TextSource>(file, reading);
}

}  // namespace vantage::importer
