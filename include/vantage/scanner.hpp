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

/// Range noise as the maker states it: one standard deviation per (reflectivity, distance), as in table 1 of the
/// method.
struct NoiseTable {
  std::vector<double> distances_m = {};           ///< Columns, ascending.
  std::vector<double> reflectivities = {};        ///< Rows, ascending, in [0, 1].
  std::vector<double> sigma_m = {};               ///< Row-major, reflectivities × distances. Empty: no noise.
  bool empty() const { return sigma_m.empty(); }  ///< No noise: ranges are exact.
};

/// Returns how much is known: "no noise table: exact ranges", "one figure of noise, of 100 m, for all distances and
/// reflectivities", or "noise of 5 distances and 3 reflectivities".
std::string describe(const NoiseTable& noise);

/// Direction of a ray in the survey frame.
struct RayAngles {
  Angle zenith;   ///< From straight up.
  Angle azimuth;  ///< From +X towards +Y; grows from heading − H/2 without wrapping.
};

/// A terrestrial laser scanner (section 3.2). Rays: floor(H/Δh) azimuths times floor(V/2/Δv) zeniths; 1e-9 guards both
/// floors. Ray (i, j) has zenith θ₀ + (i + ½)·Δv, or `row_zeniths[i]` if there are any, azimuth heading − H/2 +
/// (j + ½)·Δh and direction (sin θ cos φ, sin θ sin φ, cos θ). Its index is i·columns + j everywhere.
struct Scanner {
  std::string name = "custom";                   ///< For tables and messages.
  Angle heading = Angle::degrees(0);             ///< Azimuth of the middle of the horizontal sweep, from +X towards +Y.
  Angle horizontal_angle = Angle::degrees(360);  ///< H, (0°, 360°].
  /// V, (0°, 360°]: the mirror's sweep over both sides, so zeniths are θ₀..θ₀ + V/2.
  Angle vertical_angle = Angle::degrees(300);
  /// θ₀; θ₀ + V/2 is at most 180°. Above 0° for scanners that cannot look straight up.
  Angle zenith_start = Angle::degrees(0);
  Angle azimuth_step = Angle::degrees(0.1);  ///< Δh.
  Angle zenith_step = Angle::degrees(0.1);   ///< Δv.
  /// Zeniths of uneven rows, ascending, such as those of a spinning multi-beam scanner. Empty: even rows. θ₀, V and Δv
  /// are then their field and mean step, so set all by `set_row_zeniths()`.
  std::vector<Angle> row_zeniths = {};
  /// Directions of a pattern that is no grid, such as a rosette, in the order of its rays; azimuths are from `heading`.
  /// Empty: rows and columns. H, V, θ₀ and both steps are then its field and mean step, so set all by
  /// `set_directions()`. Such a pattern has one column.
  std::vector<RayAngles> directions = {};
  /// Seconds from the begin of a scan to each of the directions. Empty: `points_per_second` tells them.
  std::vector<double> times_s = {};
  double height_m = 1.85;      ///< Height of the scanner's head above the search area.
  double min_range_m = 0.1;    ///< d_min.
  double max_range_m = 130.0;  ///< d_max.
  NoiseTable noise = {};       ///< Empty: exact ranges.
  /// Full angle γ by which the beam widens far away, and its diameter D at the exit, both to 1/e² of the intensity on
  /// the axis. As of a Gaussian beam, the diameter at distance t is √(D² + γ² t²). Both 0: unknown.
  Angle beam_divergence = Angle::radians(0);
  double exit_diameter_m = 0;  ///< See `beam_divergence`.
  /// Longest distance at which the scanner detects a matt surface of reflectivity `detection_reflectivity` at normal
  /// incidence. 0: it detects every echo within range.
  double detection_range_m = 0;
  double detection_reflectivity = 0.9;  ///< In (0, 1].
  /// Share of the rays whose echo is lost at random, from 0 to below 1: by rain, dust, or a receiver that misses
  /// pulses. Which ones depends on the seed, the station and the ray alone.
  double dropout = 0;
  /// Errors that a calibration leaves and all scans of the instrument share, one standard deviation each: of the
  /// vertical index, the collimation and the trunnion axis; of the offset of ranges, and of their scale. They are part
  /// of the registration error; simulated scans have those that are drawn for them (`ScanOptions::instrument`). 0: not
  /// stated.
  Angle angle_accuracy = Angle::radians(0);
  double range_accuracy_m = 0;    ///< See `angle_accuracy`.
  double range_accuracy_ppm = 0;  ///< Millionths of the range; see `angle_accuracy`.
  /// Error of each of a scan's two tilts by the compensator, one standard deviation, another in every scan. 0: not
  /// stated. Registration takes it if asked to (`RegistrationOptions::tilt_of_scanner`).
  Angle tilt_accuracy = Angle::radians(0);
  /// Measurement rate, for the time on site. The default is our assumption, for presets that state none: typical of
  /// phase and time-of-flight scanners of the last ten years.
  double points_per_second = 1'000'000;
  /// Life of a charged battery: minutes with the scanner on, and scans. If a scanner takes two at once, each has half
  /// of what both last. 0: not stated, else 1 or more. If both are stated, the one that ends first counts.
  double battery_min = 0;
  double battery_scans = 0;  ///< See `battery_min`.

  std::uint32_t rows() const;                                               ///< Zenith steps.
  std::uint32_t columns() const;                                            ///< Azimuth steps.
  std::uint64_t rays() const { return std::uint64_t{rows()} * columns(); }  ///< Rays of a scan: rows times columns.
  RayAngles angles(std::uint64_t ray) const;                                ///< REQUIRES: ray < rays().
  double time_s(std::uint64_t ray) const;  ///< Seconds from the begin of a scan. REQUIRES: ray < rays().
  double seconds() const;                  ///< Duration of a scan, without setting up.
  /// Takes other steps. Uneven rows stay where they are. Throws Error invalid_argument if the scanner has a list of
  /// directions.
  void set_steps(Angle azimuth, Angle zenith);
  /// Takes rows at these zeniths, in ascending order: θ₀ is the first, θ₀ + V/2 the last, Δv their mean step. A single
  /// row has the field of one azimuth step. None: even rows again, of the present θ₀, V and Δv.
  void set_row_zeniths(std::vector<Angle> zeniths);
  /// Takes these directions; their times do not fall, or are empty. None: rows and columns again.
  void set_directions(std::vector<RayAngles> directions, std::vector<double> times_s = {});
  /// Returns true if rows and columns are the same step apart, which one number tells.
  bool one_step() const { return directions.empty() && azimuth_step == zenith_step; }
  /// Throws Error invalid_argument with the member and its value.
  void check() const;
};

/// Its members as named values, for results and configuration files.
Settings settings(const Scanner& scanner);

/// Errors of one instrument, which all its scans share. A point at range r and zenith θ lies at r (1 + scale) + offset,
/// and is turned by f · vertical_index downwards and by f · (collimation + trunnion cos θ) across its line of sight,
/// towards larger azimuths. f is 1 in the half turn before the heading and −1 in that behind it, where the mirror shows
/// its other face.
struct InstrumentErrors {
  Angle vertical_index = Angle::radians(0);  ///< Turns every ray downwards by f times this.
  Angle collimation = Angle::radians(0);     ///< Turns every ray across by f times this.
  Angle trunnion = Angle::radians(0);        ///< Turns a ray across by f cos θ times this.
  double range_offset_m = 0;                 ///< Added to every range.
  double range_scale_ppm = 0;                ///< Millionths of the range, added to it.

  /// Displacement of a point at this range, in the frame of `angles`.
  Vec3 displacement(const RayAngles& angles, double range_m, Angle heading = Angle::radians(0)) const;
};

/// Draws errors of the standard deviations that the scanner states (`angle_accuracy`, `range_accuracy_m` and
/// `range_accuracy_ppm`). Scanners of one seed err alike, as settings of one instrument do. Throws Error
/// invalid_argument if it states none.
InstrumentErrors draw_instrument_errors(const Scanner& scanner, std::uint64_t seed);

/// Table 1 of the method: Leica RTC360, single measurement.
NoiseTable rtc360_noise();

/// Returns the range noise named "off", that of a preset, or that of a CSV file: a header `reflectivity,<distance in
/// metres>,…`, then a line of standard deviations in metres for each reflectivity. A header `incidence_deg@<R>,…` has a
/// line for each angle of incidence on a surface of reflectivity R, which counts as one of R cos α seen squarely.
/// Throws Error: io, malformed_file, invalid_argument.
NoiseTable load_noise(const std::string& name);

/// Directions of rays and their times, as `Scanner::set_directions()` takes them.
struct DirectionTable {
  std::vector<RayAngles> directions = {};  ///< In the order of the scan.
  std::vector<double> times_s = {};        ///< Seconds from the begin of a scan to each; empty: not told.
};
/// Reads directions from a CSV file: a header `azimuth_deg,elevation_deg` or `azimuth_deg,elevation_deg,time_s`, then a
/// line for each ray, in the order of the scan. Azimuths grow from the heading towards the left, elevations from the
/// horizon upwards; times are in seconds from the begin of the scan. Throws Error: io, malformed_file with the line.
DirectionTable load_directions(const std::filesystem::path& file);

/// One preset scanner.
struct ScannerPreset {
  std::string key;      ///< "rtc360"
  std::string summary;  ///< One line for `vantage info`.
};

/// Returns a scanner by "key" or "key@setting", e.g. "rtc360@6mm", or by its full name; case is ignored. The presets
/// (data/scanners.json) are part of the library. A file `more` of the same form adds presets; its keys take precedence.
/// Throws Error: io, malformed_file, invalid_argument (lists what exists).
Scanner load_scanner(const std::string& name, const std::filesystem::path& more = {});
/// Returns all presets, those of `more` first. Throws Error: io, malformed_file.
std::vector<ScannerPreset> list_scanners(const std::filesystem::path& more = {});

/// Path of scanners.json in the folder named by the environment variable VANTAGE_DATA; empty if it is not set.
std::filesystem::path own_presets_file();

}  // namespace vantage
