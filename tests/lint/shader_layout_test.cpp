// SPDX-License-Identifier: Apache-2.0
// Host and shaders must place every shared member alike: offsetof against the Offset decorations of the compiled
// shaders.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "embedded_shaders.hpp"
#include "shared_headers.hpp"

namespace vantage {
namespace {

using Members = std::map<std::string, std::size_t>;  // name to offset

std::map<std::string, Members> host_layout() {
  std::map<std::string, Members> layout;
#define STRUCT(type) layout[#type];
#define MEMBER(type, member) layout[#type][#member] = offsetof(type, member);
#include "shared_layout.inc"
#undef STRUCT
#undef MEMBER
  return layout;
}

struct Shader {
  const char* name;
  std::span<const std::uint32_t> words;
};

std::vector<Shader> all_shaders() {
  return {
#define SHADER(symbol) {#symbol, shaders::symbol},
#include "shader_symbols.inc"
#undef SHADER
  };
}

// The structs of a SPIR-V module that have offsets, by name. A name may stand for several types; all must agree.
std::multimap<std::string, Members> device_layouts(std::span<const std::uint32_t> words) {
  constexpr std::uint32_t op_name = 5, op_member_name = 6, op_member_decorate = 72, decoration_offset = 35;
  std::map<std::uint32_t, std::string> names;
  std::map<std::uint32_t, std::map<std::uint32_t, std::string>> member_names;
  std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> offsets;
  const auto text = [](const std::uint32_t* word) { return std::string(reinterpret_cast<const char*>(word)); };
  for (std::size_t k = 5; k < words.size(); k += words[k] >> 16) {
    const std::uint32_t* w = &words[k];
    switch (w[0] & 0xFFFF) {
      case op_name: names[w[1]] = text(w + 2); break;
      case op_member_name: member_names[w[1]][w[2]] = text(w + 3); break;
      case op_member_decorate:
        if (w[3] == decoration_offset) offsets[w[1]][w[2]] = w[4];
        break;
      default: break;
    }
  }
  std::multimap<std::string, Members> layouts;
  for (const auto& [type, by_index] : offsets) {
    Members members;
    for (const auto& [index, offset] : by_index) members[member_names[type][index]] = offset;
    layouts.emplace(names[type], std::move(members));
  }
  return layouts;
}

TEST(ShaderLayout, EveryShaderPlacesSharedMembersAsTheHostDoes) {
  const auto host = host_layout();
  ASSERT_FALSE(host.empty());
  std::set<std::string> compared;
  for (const Shader& shader : all_shaders()) {
    ASSERT_GT(shader.words.size(), 5u) << shader.name;
    ASSERT_EQ(shader.words[0], 0x07230203u) << shader.name << " is no SPIR-V";
    for (const auto& [name, members] : device_layouts(shader.words)) {
      const auto found = host.find(name);
      if (found == host.end()) continue;
      EXPECT_EQ(members, found->second) << name << " in " << shader.name;
      compared.insert(name);
    }
  }
  // Loaded 16 bytes at a time: what shaders take these offsets to be.
  const std::map<std::string, Members> by_quarters{
      {"BvhNode",
       {{"centre0", 0},
        {"child0", 12},
        {"half0", 16},
        {"child1", 28},
        {"centre1", 32},
        {"widening", 44},
        {"half1", 48},
        {"unused", 60}}},
      {"BvhTriangle", {{"a", 0}, {"id", 12}, {"b", 16}, {"unused0", 28}, {"c", 32}, {"unused1", 44}}},
      {"OwnRay", {{"origin", 0}, {"from", 12}, {"direction", 16}, {"range", 28}}},
      {"VoxelBrick", {{"x", 0}, {"y", 4}, {"z", 8}, {"first", 12}, {"mask", 16}}}};
  for (const auto& [name, members] : by_quarters) {
    ASSERT_TRUE(host.contains(name)) << name;
    EXPECT_EQ(members, host.at(name)) << name;
    compared.insert(name);
  }
  for (const auto& [name, members] : host)
    EXPECT_TRUE(compared.contains(name)) << name << " is shared, but no shader uses it";
}

}  // namespace
}  // namespace vantage
