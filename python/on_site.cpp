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
           "Ground (x, y, z) where people enter and leave; None: at the station nearest to where the area is entered,\n"
           "if that is known, else at the first.")
      .add("day_min", &OnSiteOptions::day_min,
           "Minutes of the longest session; a longer round is split. None: it is not.")
      .add("crews", &OnSiteOptions::crews, "Crews that work side by side, a session each, every day.")
      .add("day_start_min", &OnSiteOptions::day_start_min, "Minutes after midnight at which a day begins.")
      .add<std::vector<std::string>>(
          "windows",
          [](const OnSiteOptions& o) {
            std::vector<std::string> texts;
            for (const AccessWindow& window : o.windows) texts.push_back(to_string(window));
            return texts;
          },
          [](OnSiteOptions& o, const std::vector<std::string>& texts) {
            o.windows.clear();
            for (const std::string& text : texts)
              o.windows.push_back(parse_access_window(text, "OnSiteOptions: windows"));
          },
          "Hours of the day outside of which nobody may scan in rooms of such names: \"hall*=06:00-08:00\".");
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
      .def_readonly("check", &Target::check,
                    "Whether it is a place for a check of the vertical index, which ties no scans.")
      .def("__repr__", [](const Target& t) {
        return "<vantage.Target " + t.name + " at " + std::string(py::repr(py::cast(t.centre))) + ">";
      });
  target.def(py::pickle(
      [](const Target& t) { return py::make_tuple(t.name, t.centre, t.control_m, t.proposed, t.stations, t.check); },
      [](const py::tuple& t) {
        return Target{.name = t[0].cast<std::string>(),
                      .centre = t[1].cast<Vec3>(),
                      .control_m = t[2].cast<double>(),
                      .proposed = t[3].cast<bool>(),
                      .stations = t[4].cast<std::vector<std::size_t>>(),
                      .check = t.size() > 5 && t[5].cast<bool>()};
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

  py::class_<BatteryUse> battery(m, "BatteryUse",
                                 "Charged batteries that an instrument takes, changed between stations.");
  battery.def_readonly("instrument", &BatteryUse::instrument, "The scanner's name without a setting.")
      .def_readonly("battery_min", &BatteryUse::battery_min, "Minutes that a battery lasts; 0: not stated.")
      .def_readonly("battery_scans", &BatteryUse::battery_scans, "Scans that it lasts for; 0: not stated.")
      .def_readonly("on_min", &BatteryUse::on_min,
                    "Minutes with the scanner on: from its first stay to its last, walks included, waiting left out.")
      .def_readonly("scans", &BatteryUse::scans, "Its scans.")
      .def_readonly("batteries", &BatteryUse::batteries, "Charged batteries for these minutes and scans.")
      .def_readonly("in_a_day", &BatteryUse::in_a_day, "The most in one day, of all crews.")
      .def("__repr__", [](const BatteryUse& b) {
        return "<vantage.BatteryUse of " + b.instrument + ": " + std::to_string(b.batteries) + " batteries>";
      });
  add_pickle(battery);

  py::class_<Round> round(m, "Round", "In at the entrance, to every station, and back out.");
  round.def_readonly("order", &Round::order, "Indices of the stations; unusable ones are left out.")
      .def_readonly("arrive_min", &Round::arrive_min, "Minutes from the start until the stay at each begins.")
      .def_readonly("stay_min", &Round::stay_min, "Minutes at each: scan, set-up and photos.")
      .def_readonly("legs_m", &Round::legs_m, "Path to each in that order, then back out, metres.")
      .def_readonly("paths", &Round::paths, "Ground points of each of these paths: lists of (x, y, z).")
      .def_readonly("walk_m", &Round::walk_m, "All legs together.")
      .def_readonly("scan_min", &Round::scan_min, "Minutes of scanning.")
      .def_readonly("set_up_min", &Round::set_up_min, "Minutes of setting up.")
      .def_readonly("photos_min", &Round::photos_min, "Minutes of taking pictures.")
      .def_readonly("walk_min", &Round::walk_min, "Minutes of walking.")
      .def_readonly("minutes", &Round::minutes, "Scan, set-up, photos, walking and waiting together.")
      .def_readonly("unconnected", &Round::unconnected, "Legs that the search area does not connect.")
      .def_readonly("unlinked", &Round::unlinked, "Stations without a link to the one before; 0 if no links are known.")
      .def_readonly("batteries", &Round::batteries,
                    "A BatteryUse of each instrument that states how long a battery lasts.");

  py::class_<Session, Round> session(m, "Session", "Stations of a longer round, for one crew within a day.");
  session.def_readonly("day", &Session::day, "From 1.")
      .def_readonly("crew", &Session::crew, "From 1.")
      .def_readonly("parts", &Session::parts, "Groups of its stations that no link connects; 1 if no links are known.")
      .def_readonly("linked", &Session::linked, "Whether a station is linked to one of another session, if any.")
      .def_readonly("start_min", &Session::start_min, "Minutes after midnight at which it leaves the entrance.")
      .def_readonly("wait_min", &Session::wait_min, "Minutes waited for an access window before the stay at each.")
      .def_readonly("waiting_min", &Session::waiting_min, "All of these.")
      .def("__repr__", [](const Session& s) {
        return "<vantage.Session of day " + std::to_string(s.day) + ", crew " + std::to_string(s.crew) + ": " +
               std::to_string(s.order.size()) + " stations, " + std::string(py::str(py::float_(s.minutes))) +
               " minutes>";
      });
  add_pickle(session);

  py::class_<ClosedStation> closed(m, "ClosedStation",
                                   "A station that no session can scan within the access windows of its room.");
  closed.def_readonly("station", &ClosedStation::station, "Its index.")
      .def_readonly("why", &ClosedStation::why, "What would have to change.")
      .def("__repr__", [](const ClosedStation& c) {
        return "<vantage.ClosedStation " + std::to_string(c.station) + ": " + c.why + ">";
      });
  add_pickle(closed);

  py::class_<Visit, Round> visit(m, "Visit", "The round over all stations.");
  visit.def_readonly("day_min", &Visit::day_min, "Minutes that its sessions may take; 0: none were asked for.")
      .def_readonly("sessions", &Visit::sessions, "Its Sessions by day and crew; empty: none, or not asked for.")
      .def_readonly("not_split", &Visit::not_split, "What keeps it from being split into sessions; empty: nothing.")
      .def_readonly("closed", &Visit::closed, "ClosedStations: in no session, since none keeps their access windows.")
      .def_readonly("bound", &Visit::bound, "Stations that access windows are for.")
      .def_property_readonly("batteries", &batteries_of, "As of a Round; of sessions together, if it has some.")
      .def("__repr__", [](const Visit& v) {
        return "<vantage.Visit of " + std::to_string(v.order.size()) + " stations, " +
               std::string(py::str(py::float_(v.minutes))) + " minutes>";
      });
  add_pickle(visit);
}

void add_on_site(py::module_& m) {
  py::class_<OnSite>(m, "OnSite", "Paths over a site, and the time of a round.")
      .def(py::init([](GuardedSite& site, const OnSiteOptions& how) {
             const py::gil_scoped_release unlocked;
             const auto lock = site.beside();
             return site.site.on_site(how);
           }),
           py::arg("site"), py::arg("options") = OnSiteOptions{},
           "Rounds begin and end at the site's entrance if the options name none. Raises Error invalid_argument.")
      .def("way_m", &OnSite::way_m, py::arg("start"), py::arg("end"),
           "Metres from one ground point (x, y, z) to another; None if the search area does not connect them.")
      .def("way", &OnSite::way, py::arg("start"), py::arg("end"),
           "Ground points (x, y, z) of such a way; none if the search area does not connect them.")
      .def(
          "visit",
          [](const OnSite& site, const Stations& given) {
            const std::vector<PlacedStation> stations = stations_of(given);
            Visit visit = site.visit(stations);
            visit.day_min = site.options().day_min.value_or(0);
            site.add_windows(stations, visit);
            visit.sessions = site.sessions(stations, visit);
            return visit;
          },
          py::arg("stations"),
          "A good order of the stations, the time of the round, and its sessions if the options have a day. stations: "
          "in a form that `evaluate` accepts. Raises Error invalid_argument if a day is too short for a station.");
}

}  // namespace vantage::python
