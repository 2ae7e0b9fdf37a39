// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"
#include "site.hpp"

namespace vantage::python {

namespace {

Options<OnSiteOptions> on_site_options() {
  return Options<OnSiteOptions>("OnSiteOptions")
      .add("set_up_min", &OnSiteOptions::set_up_min, "Minutes at each station besides the scan.")
      .add("photos_min", &OnSiteOptions::photos_min, "Minutes at each station for pictures.")
      .add("walking_m_per_s", &OnSiteOptions::walking_m_per_s, "Walking speed with scanner and tripod in hand.")
      .add("detour", &OnSiteOptions::detour,
           "Length over straight line of paths that the search area does not connect.")
      .add("entrance", &OnSiteOptions::entrance,
           "Ground (x, y, z) where people enter and leave; None: at the first station.");
}

}  // namespace

void add_targets(py::module_& m) {
  py::class_<Target> target(m, "Target", "A target, or a control point. Lengths in metres, survey frame.");
  target
      .def(py::init([](std::string name, const Vec3& centre, double control_m) {
             return Target{.name = std::move(name), .centre = centre, .control_m = control_m};
           }),
           py::arg("name"), py::arg("centre"), py::arg("control_m") = 0.0)
      .def_readonly("name", &Target::name, "Its name.")
      .def_readonly("centre", &Target::centre, "Its centre (x, y, z).")
      .def_readonly("control_m", &Target::control_m,
                    "Standard deviation of known coordinates, in each axis; 0: no control point.")
      .def_readonly("proposed", &Target::proposed, "Whether it was proposed.")
      .def_readonly("stations", &Target::stations, "Indices of the stations that measure it.")
      .def("__repr__", [](const Target& t) {
        return "<vantage.Target " + t.name + " at " + std::string(py::repr(py::cast(t.centre))) + ">";
      });
  target.def(
      py::pickle([](const Target& t) { return py::make_tuple(t.name, t.centre, t.control_m, t.proposed, t.stations); },
                 [](const py::tuple& t) {
                   return Target{.name = t[0].cast<std::string>(),
                                 .centre = t[1].cast<Vec3>(),
                                 .control_m = t[2].cast<double>(),
                                 .proposed = t[3].cast<bool>(),
                                 .stations = t[4].cast<std::vector<std::size_t>>()};
                 }));
  m.def(
      "read_targets_csv", [](const std::filesystem::path& file) { return read_targets_csv(file); }, py::arg("file"),
      "Reads Targets from a table with columns name, x, y, z, and for control points sigma, in metres.\nRaises Error: "
      "io, malformed_file.");
}

void add_visits(py::module_& m) {
  const auto options = on_site_options();
  py::class_<OnSiteOptions> type(m, "OnSiteOptions", ("Times of a person with a tripod." + options.doc()).c_str());
  type.def(py::init([options](const py::kwargs& given) { return options.read(given); }))
      .def("__repr__", [options](const OnSiteOptions& o) { return options.repr(o); });
  options.attributes(type);
  options.pickles(type);

  py::class_<Visit> visit(m, "Visit", "One round: in at the entrance, to every station, and back out.");
  visit.def_readonly("order", &Visit::order, "Indices of the stations; unusable ones are left out.")
      .def_readonly("legs_m", &Visit::legs_m, "Path to each in that order, then back out, metres.")
      .def_readonly("paths", &Visit::paths, "Ground points of each of these paths: lists of (x, y, z).")
      .def_readonly("walk_m", &Visit::walk_m, "All legs together.")
      .def_readonly("scan_min", &Visit::scan_min, "Minutes of scanning.")
      .def_readonly("set_up_min", &Visit::set_up_min, "Minutes of setting up.")
      .def_readonly("photos_min", &Visit::photos_min, "Minutes of taking pictures.")
      .def_readonly("walk_min", &Visit::walk_min, "Minutes of walking.")
      .def_readonly("minutes", &Visit::minutes, "Scan, set-up, photos and walking together.")
      .def_readonly("unconnected", &Visit::unconnected, "Legs that the search area does not connect.")
      .def_readonly("unlinked", &Visit::unlinked, "Stations without a link to the one before; 0 if no links are known.")
      .def("__repr__", [](const Visit& v) {
        return "<vantage.Visit of " + std::to_string(v.order.size()) + " stations, " +
               std::string(py::str(py::float_(v.minutes))) + " minutes>";
      });
  add_pickle(visit);
}

void add_on_site(py::module_& m) {
  py::class_<OnSite>(m, "OnSite", "Paths over a site, and the time of a round.")
      .def(py::init([](GuardedSite& site, const OnSiteOptions& how) {
             const auto lock = site.taken();
             const py::gil_scoped_release unlocked;
             return site.site.on_site(how);
           }),
           py::arg("site"), py::arg("options") = OnSiteOptions{},
           "Rounds begin and end at the site's entrance if the options name none. Raises Error invalid_argument.")
      .def("way_m", &OnSite::way_m, py::arg("start"), py::arg("end"),
           "Metres from one ground point (x, y, z) to another; None if the search area does not connect them.")
      .def(
          "visit", [](const OnSite& site, const py::object& stations) { return site.visit(stations_of(stations)); },
          py::arg("stations"),
          "A good order of the stations, and the time of the round. stations: in a form that `evaluate` accepts.");
}

}  // namespace vantage::python
