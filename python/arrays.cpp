// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <limits>

namespace vantage::python {

Doubles doubles_of(const py::object& given, const std::string& what) {
  auto array = Doubles::ensure(given);
  if (!array) throw py::type_error(what + ": " + std::string(py::repr(given)) + " is no array of numbers");
  return array;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const py::array& array) {
  const auto wrong = [](const std::string& text) { throw Error(Errc::invalid_argument, "triangles: " + text); };
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u') wrong("integers are wanted, and these are " + std::string(py::str(array.dtype())));
  if (array.ndim() != 2 || array.shape(1) != 3)
    wrong("an array of shape (m, 3) is wanted, and this one's is " + shape_text(array));
  const auto indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!indices) wrong("they do not fit 64 bits");
  std::vector<std::array<std::uint32_t, 3>> triangles(static_cast<std::size_t>(array.shape(0)));
  const std::int64_t* next = indices.data();
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      if (*next < 0 || *next > std::numeric_limits<std::uint32_t>::max())
        wrong("no corner has the index " + std::to_string(*next));
      corner = static_cast<std::uint32_t>(*next++);
    }
  }
  return triangles;
}

namespace {

template <class Each>
std::vector<Each> all_of(const py::object& stations) {
  std::vector<Each> all;
  for (const auto& each : stations) {
    if (!py::isinstance<Each>(each))
      throw py::type_error("stations: " + std::string(py::repr(each)) + " is none of the kind that the first one is");
    all.push_back(each.cast<Each>());
  }
  return all;
}

}  // namespace

std::vector<PlacedStation> stations_of(const py::object& stations) {
  std::vector<PlacedStation> placed;
  if (!py::isinstance<py::array>(stations) && py::isinstance<py::sequence>(stations) && py::len(stations) > 0) {
    const py::object first = stations[py::int_(0)];
    if (py::isinstance<PlacedStation>(first)) return all_of<PlacedStation>(stations);
    if (py::isinstance<Station>(first)) {
      for (const Station& one : all_of<Station>(stations))
        placed.push_back({.uv = {},
                          .position = one.position,
                          .ground = one.position,
                          .status = one.active ? StationStatus::ok : StationStatus::clash,
                          .setup = one.setup});
      return placed;
    }
  }
  const Doubles heads = doubles_of(stations, "stations");
  for (const Vec3& head : rows_of<Vec3>(heads, "stations"))
    placed.push_back({.uv = {}, .position = head, .ground = head});
  return placed;
}

Network network_of(const py::object& stations) { return to_network(stations_of(stations)); }

py::array_t<double> heads_of(std::span<const PlacedStation> stations) {
  std::vector<Vec3> heads;
  for (const PlacedStation& station : stations) heads.push_back(station.position);
  return adopt(std::move(heads));
}

Json from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

Json to_dict(const Settings& settings) {
  const py::object loads = py::module_::import("json").attr("loads");
  Json dict;
  for (const Setting& setting : settings) dict[py::str(setting.name)] = loads(setting.json);
  return dict;
}

}  // namespace vantage::python
