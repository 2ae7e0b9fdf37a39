// SPDX-License-Identifier: Apache-2.0
#include "scan.hpp"

#include "arrays.hpp"

namespace vantage::python {
namespace {

constexpr std::array<std::pair<const char*, ScanOutput>, 7> kOutputs{{{"position", scan_position},
                                                                      {"normal", scan_normal},
                                                                      {"reflectivity", scan_reflectivity},
                                                                      {"mesh", scan_ids},
                                                                      {"primitive", scan_ids},
                                                                      {"colour", scan_colour},
                                                                      {"voxel", scan_voxel}}};

std::uint32_t bits_of(const std::vector<std::string>& names) {
  std::uint32_t bits = scan_range;  // tells which rays hit
  for (const std::string& name : names) {
    const auto found = std::ranges::find(kOutputs, name, [](const auto& output) { return std::string(output.first); });
    if (found == kOutputs.end())
      throw Error(Errc::invalid_argument,
                  "outputs: there is no '" + name +
                      "'; there are position, normal, reflectivity, mesh, primitive, colour, voxel");
    bits |= found->second;
  }
  return bits;
}

// Appends what a chunk has of rays that hit, or of all of them.
void append(Scan& scan, const ScanChunk& chunk, const Vec3& origin) {
  const auto take = [](auto& to, const auto& from, std::uint64_t k) {
    if (!from.empty()) to.push_back(from[k]);
  };
  for (std::uint64_t k = 0; k < chunk.ray_count; ++k) {
    if (!scan.grid && !std::isfinite(chunk.range_m[k])) continue;
    if (!scan.grid) scan.ray.push_back(chunk.first_ray + k);
    take(scan.range_m, chunk.range_m, k);
    take(scan.normal, chunk.normal, k);
    take(scan.reflectivity, chunk.reflectivity, k);
    take(scan.mesh, chunk.mesh, k);
    take(scan.primitive, chunk.primitive, k);
    take(scan.colour, chunk.colour, k);
    take(scan.voxel, chunk.voxel, k);
    if (!chunk.position.empty()) {
      const auto& [x, y, z] = chunk.position[k];
      scan.position.push_back(origin + Vec3{x, y, z});
    }
  }
}

// A member as an array, (points, ...) or (rows, columns, ...).
template <class Number, class Value>
py::array_t<Number> array_of(const py::object& self, std::vector<Value> Scan::*member, ScanOutput bit,
                             const char* name) {
  const Scan& scan = self.cast<const Scan&>();
  if ((scan.outputs & bit) == 0)
    throw Error(Errc::invalid_argument, std::string(name) + ": was not asked for; name it in `outputs`");
  constexpr std::size_t width = sizeof(Value) / sizeof(Number);
  py::array_t<Number> flat = view<Number>(std::span<const Value>(scan.*member), self, width);
  if (!scan.grid || scan.summary.cancelled) return flat;
  Shape shape{scan.rows, scan.columns};
  if (width > 1) shape.push_back(width);
  return flat.reshape(shape);
}

py::array_t<std::uint32_t> ray_part(const Scan& scan, const auto& part) {
  const std::size_t count = scan.grid ? scan.range_m.size() : scan.ray.size();
  std::vector<std::uint32_t> parts(count);
  for (std::size_t k = 0; k < count; ++k) parts[k] = static_cast<std::uint32_t>(part(scan.grid ? k : scan.ray[k]));
  py::array_t<std::uint32_t> flat = adopt<std::uint32_t>(std::move(parts), {static_cast<py::ssize_t>(count)});
  return scan.grid && !scan.summary.cancelled ? py::array_t<std::uint32_t>(flat.reshape({scan.rows, scan.columns}))
                                              : flat;
}

}  // namespace

Scan scan(GuardedSimulator& self, const Vec3& position, const std::vector<std::string>& outputs,
          const StationSetup& setup, bool grid, std::uint32_t place, py::object progress) {
  const Simulator& simulator = self.simulator;
  Scan made{.outputs = bits_of(outputs), .grid = grid};
  LongCall call(std::move(progress));
  made.summary = call.run([&] {
    return self.simulator.scan(
        {.position = position, .setup = setup}, {.outputs = made.outputs, .place = place},
        [&](const ScanChunk& chunk) { append(made, chunk, simulator.origin()); }, call.progress());
  });
  const Scanner& scanner = simulator.scanners()[setup.scanner];  // there is one, or nothing was scanned
  made.rows = scanner.rows(), made.columns = scanner.columns();
  return made;
}

void add_scans(py::module_& m) {
  py::class_<Scan>(
      m, "Scan",
      "What a scanner recorded from one station: n points, or with grid=True an element a ray, where arrays\n"
      "have (rows, columns) in the place of (n,). Arrays are read-only and are no copies.")
      .def_property_readonly(
          "row", [](const Scan& scan) { return ray_part(scan, [&](std::uint64_t ray) { return ray / scan.columns; }); },
          "Zenith step of each point: (n,).")
      .def_property_readonly(
          "column",
          [](const Scan& scan) { return ray_part(scan, [&](std::uint64_t ray) { return ray % scan.columns; }); },
          "Azimuth step of each point: (n,).")
      .def_property_readonly(
          "range_m",
          [](const py::object& self) { return array_of<float>(self, &Scan::range_m, scan_range, "range_m"); },
          "Metres from the head, noise included: (n,); infinite where a ray of a grid hit nothing in range.")
      .def_property_readonly(
          "position",
          [](const py::object& self) { return array_of<double>(self, &Scan::position, scan_position, "position"); },
          "Survey frame, metres: (n, 3); NaN where a ray of a grid hit nothing.")
      .def_property_readonly(
          "normal", [](const py::object& self) { return array_of<float>(self, &Scan::normal, scan_normal, "normal"); },
          "Unit vectors towards the scanner: (n, 3).")
      .def_property_readonly(
          "reflectivity",
          [](const py::object& self) {
            return array_of<float>(self, &Scan::reflectivity, scan_reflectivity, "reflectivity");
          },
          "The intensity R (I . -N), in [0, 1]: (n,).")
      .def_property_readonly(
          "mesh", [](const py::object& self) { return array_of<std::int32_t>(self, &Scan::mesh, scan_ids, "mesh"); },
          "Index into `Scene.meshes`: (n,); -1 without a hit.")
      .def_property_readonly(
          "primitive",
          [](const py::object& self) { return array_of<std::uint32_t>(self, &Scan::primitive, scan_ids, "primitive"); },
          "Triangle, over all meshes in order: (n,); 2^32 - 1 without a hit.")
      .def_property_readonly(
          "colour",
          [](const py::object& self) { return array_of<std::uint32_t>(self, &Scan::colour, scan_colour, "colour"); },
          "0xAABBGGRR, sRGB, of the material: (n,); .view('u1').reshape(-1, 4) has the channels.")
      .def_property_readonly(
          "voxel",
          [](const py::object& self) { return array_of<std::uint32_t>(self, &Scan::voxel, scan_voxel, "voxel"); },
          "Surveyed voxel that the point counts in: (n,); 2^32 - 1 where it does not count.")
      .def_readonly("rows", &Scan::rows, "Zenith steps of its scanner.")
      .def_readonly("columns", &Scan::columns, "Azimuth steps of its scanner.")
      .def_property_readonly(
          "rays", [](const Scan& scan) { return scan.summary.rays; }, "Rays that were cast.")
      .def_property_readonly(
          "points", [](const Scan& scan) { return scan.summary.points; }, "Rays that hit.")
      .def_property_readonly(
          "points_on_surveyed", [](const Scan& scan) { return scan.summary.points_on_surveyed; },
          "Points that count: on a surveyed mesh and in a surveyed voxel.")
      .def_property_readonly(
          "trace_seconds", [](const Scan& scan) { return scan.summary.trace_seconds; }, "Time spent tracing.")
      .def_property_readonly(
          "cancelled", [](const Scan& scan) { return scan.summary.cancelled; },
          "Stopped before its end: has the first points alone, as flat arrays.")
      .def("__len__", [](const Scan& scan) { return scan.range_m.size(); })
      .def("__repr__", [](const Scan& scan) {
        return "<vantage.Scan of " + std::to_string(scan.summary.points) + " points from " +
               std::to_string(scan.summary.rays) + " rays>";
      });
}

}  // namespace vantage::python
