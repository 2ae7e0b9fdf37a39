// SPDX-License-Identifier: Apache-2.0
#include "import/scans.hpp"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "import/import.hpp"
#include "vantage/error.hpp"

namespace vantage::importers {
namespace {

// Its name is another than that of the surfaces, so that the cache keeps both.
constexpr Format kScans{"scans of E57", ".e57-scans ", "vantage-import-cloud"};
// Scanners level themselves to seconds of arc; poses of a registration are turned by more. No scanner is set up at less
// than this on purpose.
constexpr double kLevel_rad = 0.05;

}  // namespace

StationSetup setup_of(const std::array<double, 4>& rotation) {
  const auto [w, x, y, z] = rotation;
  // The scanner's upright axis, and its first one, in the survey's frame.
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

std::vector<TakenScan> taken_scans(const std::filesystem::path& file) {
  if (std::string_view(recognise(file).format->name) != "E57")
    throw Error(Errc::malformed_file, file.string() + ": poses of scans are read from E57; this is none");
  const std::vector<std::uint8_t> glb = as_glb(file, kScans);
  std::uint32_t length = 0;  // of the JSON; as_glb() has checked the header
  std::memcpy(&length, glb.data() + 12, sizeof length);
  std::vector<TakenScan> scans;
  try {
    if (length > glb.size() - 20) throw Error(Errc::malformed_file, file.string() + ": its scans cannot be read");
    const auto document = nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + length);
    for (const auto& scan : document.at("asset").at("extras").at("scans")) {
      const auto place = scan.at("position").get<std::array<double, 3>>();
      scans.push_back({.name = scan.at("name"),
                       .sensor = scan.at("sensor"),
                       .head = {place[0], place[1], place[2]},
                       .setup = setup_of(scan.at("rotation").get<std::array<double, 4>>())});
    }
  } catch (const nlohmann::json::exception&) {
    throw Error(Errc::malformed_file, file.string() + ": its scans cannot be read");
  }
  return scans;
}

}  // namespace vantage::importers
