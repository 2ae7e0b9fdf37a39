// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "pickle.hpp"
#include "settings.hpp"
#include "site.hpp"

namespace vantage::python {
namespace {

struct Next {
  std::shared_ptr<GuardedSite> found;
  Day day;
};

NextConfig config_of(const py::kwargs& given) {
  refuse_unknown(given, "Site.next", next_settings());
  NextConfig config;
  read_settings(next_settings(), config, given);
  return config;
}

std::optional<Next> next_of(GuardedSite& self, const std::filesystem::path& scans,
                            const std::optional<Stations>& planned, std::vector<std::string> names, Listener progress,
                            const py::kwargs& given) {
  Next next{nullptr, Day{.config = config_of(given)}};
  const auto lock = self.taken();
  Day& day = next.day;
  if (planned) day.planned = placed_on(self.site, stations_of(*planned));
  if (!names.empty() && names.size() != day.planned.size())
    throw Error(Errc::invalid_argument, "planned_names: one for each planned station is wanted, " +
                                            std::to_string(names.size()) + " for " +
                                            std::to_string(day.planned.size()) + " were given");
  day.planned_names = station_names(day.planned, names);
  LongCall call(std::move(progress));
  const bool whole = call.run([&] {
    self.site.area();  // an error now, not behind the scans
    day.scans = read_taken_scans(scans, 0.02, call.progress(0, 0.1));
    if (call.stop().stop_requested()) return false;
    if (!find_changes(self.site, day, call.progress(0.1, 0.4))) return false;
    next.found = std::shared_ptr<GuardedSite>(new GuardedSite{changed_site(self.site, day.changes)});
    auto answer =
        next_stations(next.found->site, day.scans, day.changes, day.planned, day.config, call.progress(0.4, 1));
    if (answer) day.answer = std::move(*answer);
    return answer.has_value();
  });
  if (!whole) return std::nullopt;
  return next;
}

}  // namespace

void add_next(py::module_& m) {
  py::class_<Next> type(m, "NextResult", "What taken scans captured, and where to stand next (docs/next.md).");
  type.def_property_readonly(
          "captured", [](const Next& next) { return next.day.answer.captured; },
          "Share of what is attainable that the scans captured by their real points, with its standard error.")
      .def_property_readonly(
          "captured_then", [](const Next& next) { return next.day.answer.captured_then; },
          "The share with all next stations.")
      .def_property_readonly(
          "enough", [](const Next& next) { return next.day.answer.enough; },
          "Whether that reaches the wanted share, and all stations are linked.")
      .def_property_readonly(
          "taken", [](const Next& next) { return next.day.answer.taken; },
          "The scans as existing PlacedStations, where they were fitted to the model.")
      .def_property_readonly(
          "stations",
          [](const Next& next) {
            std::vector<PlacedStation> stations;
            for (const NextStation& one : next.day.answer.next) stations.push_back(one.station);
            return stations;
          },
          "The next PlacedStations, in the order in which to take them.")
      .def_property_readonly(
          "names", [](const Next& next) { return next.day.names(); }, "Names of the scans, then of the next stations.")
      .def_property_readonly(
          "visit", [](const Next& next) { return next.day.answer.visit; }, "The round over the next stations.")
      .def_property_readonly(
          "found", [](const Next& next) { return next.found; },
          "The Site as it was found: things that are not in the model block, meshes that scans saw through are gone.")
      .def(
          "to_dict",
          [](const Next& next) {
            const auto lock = next.found->taken();
            return from_json(next_json(next.day, next.found->site));
          },
          "Content of next.json (docs/files.md).")
      .def(
          "write",
          [](const Next& next, const std::filesystem::path& folder) {
            const auto lock = next.found->taken();
            const py::gil_scoped_release unlocked;
            write_next(folder, next.day, next.found->site);
          },
          py::arg("folder"),
          "Writes next.json, stations.csv, stations.dxf and plan.png, like `vantage next`. Raises Error io.")
      .def("__repr__", [](const Next& next) {
        return "<vantage.NextResult of " + std::to_string(next.day.scans.size()) + " scans and " +
               std::to_string(next.day.answer.next.size()) + " next stations>";
      });
  refuse_pickle(type, "a NextResult owns a site with a device and is not pickled; take to_dict()");
  const py::object site = m.attr("Site");
  site.attr("next") = py::cpp_function(
      &next_of, py::name("next"), py::is_method(site), py::arg("scans"), py::arg("planned") = py::none(), py::kw_only(),
      py::arg("planned_names") = std::vector<std::string>{}, py::arg("progress") = py::none(),
      ("What scans captured by their real points, and where to stand next, like `vantage next`: scans are fitted to "
       "the\nmodel, things that are not in it are found, and the fewest further stations are chosen.\n\nscans: an E57 "
       "or PTX file, or a folder of such files. planned: stations of the plan, in a form that "
       "`Simulator.evaluate`\ntakes; heads are put on the ground below. planned_names: one for each; empty: numbered. "
       "Returns a NextResult, or None if\nprogress returned False.\nRaises Error: io, malformed_file (no scan with a "
       "pose), invalid_argument, out_of_memory." +
       settings_doc("Site.next", next_settings()))
          .c_str());
}

}  // namespace vantage::python
