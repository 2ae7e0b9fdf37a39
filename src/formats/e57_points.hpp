// SPDX-License-Identifier: Apache-2.0
// The points of one station in an E57 file: a CompressedVector section (ASTM E2807, 6.3.4), which holds each field as a
// stream of its own, cut into packets. Fields are whole bytes, so that a packet holds whole records and streams need no
// shifting.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/hash.hpp"
#include "formats/e57_paged_file.hpp"
#include "formats/point_sink.hpp"

namespace vantage {

class E57Points {
 public:
  // Begins the section at the file's end. `field_bytes`: of one value, per field. `index_entries`: the most there may
  // be, at least 2 and even. The file must outlive the object, and nothing else be written to it until close().
  E57Points(E57PagedFile& file, const std::vector<std::size_t>& field_bytes, std::size_t index_entries = 2048);

  // Next value of a field; REQUIRES: as many bytes as the field has. Each field once, then next().
  template <class T>
  void put(std::size_t field, T value) {
    append(streams_[field], value);
  }
  void next() {
    ++records_;
    if (++pending_ == packet_records_) write_packet();
  }
  // Writes what is left, and the index.
  void close();

  std::uint64_t records() const { return records_; }
  std::uint64_t section() const { return section_; }              // physical address
  std::uint64_t fingerprint() const { return content_.value(); }  // of all values, once closed

 private:
  void write_packet();
  void write_index();

  E57PagedFile& file_;
  std::vector<std::string> streams_;
  std::size_t index_entries_, packet_records_ = 0, pending_ = 0;
  std::uint64_t records_ = 0, section_ = 0, begin_ = 0, first_packet_ = 0;
  std::uint64_t packets_ = 0, stride_ = 1;                      // packets to an entry of the index
  std::vector<std::pair<std::uint64_t, std::uint64_t>> index_;  // first record of a packet, and its physical address
  Hash content_;
};

}  // namespace vantage
