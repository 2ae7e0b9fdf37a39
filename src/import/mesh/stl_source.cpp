// SPDX-License-Identifier: Apache-2.0
// STL: binary, or text of one or several solids.
#include <algorithm>
#include <cstring>

#include "core/text.hpp"
#include "import/mesh/sources.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kStlHeader = 84, kStlFacet = 50;

template <class T>
T little_endian_at(std::string_view bytes, std::size_t offset) {  // as the host
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

Model read_binary_stl(std::string_view bytes) {
  if (bytes.size() < kStlHeader) throw Refused("it is cut off in its header; copy or export it again");
  const std::size_t count = little_endian_at<std::uint32_t>(bytes, 80);
  if (count > (bytes.size() - kStlHeader) / kStlFacet)
    throw Refused("it is truncated: its header announces " + std::to_string(count) +
                  " triangles; copy or export it again");
  // Colours have five bits a channel, in two dialects. After COLOR= in the header, red is lowest, and a set bit 15
  // stands for the colour of the whole object.
  const std::size_t mark = bytes.substr(0, 80).find("COLOR=");
  const bool materialise = mark <= 70;
  Rgba object{255, 255, 255, 255};
  if (materialise) std::memcpy(object.data(), bytes.data() + mark + 6, 4);
  Part part;
  part.positions.reserve(3 * count);
  bool coloured = materialise;
  std::vector<Rgba> colours;
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t at = kStlHeader + t * kStlFacet;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      glm::dvec3 p;
      for (std::size_t c = 0; c < 3; ++c)
        p[static_cast<int>(c)] = static_cast<double>(little_endian_at<float>(bytes, at + 12 + 12 * corner + 4 * c));
      part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
      part.positions.push_back(p);
    }
    const auto attribute = little_endian_at<std::uint16_t>(bytes, at + 48);
    const bool own = ((attribute & 0x8000) != 0) != materialise;
    coloured = coloured || own;
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>((attribute >> shift & 31) * 255 / 31); };
    colours.push_back(!own          ? object
                      : materialise ? Rgba{channel(0), channel(5), channel(10), 255}
                                    : Rgba{channel(10), channel(5), channel(0), 255});
  }
  if (coloured)
    for (const Rgba& colour : colours) part.colours.insert(part.colours.end(), 3, colour);
  Model model;
  model.rounded = true;
  model.nodes[0].meshes.push_back(model.add_mesh({{}, {}}));
  model.meshes[0].parts.push_back(std::move(part));
  return model;
}

Model read_text_stl(std::string_view text) {
  Model model;
  Part part;
  std::vector<glm::dvec3> loop;
  std::string name;
  const auto finish_solid = [&] {
    if (!part.indices.empty()) {
      const std::size_t node = model.add_node(0, name);
      model.nodes[node].meshes.push_back(model.add_mesh({name, {}}));
      model.meshes.back().parts.push_back(std::move(part));
    }
    part = {};
  };
  const auto refuse = [](std::size_t number, const std::string& what) {
    throw Refused("line " + std::to_string(number) + what + "; export it again");
  };
  const auto read_word = [&](const std::string& word, std::string_view& line, std::size_t number) {
    if (word == "solid") {
      finish_solid();
      // Some writers put the whole solid into one line.
      const std::size_t end = std::min(lower_case(std::string(line)).find(" facet normal"), line.size());
      name = trimmed_text(line.substr(0, end));
      line.remove_prefix(end);
    } else if (word == "endsolid") {
      const std::size_t next = std::min(lower_case(std::string(line)).find(" solid "), line.size());
      line.remove_prefix(next);  // its name
    } else if (word == "vertex") {
      glm::dvec3 p;
      for (int c = 0; c < 3; ++c) {
        const auto value = value_of<double>(take_word(line));
        if (!value) refuse(number, " has no number where one belongs");
        p[c] = value.value_or(0);
      }
      loop.push_back(p);
    } else if (word == "endloop") {
      if (loop.size() != 3) refuse(number, " ends a facet of " + std::to_string(loop.size()) + " corners instead of 3");
      for (const glm::dvec3& p : loop) {
        part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
        part.positions.push_back(p);
      }
      loop.clear();
    }
  };
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
      read_word(lower_case(std::string(word)), line, number);
  }
  if (!loop.empty()) throw Refused("it is cut off in a facet; copy or export it again");
  finish_solid();
  return model;
}

}  // namespace

Model read_stl(const std::filesystem::path& file) {
  const std::string bytes = read_whole(file);
  const std::string_view text = trimmed_text(std::string_view(bytes).substr(0, 1024));
  const bool whole_binary =
      bytes.size() >= kStlHeader && bytes.size() == kStlHeader + kStlFacet * little_endian_at<std::uint32_t>(bytes, 80);
  const bool is_text =
      !whole_binary && lower_case(std::string(text.substr(0, 5))) == "solid" && bytes.find('\0') == bytes.npos;
  return is_text ? read_text_stl(bytes) : read_binary_stl(bytes);
}

}  // namespace vantage::importer
