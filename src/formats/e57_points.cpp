// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_points.hpp"

#include <numeric>

namespace vantage {
namespace {

constexpr std::size_t kMostPacketBytes = 65'536, kSectionHeaderBytes = 32;

}  // namespace

E57Points::E57Points(E57PagedFile& file, const std::vector<std::size_t>& field_bytes, std::size_t index_entries)
    : file_(file), streams_(field_bytes.size()), index_entries_(index_entries) {
  const std::size_t record = std::accumulate(field_bytes.begin(), field_bytes.end(), std::size_t{0});
  const std::size_t head = 6 + 2 * field_bytes.size();
  packet_records_ = (kMostPacketBytes - head - 3) / record;  // 3: what aligning may add
  for (std::size_t k = 0; k < streams_.size(); ++k) streams_[k].reserve(packet_records_ * field_bytes[k]);
  file_.begin_patchable_page();
  section_ = file_.physical(), begin_ = file_.logical();
  file_.write(std::string(kSectionHeaderBytes, '\0'));
  first_packet_ = file_.physical();
}

void E57Points::write_packet() {
  std::size_t bytes = 6 + 2 * streams_.size();
  for (const std::string& stream : streams_) bytes += stream.size();
  const std::size_t aligned = (bytes + 3) / 4 * 4;

  // An entry stands for two, four, … packets if there are more of them than entries.
  if (packets_ % stride_ == 0) {
    if (index_.size() == index_entries_) {
      for (std::size_t k = 0; k < index_.size() / 2; ++k) index_[k] = index_[2 * k];
      index_.resize(index_.size() / 2);
      stride_ *= 2;
    }
    if (packets_ % stride_ == 0) index_.emplace_back(records_ - pending_, file_.physical());
  }
  ++packets_;

  std::string head;
  append(head, std::uint8_t{1});  // a packet of data
  append(head, std::uint8_t{0});
  append(head, static_cast<std::uint16_t>(aligned - 1));
  append(head, static_cast<std::uint16_t>(streams_.size()));
  for (const std::string& stream : streams_) append(head, static_cast<std::uint16_t>(stream.size()));
  file_.write(head);
  for (std::string& stream : streams_) {
    file_.write(stream);
    content_.add_bytes(stream.data(), stream.size());
    stream.clear();
  }
  file_.align();
  pending_ = 0;
}

void E57Points::write_index() {
  std::string packet;
  append(packet, std::uint8_t{0});  // a packet of the index
  append(packet, std::uint8_t{0});
  append(packet, static_cast<std::uint16_t>(16 + 16 * index_.size() - 1));
  append(packet, static_cast<std::uint16_t>(index_.size()));
  append(packet, std::uint8_t{0});  // level: entries are packets of data
  packet.append(9, '\0');
  for (const auto& [record, address] : index_) append(packet, record), append(packet, address);
  file_.write(packet);
}

void E57Points::close() {
  // Without a record there still is a packet: readers look at the first.
  if (pending_ > 0 || records_ == 0) write_packet();
  const std::uint64_t index = file_.physical();
  write_index();
  std::string header;
  append(header, std::uint8_t{1});  // a CompressedVector
  header.append(7, '\0');
  append(header, file_.logical() - begin_);
  append(header, first_packet_);
  append(header, index);
  file_.patch(header);
}

}  // namespace vantage
