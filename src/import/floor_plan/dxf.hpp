// SPDX-License-Identifier: Apache-2.0
// The text of a DXF as entities of group codes and values, without their meaning.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::floor_plan {

struct Group {
  int code = 0;
  std::string_view value;  // without surrounding blanks; text keeps its leading ones
};

// Returns NaN if the value is no number.
double number(const Group& group);
int integer(const Group& group);  // 0 if it is none

// Groups between two groups of code 0: an entity, a table's entry, the begin or end of a section. Extended data, groups
// of applications and embedded objects are left out, as their codes have other meanings.
struct Entity {
  std::string_view type;
  std::vector<Group> groups;

  // Returns the first group of that code; null if there is none.
  const Group* find(int code) const;
  bool has(int code) const { return find(code) != nullptr; }
  double number(int code, double otherwise = 0) const;
  int integer(int code, int otherwise = 0) const;
  std::string_view text(int code, std::string_view otherwise = {}) const;
};

// Axes of an entity's object coordinates in the world, by the arbitrary axis algorithm; the third is its extrusion.
using Axes = std::array<std::array<double, 3>, 3>;
Axes object_axes(const Entity& entity);

// Reads a file as a whole, then hands on its entities one by one.
class DxfText {
 public:
  // Throws Refused if the file cannot be read.
  explicit DxfText(const std::filesystem::path& file);
  DxfText(const DxfText&) = delete;
  DxfText& operator=(const DxfText&) = delete;

  // Reads the next entity, whose views live as long as this object; returns false at the file's end (EOF). Throws
  // Refused, with the line, if the text is no DXF or ends before.
  bool next(Entity& entity);

 private:
  bool next_group(Group& group);
  std::string_view line();

  std::string text_;
  std::size_t at_ = 0, line_ = 0;
  Group ahead_;  // the group of code 0 that begins the next entity
  bool begun_ = false;
};

// Receives the content of a file, in its order. Entities come with the vertices or attributes that follow them.
struct DxfTaker {
  std::function<void(const std::map<std::string_view, Group>&)> header;  // variables by name: the first group of each
  std::function<void(const Entity&)> layer, begin_block;
  std::function<void(const Entity&, const std::vector<Entity>& parts, bool in_block)> entity;
};
// Reads a DXF into `taker`. Views live as long as the call. Throws Refused.
void read_dxf(const std::filesystem::path& file, const DxfTaker& taker);

// A unit of $INSUNITS.
struct DxfUnit {
  const char* name;
  int code;
  double metres;
};
const DxfUnit* unit_of_code(int code);  // null if the code stands for no unit

}  // namespace vantage::floor_plan
