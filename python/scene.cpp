// SPDX-License-Identifier: Apache-2.0
#include <vantage/built_in_scenes.hpp>

#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include "pickle.hpp"

namespace vantage::python {
namespace {

using Globs = std::vector<std::string>;

Options<SceneOptions> scene_options(const std::string& call) {
  return Options<SceneOptions>(call)
      .add("surveyed", &SceneOptions::surveyed, "Patterns (`*`, `?`) of surveyed nodes.")
      .add("blocking", &SceneOptions::blocking, "Nodes that only block.")
      .add("search", &SceneOptions::search, "Nodes of the search area.")
      .add("ignore", &SceneOptions::ignore, "Nodes that are left out.")
      .add("weights", &SceneOptions::weights, "Pairs (pattern, weight of its voxels in coverage, 1 to 255).")
      .add("details_mm", &SceneOptions::details_mm, "Pairs (pattern, widest beam footprint of points that count, mm).")
      .add("accuracies_mm", &SceneOptions::accuracies_mm,
           "Pairs (pattern, largest range noise of points that count, mm).")
      .add("doors", &SceneOptions::doors, "Closed door leaves: open for people, closed for rays.")
      .add("station_area", &SceneOptions::station_area, "Nodes that stations may stand on.")
      .add("glass", &SceneOptions::glass, "Nodes of glass, besides what the file says; 'opaque': none is.")
      .add("mirror", &SceneOptions::mirror, "Nodes that mirror rays, besides what the file says; 'none': none does.")
      .add("scene_index", &SceneOptions::scene_index, "Which glTF scene; None: the file's own.")
      .add("default_diffuse", &SceneOptions::default_diffuse, "Diffuse reflection R if the file gives none.")
      .add("unit", &SceneOptions::unit, "'m', 'cm', 'mm', 'in' or 'ft'; None: recognised.")
      .add("up", &SceneOptions::up, "'x', 'y' or 'z'; None: recognised.")
      .add("beside", &SceneOptions::beside, "Further files of the same site, read with it as one scene.")
      .add("wall_layers", &SceneOptions::wall_layers, "Patterns of the layers of a floor plan's walls; []: recognised.")
      .add("wall_height_m", &SceneOptions::wall_height_m, "Height of a floor plan's walls, metres; None: 2.7.")
      .add("shared_meshes", &SceneOptions::shared_meshes,
           "Whether a mesh that several nodes place is stored once: 'auto' (in large scenes), 'always' or 'never'.")
      .add("max_memory_bytes", &SceneOptions::max_memory_bytes, "Memory limit of the load; 0: half of the free memory.")
      .add("allow_outside", &SceneOptions::allow_outside, "Let the file name others outside its own folder.");
}

Options<SceneMesh> mesh_options(const std::string& call) {
  return Options<SceneMesh>(call)
      .add("name", &SceneMesh::name, "Beginning of messages.")
      .add("role", &SceneMesh::role,
           "'surveyed', 'blocking', 'search' (part of the search area) or 'ignore'; None: surveyed, or blocking once "
           "any mesh is marked surveyed.")
      .add("diffuse", &SceneMesh::diffuse, "Diffuse reflection coefficient R, in [0, 1].")
      .add("weight", &SceneMesh::weight, "Weight of its voxels in coverage, 1 to 255.")
      .add("door", &SceneMesh::door, "A closed door leaf: open for people, closed for rays.")
      .add("station_area", &SceneMesh::station_area, "Stations may stand on it, whatever its role.")
      .add("detail_m", &SceneMesh::detail_m, "Widest beam footprint of points that count, metres; 0: any.")
      .add("accuracy_m", &SceneMesh::accuracy_m, "Largest range noise (sigma) of points that count, metres; 0: any.")
      .add("colour", &SceneMesh::colour, "Linear red, green, blue and alpha, in [0, 1].")
      .add<Vec3>(
          "translation", [](const SceneMesh& mesh) { return mesh.pose.translation; },
          [](SceneMesh& mesh, const Vec3& by) { mesh.pose.translation = by; }, "Moves its points, metres.")
      .add<std::array<double, 4>>(
          "rotation", [](const SceneMesh& mesh) { return mesh.pose.rotation; },
          [](SceneMesh& mesh, const std::array<double, 4>& by) { mesh.pose.rotation = by; },
          "Turns its points before they are moved: a quaternion (x, y, z, w).");
}

SceneMesh mesh_of(const Options<SceneMesh>& options, const Doubles& positions, const py::array& triangles,
                  const py::kwargs& given) {
  SceneMesh mesh = options.read(given);
  const auto points = rows_of<Vec3>(positions, "positions");
  mesh.positions.assign(points.begin(), points.end());
  mesh.triangles = triangles_of(triangles);
  return mesh;
}

void add_mesh_info(py::module_& m) {
  py::class_<MeshInfo> type(m, "MeshInfo", "One mesh of a scene.");
  type.def_readonly("name", &MeshInfo::name, "The node's name, or the mesh's if the node has none.")
      .def_property_readonly(
          "role", [](const MeshInfo& mesh) { return mesh.role; }, "'surveyed' or 'blocking'.")
      .def_readonly("diffuse", &MeshInfo::diffuse, "Diffuse reflection coefficient R, in [0, 1].")
      .def_readonly("triangle_count", &MeshInfo::triangle_count, "Number of triangles.")
      .def_readonly("weight", &MeshInfo::weight, "Weight of its voxels in coverage, 1 to 255.")
      .def_readonly("door", &MeshInfo::door, "A closed door leaf: open for people, closed for rays.")
      .def_readonly("station_area", &MeshInfo::station_area, "Stations may stand on it.")
      .def_readonly("glass", &MeshInfo::glass, "Rays pass it; people and stations do not.")
      .def_readonly("mirror", &MeshInfo::mirror, "Rays are reflected: it has no points of its own.")
      .def_readonly("detail_m", &MeshInfo::detail_m, "Widest beam footprint of points that count, metres; 0: any.")
      .def_readonly("accuracy_m", &MeshInfo::accuracy_m,
                    "Largest range noise (sigma) of points that count, metres; 0: any.")
      .def("__repr__", [](const MeshInfo& mesh) {
        return "<vantage.MeshInfo '" + mesh.name + "', " + name_of(mesh.role) + ", " +
               std::to_string(mesh.triangle_count) + " triangles>";
      });
  add_pickle(type);
}

void add_room(py::module_& m) {
  py::class_<Room> type(m, "Room", "A room that the file names, as IFC does.");
  type.def_readonly("name", &Room::name, "Its number and its long name.")
      .def_readonly("storey", &Room::storey, "Name of its storey; '' if there is none.")
      .def_property_readonly(
          "floor_m2", [](const Room& room) { return floor_area(room); }, "Area of its floor, m².")
      .def_property_readonly(
          "box",
          [](const Room& room) {
            return adopt(std::vector<Vec3>{room.box.min, room.box.max});
          },
          "Lowest and highest corner: (2, 3), metres.")
      .def_property_readonly(
          "outline",
          [](const Room& room) {
            std::vector<py::array_t<double>> loops;
            for (const auto& loop : room.outline) {
              auto& out = loops.emplace_back(std::vector<py::ssize_t>{static_cast<py::ssize_t>(loop.size()), 2});
              if (!loop.empty()) std::memcpy(out.mutable_data(), loop.data(), loop.size() * sizeof(loop[0]));
            }
            return loops;
          },
          "Loops around its floor, seen from above: (n, 2) each, metres; none: the box alone.")
      .def("__repr__", [](const Room& room) { return "<vantage.Room '" + room.name + "'>"; });
  add_pickle(type);
}

using GivenMoves = Typed<"Mapping[str, Any]">;
using GivenMeshes = Typed<"Sequence[Mapping[str, Any]]", py::sequence>;

// A translation, or a pair of a translation and a rotation.
Pose pose_of(const py::handle& given) {
  try {
    if (py::isinstance<py::sequence>(given) && py::len(given) == 2) {
      const auto [translation, rotation] = given.cast<std::pair<Vec3, std::array<double, 4>>>();
      return {translation, rotation};
    }
    return {given.cast<Vec3>()};
  } catch (const py::cast_error&) {
    throw py::type_error(
        "with_changes: move: a mesh goes by a translation (x, y, z), or by a pair of that and a rotation (x, y, z, w); "
        "not " +
        py::repr(given).cast<std::string>());
  }
}

Scene changed(const Scene& scene, const Options<SceneMesh>& options, const GivenMoves& move, const Globs& remove,
              const GivenMeshes& add) {
  SceneChange change;
  py::dict moves;
  moves.attr("update")(move);
  for (const auto& [pattern, pose] : moves) change.move.emplace_back(pattern.cast<std::string>(), pose_of(pose));
  change.remove = remove;
  for (const auto& mesh : add) {
    py::dict rest;
    rest.attr("update")(mesh);
    for (const char* const needed : {"positions", "triangles"})
      if (!rest.contains(needed))
        throw py::type_error(std::string("with_changes: add: a mesh is a dict with 'positions' and 'triangles'; ") +
                             needed + " is missing");
    const auto positions = rest.attr("pop")("positions").cast<Doubles>();
    const auto triangles = py::array(rest.attr("pop")("triangles"));
    change.add.push_back(mesh_of(options, positions, triangles, py::reinterpret_borrow<py::kwargs>(rest)));
  }
  const py::gil_scoped_release unlocked;
  return with_changes(scene, change);
}

void add_scene(py::module_& m) {
  const auto options = scene_options("Scene.load");
  const auto added = mesh_options("Scene.with_changes");
  py::class_<Scene>(m, "Scene",
                    "The 3D model of a site: surveyed and blocking surfaces, and the search area. Immutable.\nThe "
                    "survey frame is right-handed with Z up, in metres.")
      .def_static(
          "load",
          [options](const std::filesystem::path& file, const py::kwargs& given) {
            const SceneOptions how = options.read(given);
            const py::gil_scoped_release unlocked;
            return Scene::load(file, how);
          },
          py::arg("file"),
          ("Loads a glTF file, or a model of another format through the importer for it. Y up becomes Z up, (x, y, z) "
           "-> (x, -z, y), and other units become metres.\n"
           "Raises Error: io, malformed_file, invalid_argument, out_of_memory." +
           options.doc())
              .c_str())
      .def_static(
          "from_triangles",
          [](const Doubles& positions, const py::array& triangles, double diffuse) {
            return Scene::from_triangles(rows_of<Vec3>(positions, "positions"), triangles_of(triangles), diffuse);
          },
          py::arg("positions"), py::arg("triangles"), py::arg("diffuse") = 0.5,
          "One surveyed mesh: positions (n, 3), metres, survey frame; triangles (m, 3), indices of positions.\n"
          "Raises Error: invalid_argument, malformed_file (no triangle with area).")
      .def(
          "with_changes",
          [added](const Scene& scene, const GivenMoves& move, const Globs& remove, const GivenMeshes& add) {
            return changed(scene, added, move, remove, add);
          },
          py::kw_only(), py::arg("move") = py::dict(), py::arg("remove") = Globs{}, py::arg("add") = py::tuple(),
          "A scene with some meshes changed; `Simulator.set_scene` takes it. Patterns (`*`, `?`) are on the names of "
          "`meshes`.\nmove: {pattern: translation (x, y, z), metres, or (translation, rotation (x, y, z, w))}, from "
          "where the meshes stand,\nrotated about the origin of the survey frame, then moved; the first pattern that "
          "matches a mesh counts. remove: patterns.\nadd: dicts with the arguments of `SceneBuilder.add`, roles "
          "'surveyed' (None, too) or 'blocking'. Positions are rounded to\nfloat each time: change the first scene "
          "again rather than the last.\nRaises Error: invalid_argument, malformed_file (nothing is surveyed then), "
          "out_of_memory.")
      .def_property_readonly(
          "bounds",
          [](const Scene& scene) {
            const Box box = scene.bounds();
            return adopt(std::vector<Vec3>{box.min, box.max});
          },
          "Lowest and highest corner of all surveyed and blocking meshes: (2, 3), metres.")
      .def_property_readonly(
          "meshes",
          [](const Scene& scene) { return std::vector<MeshInfo>(scene.meshes().begin(), scene.meshes().end()); },
          "Its meshes, by the numbers that scans give them.")
      .def_property_readonly(
          "rooms", [](const Scene& scene) { return std::vector<Room>(scene.rooms().begin(), scene.rooms().end()); },
          "Rooms that the file names, in its order.")
      .def_property_readonly("triangle_count", &Scene::triangle_count, "Number over all meshes.")
      .def_property_readonly("has_search_area", &Scene::has_search_area, "Whether the file marks a search area.")
      .def_property_readonly(
          "notes",
          [](const Scene& scene) { return std::vector<std::string>(scene.notes().begin(), scene.notes().end()); },
          "Notes of the load: parts that were dropped or turned, a sentence each.")
      .def_property_readonly(
          "defaults", [](const Scene& scene) { return from_json(scene.defaults_json()); },
          "Default parameters of a built-in scene.")
      .def_property_readonly("fingerprint", &Scene::fingerprint, "Hash of everything that can change a result.")
      .def("__repr__", [](const Scene& scene) {
        return "<vantage.Scene of " + std::to_string(scene.meshes().size()) + " meshes, " +
               std::to_string(scene.triangle_count()) + " triangles>";
      });
}

void add_builder(py::module_& m) {
  const auto added = mesh_options("SceneBuilder.add"), replaced = mesh_options("SceneBuilder.replace");
  py::class_<SceneBuilder>(
      m, "SceneBuilder",
      "Makes scenes of meshes from arrays; meshes may be moved and replaced between one `build` and the next.")
      .def(py::init<>())
      .def(
          "add",
          [added](SceneBuilder& builder, const Doubles& positions, const py::array& triangles,
                  const py::kwargs& given) { return builder.add(mesh_of(added, positions, triangles, given)); },
          py::arg("positions"), py::arg("triangles"),
          ("Adds a mesh and returns its number, from 0. positions: (n, 3), metres, Z up; triangles: (m, 3), indices "
           "of\n"
           "positions, counter-clockwise from outside. Raises Error invalid_argument." +
           added.doc())
              .c_str())
      .def(
          "replace",
          [replaced](SceneBuilder& builder, std::size_t mesh, const Doubles& positions, const py::array& triangles,
                     const py::kwargs& given) {
            builder.replace(mesh, mesh_of(replaced, positions, triangles, given));
          },
          py::arg("mesh"), py::arg("positions"), py::arg("triangles"),
          ("Replaces mesh number `mesh`; the rest as in `add`." + replaced.doc()).c_str())
      .def(
          "move",
          [](SceneBuilder& builder, std::size_t mesh, const Vec3& translation, std::array<double, 4> rotation) {
            builder.move(mesh, {translation, rotation});
          },
          py::arg("mesh"), py::arg("translation") = Vec3{}, py::arg("rotation") = std::array<double, 4>{0, 0, 0, 1},
          "Moves mesh number `mesh`: metres, and a quaternion (x, y, z, w).")
      .def("build", &SceneBuilder::build,
           "The scene as it stands now. Raises Error malformed_file: nothing is surveyed.")
      .def_property_readonly("rebuilt_all", &SceneBuilder::rebuilt_all, "Whether the last `build` remade every mesh.")
      .def("__len__", &SceneBuilder::size);
}

}  // namespace

void add_scenes(py::module_& m) {
  add_mesh_info(m);
  add_room(m);
  add_scene(m);
  add_builder(m);
  const auto options = scene_options("load_gltf");
  m.def(
      "load_gltf",
      [options](const py::bytes& bytes, const std::string& name, const py::kwargs& given) {
        const std::string_view text = bytes;
        return load_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, options.read(given), name);
      },
      py::arg("bytes"), py::arg("name") = "glTF in memory",
      ("Loads a scene from the bytes of a .glb or .gltf file. Messages begin with `name`.\nRaises Error as "
       "`Scene.load`, "
       "and malformed_file if the file refers to another one." +
       options.doc())
          .c_str());
  m.def(
      "built_in_scene_names",
      [] {
        const auto names = built_in_scene_names();
        return std::vector<std::string>(names.begin(), names.end());
      },
      "Scenes that `write_built_in_scene` can make.");
  m.def(
      "write_built_in_scene",
      [](const std::string& name, const std::filesystem::path& file, std::size_t triangles) {
        write_built_in_scene(name, triangles, file);
      },
      py::arg("name"), py::arg("file"), py::arg("triangles") = 0, py::call_guard<py::gil_scoped_release>(),
      "Writes a built-in scene as GLB. triangles: for 'industrial', 20 000 and up; the others ignore it.\nRaises "
      "Error: invalid_argument, io.");
}

}  // namespace vantage::python
