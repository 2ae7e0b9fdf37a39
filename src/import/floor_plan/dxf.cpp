// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/dxf.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

using importer::Refused;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

template <class Number>
bool parse(std::string_view text, Number& out) {
  text = without_blanks(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), out);
  return failure == std::errc() && end == text.data() + text.size();
}

}  // namespace

double number(const Group& group) {
  double value = 0;
  return parse(group.value, value) ? value : std::nan("");
}

int integer(const Group& group) {
  int value = 0;
  if (parse(group.value, value)) return value;
  const double real = number(group);  // some programs write 1.0
  return std::abs(real) < 1e9 ? static_cast<int>(real) : 0;
}

const Group* Entity::find(int code) const {
  const auto found = std::ranges::find(groups, code, &Group::code);
  return found == groups.end() ? nullptr : &*found;
}
double Entity::number(int code, double otherwise) const {
  const Group* group = find(code);
  return group ? floor_plan::number(*group) : otherwise;
}
int Entity::integer(int code, int otherwise) const {
  const Group* group = find(code);
  return group ? floor_plan::integer(*group) : otherwise;
}
std::string_view Entity::text(int code, std::string_view otherwise) const {
  const Group* group = find(code);
  return group ? group->value : otherwise;
}

DxfText::DxfText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(stream.tellg());
  if (!stream || size < 0) throw Refused("it cannot be read");
  text_.resize(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(text_.data(), size);
  if (!stream) throw Refused("it cannot be read");
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // UTF-8's byte order mark
}

std::string_view DxfText::line() {
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string_view out = std::string_view(text_).substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  ++line_;
  while (!out.empty() && out.back() == '\r') out.remove_suffix(1);
  return out;
}

bool DxfText::next_group(Group& group) {
  while (at_ < text_.size()) {
    const std::string_view code = line();
    if (at_ >= text_.size() && without_blanks(code).empty()) return false;
    if (!parse(code, group.code)) {
      constexpr std::size_t kShown = 30;
      std::string shown(code.substr(0, kShown));
      std::ranges::replace_if(
          shown, [](char c) { return static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~'; },
          '?');
      throw Refused("line " + std::to_string(line_) + " should hold a group code and holds \"" + shown +
                    "\"; the file is damaged: export the drawing again");
    }
    group.value = line();
    constexpr int kComment = 999, kText = 1, kMoreText = 3;
    if (group.code == kComment) continue;
    if (group.code != kText && group.code != kMoreText) group.value = without_blanks(group.value);
    return true;
  }
  return false;
}

bool DxfText::next(Entity& entity) {
  constexpr int kApplication = 102, kEmbedded = 101, kExtended = 1000;
  entity.groups.clear();
  Group group;
  const auto truncated = [] {
    return Refused("the file is truncated: its end (EOF) is missing; copy or export it again");
  };
  if (!begun_) {
    if (!next_group(ahead_)) throw truncated();
    if (ahead_.code != 0) throw Refused("it does not begin as a DXF does, with a section; export the drawing again");
    begun_ = true;
  }
  if (ahead_.value == "EOF") return false;
  entity.type = ahead_.value;
  bool foreign = false, embedded = false;
  while (next_group(group)) {
    if (group.code == 0) {
      ahead_ = group;
      return true;
    }
    if (group.code == kEmbedded) embedded = true;
    if (group.code == kApplication) {
      foreign = group.value.starts_with('{');
      continue;
    }
    if (!foreign && !embedded && group.code < kExtended) entity.groups.push_back(group);
  }
  throw truncated();
}

namespace {

std::map<std::string_view, Group> variables_of(const Entity& header) {
  std::map<std::string_view, Group> out;
  std::string_view name;
  for (const Group& group : header.groups)
    if (group.code == 9)
      name = group.value;
    else if (!name.empty())
      out.try_emplace(name, group);
  return out;
}

}  // namespace

Axes object_axes(const Entity& entity) {
  const double x = entity.number(210), y = entity.number(220), z = entity.number(230, 1);
  const double size = std::sqrt(x * x + y * y + z * z);
  if (!(size > 0) || (x == 0 && y == 0 && z > 0)) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array n{x / size, y / size, z / size};
  constexpr double kNearlyUpright = 1.0 / 64;
  // Takes the axis across n and the world's y if n is nearly upright, else across n and z.
  std::array along{-n[1], n[0], 0.0};
  if (std::abs(n[0]) < kNearlyUpright && std::abs(n[1]) < kNearlyUpright) along = {n[2], 0.0, -n[0]};
  const double wide = std::sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  for (double& part : along) part /= wide;
  return {along,
          {n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2], n[0] * along[1] - n[1] * along[0]},
          n};
}

void read_dxf(const std::filesystem::path& file, const DxfTaker& taker) {
  DxfText text(file);
  std::string_view section;
  bool in_block = false;
  Entity entity, open;  // the current one, and one that waits for its parts
  std::vector<Entity> parts;
  const auto finish = [&] {
    if (!open.type.empty()) taker.entity(open, parts, in_block);
    open.type = {};
    parts.clear();
  };
  while (text.next(entity)) {
    if (entity.type == "SECTION") {
      finish();
      section = entity.text(2);
      if (section == "HEADER") taker.header(variables_of(entity));
    } else if (entity.type == "ENDSEC") {
      finish();
      section = {}, in_block = false;
    } else if (section == "TABLES") {
      if (entity.type == "LAYER") taker.layer(entity);
    } else if (section == "BLOCKS" && (entity.type == "BLOCK" || entity.type == "ENDBLK")) {
      finish();
      in_block = entity.type == "BLOCK";
      if (in_block) taker.begin_block(entity);
    } else if (section == "ENTITIES" || in_block) {
      const bool part =
          (entity.type == "VERTEX" && open.type == "POLYLINE") || (entity.type == "ATTRIB" && open.type == "INSERT");
      if (part) {
        parts.push_back(entity);
      } else {
        finish();
        std::swap(open, entity);
      }
    }
  }
  finish();
}

const DxfUnit* unit_of_code(int code) {
  constexpr double kSurveyFoot_m = 1200.0 / 3937;
  static constexpr std::array kUnits{DxfUnit{"in", 1, 0.0254},
                                     DxfUnit{"ft", 2, 0.3048},
                                     DxfUnit{"mi", 3, 1609.344},
                                     DxfUnit{"mm", 4, 0.001},
                                     DxfUnit{"cm", 5, 0.01},
                                     DxfUnit{"m", 6, 1.0},
                                     DxfUnit{"km", 7, 1000},
                                     DxfUnit{"microinch", 8, 2.54e-8},
                                     DxfUnit{"mil", 9, 2.54e-5},
                                     DxfUnit{"yd", 10, 0.9144},
                                     DxfUnit{"angstrom", 11, 1e-10},
                                     DxfUnit{"nm", 12, 1e-9},
                                     DxfUnit{"micrometre", 13, 1e-6},
                                     DxfUnit{"dm", 14, 0.1},
                                     DxfUnit{"dam", 15, 10},
                                     DxfUnit{"hm", 16, 100},
                                     DxfUnit{"Gm", 17, 1e9},
                                     DxfUnit{"US survey foot", 21, kSurveyFoot_m},
                                     DxfUnit{"US survey inch", 22, kSurveyFoot_m / 12},
                                     DxfUnit{"US survey yard", 23, 3 * kSurveyFoot_m},
                                     DxfUnit{"US survey mile", 24, 5280 * kSurveyFoot_m}};
  const auto found = std::ranges::find(kUnits, code, &DxfUnit::code);
  return found == kUnits.end() ? nullptr : &*found;
}

}  // namespace vantage::floor_plan
