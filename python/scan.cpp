// SPDX-License-Identifier: Apache-2.0
#include "scan.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

#include "arrays.hpp"
#include "options.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

constexpr std::array<std::pair<const char*, ScanOutput>, 9> kOutputs{{{"position", scan_position},
                                                                      {"normal", scan_normal},
                                                                      {"reflectivity", scan_reflectivity},
                                                                      {"mesh", scan_ids},
                                                                      {"primitive", scan_ids},
                                                                      {"colour", scan_colour},
                                                                      {"voxel", scan_voxel},
                                                                      {"ghost", scan_ghost},
                                                                      {"returns", scan_returns}}};

std::uint32_t bits_of(const std::vector<std::string>& names, std::uint32_t bits) {
  for (const std::string& name : names) {
    const auto found = std::ranges::find(kOutputs, name, [](const auto& output) { return std::string(output.first); });
    if (found == kOutputs.end())
      throw Error(Errc::invalid_argument,
                  "outputs: there is no '" + name +
                      "'; there are position, normal, reflectivity, mesh, primitive, colour, voxel, ghost, returns");
    bits |= found->second;
  }
  return bits;
}

// Puts each value in its ray's place, and `none` in all others.
template <class Value>
void spread(std::vector<Value>& values, const std::vector<std::uint64_t>& ray, std::uint64_t rays, const Value& none) {
  if (values.empty() && !ray.empty()) return;  // not requested
  std::vector<Value> all(rays, none);
  for (std::size_t k = 0; k < values.size(); ++k) all[ray[k]] = values[k];
  values = std::move(all);
}

void spread(Scan& scan) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint32_t kNothing = ~std::uint32_t{0};
  const std::uint64_t rays = scan.summary.rays;
  spread(scan.range_m, scan.ray, rays, std::numeric_limits<float>::infinity());
  spread(scan.position, scan.ray, rays, Vec3{kNan, kNan, kNan});
  spread(scan.normal, scan.ray, rays, {0, 0, 0});
  spread(scan.reflectivity, scan.ray, rays, 0.0F);
  spread(scan.mesh, scan.ray, rays, -1);
  spread(scan.primitive, scan.ray, rays, kNothing);
  spread(scan.colour, scan.ray, rays, std::uint32_t{0});
  spread(scan.voxel, scan.ray, rays, kNothing);
  spread(scan.ghost, scan.ray, rays, std::uint8_t{0});
  spread(scan.return_number, scan.ray, rays, std::uint8_t{0});
  spread(scan.returns, scan.ray, rays, std::uint8_t{0});
  scan.ray.resize(rays);
  std::iota(scan.ray.begin(), scan.ray.end(), std::uint64_t{0});
}

// A member as an array, (points, ...) or (rows, columns, ...).
template <class Number, class Value>
py::array_t<Number> array_of(const py::object& self, std::vector<Value> ScanPoints::*member, ScanOutput bit,
                             const char* name) {
  const Scan& scan = self.cast<const Scan&>();
  if ((scan.outputs & bit) == 0)
    throw Error(Errc::invalid_argument, std::string(name) + ": was not asked for; name it in `outputs`");
  constexpr std::size_t kWidth = sizeof(Value) / sizeof(Number);
  py::array_t<Number> flat = view<Number>(std::span<const Value>(scan.*member), self, kWidth);
  if (!scan.grid || scan.summary.cancelled) return flat;
  Shape shape{scan.rows, scan.columns};
  if (kWidth > 1) shape.push_back(kWidth);
  return flat.reshape(shape);
}

py::array_t<std::uint32_t> ray_part(const Scan& scan, const auto& part) {
  std::vector<std::uint32_t> parts;
  parts.reserve(scan.ray.size());
  for (const std::uint64_t ray : scan.ray) parts.push_back(static_cast<std::uint32_t>(part(ray)));
  py::array_t<std::uint32_t> flat = adopt<std::uint32_t>(std::move(parts), {static_cast<py::ssize_t>(scan.ray.size())});
  return scan.grid && !scan.summary.cancelled ? py::array_t<std::uint32_t>(flat.reshape({scan.rows, scan.columns}))
                                              : flat;
}

// A structured array in the making: rows of packed fields.
class Rows {
 public:
  // `format`: of numpy. `write(to, chunk, k)` writes the value of ray number k of a chunk.
  using Write = std::function<void(std::byte* to, const ScanChunk& chunk, std::uint64_t k)>;
  void add(const std::string& name, const char* format, std::size_t size, Write write) {
    for (const std::string& known : names_)
      if (known == name) return;
    names_.push_back(name), formats_.emplace_back(format);
    writers_.push_back({row_bytes_, std::move(write)});
    row_bytes_ += size;
  }
  template <class Value>
  void add(const std::string& name, const char* format, std::vector<Value> ScanChunk::*member) {
    add(name, format, sizeof(Value), [member](std::byte* to, const ScanChunk& chunk, std::uint64_t k) {
      std::memcpy(to, &(chunk.*member)[k], sizeof(Value));
    });
  }

  // Takes the rays of a chunk that hit something.
  void take(const ScanChunk& chunk) {
    constexpr std::size_t kBlock = std::size_t{1} << 22;  // bytes
    for (std::uint64_t k = 0; k < chunk.ray_count; ++k) {
      if (!std::isfinite(chunk.range_m[k])) continue;
      if (blocks_.empty() || blocks_.back().size() + row_bytes_ > kBlock) {
        blocks_.emplace_back();
        blocks_.back().reserve(kBlock);
      }
      std::vector<std::byte>& block = blocks_.back();
      block.resize(block.size() + row_bytes_);
      std::byte* const row = block.data() + block.size() - row_bytes_;
      for (const auto& [offset, write] : writers_) write(row + offset, chunk, k);
      ++rows_;
    }
  }

  // Frees each block once it is copied, so that the points are in memory about once.
  py::array array() {
    py::list names, formats, offsets;
    for (std::size_t f = 0; f < names_.size(); ++f)
      names.append(names_[f]), formats.append(formats_[f]), offsets.append(writers_[f].first);
    const py::dtype row(names, formats, offsets, static_cast<py::ssize_t>(row_bytes_));
    py::array made(row, Shape{static_cast<py::ssize_t>(rows_)});
    auto* to = static_cast<std::byte*>(made.mutable_data());
    for (std::vector<std::byte>& block : blocks_) {
      to = std::ranges::copy(block, to).out;
      block = {};
    }
    return made;
  }

 private:
  std::vector<std::string> names_, formats_;
  std::vector<std::pair<std::size_t, Write>> writers_;
  std::size_t row_bytes_ = 0, rows_ = 0;
  std::vector<std::vector<std::byte>> blocks_;
};

// Fields of outputs by their names, in that order.
Rows rows_of(const std::vector<std::string>& outputs, bool float32, const Vec3& origin, std::uint64_t columns) {
  Rows rows;
  const auto axis = [&](const char* name, std::size_t at, double from) {
    if (float32)
      rows.add(name, "<f4", 4, [at](std::byte* to, const ScanChunk& chunk, std::uint64_t k) {
        std::memcpy(to, &chunk.position[k][at], 4);
      });
    else
      rows.add(name, "<f8", 8, [at, from](std::byte* to, const ScanChunk& chunk, std::uint64_t k) {
        const double value = from + static_cast<double>(chunk.position[k][at]);
        std::memcpy(to, &value, 8);
      });
  };
  const auto place = [&](const char* name, bool row) {
    rows.add(name, "<u4", 4, [=](std::byte* to, const ScanChunk& chunk, std::uint64_t k) {
      const std::uint64_t ray = chunk.first_ray + k;
      const auto value = static_cast<std::uint32_t>(row ? ray / columns : ray % columns);
      std::memcpy(to, &value, 4);
    });
  };
  for (const std::string& output : outputs) {
    if (output == "position") axis("x", 0, origin.x), axis("y", 1, origin.y), axis("z", 2, origin.z);
    if (output == "normal")
      for (std::size_t at = 0; at < 3; ++at)
        rows.add(std::string("n") + "xyz"[at], "<f4", 4, [at](std::byte* to, const ScanChunk& chunk, std::uint64_t k) {
          std::memcpy(to, &chunk.normal[k][at], 4);
        });
    if (output == "reflectivity") rows.add(output, "<f4", &ScanChunk::reflectivity);
    if (output == "mesh") rows.add(output, "<i4", &ScanChunk::mesh);
    if (output == "primitive") rows.add(output, "<u4", &ScanChunk::primitive);
    if (output == "colour") rows.add(output, "<u4", &ScanChunk::colour);
    if (output == "voxel") rows.add(output, "<u4", &ScanChunk::voxel);
    if (output == "ghost") rows.add(output, "|u1", &ScanChunk::ghost);
    if (output == "returns") {
      rows.add(output, "|u1", &ScanChunk::returns);
      rows.add("return_number", "|u1", 1, [](std::byte* to, const ScanChunk& chunk, std::uint64_t) {
        *to = static_cast<std::byte>(chunk.return_number);
      });
    }
    if (output == "range_m") rows.add(output, "<f4", &ScanChunk::range_m);
    if (output == "row") place("row", true);
    if (output == "column") place("column", false);
  }
  return rows;
}

std::uint64_t write_point_cloud(const std::filesystem::path& file, Simulators& self, const Stations& stations,
                                const std::vector<std::string>& outputs, const std::string& crs,
                                const std::optional<BeamOptions>& beam,
                                const std::optional<InstrumentErrors>& instrument, bool doubles, Listener progress) {
  const std::vector<PlacedStation> placed = stations_of(stations);
  const std::vector<std::string> names = station_names(placed);
  const std::uint32_t bits =
      point_cloud_outputs(file, bits_of(outputs, scan_position)) | (beam ? std::uint32_t{scan_returns} : 0);
  LongCall call(std::move(progress));
  return call.run([&]() -> std::uint64_t {
    Simulator& simulator = self.simulator;
    PointCloudWriter writer(file, simulator.origin(), bits, crs.empty() ? crs : coordinate_system(crs),
                            doubles ? PlyCoordinates::doubles : PlyCoordinates::floats);
    for (std::size_t k = 0; k < placed.size(); ++k) {
      const StationSetup& setup = placed[k].setup;
      if (setup.scanner < simulator.scanners().size() && active(placed[k]))
        writer.begin_station({names[k], placed[k].position, simulator.scanners()[setup.scanner], setup});
      const auto all = static_cast<double>(placed.size());
      const ScanSummary scanned = simulator.scan(
          {placed[k].position, active(placed[k]), setup},
          {.outputs = bits, .place = static_cast<std::uint32_t>(k), .beam = beam, .instrument = instrument},
          [&](const ScanChunk& chunk) { writer.write(chunk, static_cast<std::uint16_t>(k + 1)); },
          call.progress(static_cast<double>(k) / all, static_cast<double>(k + 1) / all));
      if (scanned.cancelled) return 0;
    }
    writer.close();
    return writer.points();
  });
}

}  // namespace

Scan scan(Simulators& self, const Vec3& position, const std::vector<std::string>& outputs, const StationSetup& setup,
          bool grid, std::uint32_t place, const std::optional<BeamOptions>& beam,
          const std::optional<InstrumentErrors>& instrument, Listener progress) {
  if (grid && beam && beam->returns == Returns::all)
    throw Error(Errc::invalid_argument, "scan: a grid has one element for each ray; with returns='all' leave it out");
  const Simulator& simulator = self.simulator;
  const std::uint32_t bits = bits_of(outputs, scan_range);
  LongCall call(std::move(progress));
  Scan made = call.run([&] {
    Scan points{self.simulator.scan_points({.position = position, .setup = setup},
                                           {.outputs = bits, .place = place, .beam = beam, .instrument = instrument},
                                           call.progress())};
    points.outputs = bits, points.grid = grid;
    if (grid) spread(points);
    return points;
  });
  const Scanner& scanner = simulator.scanners()[setup.scanner];  // exists, since something was scanned
  made.rows = scanner.rows(), made.columns = scanner.columns();
  return made;
}

py::array scan_array(Simulators& self, const Vec3& position, const std::vector<std::string>& outputs, bool float32,
                     const StationSetup& setup, std::uint32_t place, const std::optional<BeamOptions>& beam,
                     const std::optional<InstrumentErrors>& instrument, Listener progress) {
  std::vector<std::string> others;
  for (const std::string& output : outputs)
    if (output != "row" && output != "column" && output != "range_m") others.push_back(output);
  const std::uint32_t bits = bits_of(others, scan_range);
  if (outputs.empty()) throw Error(Errc::invalid_argument, "scan_array: outputs: name one at least");
  Simulator& simulator = self.simulator;
  if (setup.scanner >= simulator.scanners().size())
    throw Error(Errc::invalid_argument, "scan_array: the setup's scanner " + std::to_string(setup.scanner) +
                                            ", counted from 0, is not there; the simulator has " +
                                            std::to_string(simulator.scanners().size()));
  Rows rows = rows_of(outputs, float32, simulator.origin(), simulator.scanners()[setup.scanner].columns());
  LongCall call(std::move(progress));
  call.run([&] {
    return simulator.scan(
        {.position = position, .setup = setup},
        {.outputs = bits, .place = place, .beam = beam, .instrument = instrument},
        [&](const ScanChunk& chunk) { rows.take(chunk); }, call.progress());
  });
  return rows.array();
}

void add_scans(py::module_& m) {
  const auto beam = Options<BeamOptions>("BeamOptions")
                        .add("sub_rays", &BeamOptions::sub_rays, "Sub-rays over the footprint, 7 or 19.")
                        .add("returns", &BeamOptions::returns,
                             "Returns of a ray that become points: 'first', 'strongest', 'last' or 'all'.")
                        .add("pulse_m", &BeamOptions::pulse_m,
                             "Length of a pulse; echoes nearer together than half of it share a return.");
  py::class_<BeamOptions> options(m, "BeamOptions",
                                  ("A beam as wide as the scanner's divergence and exit diameter make it. Its sub-rays "
                                   "are traced on the processor." +
                                   beam.doc())
                                      .c_str());
  options.def(py::init([beam](const py::kwargs& given) { return beam.read(given); }))
      .def("__repr__", [beam](const BeamOptions& o) { return beam.repr(o); });
  beam.attributes(options);
  beam.pickles(options);

  py::class_<Scan> type(m, "Scan",
                        "Recording of a scanner at one station: n points, or with grid=True one element for each ray, "
                        "where arrays have\n(rows, columns) in the place of (n,). Arrays are read-only views.");
  type.def_property_readonly(
          "row", [](const Scan& scan) { return ray_part(scan, [&](std::uint64_t ray) { return ray / scan.columns; }); },
          "Zenith step of each point: (n,).")
      .def_property_readonly(
          "column",
          [](const Scan& scan) { return ray_part(scan, [&](std::uint64_t ray) { return ray % scan.columns; }); },
          "Azimuth step of each point: (n,).")
      .def_property_readonly(
          "range_m",
          [](const py::object& self) { return array_of<float>(self, &Scan::range_m, scan_range, "range_m"); },
          "Metres from the head, noise included: (n,); infinite if a ray of a grid hit nothing in range.")
      .def_property_readonly(
          "position",
          [](const py::object& self) { return array_of<double>(self, &Scan::position, scan_position, "position"); },
          "Survey frame, metres: (n, 3); NaN if a ray of a grid hit nothing.")
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
          "Surveyed voxel in which the point counts: (n,); 2^32 - 1 if it does not count.")
      .def_property_readonly(
          "ghost",
          [](const py::object& self) { return array_of<std::uint8_t>(self, &Scan::ghost, scan_ghost, "ghost"); },
          "1 for a point that was seen in a mirror, and lies behind it: (n,).")
      .def_property_readonly(
          "returns",
          [](const py::object& self) { return array_of<std::uint8_t>(self, &Scan::returns, scan_returns, "returns"); },
          "Returns of the point's ray: (n,); 0 without a hit.")
      .def_property_readonly(
          "return_number",
          [](const py::object& self) {
            return array_of<std::uint8_t>(self, &Scan::return_number, scan_returns, "returns");
          },
          "Number of the point among the returns of its ray, from 1: (n,). Asked for as 'returns'.")
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
          "mixed",
          [](const Scan& scan) {
            const MixedPoints& mixed = scan.summary.mixed;
            return std::tuple(mixed.points, mixed.counted, mixed.wrong_voxel);
          },
          "Points of a beam that lie off all surfaces they were made of, by more than 5 mm: all, those that count, and "
          "those in\na surveyed voxel that they did not come from.")
      .def_property_readonly(
          "trace_seconds", [](const Scan& scan) { return scan.summary.trace_seconds; }, "Time spent tracing.")
      .def_property_readonly(
          "cancelled", [](const Scan& scan) { return scan.summary.cancelled; },
          "Whether it was stopped: it then has only the first points, as flat arrays.")
      .def("__len__", [](const Scan& scan) { return scan.range_m.size(); })
      .def("__repr__", [](const Scan& scan) {
        return "<vantage.Scan of " + std::to_string(scan.summary.points) + " points from " +
               std::to_string(scan.summary.rays) + " rays>";
      });
  add_pickle(type);
}

void add_clouds(py::module_& m) {
  m.def("write_point_cloud", &write_point_cloud, py::arg("file"), py::arg("simulator"), py::arg("stations"),
        py::kw_only(), py::arg("outputs") = std::vector<std::string>{"reflectivity"}, py::arg("crs") = "",
        py::arg("beam") = py::none(), py::arg("instrument") = py::none(), py::arg("doubles") = false,
        py::arg("progress") = py::none(),
        "Scans stations and streams their points to a .ply, .las or .e57 file by its extension; returns their "
        "number.\nE57 keeps stations apart, with their poses. stations: as for `evaluate`. outputs: besides positions, "
        "as for `scan`;\nLAS has 'reflectivity' and 'colour', and like E57 always the first, as intensity. crs: of the "
        "survey frame, such as 'EPSG:25832'; '': none is written. beam: as for `scan`; numbers of returns are written "
        "too. instrument: as for `scan`. doubles: coordinates\nof a .ply are doubles; otherwise floats about an origin "
        "that its header's comment "
        "`origin X Y Z` tells. A stopped\ncall writes nothing and returns 0. Raises Error: io, invalid_argument.");
}

}  // namespace vantage::python
