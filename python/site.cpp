// SPDX-License-Identifier: Apache-2.0
#include "site.hpp"

#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "pickle.hpp"
#include "settings.hpp"

namespace vantage::python {
namespace {

SiteOptions site_options(const py::kwargs& given, const std::string& call, const SettingTable<SiteOptions>& table) {
  refuse_unknown(given, call, table);
  SiteOptions options;
  read_settings(table, options, given);
  return options;
}

// The rows of `site_settings()` that say nothing of how a file is read.
SettingTable<SiteOptions> settings_of_a_scene() {
  SettingTable<SiteOptions> rows = site_settings();
  std::erase_if(rows, [](const SettingRow<SiteOptions>& row) {
    return row.group == "Scene" || row.name == "doors" || row.name == "station-area";
  });
  return rows;
}

// In place, because of the mutex.
std::shared_ptr<GuardedSite> guarded(Site site) {
  return std::shared_ptr<GuardedSite>(new GuardedSite{std::move(site)});
}

Evaluation evaluate(GuardedSite& guarded, const Stations& stations, const EvaluationOptions& options,
                    Listener progress) {
  std::vector<PlacedStation> given = stations_of(stations);
  LongCall call(std::move(progress));
  return call.run([&] {
    const auto lock = guarded.beside();
    return guarded.site.evaluate(placed_on(guarded.site, std::move(given)), options, {}, call.progress());
  });
}

void write_site_report(GuardedSite& guarded, const std::filesystem::path& file, const Evaluation& evaluation,
                       const std::optional<std::string>& title, Listener progress) {
  const auto lock = guarded.taken();
  LongCall call(std::move(progress));
  call.run([&] {
    Site& site = guarded.site;
    MissedVoxels missed;
    if (!evaluation.field.count.empty()) missed = missed_voxels(site, evaluation.field, {}, call.progress(0, 0.3));
    if (!call.stop().stop_requested())
      write_report(file, evaluation, site, {.title = title.value_or(""), .missed = &missed}, call.progress(0.3, 1));
    return 0;
  });
}

}  // namespace

std::vector<PlacedStation> placed_on(Site& site, std::vector<PlacedStation> stations) {
  for (PlacedStation& station : stations) {
    if (station.ground != station.position || station.status == StationStatus::hole) continue;
    if (!active(station)) continue;  // it may be out of reach, as a hole is
    const StationSetup setup = station.setup;
    station = site.place_head(station.position).station;
    station.setup = setup;
  }
  return stations;
}

void add_sites(py::module_& m) {
  py::class_<SiteChoice>(m, "SiteChoice", "A setting that the user left open and the site chose.")
      .def_readonly("setting", &SiteChoice::setting, "Name of the setting.")
      .def_readonly("value", &SiteChoice::value, "Value, in the form in which users give it.")
      .def_readonly("why", &SiteChoice::why, "Reason, a phrase.")
      .def("__repr__", [](const SiteChoice& choice) {
        return "<vantage.SiteChoice " + choice.setting + "=" + choice.value + ": " + choice.why + ">";
      });
  py::class_<GuardedSite, std::shared_ptr<GuardedSite>> type(
      m, "Site",
      "Scene, scanner, ground, clash checks and simulator, with "
      "all defaults of the program. `Site.plan` plans a\nsurvey of it. While a plan or another long call runs in one "
      "thread, others get answers of `evaluate`, `nearest_place` and\n`place_heads`; calls that trace take turns.");
  const SettingTable<SiteOptions> of_a_scene = settings_of_a_scene();
  type.def(py::init([of_a_scene](const Scene& scene, std::vector<Scanner> scanners, std::string name,
                                 const py::kwargs& given) {
             SiteOptions options = site_options(given, "Site", of_a_scene);
             options.scanners = std::move(scanners);
             const py::gil_scoped_release unlocked;
             return guarded(Site(scene, std::move(options), std::move(name)));
           }),
           py::arg("scene"), py::kw_only(), py::arg("scanners") = std::vector<Scanner>{}, py::arg("name") = "site",
           ("Chooses the settings that are left open. scanners: those that stations choose from, complete, in place "
            "of the\nsettings of one. name: for titles. Raises Error invalid_argument." +
            settings_doc("Site", of_a_scene))
               .c_str())
      .def_static(
          "open",
          [](const std::filesystem::path& file, const py::kwargs& given) {
            SiteOptions options = site_options(given, "Site.open", site_settings());
            const py::gil_scoped_release unlocked;
            return guarded(Site::open(file, std::move(options)));
          },
          py::arg("file"),
          ("Reads a model, a floor plan or points, as `Scene.load`, and chooses the settings that are left open. "
           "Raises Error: io,\nmalformed_file, invalid_argument, out_of_memory." +
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
          "area",
          [](GuardedSite& self) -> const SearchArea& {
            const py::gil_scoped_release unlocked;
            const auto lock = self.beside();
            return self.site.area();
          },
          py::return_value_policy::reference_internal, "Its SearchArea. Raises Error invalid_argument if it has none.")
      .def_property_readonly(
          "clash",
          [](GuardedSite& self) -> const ClashChecker& {
            const py::gil_scoped_release unlocked;
            const auto lock = self.beside();
            return self.site.clash();
          },
          py::return_value_policy::reference_internal, "Its ClashChecker.")
      .def_property_readonly(
          "simulator",
          [](GuardedSite& self) -> Simulators& {
            const py::gil_scoped_release unlocked;
            const auto lock = self.beside();
            const std::lock_guard one(self.making);
            if (!self.simulators) self.simulators.emplace(self.site);
            return *self.simulators;
          },
          py::return_value_policy::reference_internal, "Its Simulator, made when it is first asked for.")
      .def_property_readonly(
          "choices",
          [](const GuardedSite& self) {
            return std::vector<SiteChoice>(self.site.choices().begin(), self.site.choices().end());
          },
          "Settings that the user left open and the site chose, with the reasons.")
      .def(
          "evaluate",
          [](GuardedSite& self, const Stations& stations, std::optional<std::uint64_t> sample_voxels, bool overlap,
             bool skip, bool field, double link, const std::optional<RegistrationOptions>& registration,
             const std::optional<BeamOptions>& beam, Listener progress) {
            return evaluate(self, stations,
                            {.sample_voxels = sample_voxels,
                             .overlap = overlap,
                             .skip = skip,
                             .field = field,
                             .beam = beam,
                             .registration = registration,
                             .link = link},
                            std::move(progress));
          },
          py::arg("stations"), py::kw_only(), py::arg("sample_voxels") = py::none(), py::arg("overlap") = true,
          py::arg("skip") = false, py::arg("field") = false, py::arg("link") = default_link,
          py::arg("registration") = py::none(), py::arg("beam") = py::none(), py::arg("progress") = py::none(),
          "Evaluates a network like `vantage evaluate`, with scan overlaps on all surfaces and the round on "
          "site.\n\nstations: in a form that `Simulator.evaluate` takes; heads are put on the ground below. "
          "sample_voxels: size of the sample of voxels; None: every ray.\nlink: least scan overlap of a link. The "
          "others: as for "
          "`Simulator.evaluate`.\nRaises Error invalid_argument.")
      .def(
          "nearest_place",
          [](GuardedSite& self, const Vec3& head, double reach_m) {
            const py::gil_scoped_release unlocked;
            const auto lock = self.beside();
            return self.site.nearest_place(head, reach_m);
          },
          py::arg("head"), py::arg("reach_m") = nearest_place_reach_m,
          "The PlacedStation nearest to a head (x, y, z; survey frame, metres) that may hold a station: on the search "
          "area, at the\nfirst scanner's height, free of clashes. Distances are between heads; the result is the "
          "nearest "
          "to within a fiftieth of\nthe security volume's radius. None if there is none within reach_m. Raises Error "
          "invalid_argument (no ground, a reach\nbelow 0, a value not finite).")
      .def("write_report", &write_site_report, py::arg("file"), py::arg("evaluation"), py::kw_only(),
           py::arg("title") = py::none(), py::arg("progress") = py::none(),
           "Writes report.html or report.pdf, by the file's extension, of a network evaluated on this site; if "
           "evaluated with\nfield=True, also why surfaces are not captured. title: None: the site's name.\nRaises "
           "Error: io, invalid_argument (another extension, a build that writes no reports).")
      .def("__repr__", [](const GuardedSite& self) { return "<vantage.Site " + self.site.name() + ">"; });
  m.def(
      "place_heads",
      [](GuardedSite& site, const Stations& stations) {
        const Network network = network_of(stations);
        const py::gil_scoped_release unlocked;
        const auto lock = site.beside();
        std::vector<PlacedStation> placed;
        for (const Station& station : network) {
          placed.push_back(site.site.place_head(station.position).station);
          placed.back().setup = station.setup;
        }
        return placed;
      },
      py::arg("site"), py::arg("heads"),
      "Stations by their heads (n, 3), survey frame, metres, or `Station`s, checked like those of a search.");
  refuse_pickle(type, "a Site owns a device and is not pickled; open its file again with the same settings");
}

}  // namespace vantage::python
