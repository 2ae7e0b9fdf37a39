// SPDX-License-Identifier: Apache-2.0
#include "fuzz/target.hpp"

#include <unistd.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace vantage::fuzz {
namespace {

constexpr Target kTargets[] = {{"gltf", gltf},
                               {"image", image},
                               {"panorama", panorama},
                               {"configuration", configuration},
                               {"command_line", command_line},
                               {"front_json", front_json},
                               {"stations_csv", stations_csv},
                               {"noise_csv", noise_csv},
                               {"scanners_json", scanners_json},
                               {"region_geojson", region_geojson},
                               {"region_csv", region_csv},
                               {"crs", crs},
                               {"checkpoint", checkpoint},
                               {"optimiser_state", optimiser_state},
                               {"message", message},
                               {"reference", reference},
#ifdef VANTAGE_FUZZ_CLOUDS
                               {"e57", e57},
                               {"las", las},
                               {"ply", ply},
                               {"pcd", pcd},
                               {"xyz", xyz},
#endif
                               {"simulator", simulator}};

// A folder of this process, removed with it.
struct Folder {
  std::filesystem::path path;
  Folder() {
    const std::filesystem::path memory = "/dev/shm";
    std::error_code unknown;
    path = (std::filesystem::is_directory(memory, unknown) ? memory : std::filesystem::temp_directory_path()) /
           ("vantage-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target& target(std::string_view name) {
  std::string known;
  for (const Target& one : kTargets) {
    if (name == one.name) return one;
    known += std::string(" ") + one.name;
  }
  throw std::invalid_argument("there is no target " + std::string(name) + "; known:" + known);
}

void broken(const std::string& promise) {
  std::fprintf(stderr, "broken: %s\n", promise.c_str());
  std::terminate();  // its handler may keep the input
}

std::filesystem::path file_of(Bytes bytes, const std::string& name) {
  static const Folder folder;
  const std::filesystem::path file = folder.path / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

double Source::any_real() {
  constexpr double kLimit = std::numeric_limits<double>::max();
  constexpr std::array kOdd{0.0,
                            -0.0,
                            1.0,
                            -1.0,
                            0.5,
                            1e-3,
                            90.0,
                            360.0,
                            std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity(),
                            kLimit,
                            -kLimit,
                            std::numeric_limits<double>::denorm_min(),
                            1e308,
                            1e-300};
  const std::uint8_t kind = byte();
  if (kind < kOdd.size()) return kOdd[kind];
  if (kind < 128) return between(-10, 10);
  return std::bit_cast<double>(bits());
}

double Source::between(double low, double high) {
  const unsigned value = byte() | unsigned{byte()} << 8;
  return low + (high - low) * value / 65535;
}

}  // namespace vantage::fuzz
