// SPDX-License-Identifier: Apache-2.0
// LAS files by hand.
#pragma once

#include "cloud_files.hpp"

namespace vantage::test {

inline constexpr std::size_t kLasRecords[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct Las {
  int minor = 2, format = 0;
  std::size_t spare = 0;  // bytes behind each record, as users may add
  std::string records = {};
  std::uint32_t vlrs = 0;
  std::string vlr_bytes = {}, evlr_bytes = {};
  std::uint32_t evlrs = 0;
  std::uint16_t flags = 0;  // global encoding
  std::uint64_t count = 0;
  std::array<double, 3> scale{0.01, 0.01, 0.01}, offset{1000, 2000, 0};

  void add(std::int32_t x, std::int32_t y, std::int32_t z, int kind = 2, bool withheld = false) {
    std::string record;
    put(record, x), put(record, y), put(record, z);
    record.resize(kLasRecords[format] + spare, '\0');
    if (format >= 6)
      record[15] = withheld ? 4 : 0, record[16] = static_cast<char>(kind);
    else
      record[15] = static_cast<char>(kind | (withheld ? 0x80 : 0));
    records += record;
    ++count;
  }
  void vlr(std::uint16_t id, const std::string& body) {
    vlr_bytes.append(2, '\0');
    std::string user = "LASF_Projection";
    user.resize(16, '\0');
    vlr_bytes += user;
    put(vlr_bytes, id), put(vlr_bytes, static_cast<std::uint16_t>(body.size()));
    vlr_bytes.append(32, '\0');
    vlr_bytes += body;
    ++vlrs;
  }
  void evlr(std::uint16_t id, const std::string& body) {
    evlr_bytes.append(2, '\0');
    std::string user = "LASF_Projection";
    user.resize(16, '\0');
    evlr_bytes += user;
    put(evlr_bytes, id), put(evlr_bytes, static_cast<std::uint64_t>(body.size()));
    evlr_bytes.append(32, '\0');
    evlr_bytes += body;
    ++evlrs;
  }
  std::string bytes() const {
    const std::size_t header = minor >= 5 ? 393 : minor >= 4 ? 375 : 227;
    std::string h = "LASF";
    h.resize(6, '\0');
    put(h, flags);
    h.resize(24, '\0');
    h += '\1', h += static_cast<char>(minor);
    h.resize(94, '\0');
    put(h, static_cast<std::uint16_t>(header)), put(h, static_cast<std::uint32_t>(header + vlr_bytes.size()));
    put(h, vlrs);
    h += static_cast<char>(format);
    put(h, static_cast<std::uint16_t>(kLasRecords[format & 0x3F] + spare));
    put(h, minor >= 4 ? 0U : static_cast<std::uint32_t>(count));
    h.resize(131, '\0');
    for (const double value : scale) put(h, value);
    for (const double value : offset) put(h, value);
    h.resize(header, '\0');
    if (minor >= 4) {
      const std::uint64_t end = header + vlr_bytes.size() + records.size();
      std::memcpy(h.data() + 247, &count, sizeof count);
      if (evlrs > 0) std::memcpy(h.data() + 235, &end, sizeof end), std::memcpy(h.data() + 243, &evlrs, sizeof evlrs);
    }
    return h + vlr_bytes + records + evlr_bytes;
  }
};

}  // namespace vantage::test
