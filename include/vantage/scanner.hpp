// SPDX-License-Identifier: Apache-2.0
/// The scanner: geometry of its ray pattern, range, and noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/settings.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// Range noise as a maker states it: one standard deviation per (reflectivity, distance). Table 1 of the method is one.
struct NoiseTable {
  std::vector<double> distances_m = {};     ///< Columns, ascending.
  std::vector<double> reflectivities = {};  ///< Rows, ascending, in [0, 1].
  std::vector<double> sigma_m = {};         ///< Row-major, reflectivities × distances. Empty: no noise.
  bool empty() const { return sigma_m.empty(); }
};

/// Direction of a ray in the survey frame.
struct RayAngles {
  Angle zenith;   ///< From straight up.
  Angle azimuth;  ///< From +X towards +Y; grows from heading − H/2 without wrapping.
};

/// A terrestrial laser scanner (section 3.2). Rays: floor(H/Δh) azimuths times floor(V/2/Δv) zeniths; both floors
/// guarded by 1e-9. Ray (i, j): zenith θ₀ + (i + ½)·Δv, azimuth heading − H/2 + (j + ½)·Δh, direction (sin θ cos φ, sin
/// θ sin φ, cos θ); its index is i·columns + j everywhere.
struct Scanner {
  std::string name = "custom";
  Angle heading = Angle::degrees(0);             ///< Azimuth of the middle of the horizontal sweep, from +X towards +Y.
  Angle horizontal_angle = Angle::degrees(360);  ///< H, (0°, 360°].
  /// V, (0°, 360°]: the mirror's sweep over both sides, so zeniths θ₀..θ₀ + V/2.
  Angle vertical_angle = Angle::degrees(300);
  /// θ₀; with V/2 at most 180°. Above 0° for scanners that cannot look straight up.
  Angle zenith_start = Angle::degrees(0);
  Angle azimuth_step = Angle::degrees(0.1);  ///< Δh.
  Angle zenith_step = Angle::degrees(0.1);   ///< Δv.
  double height_m = 1.85;                    ///< Of the scanner's head above the search area.
  double min_range_m = 0.1;                  ///< d_min.
  double max_range_m = 130.0;                ///< d_max.
  NoiseTable noise = {};                     ///< Empty: exact ranges.
  /// Full angle by which the beam widens, and its diameter where it leaves the scanner, both to 1/e² of the intensity
  /// on the axis. Both 0: not known.
  Angle beam_divergence = Angle::radians(0);
  double exit_diameter_m = 0;
  /// How fast rays are measured, for the time on site. The figure that no preset gives is an assumption of ours: what
  /// phase and time-of-flight scanners of the last ten years have reached.
  double points_per_second = 1'000'000;

  std::uint32_t rows() const;     ///< Zenith steps.
  std::uint32_t columns() const;  ///< Azimuth steps.
  std::uint64_t rays() const { return std::uint64_t{rows()} * columns(); }
  RayAngles angles(std::uint64_t ray) const;  ///< REQUIRES: ray < rays().
  /// Throws Error invalid_argument with the member and its value.
  void check() const;
};

Settings settings(const Scanner& scanner);

/// Table 1 of the method: Leica RTC360, single measurement.
NoiseTable rtc360_noise();

/// Range noise by "off", a scanner's name, or a CSV file with a header `reflectivity,<distance in metres>,…` and a line
/// of standard deviations in metres for each reflectivity. Throws Error: io, malformed_file, invalid_argument.
NoiseTable load_noise(const std::string& name);

/// One scanner of the presets.
struct ScannerPreset {
  std::string key;      ///< "rtc360"
  std::string summary;  ///< One line for `vantage info`.
};

/// A scanner by "key" or "key@setting", e.g. "rtc360@6mm", or by its name in full; upper or lower case. The presets
/// (data/scanners.json) are part of the library; a file `more` of that form adds to them, and goes before them where a
/// key is in both. Throws Error: io, malformed_file, invalid_argument (lists what exists).
Scanner load_scanner(const std::string& name, const std::filesystem::path& more = {});
/// All of them, those of `more` first. Throws Error: io, malformed_file.
std::vector<ScannerPreset> list_scanners(const std::filesystem::path& more = {});

/// scanners.json in the folder that the environment variable VANTAGE_DATA names; empty where it names none.
std::filesystem::path own_presets_file();

}  // namespace vantage
