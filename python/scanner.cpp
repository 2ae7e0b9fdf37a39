// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"

namespace vantage::python {
namespace {

using Numbers = py::array_t<double>;
using GivenNoise = Typed<"Dict[str, numpy.typing.ArrayLike]">;

// {'distances_m': (d,), 'reflectivities': (r,), 'sigma_m': (r, d)}; None: no noise.
std::optional<std::map<std::string, Numbers>> noise_of(const NoiseTable& noise) {
  if (noise.empty()) return std::nullopt;
  const auto d = static_cast<py::ssize_t>(noise.distances_m.size());
  const auto r = static_cast<py::ssize_t>(noise.reflectivities.size());
  return {{{"distances_m", Numbers(d, noise.distances_m.data())},
           {"reflectivities", Numbers(r, noise.reflectivities.data())},
           {"sigma_m", Numbers(Shape{r, d}, noise.sigma_m.data())}}};
}

NoiseTable noise_from(const std::optional<GivenNoise>& given) {
  if (!given) return {};
  const auto part = [&](const char* key) {
    const Doubles numbers = doubles_of((*given)[key], std::string("noise: ") + key);
    return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
  };
  return {.distances_m = part("distances_m"), .reflectivities = part("reflectivities"), .sigma_m = part("sigma_m")};
}

Numbers numbers_of(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

// An array of what a list holds; None of an empty one.
template <class List, class Array>
std::optional<Numbers> or_none(const List& list, const Array& array) {
  return list.empty() ? std::nullopt : std::optional(array(list));
}

std::vector<double> numbers_from(const std::optional<ArrayLike>& given, const char* name) {
  if (!given) return {};
  const Doubles numbers = doubles_of(*given, name);
  return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
}

Numbers zeniths_of(const std::vector<Angle>& zeniths) {
  std::vector<double> degrees;
  for (const Angle& zenith : zeniths) degrees.push_back(zenith.in_degrees());
  return numbers_of(degrees);
}

std::vector<Angle> zeniths_from(const std::optional<ArrayLike>& given) {
  std::vector<Angle> zeniths;
  for (const double degrees : numbers_from(given, "row_zeniths_deg")) zeniths.push_back(Angle::degrees(degrees));
  return zeniths;
}

Numbers pairs_of(const std::vector<RayAngles>& directions) {
  Numbers pairs(Shape{static_cast<py::ssize_t>(directions.size()), 2});
  double* next = pairs.mutable_data();
  for (const RayAngles& angles : directions)
    *next++ = angles.azimuth.in_degrees(), *next++ = 90 - angles.zenith.in_degrees();
  return pairs;
}

std::vector<RayAngles> directions_from(const std::optional<ArrayLike>& pairs) {
  std::vector<RayAngles> directions;
  if (!pairs) return directions;
  const Doubles given = doubles_of(*pairs, "directions_deg");
  if (given.ndim() != 2 || given.shape(1) != 2)
    throw Error(Errc::invalid_argument, "directions_deg must have the shape (n, 2): azimuths and elevations");
  for (py::ssize_t k = 0; k < given.shape(0); ++k)
    directions.push_back({Angle::degrees(90 - given.data()[2 * k + 1]), Angle::degrees(given.data()[2 * k])});
  return directions;
}

Options<Scanner> scanner_options() {
  return Options<Scanner>("Scanner")
      .add("name", &Scanner::name, "Name of the model.")
      .add("heading_deg", &Scanner::heading, "Azimuth of the middle of the sweep, degrees from +X towards +Y.")
      .add("horizontal_angle_deg", &Scanner::horizontal_angle, "H, above 0 to 360.")
      .add("vertical_angle_deg", &Scanner::vertical_angle, "V, the mirror's sweep over both sides: zeniths to V/2.")
      .add("zenith_start_deg", &Scanner::zenith_start, "First zenith, from straight up.")
      .add("azimuth_step_deg", &Scanner::azimuth_step, "Angle between columns.")
      .add("zenith_step_deg", &Scanner::zenith_step, "Angle between rows.")
      .add<std::optional<ArrayLike>>(
          "row_zeniths_deg", [](const Scanner& s) { return or_none(s.row_zeniths, zeniths_of); },
          [](Scanner& s, const std::optional<ArrayLike>& zeniths) { s.set_row_zeniths(zeniths_from(zeniths)); },
          "Zeniths of uneven rows, ascending, degrees (n,), in place of even ones; vertical_angle_deg, "
          "zenith_start_deg and zenith_step_deg are then set to their field and mean step. None: even rows.")
      .add<std::optional<ArrayLike>>(
          "directions_deg", [](const Scanner& s) { return or_none(s.directions, pairs_of); },
          [](Scanner& s, const std::optional<ArrayLike>& pairs) {
            s.set_directions(directions_from(pairs), std::move(s.times_s));
          },
          "Directions of a pattern that is no grid, in the order of its rays: azimuths from the heading and elevations "
          "from the horizon, degrees (n, 2); angles and steps are then set to their field and mean step. None: a grid.")
      .add<std::optional<ArrayLike>>(
          "times_s", [](const Scanner& s) { return or_none(s.times_s, numbers_of); },
          [](Scanner& s, const std::optional<ArrayLike>& times) { s.times_s = numbers_from(times, "times_s"); },
          "Seconds from the begin of a scan to each of the directions (n,). None: points_per_second tells them.")
      .add("height_m", &Scanner::height_m, "Height of the head above the search area, metres.")
      .add("min_range_m", &Scanner::min_range_m, "Nearest distance measured, metres.")
      .add("max_range_m", &Scanner::max_range_m, "Farthest distance measured, metres.")
      .add("points_per_second", &Scanner::points_per_second, "Measurement rate, for the time on site.")
      .add("battery_min", &Scanner::battery_min,
           "Minutes that a charged battery lasts with the scanner on, 1 or more; 0: not stated.")
      .add("battery_scans", &Scanner::battery_scans, "The same in scans.")
      .add<std::optional<GivenNoise>>(
          "noise", [](const Scanner& s) { return noise_of(s.noise); },
          [](Scanner& s, const std::optional<GivenNoise>& noise) { s.noise = noise_from(noise); },
          "Standard deviations of ranges: a dict of 'distances_m' (d,), 'reflectivities' (r,), 'sigma_m' (r, d); None: "
          "exact.")
      .add<double>(
          "beam_divergence_mrad", [](const Scanner& s) { return s.beam_divergence.in_radians() * 1e3; },
          [](Scanner& s, double mrad) { s.beam_divergence = Angle::radians(mrad * 1e-3); },
          "Full angle of divergence, to 1/e^2; 0: not known.")
      .add<double>(
          "exit_diameter_mm", [](const Scanner& s) { return s.exit_diameter_m * 1e3; },
          [](Scanner& s, double mm) { s.exit_diameter_m = mm * 1e-3; },
          "Diameter of the beam at the exit, to 1/e^2; 0: not known.")
      .add<double>(
          "angle_accuracy_arcsec", [](const Scanner& s) { return s.angle_accuracy.in_degrees() * 3600; },
          [](Scanner& s, double arcsec) { s.angle_accuracy = Angle::degrees(arcsec / 3600); },
          "What a calibration leaves of the vertical index, the collimation and the trunnion axis, in arc seconds, one "
          "standard deviation each; 0: not stated.")
      .add<double>(
          "range_accuracy_mm", [](const Scanner& s) { return s.range_accuracy_m * 1e3; },
          [](Scanner& s, double mm) { s.range_accuracy_m = mm * 1e-3; }, "The same of the offset of ranges.")
      .add("range_accuracy_ppm", &Scanner::range_accuracy_ppm, "The same of their scale.")
      .add<double>(
          "tilt_accuracy_arcsec", [](const Scanner& s) { return s.tilt_accuracy.in_degrees() * 3600; },
          [](Scanner& s, double arcsec) { s.tilt_accuracy = Angle::degrees(arcsec / 3600); },
          "Error of each tilt of a scan by the compensator, one standard deviation; 0: not stated.")
      .add("detection_range_m", &Scanner::detection_range_m,
           "Longest distance from which a surface of detection_reflectivity is detected; 0: every echo is.")
      .add("detection_reflectivity", &Scanner::detection_reflectivity, "Above 0 to 1.")
      .add("dropout", &Scanner::dropout, "Share of the rays whose echo is lost at random, 0 to below 1.");
}

Options<InstrumentErrors> instrument_options() {
  return Options<InstrumentErrors>("InstrumentErrors")
      .add("vertical_index_deg", &InstrumentErrors::vertical_index, "Turns points downwards on one face.")
      .add("collimation_deg", &InstrumentErrors::collimation, "Turns them across the line of sight on one face.")
      .add("trunnion_deg", &InstrumentErrors::trunnion, "The same, times the cosine of the zenith.")
      .add("range_offset_m", &InstrumentErrors::range_offset_m, "Added to ranges.")
      .add("range_scale_ppm", &InstrumentErrors::range_scale_ppm, "Millionths by which ranges grow.");
}

}  // namespace

void add_scanners(py::module_& m) {
  const auto options = scanner_options();
  py::class_<Scanner> type(
      m, "Scanner",
      ("A terrestrial laser scanner (section 3.2 of the paper). Ray (row, column) has zenith\n"
       "zenith_start + (row + 1/2) zenith_step and azimuth heading - H/2 + (column + 1/2) azimuth_step." +
       options.doc())
          .c_str());
  type.def(py::init([options](const py::kwargs& given) { return options.read(given); }))
      .def_static(
          "load", [](const std::string& name, const std::filesystem::path& more) { return load_scanner(name, more); },
          py::arg("name"), py::arg("more") = "",
          "A preset by its key, such as 'rtc360' or 'rtc360@6mm'. more: a file of further ones, in the form "
          "of\ndata/scanners.json. Raises Error: io, malformed_file, invalid_argument (lists what exists).")
      .def_property_readonly("rows", &Scanner::rows, "Zenith steps.")
      .def_property_readonly("columns", &Scanner::columns, "Azimuth steps.")
      .def_property_readonly("rays", &Scanner::rays, "rows * columns.")
      .def("check", &Scanner::check, "Raises Error invalid_argument with the member that is out of range.")
      .def(
          "to_dict", [](const Scanner& scanner) { return to_dict(settings(scanner)); }, "Its members by their names.")
      .def("__repr__", [options](const Scanner& scanner) { return options.repr(scanner); });
  options.attributes(type);
  options.pickles(type);

  const auto errors = instrument_options();
  py::class_<InstrumentErrors> instrument(m, "InstrumentErrors",
                                          ("Errors of one instrument, which all its scans share. Angles have the "
                                           "opposite sign behind the heading, where the "
                                           "mirror\nshows its other face." +
                                           errors.doc())
                                              .c_str());
  instrument.def(py::init([errors](const py::kwargs& given) { return errors.read(given); }))
      .def_static("draw", &draw_instrument_errors, py::arg("scanner"), py::arg("seed"),
                  "Draws errors of the standard deviations that the scanner states. Scanners of one seed err alike. "
                  "Raises Error\ninvalid_argument if it states none.")
      .def("__repr__", [errors](const InstrumentErrors& e) { return errors.repr(e); });
  errors.attributes(instrument);
  errors.pickles(instrument);

  m.def(
      "scanners",
      [](const std::filesystem::path& more) {
        std::vector<std::pair<std::string, std::string>> all;
        for (const ScannerPreset& preset : list_scanners(more)) all.emplace_back(preset.key, preset.summary);
        return all;
      },
      py::arg("more") = "",
      "Pairs (key, summary) of the presets, those of the file `more` first. Raises Error: io, malformed_file.");
  m.def(
      "load_directions",
      [](const std::filesystem::path& file) {
        const DirectionTable table = load_directions(file);
        return std::pair(pairs_of(table.directions), or_none(table.times_s, numbers_of));
      },
      py::arg("file"),
      "Directions of a CSV file and their times, as Scanner takes them: azimuths and elevations, degrees (n, 2), and "
      "seconds (n,) or None. The\nheader is azimuth_deg,elevation_deg or azimuth_deg,elevation_deg,time_s. Raises "
      "Error: "
      "io, malformed_file with the line.");
}

}  // namespace vantage::python
