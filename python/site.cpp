// SPDX-License-Identifier: Apache-2.0
#include "site.hpp"

#include "module.hpp"
#include "settings.hpp"

namespace vantage::python {
namespace {

SiteOptions site_options(const py::kwargs& given, const std::string& call) {
  refuse_unknown(given, call, site_settings());
  SiteOptions options;
  read_settings(site_settings(), options, given);
  return options;
}

}  // namespace

void add_sites(py::module_& m) {
  py::class_<SiteChoice>(m, "SiteChoice", "Something that nobody gave, and a site chose.")
      .def_readonly("setting", &SiteChoice::setting, "Its name.")
      .def_readonly("value", &SiteChoice::value, "As one would give it.")
      .def_readonly("why", &SiteChoice::why, "A phrase.")
      .def("__repr__", [](const SiteChoice& choice) {
        return "<vantage.SiteChoice " + choice.setting + "=" + choice.value + ": " + choice.why + ">";
      });
  py::class_<GuardedSite, std::shared_ptr<GuardedSite>>(
      m, "Site",
      "Scene, scanner, ground, clash checks and simulator, with every default that the program has. `vantage.plan`\n"
      "takes one.")
      .def_static(
          "open",
          [](const std::filesystem::path& file, const py::kwargs& given) {
            SiteOptions options = site_options(given, "Site.open");
            const py::gil_scoped_release unlocked;
            return std::make_shared<GuardedSite>(GuardedSite{Site::open(file, std::move(options))});
          },
          py::arg("file"),
          ("Reads a model and chooses what the settings leave open. Raises Error: io, malformed_file,\n"
           "invalid_argument, out_of_memory." +
           settings_doc("Site.open", site_settings()))
              .c_str())
      .def_property_readonly(
          "name", [](const GuardedSite& self) { return self.site.name(); }, "The file's, without its extension.")
      .def_property_readonly(
          "scene", [](const GuardedSite& self) { return self.site.scene(); }, "Its scene, with the weights that hold.")
      .def_property_readonly(
          "scanners",
          [](const GuardedSite& self) {
            return std::vector<Scanner>(self.site.scanners().begin(), self.site.scanners().end());
          },
          "Copies of its scanners, which `StationSetup.scanner` counts from 0.")
      .def_property_readonly(
          "choices",
          [](const GuardedSite& self) {
            return std::vector<SiteChoice>(self.site.choices().begin(), self.site.choices().end());
          },
          "What nobody gave and the site chose, with the reason.")
      .def("__repr__", [](const GuardedSite& self) { return "<vantage.Site " + self.site.name() + ">"; });
}

}  // namespace vantage::python
