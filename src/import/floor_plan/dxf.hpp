// SPDX-License-Identifier: Apache-2.0
// The text of a DXF as entities of group codes and values, without what they mean.
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
  std::string_view value;  // without blanks around it; text keeps those before it
};

// NaN if the value is no number.
double number(const Group& group);
int integer(const Group& group);  // 0 if it is none

// What stands between two groups of code 0: an entity, a table's entry, the begin or end of a section. Extended data,
// groups of applications and embedded objects, whose codes mean something else, are left out.
struct Entity {
  std::string_view type;
  std::vector<Group> groups;

  // The first group of that code.
  const Group* find(int code) const;
  bool has(int code) const { return find(code) != nullptr; }
  double number(int code, double otherwise = 0) const;
  int integer(int code, int otherwise = 0) const;
  std::string_view text(int code, std::string_view otherwise = {}) const;
};

// The axes of an entity's object coordinates in the world: the arbitrary axes of its extrusion, which is the third.
using Axes = std::array<std::array<double, 3>, 3>;
Axes object_axes(const Entity& entity);

// Reads a file whole, then entity by entity.
class DxfText {
 public:
  // Throws Refused if the file cannot be read.
  explicit DxfText(const std::filesystem::path& file);
  DxfText(const DxfText&) = delete;
  DxfText& operator=(const DxfText&) = delete;

  // The next entity, whose views live as long as this; false at the file's end (EOF). Throws Refused, with the line, if
  // the text is no DXF or ends before its end.
  bool next(Entity& entity);

 private:
  bool next_group(Group& group);
  std::string_view line();

  std::string text_;
  std::size_t at_ = 0, line_ = 0;
  Group ahead_;  // the group of code 0 that begins the next entity
  bool begun_ = false;
};

// Takes what a file holds, in its order. Entities come with the vertices or attributes that follow them.
struct DxfTaker {
  std::function<void(const std::map<std::string_view, Group>&)> header;  // variables by name: the first group of each
  std::function<void(const Entity&)> layer, begin_block;
  std::function<void(const Entity&, const std::vector<Entity>& parts, bool in_block)> entity;
};
// Views live as long as the call. Throws Refused.
void read_dxf(const std::filesystem::path& file, const DxfTaker& taker);

// A unit of $INSUNITS.
struct DxfUnit {
  const char* name;
  int code;
  double metres;
};
const DxfUnit* unit_of_code(int code);  // null if it means none

}  // namespace vantage::floor_plan
