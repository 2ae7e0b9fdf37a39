// SPDX-License-Identifier: Apache-2.0
#include "import/scans.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>

#include "import/import.hpp"
#include "vantage/error.hpp"

namespace vantage::importers {
namespace {

// Its name differs from that of the surfaces, so that the cache keeps both.
constexpr Format kScans{"scans of E57", ".e57-scans ", "vantage-import-cloud"};
constexpr Format kPoints{"points of E57", ".e57-points ", "vantage-import-cloud"},
    kTextPoints{"points of PTX", ".xyz-points ", "vantage-import-cloud"};
// Scanners level themselves to seconds of arc; a registration turns poses by more. Nobody sets a scanner up with a
// smaller tilt on purpose.
constexpr double kLevel_rad = 0.05;

}  // namespace

StationSetup setup_of(const std::array<double, 4>& rotation) {
  const auto [w, x, y, z] = rotation;
  // The scanner's vertical axis in the survey's frame.
  const Vec3 up{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  StationSetup setup;
  const double tilt = std::atan2(std::hypot(up.x, up.y), up.z);
  if (tilt < kLevel_rad) {
    setup.heading = Angle::radians(std::atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)));
  } else {
    setup.tilt = Angle::radians(tilt);
    setup.heading = Angle::radians(std::atan2(up.y, up.x));
  }
  return setup;
}

namespace {

// Calls `read(document, binary)` for the parts of a GLB; throws Error if they are not as expected.
template <class Read>
void read_parts(const std::filesystem::path& file, const std::vector<std::uint8_t>& glb, Read&& read) {
  constexpr std::size_t kHead = 20, kChunkHead = 8;  // headers of the GLB with its first chunk; of another chunk
  std::uint32_t length = 0;                          // of the JSON; as_glb() has checked the header
  std::memcpy(&length, glb.data() + kHead - kChunkHead, sizeof length);
  try {
    if (length > glb.size() - kHead) throw std::out_of_range("JSON");
    const auto json = std::span(glb).subspan(kHead, length);
    const auto binary = std::span(glb).subspan(std::min(glb.size(), kHead + length + kChunkHead));
    read(nlohmann::json::parse(json.begin(), json.end()).at("asset").at("extras").at("scans"), binary);
  } catch (const std::exception&) {
    throw Error(Errc::malformed_file, file.string() + ": its scans cannot be read");
  }
}

TakenScan scan_of(const nlohmann::json& scan) {
  const auto place = scan.at("position").get<std::array<double, 3>>();
  return {.name = scan.at("name"),
          .sensor = scan.at("sensor"),
          .head = {place[0], place[1], place[2]},
          .setup = setup_of(scan.at("rotation").get<std::array<double, 4>>())};
}

std::optional<TakenSettings> settings_of(const nlohmann::json& told) {
  if (told.is_null()) return {};
  const auto pair = [](const nlohmann::json& values) { return values.get<std::array<double, 2>>(); };
  const auto degrees = [](const std::array<double, 2>& values) {
    return std::array{Angle::degrees(values[0]), Angle::degrees(values[1])};
  };
  const auto sweep = degrees(pair(told.at("azimuth")));
  TakenSettings settings{.steps = {},
                         .steps_by_grid = told.at("by_grid"),
                         .sweep_middle = sweep[0],
                         .sweep = sweep[1],
                         .zeniths = degrees(pair(told.at("zenith"))),
                         .range_m = pair(told.at("range"))};
  if (!told.at("step").is_null()) settings.steps = degrees(pair(told["step"]));
  return settings;
}

}  // namespace

std::vector<TakenScan> taken_scans(const std::filesystem::path& file, const Progress& progress) {
  if (std::string_view(recognise(file).format->name) != "E57")
    throw Error(Errc::malformed_file, file.string() + ": poses of scans are read from E57; this is none");
  std::vector<TakenScan> scans;
  const auto glb = as_glb(file, kScans, {}, {}, progress);
  if (glb.empty()) return scans;
  read_parts(file, glb, [&](const nlohmann::json& all, std::span<const std::uint8_t>) {
    for (const auto& scan : all)
      scans.push_back(scan_of(scan)), scans.back().settings = settings_of(scan.at("settings"));
  });
  return scans;
}

std::vector<ThinScan> thin_scans(const std::filesystem::path& file, double cell_m, const Progress& progress) {
  const std::string_view name = recognise(file).format->name;
  if (name != "E57" && name != "XYZ")
    throw Error(Errc::malformed_file,
                file.string() + ": scans with their poses are read from E57 and PTX; this is " + std::string(name));
  char cell[32];
  std::snprintf(cell, sizeof cell, "cell=%.17g", cell_m);
  std::vector<ThinScan> scans;
  const auto glb = as_glb(file, name == "E57" ? kPoints : kTextPoints, {}, {cell}, progress);
  if (glb.empty()) return scans;
  read_parts(file, glb, [&](const nlohmann::json& all, std::span<const std::uint8_t> binary) {
    for (const auto& entry : all) {
      ThinScan scan{scan_of(entry), entry.at("points"), {}};
      const std::size_t first = entry.at("first"), count = entry.at("count");
      const std::size_t whole = binary.size() / sizeof(ThinPoint);
      if (first > whole || count > whole - first) throw std::out_of_range("points");
      scan.thinned.resize(count);
      if (count > 0)
        std::memcpy(scan.thinned.data(), binary.data() + first * sizeof(ThinPoint), count * sizeof(ThinPoint));
      scans.push_back(std::move(scan));
    }
  });
  return scans;
}

}  // namespace vantage::importers
