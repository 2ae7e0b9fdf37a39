// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

// A function of each row.
template <class Result, class Row, class Of>
py::array_t<Result> for_each_row(const Doubles& rows, const char* what, const Of& of) {
  const auto points = rows_of<Row>(rows, what);
  py::array_t<Result> results(static_cast<py::ssize_t>(points.size()));
  std::ranges::transform(points, results.mutable_data(), of);
  return results;
}

Options<WalkableOptions> walkable_options() {
  return Options<WalkableOptions>("SearchArea")
      .add("max_slope_deg", &WalkableOptions::max_slope, "Steepest walkable ground.")
      .add("headroom_m", &WalkableOptions::headroom_m, "Clear height above walkable ground.")
      .add("min_area_m2", &WalkableOptions::min_area_m2, "Smaller connected parts are left out.")
      .add("passage_width_m", &WalkableOptions::passage_width_m, "Width of the narrowest opening that a person passes.")
      .add("passage_height_m", &WalkableOptions::passage_height_m, "Height of the lowest opening that a person passes.")
      .add("climb_m", &WalkableOptions::climb_m, "Highest step that a person takes.")
      .add("enter", &WalkableOptions::enter, "Entrances of the site, a list of (x, y, z); empty: found automatically.")
      .add("enter_closed", &WalkableOptions::enter_closed,
           "Whether large parts that something bars the way to are walkable, too, unless enter is given.")
      .add("levels", &WalkableOptions::levels, "Lowest and highest height of ground; None: any.")
      .add("within", &WalkableOptions::within,
           "Regions, lists of rings of corners (x, y): only ground in one of these.")
      .add("without", &WalkableOptions::without, "Regions: no ground in any of these.");
}

// (3, 3): rows of a rotation.
py::array_t<double> rotation_of(const StationSetup& setup) {
  const auto rows = setup.survey_from_scanner();
  return adopt(std::vector<Vec3>(rows.begin(), rows.end()));
}

void add_setups(py::module_& m) {
  const auto options =
      Options<StationSetup>("StationSetup")
          .add("heading_deg", &StationSetup::heading, "Turn about up, from +X towards +Y.")
          .add("tilt_deg", &StationSetup::tilt, "Angle of the scanner's axis from straight up towards the heading.")
          .add("scanner", &StationSetup::scanner, "Index into `Simulator.scanners`.");
  py::class_<StationSetup> setup(m, "StationSetup",
                                 ("Setup of a scanner at a station: which one, and how it is turned. At a tilt of 90 "
                                  "degrees the\nhead lies, at 180 it hangs." +
                                  options.doc())
                                     .c_str());
  setup.def(py::init([options](const py::kwargs& given) { return options.read(given); }))
      .def_property_readonly("turned", &StationSetup::turned, "Whether it is turned or tilted.")
      .def("survey_from_scanner", &rotation_of,
           "Rz(heading) Ry(tilt), from the scanner's frame to the survey's: (3, 3). Quarter turns are exact.")
      .def("__eq__", [](const StationSetup& self, const StationSetup& other) { return self == other; })
      .def("__repr__", [options](const StationSetup& self) { return options.repr(self); });
  setup.attr("__hash__") = py::none();
  options.attributes(setup);
  options.pickles(setup);
  py::class_<Station> station(m, "Station", "A scanner's head, and its setup there.");
  station
      .def(py::init([](const Vec3& position, const StationSetup& how, bool on) {
             return Station{.position = position, .active = on, .setup = how};
           }),
           py::arg("position"), py::arg("setup") = StationSetup{}, py::arg("active") = true,
           "position: (x, y, z), survey frame, metres. active: whether it is simulated; an inactive one keeps its "
           "place in\na network.")
      .def_readwrite("position", &Station::position, "The head (x, y, z), survey frame, metres.")
      .def_readwrite("setup", &Station::setup, "Setup of the scanner.")
      .def_readwrite("active", &Station::active, "Whether it is simulated.")
      .def("__repr__", [](const Station& s) {
        return "<vantage.Station at " + std::string(py::repr(py::cast(s.position))) +
               (s.setup == StationSetup() ? "" : ", " + std::string(py::repr(py::cast(s.setup)))) +
               (s.active ? "" : ", not active") + ">";
      });
  add_pickle(station);
}

void add_stations(py::module_& m) {
  py::class_<PlacedStation> placed(m, "PlacedStation", "A station, and its status.");
  placed.def_readonly("uv", &PlacedStation::uv, "Point of the search area.")
      .def_readonly("position", &PlacedStation::position, "The scanner's head (x, y, z), survey frame, metres.")
      .def_readonly("ground", &PlacedStation::ground, "Ground below the tripod, survey frame, metres.")
      .def_property_readonly(
          "status", [](const PlacedStation& s) { return s.status; },
          "'ok', 'hole', 'clash', 'inside', 'off_ground' or 'outside'.")
      .def_readonly("existing", &PlacedStation::existing, "Whether it is an existing station.")
      .def_readonly("setup", &PlacedStation::setup, "Setup of the scanner.")
      .def_property_readonly("active", &active, "Whether it adds to the measures of its network.")
      .def("__repr__", [](const PlacedStation& s) {
        return "<vantage.PlacedStation at " + std::string(py::repr(py::cast(s.position))) + ", " + to_string(s.status) +
               ">";
      });
  add_pickle(placed);
  m.def(
      "heads", [](const std::vector<PlacedStation>& stations) { return heads_of(stations); }, py::arg("stations"),
      "Heads of stations, survey frame: (n, 3), metres.");
}

void add_search_area(py::module_& m) {
  const auto options = walkable_options();
  py::class_<SearchArea>(m, "SearchArea",
                         ("The search area: maps (u, v) to the ground (section 4.2 of the paper). Made of the scene's "
                          "marked area, else\nof the ground that a person with a tripod can reach.\nRaises Error "
                          "invalid_argument: nothing to stand on, or an option out of its range." +
                          options.doc())
                             .c_str())
      .def(py::init([options](const Scene& scene, const py::kwargs& given) {
             const WalkableOptions how = options.read(given);
             const py::gil_scoped_release unlocked;
             return SearchArea::build(scene, how);
           }),
           py::arg("scene"))
      .def_property_readonly("uv_min", &SearchArea::uv_min, "Lowest (u, v).")
      .def_property_readonly("uv_max", &SearchArea::uv_max, "Highest (u, v).")
      .def_property_readonly("derived", &SearchArea::derived, "Whether it was made from walkable surfaces.")
      .def_property_readonly("description", &SearchArea::description, "Its origin, a sentence.")
      .def_property_readonly(
          "positions",
          [](const py::object& self) {
            return view<double>(std::span(self.cast<const SearchArea&>().mesh().positions), self, 3);
          },
          "Vertices of its triangles, survey frame: (n, 3), metres, read-only.")
      .def_property_readonly(
          "uvs",
          [](const py::object& self) {
            return view<double>(std::span(self.cast<const SearchArea&>().mesh().uvs), self, 2);
          },
          "Their (u, v): (n, 2), read-only.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            return view<std::uint32_t>(std::span(self.cast<const SearchArea&>().mesh().triangles), self, 3);
          },
          "Indices of vertices: (m, 3), read-only.")
      .def(
          "locate",
          [](const SearchArea& area, const ArrayLike& uvs) {
            const Doubles rows = doubles_of(uvs, "uvs");
            std::vector<Vec3> found;
            for (const Uv& uv : rows_of<Uv>(rows, "uvs"))
              found.push_back(area.locate(uv).value_or(Vec3{kNowhere, kNowhere, kNowhere}));
            return adopt(std::move(found));
          },
          py::arg("uvs"), "Ground under each (u, v) of (n, 2), survey frame: (n, 3), metres; NaN in a hole.")
      .def(
          "project",
          [](const SearchArea& area, const ArrayLike& grounds) {
            const Doubles rows = doubles_of(grounds, "grounds");
            std::vector<Uv> found;
            for (const Vec3& ground : rows_of<Vec3>(rows, "grounds"))
              found.push_back(area.project(ground).value_or(Uv{kNowhere, kNowhere}));
            const auto count = static_cast<py::ssize_t>(found.size());
            return adopt<double>(std::move(found), {count, 2});
          },
          py::arg("grounds"),
          "(u, v) straight above or below each point of (n, 3), survey frame, metres: (n, 2); NaN outside.")
      .def("__repr__", [](const SearchArea& area) { return "<vantage.SearchArea: " + area.description() + ">"; });
}

void add_clash(py::module_& m) {
  const auto options = Options<SecurityVolume>("ClashChecker")
                           .add("lower_m", &SecurityVolume::lower_m, "Height of the lower sphere's centre.")
                           .add("upper_m", &SecurityVolume::upper_m, "Height of the upper sphere's centre.")
                           .add("radius_m", &SecurityVolume::radius_m, "Radius of both; 0 switches the check off.");
  py::class_<ClashChecker>(
      m, "ClashChecker",
      ("The security volume of section 4.3 of the paper, two spheres above the ground, against all meshes of a scene.\n"
       "Raises Error invalid_argument." +
       options.doc())
          .c_str())
      .def(py::init([options](const Scene& scene, const py::kwargs& given) {
             const SecurityVolume volume = options.read(given);
             const py::gil_scoped_release unlocked;
             return ClashChecker(scene, volume);
           }),
           py::arg("scene"))
      .def(
          "clashes",
          [](const ClashChecker& clash, const ArrayLike& grounds, std::optional<double> height_m) {
            return for_each_row<bool, Vec3>(doubles_of(grounds, "grounds"), "grounds", [&](const Vec3& ground) {
              return height_m ? clash.clashes(ground, *height_m) : clash.clashes(ground);
            });
          },
          py::arg("grounds"), py::arg("height_m") = py::none(),
          "Whether something is within the volume above each ground of (n, 3), survey frame, metres: (n,). "
          "With\nheight_m, that of the head above the ground, mast and head are kept clear too.")
      .def(
          "sees",
          [](const ClashChecker& clash, const ArrayLike& a,
             const ArrayLike& b) -> Typed<"Union[bool, numpy.ndarray[bool]]"> {
            const Doubles first = doubles_of(a, "a"), second = doubles_of(b, "b");
            const std::span<const Vec3> from = points_of(first, "a"), to = points_of(second, "b");
            std::vector<std::uint8_t> free = [&] {
              const py::gil_scoped_release unlocked;
              return clash.sees(from, to);
            }();
            if (first.ndim() == 1 && second.ndim() == 1) return py::bool_(free.front() != 0);
            const auto count = static_cast<py::ssize_t>(free.size());
            return adopt<bool>(std::move(free), {count});
          },
          py::arg("a"), py::arg("b"),
          "Whether nothing stands between two points (x, y, z), survey frame; between the rows of two arrays of (n, "
          "3), "
          "or of\none and a point: (n,).")
      .def(
          "distance",
          [](const ClashChecker& clash, const ArrayLike& points, double limit_m) {
            return for_each_row<double, Vec3>(doubles_of(points, "points"), "points",
                                              [&](const Vec3& point) { return clash.distance(point, limit_m); });
          },
          py::arg("points"), py::arg("limit_m"),
          "Distance of each point of (n, 3) from the nearest mesh, at most limit_m: (n,), metres.");
}

}  // namespace

void add_placement(py::module_& m) {
  add_setups(m);
  add_stations(m);
  add_search_area(m);
  add_clash(m);
}

}  // namespace vantage::python
