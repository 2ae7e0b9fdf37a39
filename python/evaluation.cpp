// SPDX-License-Identifier: Apache-2.0
#include "evaluation.hpp"

#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

[[noreturn]] void not_asked_for(const std::string& what, const std::string& how) {
  throw Error(Errc::invalid_argument, what + ": was not asked for; evaluate with " + how);
}

const Evaluation& with_pairs(const Evaluation& e, const char* what) {
  if (e.counts.stations > 0 && e.counts.seen.empty()) not_asked_for(what, "overlap=True");
  return e;
}

const Estimate& estimate_of(const Evaluation& e, const char* measure, const char* how) {
  const auto found = e.values.find(measure);
  if (found != e.values.end()) return found->second;
  if (e.counts.cancelled) throw Error(Errc::invalid_argument, std::string(measure) + ": the call was cancelled");
  not_asked_for(measure, how);
}
double value_of(const Evaluation& e, const char* measure) { return estimate_of(e, measure, "overlap=True").value; }
double error_of(const Evaluation& e, const char* measure) {
  return estimate_of(e, measure, "overlap=True").standard_error;
}

const VoxelField& field_of(const Evaluation& e, const char* what) {
  if (e.field.count.empty() && e.voxels > 0) not_asked_for(what, "field=True");
  return e.field;
}

const ScanOverlapMatrix& scan_overlaps_of(const Evaluation& e, const char* what) {
  if (e.scan_overlap_matrix.size() == 0 && e.counts.stations > 0) not_asked_for(what, "surroundings=True");
  return e.scan_overlap_matrix;
}

py::array_t<std::uint64_t> shared_voxels(const Evaluation& e) {
  const NetworkCounts& counts = with_pairs(e, "shared").counts;
  const std::size_t n = counts.stations;
  std::vector<std::uint64_t> shared(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) shared[i * n + j] = i == j ? counts.seen[i] : counts.shared_by(i, j);
  return adopt<std::uint64_t>(std::move(shared), {static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(n)});
}

}  // namespace

const char* const kData =
    "What its scans hold, besides those of existing stations: a dict with `points` on all surfaces, counted or "
    "estimated from\nthe surroundings, and `e57_bytes` and `las_bytes` of files with their reflectivity. None if it is "
    "not known.";

Data data_of(const Evaluation& e) {
  if (!e.data) return py::none();
  py::dict dict;
  dict["points"] = e.data->points, dict["e57_bytes"] = e.data->e57_bytes, dict["las_bytes"] = e.data->las_bytes;
  return dict;
}

namespace {

Json values_of(const Evaluation& e) {
  Json dict = from_json(evaluation_json(e));
  dict["points"] = e.counts.points;
  dict["points_on_surveyed"] = e.counts.points_on_surveyed;
  dict["trace_seconds"] = e.counts.trace_seconds;
  return dict;
}

void add_registration(py::module_& m) {
  const auto options = [] {
    return Options<RegistrationOptions>("RegistrationOptions")
        .add<double>(
            "rho_m", [](const RegistrationOptions& o) { return o.model.rho_m; },
            [](RegistrationOptions& o, double value) { o.model.rho_m = value; },
            "Modelling error along the normal, one sigma, the same over a patch; metres.")
        .add<double>(
            "patch_m", [](const RegistrationOptions& o) { return o.model.patch_m; },
            [](RegistrationOptions& o, double value) { o.model.patch_m = value; },
            "Side of such a patch, metres; planes count if the surface is flat over half of it.")
        .add("position_m", &RegistrationOptions::position_m, "Sigma of a head before registration, in each axis.")
        .add("heading_deg", &RegistrationOptions::heading, "Sigma of the heading before registration.")
        .add("tilt_deg", &RegistrationOptions::tilt, "Sigma of each tilt; 0: exactly level.")
        .add("tilt_of_scanner", &RegistrationOptions::tilt_of_scanner, "Take the tilt that the scanners state instead.")
        .add("surfaces", &RegistrationOptions::surfaces, "Surfaces that scans register on: 'surveyed' or 'all'.");
  }();
  py::class_<RegistrationOptions> type(
      m, "RegistrationOptions",
      ("Prior of registration, and how accurately scans have the surface (docs/registration.md)." + options.doc())
          .c_str());
  type.def(py::init([options](const py::kwargs& given) {
        const RegistrationOptions made = options.read(given);
        check(made);
        return made;
      }))
      .def("__repr__", [options](const RegistrationOptions& o) { return options.repr(o); });
  options.attributes(type);
  options.pickles(type);

  py::class_<RegistrationError> error(m, "RegistrationError", "Predicted error of a registered network, metres.");
  error.def_readonly("rms_m", &RegistrationError::rms_m, "Root mean square displacement over the covered surface.")
      .def_readonly("random_m", &RegistrationError::random_m,
                    "What rms_m would be without the errors that all scans of an instrument share.")
      .def_readonly("worst_m", &RegistrationError::worst_m, "The same for the worst station.")
      .def_readonly("worst_station", &RegistrationError::worst_station, "Index of the worst station, from 0.")
      .def_property_readonly(
          "station_rms_m",
          [](const RegistrationError& error) {
            std::vector<double> rms;
            for (const StationError& station : error.stations) rms.push_back(station.rms_m);
            const auto n = static_cast<py::ssize_t>(rms.size());
            return adopt<double>(std::move(rms), {n});
          },
          "Error of each station over the surface that it sees: (n,).")
      .def_property_readonly(
          "head_covariance_m2",
          [](const RegistrationError& error) {
            std::vector<std::array<double, 9>> covariances;
            for (const StationError& station : error.stations) covariances.push_back(station.covariance);
            const auto n = static_cast<py::ssize_t>(covariances.size());
            return adopt<double>(std::move(covariances), {n, 3, 3});
          },
          "Covariances of the heads in the survey frame, square metres: (n, 3, 3).");
  add_pickle(error);
}

void add_connectivity(py::module_& m) {
  py::class_<Connectivity> connectivity(m, "Connectivity", "Connectivity of a network. Stations count from 0.");
  connectivity.def_readonly("parts", &Connectivity::parts, "Number of connected components.")
      .def_readonly("part", &Connectivity::part, "Component of each station.")
      .def_readonly("bridges", &Connectivity::bridges, "Links without which a component falls in two.")
      .def_readonly("weakest_link", &Connectivity::weakest_link,
                    "Weakest link of the maximum spanning tree, if there is one component.")
      .def_readonly("weakest_overlap", &Connectivity::weakest_overlap, "Its overlap.");
  add_pickle(connectivity);
}

}  // namespace

void add_evaluations(py::module_& m) {
  add_registration(m);
  add_connectivity(m);
  py::class_<Evaluation> type(
      m, "Evaluation",
      "Evaluation of a network of n stations in the surveyed voxels: by every ray, or on a sample of the voxels "
      "with\nstandard errors (`coverage_se` and the like). Measures that were not requested raise Error.");
  type.def_property_readonly(
          "coverage", [](const Evaluation& e) { return value_of(e, "coverage"); },
          "Equation 8 of the paper, in [0, 1].")
      .def_property_readonly(
          "coverage_se", [](const Evaluation& e) { return error_of(e, "coverage"); },
          "Standard error; 0 if all voxels were counted.")
      .def_property_readonly(
          "overlap", [](const Evaluation& e) { return value_of(e, "overlap"); },
          "Average weighted clustering coefficient (equation 13), in [0, 1].")
      .def_property_readonly(
          "overlap_se", [](const Evaluation& e) { return error_of(e, "overlap"); },
          "Standard error; 0 if all voxels were counted.")
      .def_property_readonly(
          "overlap_matrix",
          [](const Evaluation& e) { return matrix_of(with_pairs(e, "overlap_matrix").overlap_matrix); },
          "Voxels seen by both over voxels seen by either (equation 11): (n, n), 0 on the diagonal.")
      .def_property_readonly(
          "overlap_matrix_se",
          [](const Evaluation& e) {
            const bool none = with_pairs(e, "overlap_matrix_se").overlap_errors.size() == 0;
            return matrix_of(none ? PairMatrix(e.counts.stations) : e.overlap_errors);
          },
          "Standard errors of `overlap_matrix`: (n, n).")
      .def_property_readonly(
          "scan_overlap_matrix",
          [](const Evaluation& e) { return matrix_of(scan_overlaps_of(e, "scan_overlap_matrix")); },
          "Voxels of all surfaces, surveyed or not, that both stations see, over those of the smaller scan, as usual "
          "in\npractice: (n, n), 0 on the diagonal.")
      .def(
          "connectivity",
          [](const Evaluation& e, double min_overlap) {
            return connectivity(with_pairs(e, "connectivity").overlap_matrix, min_overlap);
          },
          py::arg("min_overlap") = default_link_overlap,
          "Connectivity by overlaps (equation 11) of at least `min_overlap`.")
      .def(
          "scan_connectivity",
          [](const Evaluation& e, double min_overlap) {
            return connectivity(scan_overlaps_of(e, "scan_connectivity"), min_overlap);
          },
          py::arg("min_overlap") = default_link, "Connectivity by scan overlaps of at least `min_overlap`.")
      .def_property_readonly(
          "registration",
          [](const Evaluation& e) {
            if (!e.registration) not_asked_for("registration", "registration=RegistrationOptions()");
            return *e.registration;
          },
          "Predicted error of the registered scans.")
      .def_property_readonly(
          "registration_estimate",
          [](const Evaluation& e) {
            const Estimate& mm = estimate_of(e, "registration", "registration=RegistrationOptions()");
            return Estimate{mm.value / 1e3, mm.standard_error / 1e3};
          },
          "(rms_m, its standard error); for a sample less its bias.")
      .def_property_readonly(
          "seen",
          [](const py::object& self) {
            return view<std::uint64_t>(std::span(with_pairs(self.cast<const Evaluation&>(), "seen").counts.seen), self);
          },
          "Voxels with a point of each station: (n,), read-only.")
      .def_property_readonly(
          "shared", &shared_voxels,
          "Voxels with points of both stations: (n, n); on the diagonal those of the station itself.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return view<std::uint64_t>(std::span(self.cast<const Evaluation&>().counts.points), self);
          },
          "Points of each station on all meshes: (n,), read-only; (0,) if they were not counted.")
      .def_property_readonly(
          "points_on_surveyed",
          [](const py::object& self) {
            return view<std::uint64_t>(std::span(self.cast<const Evaluation&>().counts.points_on_surveyed), self);
          },
          "Points of each station that count: (n,), read-only.")
      .def_property_readonly(
          "mixed",
          [](const py::object& self) {
            const Evaluation& e = self.cast<const Evaluation&>();
            if (e.counts.mixed.empty() && e.counts.stations > 0) not_asked_for("mixed", "beam=BeamOptions()");
            return view<std::uint64_t>(std::span(e.counts.mixed), self, 3);
          },
          "Points of each station that lie off all surfaces they were made of, by more than 5 mm: (n, 3), read-only. "
          "All "
          "of them,\nthose that count, and those in a surveyed voxel that they did not come from.")
      .def_property_readonly(
          "voxel_points",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(field_of(self.cast<const Evaluation&>(), "voxel_points").count), self);
          },
          "Points in each voxel, in the order of `Simulator.voxel_centres`: (N_v,), read-only.")
      .def_property_readonly(
          "voxel_stations",
          [](const py::object& self) {
            const StationMasks& masks = field_of(self.cast<const Evaluation&>(), "voxel_stations").stations;
            return adopt<std::uint64_t>(masks.all_words(), {static_cast<py::ssize_t>(masks.words() * masks.voxels())});
          },
          "Station masks: bit i is set if station i has a point in the voxel: (N_v,), a copy. Beyond 64 stations the "
          "masks of the next\n64 follow, and so on.")
      .def("value", &Evaluation::value, py::arg("name"),
           "A measure by its name in `vantage evaluate --json`, in its unit. Raises Error invalid_argument if it was "
           "not "
           "requested, and\nsuggests one that was.")
      .def_readonly("voxels", &Evaluation::voxels, "Surveyed voxels of the site, N_v.")
      .def_property_readonly(
          "sample", [](const Evaluation& e) { return e.counts.voxels; },
          "Voxels that were counted; equals `voxels` without a sample.")
      .def_readonly("goal_density", &Evaluation::goal_density, "Points wanted in a voxel.")
      .def_property_readonly(
          "stations", [](const Evaluation& e) { return e.counts.stations; }, "Number of stations.")
      .def_property_readonly(
          "heads", [](const Evaluation& e) { return heads_of(e.stations); },
          "Their heads, survey frame: (n, 3), metres.")
      .def_property_readonly(
          "rays", [](const Evaluation& e) { return e.counts.rays; }, "Rays that were traced.")
      .def_property_readonly(
          "trace_seconds", [](const Evaluation& e) { return e.counts.trace_seconds; }, "Time spent tracing.")
      .def_property_readonly(
          "cancelled", [](const Evaluation& e) { return e.counts.cancelled; },
          "Whether it was stopped: its counts are then too low, and its measures raise `vantage.Error`.")
      .def_property_readonly(
          "data", [](const Evaluation& e) { return data_of(e); }, kData)
      .def_readonly("visit", &Evaluation::visit, "The round on site without existing stations; None if unknown.")
      .def_property_readonly(
          "summary", [](const Evaluation& e) { return summary_text(e); }, "Summary in plain words.")
      .def("to_dict", &values_of, "Plain values by their names in `vantage evaluate --json`.")
      .def("__repr__", [](const Evaluation& e) {
        if (e.counts.cancelled) return std::string("<vantage.Evaluation: cancelled>");
        return "<vantage.Evaluation of " + std::to_string(e.counts.stations) + " stations: coverage " +
               std::string(py::str(py::float_(value_of(e, "coverage")))) + ">";
      });
  add_pickle(type);
}

}  // namespace vantage::python
