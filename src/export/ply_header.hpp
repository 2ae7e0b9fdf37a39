// SPDX-License-Identifier: Apache-2.0
// Header of a binary PLY whose number of vertices is only known at the end. Its length does not depend on the number.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "vantage/version.hpp"

namespace vantage {

struct PlyProperty {
  const char* type;
  std::string name;
};

class PlyHeader {
 public:
  // `crs`: well-known text in one line, written as a comment, or empty.
  explicit PlyHeader(std::vector<PlyProperty> properties, std::string crs = {})
      : properties_(std::move(properties)), crs_(std::move(crs)) {}

  std::string text(std::uint64_t vertices) const {
    const std::string count = std::to_string(vertices);
    // The comment pads the digits that the number lacks; some readers take leading zeros as octal.
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment vantage " + std::string(version()) + " " +
                       std::string(20 - count.size(), '.') + "\n" + (crs_.empty() ? "" : "comment crs " + crs_ + "\n") +
                       "element vertex " + count + "\n";
    for (const auto& [type, name] : properties_)
      text.append("property ").append(type).append(" ").append(name).append("\n");
    return text + "end_header\n";
  }

 private:
  std::vector<PlyProperty> properties_;
  std::string crs_;
};

}  // namespace vantage
