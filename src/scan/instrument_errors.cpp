// SPDX-License-Identifier: Apache-2.0
#include "scan/instrument_errors.hpp"

#include <cmath>

#include "core/normal_table.hpp"
#include "core/parallel.hpp"
#include "core/philox.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kInstrumentStream = 0x696e7374u;  // separates this stream from others of the same seed

double wrong_range(const InstrumentErrors& errors, double range) {
  return range * (1 + errors.range_scale_ppm * 1e-6) + errors.range_offset_m;
}

}  // namespace

Vec3 InstrumentErrors::displacement(const RayAngles& angles, double range_m, Angle heading) const {
  const double zenith = angles.zenith.in_radians(), azimuth = angles.azimuth.in_radians();
  const double st = std::sin(zenith), ct = std::cos(zenith), sa = std::sin(azimuth), ca = std::cos(azimuth);
  const Vec3 line{st * ca, st * sa, ct}, down{ct * ca, ct * sa, -st}, across{-sa, ca, 0};
  const double face = std::sin(azimuth - heading.in_radians()) < 0 ? 1 : -1;
  const Vec3 turned = line + down * (face * vertical_index.in_radians()) +
                      across * (face * (collimation.in_radians() + trunnion.in_radians() * ct));
  return turned * (wrong_range(*this, range_m) / std::sqrt(dot(turned, turned))) - line * range_m;
}

InstrumentErrors draw_instrument_errors(const Scanner& scanner, std::uint64_t seed) {
  if (!(scanner.angle_accuracy.in_radians() > 0 || scanner.range_accuracy_m > 0 || scanner.range_accuracy_ppm > 0))
    throw Error(Errc::invalid_argument,
                "the scanner \"" + scanner.name + "\" states no calibration, so its errors cannot be drawn: give one");
  const auto normal = [&](std::uint32_t number) {
    return static_cast<double>(
        normal_from_bits(philox4x32(seed, {number, 0, 0, kInstrumentStream})[0], normal_table()));
  };
  const auto angle = [&](std::uint32_t number) {
    return Angle::radians(scanner.angle_accuracy.in_radians() * normal(number));
  };
  return {.vertical_index = angle(0),
          .collimation = angle(1),
          .trunnion = angle(2),
          .range_offset_m = scanner.range_accuracy_m * normal(3),
          .range_scale_ppm = scanner.range_accuracy_ppm * normal(4)};
}

void apply(const InstrumentErrors& errors, const Scanner& scanner, const TraceStation& station, std::uint64_t first_ray,
           Tracer::RawChunk& raw) {
  parallel::for_all(tbb::blocked_range<std::size_t>(0, raw.range.size(), 4096), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const auto r = static_cast<double>(raw.range[k]);
      if (!std::isfinite(r)) continue;
      if (!raw.position.empty()) {
        Float3 moved = narrow(errors.displacement(scanner.angles(first_ray + k), r, scanner.heading));
        if (station.turn) moved = (*station.turn)(moved);
        raw.position[k] = narrow(widen(raw.position[k]) + widen(moved));
      }
      raw.range[k] = static_cast<float>(wrong_range(errors, r));
    }
  });
}

}  // namespace vantage
