// SPDX-License-Identifier: Apache-2.0
// Multilines (MLINE), which dxflib passes over: walls of older drawings.
#include "import/floor_plan/multilines.hpp"

#include <charconv>
#include <cmath>
#include <fstream>

namespace vantage::floor_plan {
namespace {

// A vertex, and how far along its mitre each element lies.
struct MultilineVertex {
  Point at, mitre;
  std::vector<double> offsets;
};

std::string trimmed(const std::string& line) {
  const auto from = line.find_first_not_of(" \t\r"), to = line.find_last_not_of(" \t\r");
  return from == std::string::npos ? "" : line.substr(from, to - from + 1);
}

double coordinate(const std::string& text) {
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size() ? value : std::nan("");
}

// Group codes of one entity, in their order.
class Multiline {
 public:
  std::string layer = "0";
  bool model_space = true;

  void add(int code, const std::string& value) {
    constexpr int kClosed = 2;
    if (code == 8) layer = value;
    if (code == 67) model_space = value == "0";
    if (code == 71) closed_ = (static_cast<int>(coordinate(value)) & kClosed) != 0;
    if (code == 11) vertices_.push_back({{coordinate(value), 0}, {}, {}});
    if (vertices_.empty()) return;
    MultilineVertex& last = vertices_.back();
    if (code == 21) last.at.y = coordinate(value);
    if (code == 13) last.mitre.x = coordinate(value);
    if (code == 23) last.mitre.y = coordinate(value);
    // The first parameter of an element is its place; others begin and end its dashes.
    if (code == 74) first_ = true;
    if (code == 41 && first_) last.offsets.push_back(coordinate(value)), first_ = false;
  }

  std::vector<std::pair<Point, Point>> lines() const {
    std::vector<std::pair<Point, Point>> all;
    const std::size_t edges = vertices_.size() < 2 ? 0 : vertices_.size() - (closed_ ? 0 : 1);
    for (std::size_t k = 0; k < edges; ++k) {
      const MultilineVertex &a = vertices_[k], &b = vertices_[(k + 1) % vertices_.size()];
      for (std::size_t e = 0; e < std::min(a.offsets.size(), b.offsets.size()); ++e)
        all.emplace_back(a.at + a.mitre * a.offsets[e], b.at + b.mitre * b.offsets[e]);
    }
    return all;
  }

 private:
  bool closed_ = false, first_ = false;
  std::vector<MultilineVertex> vertices_;
};

}  // namespace

void read_multilines(const std::filesystem::path& file,
                     const std::function<void(const std::string& layer, Point a, Point b)>& add) {
  std::ifstream stream(file, std::ios::binary);
  std::string code, value, section;
  std::optional<Multiline> open;
  const auto finish = [&] {
    if (open && open->model_space)
      for (const auto& [a, b] : open->lines()) add(open->layer, a, b);
    open.reset();
  };
  while (std::getline(stream, code) && std::getline(stream, value)) {
    code = trimmed(code), value = trimmed(value);
    if (code == "0") {
      finish();
      if (value == "ENDSEC") section.clear();
      if (value == "MLINE" && section == "ENTITIES") open.emplace();
    } else if (code == "2" && section.empty()) {
      section = value;
    } else if (open) {
      int number = -1;
      std::from_chars(code.data(), code.data() + code.size(), number);
      open->add(number, value);
    }
  }
  finish();
}

}  // namespace vantage::floor_plan
