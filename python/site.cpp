// SPDX-License-Identifier: Apache-2.0
#include "site.hpp"

#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "pickle.hpp"
#include "settings.hpp"

namespace vantage::python {
namespace {

SiteOptions site_options(const py::kwargs& given, const std::string& call) {
  refuse_unknown(given, call, site_settings());
  SiteOptions options;
  read_settings(site_settings(), options, given);
  return options;
}

// One call at a time, since a site makes its parts at first use.
std::unique_lock<std::mutex> taken(GuardedSite& guarded) {
  std::unique_lock lock(guarded.mutex, std::try_to_lock);
  if (!lock) throw Error(Errc::invalid_argument, "the site is in use by another call: open one for each thread");
  return lock;
}

// Places stations given by heads alone as the program does: on the ground below, with checks.
std::vector<PlacedStation> placed_on(Site& site, const py::object& stations) {
  std::vector<PlacedStation> placed = stations_of(stations);
  for (PlacedStation& station : placed) {
    if (station.ground != station.position || station.status == StationStatus::hole) continue;
    const StationSetup setup = station.setup;
    const bool skipped = !active(station);
    station =
        place_head(site.has_area() ? &site.area() : nullptr, site.clash(), site.scanner().height_m, station.position)
            .station;
    station.setup = setup;
    if (skipped) station.status = StationStatus::clash;
  }
  return placed;
}

Evaluation evaluate(GuardedSite& guarded, const py::object& stations, const EvaluationOptions& options,
                    py::object progress) {
  const auto lock = taken(guarded);
  const std::vector<PlacedStation> placed = placed_on(guarded.site, stations);
  LongCall call(std::move(progress));
  return call.run([&] { return guarded.site.evaluate(placed, options, {}, call.progress()); });
}

void write_site_report(GuardedSite& guarded, const std::filesystem::path& file, const Evaluation& evaluation,
                       const std::optional<std::string>& title, py::object progress) {
  const auto lock = taken(guarded);
  LongCall call(std::move(progress));
  call.run([&] {
    Site& site = guarded.site;
    MissedVoxels missed;
    if (!evaluation.field.count.empty())
      missed = missed_voxels(site.simulator(), site.area(), site.clash(), evaluation.field, {}, call.progress(0, 0.3));
    if (!call.stop().stop_requested())
      write_report(file, evaluation, site.simulator(), site.area(),
                   {.title = title.value_or(site.name()), .missed = &missed}, call.progress(0.3, 1));
    return 0;
  });
}

}  // namespace

void add_sites(py::module_& m) {
  py::class_<SiteChoice>(m, "SiteChoice", "A setting that the user left open and the site chose.")
      .def_readonly("setting", &SiteChoice::setting, "Name of the setting.")
      .def_readonly("value", &SiteChoice::value, "Value, in the form in which users give it.")
      .def_readonly("why", &SiteChoice::why, "Reason, a phrase.")
      .def("__repr__", [](const SiteChoice& choice) {
        return "<vantage.SiteChoice " + choice.setting + "=" + choice.value + ": " + choice.why + ">";
      });
  py::class_<GuardedSite, std::shared_ptr<GuardedSite>> type(m, "Site",
                                                             "Scene, scanner, ground, clash checks and simulator, with "
                                                             "all defaults of the program. `vantage.plan`\ntakes one.");
  type.def_static(
          "open",
          [](const std::filesystem::path& file, const py::kwargs& given) {
            SiteOptions options = site_options(given, "Site.open");
            const py::gil_scoped_release unlocked;
            return std::shared_ptr<GuardedSite>(
                new GuardedSite{Site::open(file, std::move(options))});  // keeps the mutex in place
          },
          py::arg("file"),
          ("Reads a model and chooses the settings that are left open. Raises Error: io, "
           "malformed_file,\ninvalid_argument, out_of_memory." +
           settings_doc("Site.open", site_settings()))
              .c_str())
      .def_property_readonly(
          "name", [](const GuardedSite& self) { return self.site.name(); }, "The file's name without its extension.")
      .def_property_readonly(
          "scene", [](const GuardedSite& self) { return self.site.scene(); }, "Its scene, with the weights in force.")
      .def_property_readonly(
          "scanners",
          [](const GuardedSite& self) {
            return std::vector<Scanner>(self.site.scanners().begin(), self.site.scanners().end());
          },
          "Copies of its scanners, indexed by `StationSetup.scanner`.")
      .def_property_readonly(
          "choices",
          [](const GuardedSite& self) {
            return std::vector<SiteChoice>(self.site.choices().begin(), self.site.choices().end());
          },
          "Settings that the user left open and the site chose, with the reasons.")
      .def(
          "evaluate",
          [](GuardedSite& self, const py::object& stations, std::uint64_t sample_voxels, bool overlap, bool skip,
             bool field, double link, const std::optional<RegistrationOptions>& registration, py::object progress) {
            return evaluate(self, stations,
                            {.sample_voxels = sample_voxels,
                             .overlap = overlap,
                             .skip = skip,
                             .field = field,
                             .registration = registration,
                             .link = link},
                            std::move(progress));
          },
          py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = 0, py::arg("overlap") = true,
          py::arg("skip") = false, py::arg("field") = false, py::arg("link") = default_link,
          py::arg("registration") = py::none(), py::arg("progress") = py::none(),
          "Evaluates a network like `vantage evaluate`, with scan overlaps on all surfaces and the round on "
          "site.\n\nstations: in a form that `Simulator.evaluate` takes; heads are put on the ground below. "
          "sample_voxels: 0: every ray.\nlink: least scan overlap of a link. The others: as for "
          "`Simulator.evaluate`.\nRaises Error invalid_argument.")
      .def("write_report", &write_site_report, py::arg("file"), py::arg("evaluation"), py::kw_only(),
           py::arg("title") = py::none(), py::arg("progress") = py::none(),
           "Writes report.html or report.pdf, by the file's extension, of a network evaluated on this site; if "
           "evaluated with\nfield=True, also why surfaces are not captured. title: None: the site's name.\nRaises "
           "Error: io, invalid_argument (another extension, a build that writes no reports).")
      .def("__repr__", [](const GuardedSite& self) { return "<vantage.Site " + self.site.name() + ">"; });
  refuse_pickle(type, "a Site owns a device and is not pickled; open its file again with the same settings");
}

}  // namespace vantage::python
