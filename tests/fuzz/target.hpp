// SPDX-License-Identifier: Apache-2.0
// Fuzz targets: functions of arbitrary bytes. Each may reject them with a vantage::Error with a message. Any other
// exception, and every broken promise, is a finding.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/error.hpp"

namespace vantage::fuzz {

using Bytes = std::span<const std::uint8_t>;

struct Target {
  const char* name;
  void (*run)(Bytes bytes);
};
std::span<const Target> targets();
// Throws std::invalid_argument and lists the targets.
const Target& target(std::string_view name);

// Reports a broken promise and aborts.
[[noreturn]] void broken(const std::string& promise);
inline void require(bool holds, const char* promise) {
  if (!holds) broken(promise);
}
inline void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) broken(std::string(what) + " is " + std::to_string(value));
}

// Runs a reader and returns whether it accepted the bytes. An Error must have a message.
template <class Read>
bool accepts(Read&& read) {
  try {
    std::forward<Read>(read)();
    return true;
  } catch (const Error& error) {
    require(!std::string_view(error.what()).empty(), "an error says what is wrong");
    return false;
  }
}

// Writes the bytes to a file of that name, in memory if the system has such a folder.
std::filesystem::path file_of(Bytes bytes, const std::string& name);
inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// Takes numbers from the front of the bytes; zeros after their end.
class Source {
 public:
  explicit Source(Bytes bytes) : left_(bytes) {}
  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t value = left_.front();
    left_ = left_.subspan(1);
    return value;
  }
  std::uint64_t bits() {
    std::uint64_t value = 0;
    for (int k = 0; k < 8; ++k) value |= std::uint64_t{byte()} << (8 * k);
    return value;
  }
  double any_real();                        // any double, with NaN, infinity, 0 and 1 more often
  double between(double low, double high);  // one of 65536 values
  std::uint32_t below(std::uint32_t n) { return n > 0 ? byte() % n : 0; }
  bool empty() const { return left_.empty(); }
  Bytes rest() const { return left_; }

 private:
  Bytes left_;
};

// Files below seeds/ and their contents: states that nobody writes by hand.
std::vector<std::pair<std::string, std::string>> state_seeds();
std::vector<std::pair<std::string, std::string>> message_seeds();  // among those

// The targets, one file per kind.
void gltf(Bytes);
void image(Bytes);
void panorama(Bytes);
void configuration(Bytes);
void command_line(Bytes);
void front_json(Bytes);
void stations_csv(Bytes);
void noise_csv(Bytes);
void scanners_json(Bytes);
void region_geojson(Bytes);
void region_csv(Bytes);
void crs(Bytes);
void checkpoint(Bytes);
void optimiser_state(Bytes);
void message(Bytes);
void reference(Bytes);
void simulator(Bytes);
void e57(Bytes);
void las(Bytes);
void ply(Bytes);
void pcd(Bytes);
void xyz(Bytes);

}  // namespace vantage::fuzz
