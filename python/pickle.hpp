// SPDX-License-Identifier: Apache-2.0
// Converts results of plain data to bytes and back, for Python's pickle. `members` lists the content of a type once.
#pragma once

#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "casters.hpp"
#include "scan.hpp"
#include "vantage/evaluate.hpp"

namespace vantage::python {

inline auto members(RegistrationSums& s) {
  return std::tie(s.voxels, s.centre, s.radius_m, s.heads, s.pairs, s.surface, s.groups);
}
inline auto members(NetworkCounts& c) {
  return std::tie(c.voxels, c.weight, c.saturated, c.partial_points, c.point_weight, c.rays, c.stations, c.points,
                  c.points_on_surveyed, c.dropped, c.mixed, c.seen, c.shared, c.meshes, c.registration, c.groups,
                  c.successive_difference_sum, c.trace_seconds, c.cancelled);
}
inline auto members(RayHits& h) {
  return std::tie(h.range_m, h.position, h.normal, h.reflectivity, h.diffuse, h.mesh, h.primitive);
}
inline auto members(UncoveredVoxels& u) { return std::tie(u.voxels, u.centres, u.meshes, u.points); }
inline auto members(VoxelField& f) { return std::tie(f.count, f.stations); }
inline auto members(RegistrationError& e) {
  return std::tie(e.rms_m, e.random_m, e.worst_m, e.worst_station, e.stations, e.poses, e.centre, e.scale_m);
}
inline auto members(BatteryUse& b) {
  return std::tie(b.instrument, b.battery_min, b.battery_scans, b.on_min, b.scans, b.batteries, b.in_a_day);
}
inline auto members(Round& r) {
  return std::tie(r.order, r.arrive_min, r.stay_min, r.legs_m, r.paths, r.walk_m, r.scan_min, r.set_up_min,
                  r.photos_min, r.walk_min, r.minutes, r.unconnected, r.unlinked, r.batteries);
}
inline auto members(Session& s) {
  return std::tuple_cat(members(static_cast<Round&>(s)),
                        std::tie(s.day, s.crew, s.parts, s.linked, s.start_min, s.wait_min, s.waiting_min));
}
inline auto members(ClosedStation& c) { return std::tie(c.station, c.why); }
inline auto members(Visit& v) {
  return std::tuple_cat(members(static_cast<Round&>(v)),
                        std::tie(v.day_min, v.sessions, v.not_split, v.closed, v.bound));
}
inline auto members(StoreyTie& t) { return std::tie(t.a, t.b, t.value, t.apart_m, t.way_m); }
inline auto members(ScanData& d) { return std::tie(d.points, d.e57_bytes, d.las_bytes); }
inline auto members(StationMove& m) { return std::tie(m.station, m.to, m.reach_m); }
inline auto members(Work& w) {
  return std::tie(w.networks, w.rays, w.sampled_networks, w.sampled_voxels, w.sampled_rays, w.planes, w.choice_steps,
                  w.uploaded_bytes);
}
inline auto members(Evaluation& e) {
  return std::tie(e.stations, e.names, e.exact, e.voxels, e.goal_density, e.counts, e.work, e.field, e.values,
                  e.attainable, e.overlap_matrix, e.overlap_errors, e.scan_overlap_matrix, e.through_glass,
                  e.link_overlap, e.link, e.registration, e.calibration, e.data, e.visit, e.storey_ties, e.moves,
                  e.violation);
}
inline auto members(Connectivity& c) { return std::tie(c.parts, c.part, c.bridges, c.weakest_link, c.weakest_overlap); }
inline auto members(MeshInfo& m) {
  return std::tie(m.name, m.role, m.diffuse, m.triangle_count, m.weight, m.door, m.station_area, m.glass, m.mirror,
                  m.detail_m, m.accuracy_m);
}
inline auto members(MissedShare& s) { return std::tie(s.node, s.voxels, s.shares); }
inline auto members(RoomShare& r) { return std::tie(r.share, r.ground_m2, r.left_out); }
inline auto members(Room& r) { return std::tie(r.name, r.storey, r.box, r.outline); }
inline auto members(VoxelStatus& s) { return std::tie(s.why, s.captured, s.attainable); }
inline auto members(MissedVoxels& m) { return std::tie(m.voxels, m.points, m.status, m.shares, m.rooms, m.candidates); }
inline auto members(Scan& s) {
  return std::tie(s.ray, s.position, s.range_m, s.normal, s.reflectivity, s.mesh, s.primitive, s.colour, s.voxel,
                  s.ghost, s.return_number, s.returns, s.summary, s.rows, s.columns, s.outputs, s.grid);
}

/// Writes values one after another, or reads them back in the same order. Throws Error malformed_file if bytes end too
/// early.
class Archive {
 public:
  Archive() = default;
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reading_(true) {}
  const std::string& bytes() const { return bytes_; }

  template <class Value>
  void pass(Value& value) {
    if constexpr (requires { members(value); })
      std::apply([&](auto&... member) { (pass(member), ...); }, members(value));
    else if constexpr (std::is_base_of_v<PairMatrix, Value>)
      pass_matrix(value);
    else
      pass_plain(value);
  }

 private:
  void raw(void* data, std::size_t size) {
    if (!reading_) {
      bytes_.append(static_cast<const char*>(data), size);
      return;
    }
    require(size);
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  void require(std::size_t size) const {
    if (size > bytes_.size() - at_) throw Error(Errc::malformed_file, "a pickle of vantage is cut short");
  }
  // Number of following elements, each of which takes at least this many bytes.
  std::size_t count(std::size_t size, std::size_t least) {
    raw(&size, sizeof size);
    if (reading_) {
      require(size);
      require(size * least);
    }
    return size;
  }

  template <class Value>
  void pass_plain(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
    raw(&value, sizeof value);
  }
  void pass_plain(StationMasks& masks) {
    std::size_t voxels = masks.voxels(), words = masks.words();
    pass(voxels), pass(words);
    std::vector<std::uint64_t> all = masks.all_words();
    pass(all);
    if (!reading_) return;
    if (words == 0 ? !all.empty() : all.size() % words != 0 || all.size() / words != voxels)
      throw Error(Errc::malformed_file, "a pickle of vantage has station masks of another number of voxels");
    masks = StationMasks(voxels, words * mask_bits);
    for (std::size_t w = 0; w < words; ++w) masks.set_words(w, std::span(all).subspan(w * voxels, voxels));
  }
  void pass_plain(std::string& text) {
    text.resize(count(text.size(), 1));
    raw(text.data(), text.size());
  }
  template <class A, class B>
  void pass_plain(std::pair<A, B>& pair) {
    pass(pair.first), pass(pair.second);
  }
  template <class Value>
  void pass_plain(std::optional<Value>& value) {
    bool there = value.has_value();
    raw(&there, sizeof there);
    if (reading_) value = there ? std::optional<Value>(std::in_place) : std::nullopt;
    if (value) pass(*value);
  }
  template <class Value>
  void pass_plain(std::vector<Value>& values) {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      values.resize(count(values.size(), sizeof(Value)));
      raw(values.data(), values.size() * sizeof(Value));
    } else {
      values.resize(count(values.size(), 1));
      for (Value& value : values) pass(value);
    }
  }
  template <class Key, class Value>
  void pass_plain(std::map<Key, Value>& map) {
    const std::size_t size = count(map.size(), 1);
    if (!reading_)
      for (const auto& [key, value] : map) {
        Key name = key;
        Value copy = value;
        pass(name), pass(copy);
      }
    else
      for (std::size_t k = 0; k < size; ++k) {
        Key name;
        pass(name);
        pass(map[name]);
      }
  }
  template <class Matrix>
  void pass_matrix(Matrix& matrix) {
    const std::size_t n = count(matrix.size(), sizeof(double));
    if (reading_) require(n * n * sizeof(double)), matrix = Matrix(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double value = matrix(i, j);
        raw(&value, sizeof value);
        matrix.set(i, j, value);
      }
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reading_ = false;
};

/// Makes values of a type of plain data picklable; other versions of vantage cannot read them.
template <class Type, class... Extra>
void add_pickle(py::class_<Type, Extra...>& type) {
  type.def(py::pickle(
      [](const Type& value) {
        Archive archive;
        archive.pass(const_cast<Type&>(value));  // writing changes nothing
        return py::make_tuple(version(), py::bytes(archive.bytes()));
      },
      [](const py::tuple& state) {
        const auto from = state[0].cast<std::string>();
        if (from != version())
          throw Error(Errc::invalid_argument, "a pickle of vantage " + from + " is not read by vantage " + version());
        Archive archive(state[1].cast<std::string>());
        Type value{};
        archive.pass(value);
        return value;
      }));
}

/// Makes pickle refuse a type with a TypeError that says why, and what to do.
template <class Type, class... Extra>
void refuse_pickle(py::class_<Type, Extra...>& type, const std::string& why) {
  type.def("__reduce__", [why](const py::object&) -> py::object { throw py::type_error(why); });
}

}  // namespace vantage::python
