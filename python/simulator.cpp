// SPDX-License-Identifier: Apache-2.0
#include "simulator.hpp"

#include <variant>

#include "evaluation.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"
#include "scan.hpp"

namespace vantage::python {
namespace {

using Networks =
    Typed<"Sequence[Union[numpy.typing.ArrayLike, Sequence[vantage.Station], Sequence[vantage.PlacedStation]]]",
          py::sequence>;
using Devices = std::vector<std::pair<Engine, std::optional<std::uint32_t>>>;

Options<SimulatorConfig> simulator_options() {
  return Options<SimulatorConfig>("Simulator")
      .add("engine", &SimulatorConfig::engine, "'auto', 'ray_query', 'compute_bvh' or 'embree'.")
      .add("device_index", &SimulatorConfig::device_index,
           "Number of the device; None: the best one that has the engine.")
      .add<Devices>(
          "devices",
          [](const SimulatorConfig& c) {
            Devices pairs;
            for (const DeviceChoice& choice : c.devices) pairs.emplace_back(choice.engine, choice.index);
            return pairs;
          },
          [](SimulatorConfig& c, const Devices& pairs) {
            for (const auto& [engine, index] : pairs) c.devices.push_back({engine, index});
          },
          "Pairs (engine, device_index) that share the work, in place of those two; `all_devices` lists them.")
      .add("max_memory_bytes", &SimulatorConfig::max_memory_bytes,
           "Memory limit, checked before anything is built; 0: half of the free memory.")
      .add("user_size_m", &SimulatorConfig::user_size_m, "Upper bound of the voxel size (equation 2), metres.")
      .add("point_spacing_m", &SimulatorConfig::point_spacing_m,
           "Wanted spacing n of points, metres; goal density = voxel_size^2 / n^2.")
      .add("spacing_by_detail", &SimulatorConfig::spacing_by_detail, "Use the detail of a mesh as its spacing.")
      .add("max_incidence_deg", &SimulatorConfig::max_incidence,
           "Largest angle from the normal of points that count; None: 60 if meshes have limits, else any.")
      .add("noise", &SimulatorConfig::noise, "Apply the scanner's noise table, if it has one.")
      .add("seed", &SimulatorConfig::seed, "Seed of noise and of the voxel sample.")
      .add("validation", &SimulatorConfig::validation, "Load the Vulkan validation layer.")
      .add("max_rays_per_dispatch", &SimulatorConfig::max_rays_per_dispatch, "0: chosen.");
}

bool all_surfaces(const std::optional<RegistrationOptions>& registration) {
  return registration && registration->surfaces == RegistrationSurfaces::all;
}

Evaluation evaluate(Simulators& self, const Stations& stations, bool overlap, bool skip, bool field, bool surroundings,
                    const std::optional<RegistrationOptions>& registration, const std::optional<BeamOptions>& beam,
                    Listener progress) {
  const std::vector<PlacedStation> placed = stations_of(stations);
  LongCall call(std::move(progress));
  return call.run([&] {
    const bool around = surroundings || all_surfaces(registration);
    return evaluate_stations(
        {.simulator = self.simulator, .surroundings = around ? &self.surroundings() : nullptr}, placed,
        {.overlap = overlap, .skip = skip, .field = field, .beam = beam, .registration = registration},
        call.progress());
  });
}

std::vector<Evaluation> evaluate_sampled(Simulators& self, const Networks& networks, std::uint64_t voxels, bool overlap,
                                         bool surroundings, const std::optional<RegistrationOptions>& registration,
                                         Listener progress) {
  if (voxels == 0) throw Error(Errc::invalid_argument, "evaluate_sampled: voxels: a sample has at least one");
  std::vector<std::vector<PlacedStation>> all;
  for (const auto& stations : networks) all.push_back(stations_of(py::reinterpret_borrow<py::object>(stations)));
  LongCall call(std::move(progress));
  return call.run([&] {
    const bool around = surroundings || all_surfaces(registration);
    return evaluate_networks({.simulator = self.simulator, .surroundings = around ? &self.surroundings() : nullptr},
                             all, {.sample_voxels = voxels, .overlap = overlap, .registration = registration},
                             call.progress());
  });
}

py::array_t<double> voxel_centres(const Simulators& self) {
  std::vector<Vec3> centres(self.simulator.voxel_count());
  for (std::uint64_t voxel_index = 0; voxel_index < centres.size(); ++voxel_index)
    centres[voxel_index] = self.simulator.voxel_centre(voxel_index);
  return adopt(std::move(centres));
}

py::array_t<std::uint32_t> voxel_weights(const Simulators& self) {
  std::vector<std::uint32_t> weights(self.simulator.voxel_count());
  for (std::uint64_t voxel_index = 0; voxel_index < weights.size(); ++voxel_index)
    weights[voxel_index] = self.simulator.voxel_weight(voxel_index);
  const auto count = static_cast<py::ssize_t>(weights.size());
  return adopt<std::uint32_t>(std::move(weights), {count});
}

py::array_t<double> goal_densities(const Simulators& self) {
  std::vector<double> goals(self.simulator.voxel_count());
  for (std::uint64_t voxel_index = 0; voxel_index < goals.size(); ++voxel_index)
    goals[voxel_index] = self.simulator.goal_density(voxel_index);
  const auto count = static_cast<py::ssize_t>(goals.size());
  return adopt<double>(std::move(goals), {count});
}

void add_uncovered(py::module_& m) {
  py::class_<UncoveredVoxels> type(m, "UncoveredVoxels", "Surveyed voxels below their goal density: k of them.");
  const auto numbers = [](std::vector<std::uint32_t> UncoveredVoxels::*member) {
    return [member](const py::object& self) {
      return view<std::uint32_t>(std::span<const std::uint32_t>(self.cast<const UncoveredVoxels&>().*member), self);
    };
  };
  type.def_property_readonly("voxels", numbers(&UncoveredVoxels::voxels),
                             "Voxel indices, in the order of `Simulator.voxel_centres`: (k,), ascending, read-only.")
      .def_property_readonly(
          "centres",
          [](const py::object& self) {
            return view<double>(std::span(self.cast<const UncoveredVoxels&>().centres), self, 3);
          },
          "Their centres, survey frame: (k, 3), metres, read-only.")
      .def_property_readonly("meshes", numbers(&UncoveredVoxels::meshes),
                             "Index into `Scene.meshes` of the mesh with most surface in each: (k,), read-only.")
      .def_property_readonly("points", numbers(&UncoveredVoxels::points),
                             "Points of the network in each: (k,), read-only.")
      .def("__len__", [](const UncoveredVoxels& self) { return self.voxels.size(); });
  add_pickle(type);
  m.def(
      "uncovered",
      [](const Simulators& self, const Evaluation& evaluation) {
        const py::gil_scoped_release unlocked;
        return uncovered(self.simulator, evaluation);
      },
      py::arg("simulator"), py::arg("evaluation"),
      "Voxels that a network does not capture. evaluation: of this simulator, with field=True.\nRaises Error "
      "invalid_argument.");
}

void add_engines(py::module_& m) {
  py::class_<EngineInfo>(m, "EngineInfo", "An engine on a device.")
      .def_property_readonly(
          "engine", [](const EngineInfo& info) { return info.engine; }, "'ray_query', 'compute_bvh' or 'embree'.")
      .def_readonly("device", &EngineInfo::device, "The device's name.")
      .def_readonly("driver", &EngineInfo::driver, "Driver or library with version.")
      .def_readonly("device_index", &EngineInfo::device_index, "For `Simulator(device_index=...)`.")
      .def_readonly("usable", &EngineInfo::usable, "Whether it can be used.")
      .def_readonly("software", &EngineInfo::software, "A CPU behind a GPU interface.")
      .def_readonly("chosen_by_default", &EngineInfo::chosen_by_default, "Whether 'auto' takes it.")
      .def_readonly("reason", &EngineInfo::reason, "Why it was taken or refused.")
      .def("__repr__", [](const EngineInfo& info) {
        return "<vantage.EngineInfo " + name_of(info.engine) + " on " + info.device +
               (info.usable ? "" : ", not usable") + ">";
      });
  m.def("list_engines", &list_engines, py::call_guard<py::gil_scoped_release>(),
        "All engines on all devices of this machine, usable or not.");
  m.def(
      "all_devices",
      [](Engine engine) {
        Devices pairs;
        for (const DeviceChoice& choice : all_devices(engine)) pairs.emplace_back(choice.engine, choice.index);
        return pairs;
      },
      py::arg("engine") = Engine::automatic, py::call_guard<py::gil_scoped_release>(),
      "Pairs (engine, device_index) of all devices that have the engine, for `Simulator(devices=...)`.");
}

}  // namespace

void add_simulators(py::module_& m) {
  add_engines(m);
  add_scans(m);
  const auto options = simulator_options();
  py::class_<Simulators> type(
      m, "Simulator",
      ("Simulates a scanner in a scene, or several, of which each station has one (`StationSetup`). Other Python "
       "threads\nrun while it traces. Calls from several threads run one after another; a callback that calls the "
       "simulator that\ncalled it gets an Error. The same inputs, seed and engine give the same result, bit for "
       "bit.\n\n`progress`, if given, is called with the share done in [0, 1]. If it returns False, the call ends "
       "early, and its\nresult has `cancelled` set. Ctrl-C ends a call too, with KeyboardInterrupt.\n\nRaises Error: "
       "invalid_argument, no_suitable_device, out_of_memory." +
       options.doc())
          .c_str());
  type.def(py::init([options](const Scene& scene, const std::variant<Scanner, std::vector<Scanner>>& scanner,
                              const py::kwargs& given) {
             const SimulatorConfig config = options.read(given);
             const py::gil_scoped_release unlocked;
             const auto* several = std::get_if<std::vector<Scanner>>(&scanner);
             return new Simulators(several ? Simulator(scene, *several, config)
                                           : Simulator(scene, std::get<Scanner>(scanner), config));
           }),
           py::arg("scene"), py::arg("scanner"))
      .def_property_readonly(
          "engine", [](const Simulators& self) { return self.simulator.engine(); }, "The chosen engine.")
      .def_property_readonly(
          "scanner", [](const Simulators& self) { return self.simulator.scanner(); },
          "A copy of its scanner, or of the first.")
      .def_property_readonly(
          "scanners",
          [](const Simulators& self) {
            const auto scanners = self.simulator.scanners();
            return std::vector<Scanner>(scanners.begin(), scanners.end());
          },
          "Copies of all scanners, indexed by `StationSetup.scanner`.")
      .def_property_readonly(
          "scene", [](const Simulators& self) { return self.simulator.scene(); }, "Its scene.")
      .def_property_readonly(
          "origin", [](const Simulators& self) { return self.simulator.origin(); },
          "Local origin, survey frame, metres: floats about it are fine enough for any point of the scene.")
      .def_property_readonly(
          "voxel_count", [](const Simulators& self) { return self.simulator.voxel_count(); },
          "Surveyed voxels, N_v of equation 8.")
      .def_property_readonly(
          "voxel_size_m", [](const Simulators& self) { return self.simulator.voxel_size_m(); },
          "Side of a voxel, metres.")
      .def_property_readonly(
          "goal_density", [](const Simulators& self) { return self.simulator.goal_density(); },
          "Points wanted in a voxel; the densest goal if goals differ.")
      .def("set_scene", &Simulators::set_scene, py::arg("scene"), py::call_guard<py::gil_scoped_release>(),
           "Takes another scene, mostly the same one with some meshes changed (`Scene.with_changes`). Results are then "
           "those of a\nnew Simulator of that scene, bit for bit. On 'embree' only what differs is made anew, and "
           "'compute_bvh' follows meshes\nthat move; otherwise the structure is rebuilt. Returns whether the rest was "
           "kept. No other call may run meanwhile.\nRaises Error as `Simulator` does, and stays as it was; "
           "invalid_argument for the simulator of a site.")
      .def(
          "set_scanners", &Simulators::set_scanners, py::arg("scanners"), py::call_guard<py::gil_scoped_release>(),
          "Takes other scanners. Results are then those of a new Simulator with them, bit for bit; voxels are kept. No "
          "other call\nmay run meanwhile. Raises Error as `set_scene`.")
      .def("voxel_centres", &voxel_centres, "Centres of the surveyed voxels, survey frame: (N_v, 3), metres.")
      .def("voxel_weights", &voxel_weights, "Weight of each voxel in coverage: (N_v,).")
      .def("goal_densities", &goal_densities, "Points wanted in each voxel: (N_v,).")
      .def("scan", &scan, py::arg("position"),
           py::arg("outputs") = std::vector<std::string>{"position", "reflectivity"}, py::kw_only(),
           py::arg("setup") = StationSetup{}, py::arg("grid") = false, py::arg("place") = 0,
           py::arg("beam") = py::none(), py::arg("instrument") = py::none(), py::arg("progress") = py::none(),
           "Scans one station, whose head is at `position` (x, y, z), survey frame, metres, with this "
           "setup.\n\noutputs: any of 'position', 'normal', 'reflectivity', 'mesh', 'primitive', 'colour', 'voxel', "
           "'ghost', 'returns';\nrow, column and range_m are always there. grid: arrays of shape (rows, columns, ...), "
           "one element for each ray,\ninstead of (points, ...). place: the station's in its network, which keys the "
           "noise. beam: BeamOptions; gives the beam\na width. instrument: InstrumentErrors; moves ranges and "
           "positions by them.\nRaises Error invalid_argument: a position that is not "
           "finite, an unknown output, a beam that is not known.")
      .def(
          "scan_array", &scan_array, py::arg("position"),
          py::arg("outputs") = std::vector<std::string>{"position", "reflectivity"}, py::kw_only(),
          py::arg("float32") = false, py::arg("setup") = StationSetup{}, py::arg("place") = 0,
          py::arg("beam") = py::none(), py::arg("instrument") = py::none(), py::arg("progress") = py::none(),
          "Scans one station as `scan` does, into a structured array with a row for each point: (n,). Fields: 'x', "
          "'y', "
          "'z' of\n'position', 'nx', 'ny', 'nz' of 'normal', 'returns' and 'return_number' of 'returns', and the other "
          "outputs by their names;\n'row', 'column' and 'range_m' are outputs, too. float32: coordinates are floats "
          "about `origin`, 4 bytes each; otherwise doubles\nin the survey frame. What a stopped call returns has the "
          "first points.\nRaises Error invalid_argument, as `scan`.")
      .def("evaluate", &evaluate, py::arg("stations"), py::kw_only(), py::arg("overlap") = true, py::arg("skip") = true,
           py::arg("field") = false, py::arg("surroundings") = false, py::arg("registration") = py::none(),
           py::arg("beam") = py::none(), py::arg("progress") = py::none(),
           "Evaluates a network with every ray of every station. stations: heads (n, 3), survey frame, metres, or "
           "`Station`s or\n`PlacedStation`s; n at most 1024. overlap: count pairs. skip: leave out rays that can reach "
           "no surveyed voxel; counts\ndo not change, but `points` is not counted. field: keep the counts of every "
           "voxel. surroundings: count all surfaces\ntoo, surveyed or not, for scan overlaps. registration: "
           "RegistrationOptions; predict its error. beam: BeamOptions; counts points of a beam "
           "with a width, and\nmixed ones (`Evaluation.mixed`).\nRaises Error invalid_argument.")
      .def("evaluate_sampled", &evaluate_sampled, py::arg("networks"), py::kw_only(), py::arg("voxels") = 20'000,
           py::arg("overlap") = true, py::arg("surroundings") = false, py::arg("registration") = py::none(),
           py::arg("progress") = py::none(),
           "Evaluates several networks, each as in `evaluate`, on one sample of the surveyed voxels: an Evaluation "
           "each, with\nstandard errors. voxels: size of the sample, at most all of them.\nRaises Error "
           "invalid_argument.")
      .def("__repr__", [](const Simulators& self) {
        return "<vantage.Simulator on " + name_of(self.simulator.engine().engine) + ", " +
               std::to_string(self.simulator.voxel_count()) + " voxels>";
      });
  refuse_pickle(type, "a Simulator owns a device and is not pickled; make another of its scene, scanners and options");
  add_clouds(m);
  add_uncovered(m);
}

}  // namespace vantage::python
