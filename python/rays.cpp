// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "long_call.hpp"
#include "module.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

// Rays of a caller, with the arrays that they lie in.
struct GivenRays {
  Doubles origins, directions;
  std::optional<Doubles> ranges;

  Rays rays() const {
    Rays made{points_of(origins, "origins"), points_of(directions, "directions")};
    if (!ranges) return made;
    if (ranges->ndim() > 1)
      throw Error(Errc::invalid_argument,
                  "ranges_m: a number or an array of shape (n,) is wanted, and this one's is " + shape_text(*ranges));
    if (ranges->size() == 0 && (origins.size() > 0 || directions.size() > 0))
      throw Error(Errc::invalid_argument, "ranges_m: give one for all rays, or one each; this array is empty");
    made.ranges_m = {ranges->data(), static_cast<std::size_t>(ranges->size())};
    return made;
  }
};

GivenRays given_rays(const ArrayLike& origins, const ArrayLike& directions, const std::optional<ArrayLike>& ranges_m) {
  return {doubles_of(origins, "origins"), doubles_of(directions, "directions"),
          ranges_m ? std::optional(doubles_of(*ranges_m, "ranges_m")) : std::nullopt};
}

// A call of the tracer with arrays, whose result `give` makes one of Python's.
template <class Result, class Give>
auto call_of(Result (RayTracer::*traced)(const Rays&, const RayOptions&, const Progress&) const, const Give& give) {
  return [traced, give](const RayTracer& self, const ArrayLike& origins, const ArrayLike& directions,
                        const std::optional<ArrayLike>& ranges_m, double from_m, bool glass, Listener progress) {
    const GivenRays given = given_rays(origins, directions, ranges_m);
    const Rays rays = given.rays();
    LongCall call(std::move(progress));
    return give(call.run([&] { return (self.*traced)(rays, {.from_m = from_m, .glass = glass}, call.progress()); }));
  };
}

template <class Number, class Value>
py::array_t<Number> give_array(std::vector<Value>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return adopt<Number>(std::move(values), {count});
}

template <class Number, class Value>
auto array_of(std::vector<Value> RayHits::*member) {
  return [member](const py::object& self) {
    return view<Number>(std::span<const Value>(self.cast<const RayHits&>().*member), self,
                        sizeof(Value) / sizeof(Number));
  };
}

void add_hits(py::module_& m) {
  py::class_<RayHits> hits(m, "RayHits", "What each ray meets first. Arrays are read-only views, named as in `Scan`.");
  hits.def_property_readonly("range_m", array_of<double>(&RayHits::range_m),
                             "Distance from the origin, metres: (n,); infinite without a hit.")
      .def_property_readonly("position", array_of<double>(&RayHits::position),
                             "Survey frame, metres: (n, 3); NaN without a hit.")
      .def_property_readonly("normal", array_of<float>(&RayHits::normal),
                             "Unit vectors turned towards the origin: (n, 3); 0 without a hit.")
      .def_property_readonly("reflectivity", array_of<float>(&RayHits::reflectivity),
                             "The intensity R (I . -N), in [0, 1]: (n,); 0 without a hit.")
      .def_property_readonly("diffuse", array_of<float>(&RayHits::diffuse),
                             "Diffuse reflection coefficient R of the mesh: (n,); 0 without a hit.")
      .def_property_readonly("mesh", array_of<std::int32_t>(&RayHits::mesh),
                             "Index into `Scene.meshes`: (n,); -1 without a hit.")
      .def_property_readonly("primitive", array_of<std::uint32_t>(&RayHits::primitive),
                             "Triangle, over all meshes in order: (n,); 2^32 - 1 without a hit.")
      .def("__len__", &RayHits::size)
      .def("__repr__", [](const RayHits& self) {
        const auto missed = std::ranges::count(self.mesh, -1);
        return "<vantage.RayHits of " + std::to_string(self.size()) + " rays, " +
               std::to_string(static_cast<std::ptrdiff_t>(self.size()) - missed) + " hit>";
      });
  add_pickle(hits);
}

}  // namespace

void add_rays(py::module_& m) {
  add_hits(m);
  py::class_<RayTracer> tracer(
      m, "RayTracer",
      "Traces rays of any origins and directions in a scene, in double precision: on the processor, or on a graphics "
      "card by the\nengine 'compute_bvh' or 'ray_query' ('auto': on the best one, if there is any). Every engine gives "
      "the same answers, to the\nbit. A graphics card leaves to the processor what float arithmetic cannot decide: "
      "rays "
      "that pass an edge or end at a surface.\nAny number of rays a call; other Python threads run meanwhile.\n\n"
      "origins, directions: arrays of (n, 3), or one row for all rays; survey frame, metres; directions of any finite "
      "length\nabove 0. ranges_m: farthest hit that counts, a number or (n,); None: any. from_m: only hits further "
      "than "
      "this count.\nglass: it stops rays, which otherwise pass it as those of a scan do. progress as in `Simulator`; "
      "arrays are empty if it\nstopped the call, and on a graphics card it must not call the same tracer.\nRaises "
      "Error: "
      "invalid_argument, with the row, for values that are not finite or out of reach; no_suitable_device, "
      "out_of_memory,\ndevice_failure.");
  tracer
      .def(py::init([](const Scene& scene, Engine engine, std::optional<std::uint32_t> device_index) {
             const py::gil_scoped_release unlocked;
             return RayTracer(scene, {engine, device_index});
           }),
           py::arg("scene"), py::kw_only(), py::arg("engine") = Engine::embree, py::arg("device_index") = py::none())
      .def_property_readonly("scene", &RayTracer::scene, "Its scene.")
      .def_property_readonly(
          "engine", [](const RayTracer& self) { return self.engine(); }, "The chosen engine.");
  const auto add = [&](const char* name, const auto& call, const char* doc) {
    tracer.def(name, call, py::arg("origins"), py::arg("directions"), py::kw_only(), py::arg("ranges_m") = py::none(),
               py::arg("from_m") = 0.0, py::arg("glass") = false, py::arg("progress") = py::none(), doc);
  };
  add("nearest", call_of(&RayTracer::nearest, [](RayHits&& hits) { return std::move(hits); }),
      "The nearest hit of each ray.");
  add("blocked", call_of(&RayTracer::blocked, &give_array<bool, std::uint8_t>),
      "Whether each ray meets anything: (n,). Faster than `nearest`.");
  add("count", call_of(&RayTracer::count, &give_array<std::uint32_t, std::uint32_t>),
      "Triangles that each ray passes through: (n,). On an edge that triangles share, each of them counts.");
  refuse_pickle(tracer, "a RayTracer owns a tree and is not pickled; make another of its scene");
}

}  // namespace vantage::python
