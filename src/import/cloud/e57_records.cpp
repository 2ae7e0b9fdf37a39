// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/e57_records.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kSectionHeader = 32, kMostWaiting = std::size_t{1} << 24;
constexpr std::uint8_t kIndexPacket = 0, kDataPacket = 1, kEmptyPacket = 2;

std::int64_t bound(const XmlElement& element, const char* name, std::int64_t missing) {
  const auto found = element.attributes.find(name);
  if (found == element.attributes.end()) return missing;
  const std::string& text = found->second;
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size())
    throw Refused("the " + std::string(name) + " of its field " + element.name +
                  " is no whole number; export it again");
  return value;
}

double factor(const XmlElement& element, const char* name, double missing) {
  const auto found = element.attributes.find(name);
  if (found == element.attributes.end()) return missing;
  const auto value = number_of(found->second);
  if (!value || !std::isfinite(*value))
    throw Refused("the " + std::string(name) + " of its field " + element.name + " is no number; export it again");
  return *value;
}

E57RecordField field_of(const XmlElement& element) {
  using Type = E57RecordField::Type;
  E57RecordField field;
  field.name = element.name;
  const auto given = element.attributes.find("type");
  const std::string type = given == element.attributes.end() ? "" : given->second;
  if (type == "Float") {
    const auto precision = element.attributes.find("precision");
    const bool single = precision != element.attributes.end() && precision->second == "single";
    field.type = single ? Type::single_precision : Type::double_precision;
    field.bits = single ? 32 : 64;
  } else if (type == "Integer" || type == "ScaledInteger") {
    field.type = Type::integer;
    field.minimum = bound(element, "minimum", std::numeric_limits<std::int64_t>::min());
    const std::int64_t maximum = bound(element, "maximum", std::numeric_limits<std::int64_t>::max());
    if (maximum < field.minimum)
      throw Refused("the bounds of its field " + field.name + " are reversed; export it again");
    const std::uint64_t span = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(field.minimum);
    field.bits = static_cast<unsigned>(std::bit_width(span));
    if (type == "ScaledInteger") field.scale = factor(element, "scale", 1), field.offset = factor(element, "offset", 0);
  } else if (type == "String") {
    field.type = Type::text;
  } else {
    throw Refused("its field " + field.name + " is of the type \"" + type +
                  "\", which records cannot have; export it again");
  }
  return field;
}

}  // namespace

std::vector<E57RecordField> e57_fields(const XmlElement& prototype) {
  std::vector<E57RecordField> fields;
  for (const XmlElement& element : prototype.children) fields.push_back(field_of(element));
  return fields;
}

void E57Column::append(const char* bytes, std::size_t count) { bytes_.append(bytes, count); }

std::uint64_t E57Column::available() const {
  if (field_.bits == 0) return std::numeric_limits<std::uint64_t>::max();
  return (8 * bytes_.size() - bit_) / field_.bits;
}

double E57Column::take() {
  using Type = E57RecordField::Type;
  // A value begins at the lowest bit that is left of the current byte.
  std::uint64_t raw = 0;
  for (unsigned have = 0; have < field_.bits;) {
    const unsigned within = bit_ % 8, n = std::min(8 - within, field_.bits - have);
    const auto byte = static_cast<std::uint8_t>(bytes_[bit_ / 8]);
    raw |= static_cast<std::uint64_t>((byte >> within) & ((1U << n) - 1)) << have;
    have += n, bit_ += n;
  }
  switch (field_.type) {
    case Type::single_precision: return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
    case Type::double_precision: return std::bit_cast<double>(raw);
    case Type::integer:
    case Type::text: break;
  }
  const auto value = static_cast<std::int64_t>(static_cast<std::uint64_t>(field_.minimum) + raw);
  return static_cast<double>(value) * field_.scale + field_.offset;
}

void E57Column::compact() {
  bytes_.erase(0, bit_ / 8);
  bit_ %= 8;
}

void read_e57_records(E57Pages& pages, std::uint64_t section, std::uint64_t count,
                      std::span<const E57RecordField> fields, std::span<const std::size_t> wanted,
                      const std::function<void(std::span<const double>)>& record) {
  if (count == 0) return;
  char header[kSectionHeader];
  const std::uint64_t begin = pages.logical(section);
  pages.read(begin, header, kSectionHeader);
  if (header[0] != 1) throw Refused("there are no points where its description says; export it again");
  const auto length = value_at<std::uint64_t>(header + 8);
  const std::uint64_t end = begin + std::min(length, pages.logical_end() - begin);
  std::uint64_t at = pages.logical(value_at<std::uint64_t>(header + 16));

  std::vector<E57Column> columns;
  std::vector<std::size_t> column_of(fields.size(), fields.size());
  for (const std::size_t k : wanted) column_of[k] = columns.size(), columns.emplace_back(fields[k]);
  if (std::ranges::all_of(wanted, [&](std::size_t k) { return fields[k].bits == 0; }))
    throw Refused("all of its points have the same place, by their fields' bounds; export it again");

  std::vector<double> values(columns.size());
  std::string packet;
  std::uint64_t done = 0;
  while (done < count) {
    if (at + 4 > end)
      throw Refused("its points end after " + std::to_string(done) + " of " + std::to_string(count) +
                    "; export it again");
    char head[4];
    pages.read(at, head, sizeof head);
    const std::size_t bytes = value_at<std::uint16_t>(head + 2) + std::size_t{1};
    const auto kind = static_cast<std::uint8_t>(head[0]);
    if (kind > kEmptyPacket || bytes < 4 || bytes > end - at)
      throw Refused("a packet of its points is damaged; copy or export it again");
    if (kind != kDataPacket) {
      static_assert(kIndexPacket == 0);
      at += bytes;
      continue;
    }
    packet.resize(bytes);
    pages.read(at, packet.data(), bytes);
    at += bytes;
    const std::size_t streams = bytes < 6 ? 0 : value_at<std::uint16_t>(packet.data() + 4);
    std::size_t stream_at = 6 + 2 * streams;
    if (streams != fields.size() || stream_at > bytes)
      throw Refused("a packet of its points has not the fields of their description; export it again");
    for (std::size_t k = 0; k < streams; ++k) {
      const std::size_t size = value_at<std::uint16_t>(packet.data() + 6 + 2 * k);
      if (size > bytes - stream_at) throw Refused("a packet of its points is damaged; copy or export it again");
      if (column_of[k] < columns.size()) columns[column_of[k]].append(packet.data() + stream_at, size);
      stream_at += size;
    }
    std::uint64_t ready = count - done, most = 0;
    for (const E57Column& column : columns) {
      ready = std::min(ready, column.available());
      if (column.available() != std::numeric_limits<std::uint64_t>::max()) most = std::max(most, column.available());
    }
    for (std::uint64_t k = 0; k < ready; ++k) {
      for (std::size_t c = 0; c < columns.size(); ++c) values[c] = columns[c].take();
      record(values);
    }
    done += ready;
    if (most - std::min(most, ready) > kMostWaiting)
      throw Refused("the fields of its points are out of step; export it again");
    for (E57Column& column : columns) column.compact();
  }
}

}  // namespace vantage::importer
