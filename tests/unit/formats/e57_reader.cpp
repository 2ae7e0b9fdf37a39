// SPDX-License-Identifier: Apache-2.0
#include "unit/formats/e57_reader.hpp"

#include <cstring>
#include <optional>
#include <stdexcept>

namespace vantage::test {
namespace {

constexpr std::size_t kPage = 1024, kContent = 1020;

void demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("E57: " + what);
}

std::uint32_t checksum(const char* bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (std::size_t k = 0; k < kContent; ++k)
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 1) ^ ((crc ^ (static_cast<unsigned char>(bytes[k]) >> bit)) & 1 ? 0x82F63B78u : 0u);
  return ~crc;
}

// Pages checked and put together.
std::string unpaged(const std::string& bytes) {
  demand(bytes.size() >= kPage && bytes.size() % kPage == 0, "length is no multiple of a page");
  std::string logical;
  for (std::size_t at = 0; at < bytes.size(); at += kPage) {
    std::uint32_t stored = 0;
    for (std::size_t k = kContent; k < kPage; ++k) stored = stored << 8 | static_cast<unsigned char>(bytes[at + k]);
    demand(stored == checksum(&bytes[at]), "checksum of page " + std::to_string(at / kPage));
    logical.append(bytes, at, kContent);
  }
  return logical;
}

std::uint64_t logical_of(std::uint64_t physical) {
  demand(physical % kPage < kContent, "an address within a checksum");
  return physical / kPage * kContent + physical % kPage;
}

template <class T>
T get(const std::string& bytes, std::uint64_t at) {
  T value{};
  demand(at + sizeof value <= bytes.size(), "reaches over the end");
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Node {
  std::string name, text;
  std::map<std::string, std::string> attributes;
  std::vector<Node> children;

  const Node& child(const std::string& wanted) const {
    for (const Node& c : children)
      if (c.name == wanted) return c;
    throw std::runtime_error("E57: " + name + " has no " + wanted);
  }
};

// As much of XML as such files use.
class Parser {
 public:
  explicit Parser(const std::string& xml) : xml_(xml) {
    demand(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"), "no XML declaration");
    at_ = xml.find("?>") + 2;
  }
  Node element() {
    blanks();
    expect('<');
    Node node;
    node.name = until(" />");
    for (blanks(); xml_.at(at_) != '>' && xml_.at(at_) != '/'; blanks()) {
      const std::string key = until("=");
      expect('='), expect('"');
      demand(node.attributes.emplace(key, until("\"")).second, "the attribute " + key + " twice");
      expect('"');
    }
    if (xml_.at(at_) == '/') {
      ++at_, expect('>');
      return node;
    }
    expect('>');
    for (;;) {
      node.text += unescaped(until("<"));
      if (xml_.at(at_ + 1) == '/') break;
      node.children.push_back(element());
    }
    at_ += 2;
    demand(until(">") == node.name, "the end of " + node.name + " is missing");
    expect('>');
    return node;
  }
  void end() {
    blanks();
    demand(at_ == xml_.size(), "text behind the XML's root");
  }

 private:
  void blanks() {
    while (at_ < xml_.size() && (xml_[at_] == ' ' || xml_[at_] == '\n')) ++at_;
  }
  void expect(char c) {
    demand(at_ < xml_.size() && xml_[at_] == c, std::string("expected ") + c + " at " + std::to_string(at_));
    ++at_;
  }
  std::string until(const char* ends) {
    const std::size_t end = xml_.find_first_of(ends, at_);
    demand(end != std::string::npos, "the XML ends early");
    return xml_.substr(std::exchange(at_, end), end - at_);
  }
  static std::string unescaped(std::string text) {
    for (const auto& [code, sign] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
      for (std::size_t at = 0; (at = text.find(code, at)) != std::string::npos; ++at)
        text.replace(at, std::strlen(code), sign);
    return text;
  }

  const std::string& xml_;
  std::size_t at_ = 0;
};

void gather(const Node& node, const std::string& path, std::map<std::string, std::string>& texts) {
  for (const Node& child : node.children) {
    if (child.attributes.count("type") && child.attributes.at("type") == "Structure")
      gather(child, path + child.name + "/", texts);
    else if (child.children.empty())
      texts[path + child.name] = child.text;
  }
}

struct Field {
  std::string name, type;
  bool single = false;
  std::int64_t low = 0, high = 0;
  std::size_t bits = 0;
};

Field field_of(const Node& node) {
  Field field{.name = node.name, .type = node.attributes.at("type")};
  const auto attribute = [&](const char* name) -> std::optional<std::string> {
    const auto found = node.attributes.find(name);
    return found == node.attributes.end() ? std::nullopt : std::optional(found->second);
  };
  if (field.type == "Float") {
    field.single = attribute("precision").value_or("double") == "single";
    field.bits = field.single ? 32 : 64;
    return field;
  }
  demand(field.type == "Integer", "a field of type " + field.type);
  field.low = std::stoll(attribute("minimum").value()), field.high = std::stoll(attribute("maximum").value());
  for (auto range = static_cast<std::uint64_t>(field.high - field.low); range > 0; range >>= 1) ++field.bits;
  return field;
}

std::uint64_t bits_at(const std::string& stream, std::uint64_t first, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t bit = first + k;
    value |= std::uint64_t{static_cast<unsigned char>(stream.at(bit / 8)) >> (bit % 8) & 1u} << k;
  }
  return value;
}

E57ReadScan read_scan(const std::string& bytes, const Node& node) {
  E57ReadScan scan;
  gather(node, "", scan.texts);
  const Node& points = node.child("points");
  demand(points.attributes.at("type") == "CompressedVector", "points are no CompressedVector");
  scan.records = std::stoull(points.attributes.at("recordCount"));
  std::vector<Field> fields;
  for (const Node& child : points.child("prototype").children) fields.push_back(field_of(child));

  const std::uint64_t section = logical_of(std::stoull(points.attributes.at("fileOffset")));
  demand(section % 4 == 0, "a section that is not aligned");
  demand(get<std::uint8_t>(bytes, section) == 1, "no CompressedVector section where the points should be");
  for (std::uint64_t k = 1; k < 8; ++k) demand(get<std::uint8_t>(bytes, section + k) == 0, "reserved bytes");
  const auto length = get<std::uint64_t>(bytes, section + 8);
  demand(length % 4 == 0 && section + length <= bytes.size(), "length of a section");
  const std::uint64_t first = logical_of(get<std::uint64_t>(bytes, section + 16));
  const std::uint64_t index = logical_of(get<std::uint64_t>(bytes, section + 24));

  std::vector<std::string> streams(fields.size());
  std::map<std::uint64_t, std::uint64_t> records_before;  // packets by their address
  bool index_seen = false;
  std::uint64_t at = first;
  for (std::size_t packet_bytes = 0; at < section + length; at += packet_bytes) {
    demand(at % 4 == 0, "a packet that is not aligned");
    packet_bytes = std::size_t{get<std::uint16_t>(bytes, at + 2)} + 1;
    demand(packet_bytes % 4 == 0, "length of a packet");
    if (get<std::uint8_t>(bytes, at) == 0) {
      demand(at == index, "an index that the section does not name");
      index_seen = true;
      const auto entries = get<std::uint16_t>(bytes, at + 4);
      demand(entries >= 1 && packet_bytes == 16u + 16u * entries, "length of the index");
      for (std::uint64_t k = 6; k < 16; ++k) demand(get<std::uint8_t>(bytes, at + k) == 0, "level of the index");
      for (std::uint64_t k = 0; k < entries; ++k) {
        const std::uint64_t packet = logical_of(get<std::uint64_t>(bytes, at + 16 + 16 * k + 8));
        demand(records_before.count(packet) == 1, "an entry of the index that names no packet");
        scan.index.emplace_back(get<std::uint64_t>(bytes, at + 16 + 16 * k), records_before[packet]);
      }
      continue;
    }
    demand(get<std::uint8_t>(bytes, at) == 1, "an unknown packet");
    demand(get<std::uint16_t>(bytes, at + 4) == fields.size(), "a packet with other streams than fields");
    records_before[at] = fields[0].bits == 0 ? 0 : streams[0].size() * 8 / fields[0].bits;
    ++scan.packets;
    std::uint64_t from = at + 6 + 2 * fields.size();
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const auto size = get<std::uint16_t>(bytes, at + 6 + 2 * k);
      demand(from + size <= at + packet_bytes, "streams longer than their packet");
      streams[k].append(bytes, from, size);
      from += size;
    }
    demand(at + packet_bytes - from < 4, "a packet with more than its streams");
  }
  demand(at == section + length && index_seen, "a section without an index");

  for (std::size_t k = 0; k < fields.size(); ++k) {
    const Field& field = fields[k];
    scan.order.push_back(field.name);
    std::vector<double>& values = scan.fields[field.name];
    demand(streams[k].size() * 8 == scan.records * field.bits, "the stream of " + field.name + " has another length");
    for (std::uint64_t r = 0; r < scan.records; ++r)
      if (field.type == "Integer")
        values.push_back(static_cast<double>(
            field.low + static_cast<std::int64_t>(bits_at(streams[k], r * field.bits, field.bits))));
      else if (field.single)
        values.push_back(double{get<float>(streams[k], 4 * r)});
      else
        values.push_back(get<double>(streams[k], 8 * r));
  }
  return scan;
}

}  // namespace

double E57ReadScan::number(const std::string& path) const {
  const auto found = texts.find(path);
  if (found == texts.end()) throw std::runtime_error("E57: there is no " + path);
  return std::stod(found->second);
}

E57ReadFile read_e57(const std::string& bytes) {
  const std::string logical = unpaged(bytes);
  demand(logical.starts_with("ASTM-E57"), "no signature");
  demand(get<std::uint32_t>(logical, 8) == 1 && get<std::uint32_t>(logical, 12) == 0, "another version");
  demand(get<std::uint64_t>(logical, 16) == bytes.size(), "another length than the header says");
  demand(get<std::uint64_t>(logical, 40) == kPage, "pages of another size");
  const std::uint64_t xml = logical_of(get<std::uint64_t>(logical, 24));
  const auto xml_length = get<std::uint64_t>(logical, 32);
  demand(xml % 4 == 0 && xml + xml_length <= logical.size(), "the XML section");

  E57ReadFile file;
  file.xml = logical.substr(xml, xml_length);
  Parser parser(file.xml);
  const Node root = parser.element();
  parser.end();
  demand(root.name == "e57Root", "the root is " + root.name);
  demand(root.attributes.at("xmlns") == "http://www.astm.org/COMMIT/E57/2010-e57-v1.0", "another name space");
  gather(root, "", file.texts);
  for (const Node& child : root.child("data3D").children) file.scans.push_back(read_scan(logical, child));
  return file;
}

}  // namespace vantage::test
