// SPDX-License-Identifier: Apache-2.0
// Header of a binary PLY whose number of vertices is only known at the end, and how the coordinates behind it are
// written. Its length does not depend on the number.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/point_sink.hpp"
#include "vantage/export.hpp"
#include "vantage/version.hpp"

namespace vantage {

struct PlyProperty {
  const char* type;
  std::string name;
};

class PlyHeader {
 public:
  // `site`: a place in the midst of the points, survey frame. `more`: properties behind x, y and z. `crs`: well-known
  // text in one line, written as a comment, or empty.
  PlyHeader(PlyCoordinates coordinates, const Vec3& site, const std::vector<PlyProperty>& more, std::string crs = {})
      : doubles_(coordinates == PlyCoordinates::doubles), crs_(std::move(crs)) {
    const char* type = doubles_ ? "double" : "float";
    properties_ = {{type, "x"}, {type, "y"}, {type, "z"}};
    properties_.insert(properties_.end(), more.begin(), more.end());
    // A kilometre away floats still keep 0.03 mm; whole ones are the same for all files of a site, and easy to type.
    if (!doubles_) origin_ = {whole_km(site.x), whole_km(site.y), whole_km(site.z)};
  }

  std::string text(std::uint64_t vertices) const {
    const std::string count = std::to_string(vertices);
    // The comment pads the digits that the number lacks; some readers take leading zeros as octal.
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment vantage " + std::string(version()) + " " +
                       std::string(20 - count.size(), '.') + "\n";
    if (!doubles_) {
      text += "comment origin";
      for (const double c : {origin_.x, origin_.y, origin_.z}) text += " " + std::to_string(std::llround(c));
      text += "\n";
    }
    text += (crs_.empty() ? "" : "comment crs " + crs_ + "\n") + "element vertex " + count + "\n";
    for (const auto& [type, name] : properties_)
      text.append("property ").append(type).append(" ").append(name).append("\n");
    return text + "end_header\n";
  }

  // Appends x, y and z of a point of the survey frame.
  void append_place(std::string& record, const Vec3& point) const {
    for (const double c : {point.x - origin_.x, point.y - origin_.y, point.z - origin_.z})
      doubles_ ? append(record, c) : append(record, static_cast<float>(c));
  }

 private:
  static double whole_km(double metres) { return 1000 * std::round(metres / 1000); }

  bool doubles_;
  Vec3 origin_{};
  std::vector<PlyProperty> properties_;
  std::string crs_;
};

}  // namespace vantage
