// SPDX-License-Identifier: Apache-2.0
#include "random_meshes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>

#include "scene/positions.hpp"
#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"

namespace vantage::test {
namespace {

using Polygon = std::vector<std::uint32_t>;

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  if (std::abs(value) > 1e5) std::snprintf(text, sizeof text, "%.6f", value);
  return text;
}
std::string text_of(const glm::dvec3& p) { return text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z); }

template <class T>
void append_bytes(std::string& out, T value, bool big_endian = false) {
  std::array<char, sizeof(T)> bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

class Generator {
 public:
  Generator(std::uint64_t seed, const std::filesystem::path& folder) : rng_(seed), seed_(seed), folder_(folder) {}

  RandomMeshFile write() {
    using Write = void (Generator::*)();
    constexpr std::array<Write, 7> kWriters{&Generator::ply,     &Generator::stl,  &Generator::obj, &Generator::x3d,
                                            &Generator::collada, &Generator::gltf, &Generator::dxf};
    const Write writer = kWriters[seed_ % kWriters.size()];
    national_ = chance(0.4);
    const bool holes = writer == &Generator::collada;
    const int count = whole(2, 4);
    for (int k = 0; k < count; ++k) solids_.push_back(prism(k, holes && chance(0.5)));
    (this->*writer)();
    const bool named = !out_.truth.contains("");
    for (const Solid& solid : solids_) add(out_.truth[named ? solid.name : ""], solid);
    return std::move(out_);
  }

 private:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(rng_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(rng_); }
  bool chance(double p) { return between(0, 1) < p; }
  template <class T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
  }

  // In millimetres, so that texts of six decimals hold it.
  static glm::dvec3 rounded(const glm::dvec3& p) {
    return {std::round(p.x * 1e3) / 1e3, std::round(p.y * 1e3) / 1e3, std::round(p.z * 1e3) / 1e3};
  }

  // A star-shaped outline of random radii, so that many corners are concave.
  Solid prism(int number, bool hole) {
    if (number == 0 && national_)
      site_ = {std::round(between(3e5, 7e5)), std::round(between(5e6, 6e6)), std::round(between(10, 900))};
    Solid solid;
    solid.name = one_of({"wall ", "Tür ", "slab-", "Box."}) + std::to_string(number);
    const glm::dvec3 at = site_ + glm::dvec3(12.0 * number, between(-20, 20), between(0, 5));
    // A narrow triangle would not hold the hole.
    const int corners = std::max(whole(3, 9), hole ? 4 : 3);
    const double height = between(0.5, 4);
    const auto ring = [&](double low, double high) {
      std::vector<std::pair<double, double>> plan;
      for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * (k + between(0, 0.6)) / corners, radius = between(low, high);
        plan.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
      }
      return plan;
    };
    // Returns the first of the ring's points: all below, then all above.
    const auto extrude = [&](const std::vector<std::pair<double, double>>& plan, bool inner) {
      const auto first = static_cast<std::uint32_t>(solid.points.size());
      for (const double z : {0.0, height})
        for (const auto& [x, y] : plan) solid.points.push_back(rounded(at + glm::dvec3(x, y, z)));
      const auto n = static_cast<std::uint32_t>(plan.size());
      for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t a = first + k, b = first + (k + 1) % n;
        solid.faces.push_back({inner ? Polygon{b, a, a + n, b + n} : Polygon{a, b, b + n, a + n}, {}});
      }
      return first;
    };
    const auto run = [&](std::uint32_t first, bool reversed) {
      Polygon polygon;
      for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(corners); ++k) polygon.push_back(first + k);
      if (reversed) std::ranges::reverse(polygon);
      return polygon;
    };
    const std::uint32_t outer = extrude(ring(2, 5), false);
    Solid::Face below{run(outer, true), {}}, above{run(outer + static_cast<std::uint32_t>(corners), false), {}};
    if (hole) {
      const std::uint32_t inner = extrude(ring(0.3, 0.6), true);
      below.hole = run(inner, chance(0.5));
      above.hole = run(inner + static_cast<std::uint32_t>(corners), chance(0.5));
    }
    solid.faces.push_back(below), solid.faces.push_back(above);
    return solid;
  }

  static void add(Measures& to, const Solid& solid) {
    const auto fan = [&](const Polygon& polygon) {
      glm::dvec3 sum(0);
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        sum += cross(solid.points[polygon[k]] - solid.points[polygon[0]],
                     solid.points[polygon[k + 1]] - solid.points[polygon[0]]);
      return sum * 0.5;
    };
    for (const Solid::Face& face : solid.faces) {
      glm::dvec3 area = fan(face.outline);
      if (!face.hole.empty()) {
        const glm::dvec3 hole = fan(face.hole);
        area -= dot(hole, area) > 0 ? hole : -hole;
      }
      to.area_m2 += length(area);
      to.volume_m3 += dot(solid.points[face.outline[0]] - solid.points[0], area) / 3;
    }
    for (const glm::dvec3& p : solid.points) to.bounds.extend(to_vec3(p));
  }

  // Cut into triangles by ears, of the truth's own: small polygons alone.
  static std::vector<std::array<std::uint32_t, 3>> triangles(const Solid& solid, const Polygon& polygon) {
    std::vector<std::array<std::uint32_t, 3>> out;
    Polygon left = polygon;
    glm::dvec3 normal(0);
    for (std::size_t k = 1; k + 1 < left.size(); ++k)
      normal += cross(solid.points[left[k]] - solid.points[left[0]], solid.points[left[k + 1]] - solid.points[left[0]]);
    const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      return dot(cross(solid.points[b] - solid.points[a], solid.points[c] - solid.points[a]), normal);
    };
    while (left.size() > 3) {
      std::size_t ear = 0;
      for (; ear < left.size(); ++ear) {
        const std::uint32_t a = left[(ear + left.size() - 1) % left.size()], b = left[ear],
                            c = left[(ear + 1) % left.size()];
        const bool inside = std::ranges::any_of(left, [&](std::uint32_t p) {
          return p != a && p != b && p != c && side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0;
        });
        if (side(a, b, c) > 0 && !inside) break;
      }
      if (ear == left.size()) ear = 0;
      out.push_back({left[(ear + left.size() - 1) % left.size()], left[ear], left[(ear + 1) % left.size()]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    out.push_back({left[0], left[1], left[2]});
    return out;
  }
  static std::vector<std::array<std::uint32_t, 3>> triangles(const Solid& solid) {
    std::vector<std::array<std::uint32_t, 3>> out;
    for (const Solid::Face& face : solid.faces)
      for (const auto& t : triangles(solid, face.outline)) out.push_back(t);
    return out;
  }

  void save(const std::string& extension, const std::string& bytes, const std::string& choices) {
    out_.file = folder_ / ("random-" + std::to_string(seed_) + "." + extension);
    out_.what = extension + (national_ ? " national" : " local") + choices;
    std::ofstream(out_.file, std::ios::binary) << bytes;
  }

  // A unit and an axis for formats that tell neither: the options say them.
  void choose_axes() {
    out_.options.unit = one_of({Unit::metre, Unit::millimetre, Unit::foot, Unit::centimetre});
    out_.options.up = one_of({UpAxis::x, UpAxis::y, UpAxis::z});
  }
  glm::dvec3 in_axes(const glm::dvec3& p, Unit unit, UpAxis up) const {
    const glm::dvec3 q = up == UpAxis::z   ? p
                         : up == UpAxis::y ? glm::dvec3(p.x, p.z, -p.y)
                                           : glm::dvec3(p.z, -p.x, -p.y);
    return q * (1 / metres_in(unit));
  }
  glm::dvec3 in_file(const glm::dvec3& p) const { return in_axes(p, *out_.options.unit, *out_.options.up); }
  std::string axes_text() const {
    return std::string(" ") + to_string(*out_.options.unit) + " " + to_string(*out_.options.up);
  }

  void ply() {
    out_.truth[""];
    choose_axes();
    const int form = whole(0, 2);  // text, little endian, big endian
    const bool doubles = national_ || chance(0.5), strips = chance(0.4), cr = chance(0.3), narrow = chance(0.5);
    const std::string end = cr ? "\r\n" : "\n", number = doubles ? "double" : "float";
    std::string data, faces;
    std::size_t vertices = 0, count = 0;
    const auto put = [&](std::string& to, double value, const std::string& type) {
      if (form == 0)
        to += text_of(value) + " ";
      else if (type == "double")
        append_bytes(to, value, form == 2);
      else if (type == "float")
        append_bytes(to, static_cast<float>(value), form == 2);
      else if (type == "uchar")
        to += static_cast<char>(static_cast<unsigned char>(value));
      else
        append_bytes(to, static_cast<std::int32_t>(value), form == 2);
    };
    const auto line = [&](std::string& to) {
      if (form == 0) to += end;
    };
    std::vector<Polygon> lists;
    Polygon strip;
    for (const Solid& solid : solids_) {
      const auto first = static_cast<std::uint32_t>(vertices);
      for (const glm::dvec3& p : solid.points) {
        const glm::dvec3 q = in_file(p);
        // Its first byte may be that of a line end.
        put(data, 10, "uchar");
        for (int c = 0; c < 3; ++c) put(data, q[c], number);
        line(data);
        ++vertices;
      }
      if (strips) {
        for (const auto& t : triangles(solid)) {
          for (const std::uint32_t v : t) strip.push_back(first + v);
          strip.push_back(0xFFFFFFFF);
        }
      } else {
        for (const Solid::Face& face : solid.faces) {
          Polygon polygon = face.outline;
          for (std::uint32_t& v : polygon) v += first;
          lists.push_back(polygon);
        }
      }
    }
    if (strips) lists = {strip};
    for (const Polygon& list : lists) {
      put(faces, static_cast<double>(list.size()), strips || !narrow ? "int" : "uchar");
      for (const std::uint32_t v : list) put(faces, static_cast<double>(static_cast<std::int32_t>(v)), "int");
      if (!strips) put(faces, 7, "uchar");
      line(faces);
    }
    count = lists.size();
    std::string header =
        "ply" + end + "format " +
        std::array{"ascii", "binary_little_endian", "binary_big_endian"}[static_cast<std::size_t>(form)] + " 1.0" +
        end + "comment made by a test" + end + "obj_info none" + end + "element vertex " + std::to_string(vertices) +
        end + "property uchar quality" + end;
    for (const char* axis : {"x", "y", "z"}) header += "property " + number + " " + axis + end;
    header += (strips ? "element tristrips " : "element face ") + std::to_string(count) + end + "property list " +
              (strips || !narrow ? "int" : "uchar") + " int " + (narrow || strips ? "vertex_indices" : "vertex_index") +
              end;
    if (!strips) header += "property uchar flags" + end;
    save("ply", header + "end_header" + end + data + faces,
         axes_text() + " form " + std::to_string(form) + (doubles ? " double" : "") + (strips ? " strips" : "") +
             (cr ? " CR" : ""));
  }

  void stl() {
    choose_axes();
    const bool binary = !national_ && chance(0.4);
    std::string out;
    if (binary) {
      out_.truth[""];
      std::uint32_t count = 0;
      for (const Solid& solid : solids_) count += static_cast<std::uint32_t>(triangles(solid).size());
      out = chance(0.5) ? "solid although binary" : "made by a test";
      out.resize(80, ' ');
      append_bytes(out, count);
      for (const Solid& solid : solids_)
        for (const auto& t : triangles(solid)) {
          out.append(12, '\0');
          for (const std::uint32_t v : t)
            for (int c = 0; c < 3; ++c) append_bytes(out, static_cast<float>(in_file(solid.points[v])[c]));
          out.append(2, '\0');
        }
    } else {
      for (const Solid& solid : solids_) {
        if (chance(0.4)) out += "solid empty\nendsolid empty\n";
        out += "solid " + solid.name + "\n";
        for (const auto& t : triangles(solid)) {
          out += "  facet normal 0 0 0\n    outer loop\n";
          for (const std::uint32_t v : t) out += "      vertex " + text_of(in_file(solid.points[v])) + "\n";
          out += "    endloop\n  endfacet\n";
        }
        out += "endsolid " + solid.name + "\n";
      }
    }
    save("stl", out, axes_text() + (binary ? " binary" : ""));
  }

  void obj() {
    choose_axes();
    const bool relative = chance(0.4), groups = chance(0.3), reopened = chance(0.5), unused = chance(0.3);
    std::string out = "# a test\nmtllib none of\n";
    std::size_t vertices = 0;
    if (unused) out += "v 0 0 0\n", ++vertices;
    std::string later;
    for (const Solid& solid : solids_) {
      const std::size_t first = vertices;
      out += (groups ? "g " : "o ") + solid.name + "\n";
      for (const glm::dvec3& p : solid.points) {
        out += "v " + text_of(in_file(p)) + (chance(0.1) ? " 1.0\n" : "\n");
        ++vertices;
      }
      const auto faces = [&](std::size_t begin, std::size_t end, bool back) {
        std::string text;
        for (std::size_t f = begin; f < end; ++f) {
          text += "f";
          for (const std::uint32_t v : solid.faces[f].outline) {
            const auto number = static_cast<long>(first + v + 1);
            text += " " + std::to_string(back ? number - 1 - static_cast<long>(vertices) : number);
            if (chance(0.05)) text += " \\\n";
          }
          text += "\n";
        }
        return text;
      };
      const std::size_t half = reopened ? solid.faces.size() / 2 : solid.faces.size();
      out += faces(0, half, relative);
      if (reopened) later += (groups ? "g " : "o ") + solid.name + "\n" + faces(half, solid.faces.size(), false);
    }
    save("obj", out + later,
         axes_text() + (relative ? " relative" : "") + (groups ? " groups" : "") + (reopened ? " reopened" : ""));
  }

  void x3d() {
    const double metres = one_of({1.0, 0.001, 0.3048});
    std::string scene, choices;
    for (const Solid& solid : solids_) {
      // Either the coordinates or a transform have the place.
      const glm::dvec3 at = chance(0.5) ? rounded(solid.points[0]) : glm::dvec3(0);
      const auto in_x3d = [&](const glm::dvec3& p) { return in_axes(p, Unit::metre, UpAxis::y) * (1 / metres); };
      std::string points, indices;
      for (const glm::dvec3& p : solid.points) points += text_of(in_x3d(p - at)) + ", ";
      const bool ccw = chance(0.6);
      const int form = whole(0, 2);
      const auto put = [&](Polygon polygon, bool separated) {
        if (!ccw) std::ranges::reverse(polygon);
        for (const std::uint32_t v : polygon) indices += std::to_string(v) + " ";
        if (separated) indices += "-1 ";
      };
      if (form == 0)
        for (const Solid::Face& face : solid.faces) put(face.outline, true);
      else
        for (const auto& t : triangles(solid)) put({t[0], t[1], t[2]}, form == 2);
      const std::string node =
          std::array{"IndexedFaceSet", "IndexedTriangleSet", "IndexedTriangleStripSet"}[static_cast<std::size_t>(form)];
      std::string shape = "<Shape><" + node + (ccw ? "" : " ccw='false'") + (form == 0 ? " coordIndex='" : " index='") +
                          indices + "'><Coordinate" + (chance(0.5) ? "Double" : "") + " point='" + points + "'/></" +
                          node + "></Shape>";
      // An outer node of any kind; the first child of a LOD is the finest.
      const int outer = whole(0, 6);
      const std::string coarse = "<Shape><Box size='1 1 1'/></Shape>";
      choices += " " + node + (ccw ? "" : " cw") + std::to_string(outer);
      if (outer == 1)
        shape = "<Collision>" + shape + "<Group containerField='proxy'>" + coarse + "</Group></Collision>";
      if (outer == 2) shape = "<LOD range='10'>" + shape + coarse + "</LOD>";
      if (outer == 3) shape = "<Switch whichChoice='1'>" + coarse + shape + "</Switch>";
      if (outer == 4) shape = "<Anchor url='\"a.html\"'>" + shape + "</Anchor>";
      if (outer == 5) shape = "<Billboard>" + shape + "</Billboard>";
      if (outer == 6) shape = "<StaticGroup><Group>" + shape + "</Group></StaticGroup>";
      scene +=
          "<Transform DEF='" + solid.name + "' translation='" + text_of(in_x3d(at)) + "'>" + shape + "</Transform>\n";
    }
    save("x3d",
         "<?xml version='1.0' encoding='UTF-8'?>\n<X3D profile='Immersive' version='3.3'><head>"
         "<unit category='length' name='own' conversionFactor='" +
             text_of(metres) + "'/></head><Scene>\n<Viewpoint/>" + scene + "</Scene></X3D>\n",
         choices);
  }

  void collada() {
    const Unit unit = one_of({Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch});
    const UpAxis up = one_of({UpAxis::x, UpAxis::y, UpAxis::z});
    std::string geometries, nodes, others, choices;
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      const Solid& solid = solids_[s];
      const std::string id = "g" + std::to_string(s);
      const glm::dvec3 at = chance(0.5) ? rounded(solid.points[0]) : glm::dvec3(0);
      std::string points, list;
      const bool padded = chance(0.3);  // a fourth number that has no name
      for (const glm::dvec3& p : solid.points) points += text_of(in_axes(p - at, unit, up)) + (padded ? " 1 " : " ");
      const bool holes = std::ranges::any_of(solid.faces, [](const auto& face) { return !face.hole.empty(); });
      const int form = holes ? 0 : whole(0, 3);
      choices += " form " + std::to_string(form);
      const auto numbers = [](const auto& polygon) {
        std::string text;
        for (const std::uint32_t v : polygon) text += std::to_string(v) + " ";
        return text;
      };
      const std::string input = "<input semantic='VERTEX' source='#" + id + "-v' offset='0'/>";
      std::string counts;
      if (form == 0) {
        for (const Solid::Face& face : solid.faces)
          list += face.hole.empty() ? "<p>" + numbers(face.outline) + "</p>"
                                    : "<ph><p>" + numbers(face.outline) + "</p><h>" + numbers(face.hole) + "</h></ph>";
        list = "<polygons>" + input + list + "</polygons>";
      } else if (form == 1) {
        for (const Solid::Face& face : solid.faces)
          counts += std::to_string(face.outline.size()) + " ", list += numbers(face.outline);
        list = "<polylist count='" + std::to_string(solid.faces.size()) + "'>" + input + "<vcount>" + counts +
               "</vcount><p>" + list + "</p></polylist>";
      } else {
        for (const auto& t : triangles(solid))
          list += (form == 3 ? "<p>" : "") + numbers(t) + (form == 3 ? "</p>" : "");
        list = form == 2 ? "<triangles>" + input + "<p>" + list + "</p></triangles>"
                         : std::string(chance(0.5) ? "<tristrips>" : "<trifans>") + input + list;
        if (form == 3) list += list.starts_with("<tristrips>") ? "</tristrips>" : "</trifans>";
      }
      const std::string stride = padded ? "4" : "3";
      geometries += "<geometry id='" + id + "'><mesh><source id='" + id + "-p'><float_array id='" + id +
                    "-a' count='0'>" + points + "</float_array><technique_common><accessor source='#" + id +
                    "-a' count='" + std::to_string(solid.points.size()) + "' stride='" + stride +
                    "'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' type='float'/>" +
                    (padded ? "<param type='float'/>" : "") + "</accessor></technique_common></source><vertices id='" +
                    id + "-v'><input semantic='POSITION' source='#" + id + "-p'/></vertices>" + list +
                    "</mesh></geometry>\n";
      std::string place = "<translate>" + text_of(in_axes(at, unit, up)) + "</translate>";
      if (chance(0.4))
        place += "<rotate>0 0 1 90</rotate><rotate>0 0 1 -90</rotate><scale>2 2 2</scale><scale>0.5 0.5 0.5</scale>";
      const std::string body = place + "<instance_geometry url='#" + id + "'/></node>\n";
      if (chance(0.3)) {
        others += "<node id='o" + std::to_string(s) + "' name='" + solid.name + "'>" + body;
        nodes += "<node id='i" + std::to_string(s) + "'><instance_node url='#o" + std::to_string(s) + "'/></node>\n";
      } else {
        nodes += "<node id='n" + std::to_string(s) + "' name='" + solid.name + "'>" + body;
      }
    }
    save("dae",
         "<?xml version='1.0' encoding='utf-8'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit name='own' meter='" +
             text_of(metres_in(unit)) + "'/><up_axis>" +
             (up == UpAxis::x   ? "X"
              : up == UpAxis::y ? "Y"
                                : "Z") +
             "_UP</up_axis></asset>\n<library_geometries>" + geometries + "</library_geometries>" +
             (others.empty() ? "" : "<library_nodes>" + others + "</library_nodes>") +
             "<library_visual_scenes><visual_scene id='s'>" + nodes +
             "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>\n",
         " " + std::string(to_string(unit)) + " " + to_string(up) + choices);
  }

  void gltf() {
    GlbBuilder builder;
    std::string choices;
    const bool doubles = chance(0.5), restart = chance(0.5), levels = chance(0.4);
    for (const Solid& solid : solids_) {
      const glm::dvec3 at = national_ && !doubles ? rounded(solid.points[0]) : glm::dvec3(0);
      std::vector<double> wide;
      std::vector<std::uint16_t> indices;
      for (const glm::dvec3& p : solid.points) {
        const glm::dvec3 q = in_axes(p - at, Unit::metre, UpAxis::y);
        wide.insert(wide.end(), {q.x, q.y, q.z});
      }
      const std::vector<float> narrow(wide.begin(), wide.end());
      const auto all = triangles(solid);
      for (const auto& t : all) {
        for (const std::uint32_t v : t) indices.push_back(static_cast<std::uint16_t>(v));
        if (restart && &t != &all.back()) indices.push_back(0xFFFF);
      }
      const int position = doubles ? builder.accessor(wide, 5130, "VEC3") : builder.positions(narrow);
      const int mesh = builder.mesh({{"attributes", {{"POSITION", position}}},
                                     {"indices", builder.accessor(indices, 5123, "SCALAR")},
                                     {"mode", restart ? (chance(0.5) ? 5 : 6) : 4}});
      const glm::dvec3 place = in_axes(at, Unit::metre, UpAxis::y);
      const int node =
          builder.node({{"name", solid.name}, {"mesh", mesh}, {"translation", {place.x, place.y, place.z}}});
      if (levels) {
        const int coarse = builder.node({{"name", "coarse"}, {"mesh", mesh}, {"scale", {3, 3, 3}}});
        builder.json["nodes"][static_cast<std::size_t>(node)]["extensions"]["MSFT_lod"]["ids"] = {coarse};
      }
    }
    std::vector<std::string> required;
    if (doubles) required.emplace_back("KHR_accessor_float64");
    if (restart) required.emplace_back("KHR_mesh_primitive_restart");
    if (!required.empty()) builder.json["extensionsRequired"] = required;
    if (levels) required.emplace_back("MSFT_lod");
    if (!required.empty()) builder.json["extensionsUsed"] = required;
    out_.options.unit = Unit::metre, out_.options.up = UpAxis::y;
    save("glb", builder.glb(),
         std::string(doubles ? " double" : "") + (restart ? " restart" : "") + (levels ? " levels" : ""));
  }

  // Each solid on a layer of its own: as faces, a mesh of faces or a MESH; as it is, or in a block that is turned, and
  // perhaps mirrored, where it is placed.
  void dxf() {
    struct DxfUnit {
      int code;
      double metres;
    };
    const DxfUnit unit = one_of({DxfUnit{4, 0.001}, DxfUnit{6, 1}, DxfUnit{2, 0.3048}, DxfUnit{5, 0.01}});
    const auto group = [](int code, const std::string& value) { return std::to_string(code) + "\n" + value + "\n"; };
    const auto at = [&](int code, const glm::dvec3& p) {
      std::string out;
      for (int c = 0; c < 3; ++c) out += group(code + 10 * c, text_of(p[c] / unit.metres));
      return out;
    };
    std::string blocks, entities, choices;
    for (const Solid& solid : solids_) {
      const bool placed = chance(0.6), mirrored = placed && chance(0.4), by_insert = placed && chance(0.5);
      const glm::dvec3 origin = placed ? rounded(solid.points[0]) : glm::dvec3(0);
      const double angle = placed ? between(0, 2 * std::numbers::pi) : 0;
      const std::string layer = by_insert ? "0" : solid.name;
      const auto local = [&](std::uint32_t v) {
        const glm::dvec3 q = solid.points[v] - origin;
        const glm::dvec3 turned{std::cos(angle) * q.x + std::sin(angle) * q.y,
                                std::cos(angle) * q.y - std::sin(angle) * q.x, q.z};
        return mirrored ? glm::dvec3(-turned.x, turned.y, turned.z) : turned;
      };
      // A block's faces show outward in its own coordinates.
      const auto wound = [&](auto polygon) {
        if (mirrored) std::ranges::reverse(polygon);
        return polygon;
      };
      std::string drawn;
      const int form = whole(0, 2);
      if (form == 0) {
        for (const auto& t : triangles(solid)) {
          drawn += group(0, "3DFACE") + group(8, layer);
          const auto corners = wound(t);
          for (int k = 0; k < 4; ++k) drawn += at(10 + k, local(corners[static_cast<std::size_t>(std::min(k, 2))]));
        }
      } else if (form == 1) {
        drawn += group(0, "POLYLINE") + group(8, layer) + group(66, "1") + group(70, "64");
        const auto vertex = [&](const std::string& groups) { drawn += group(0, "VERTEX") + group(8, layer) + groups; };
        for (std::uint32_t v = 0; v < solid.points.size(); ++v) vertex(at(10, local(v)) + group(70, "192"));
        for (const auto& t : triangles(solid)) {
          std::string groups = at(10, glm::dvec3(0)) + group(70, "128");
          int code = 71;
          for (const std::uint32_t v : wound(t))
            groups += group(code++, (chance(0.3) ? "-" : "") + std::to_string(v + 1));
          vertex(groups);
        }
        drawn += group(0, "SEQEND");
      } else {
        std::string faces;
        std::size_t numbers = 0;
        for (const Solid::Face& face : solid.faces) {
          faces += group(90, std::to_string(face.outline.size()));
          for (const std::uint32_t v : wound(face.outline)) faces += group(90, std::to_string(v));
          numbers += face.outline.size() + 1;
        }
        drawn += group(0, "MESH") + group(8, layer) + group(71, "2") + group(91, "0") +
                 group(92, std::to_string(solid.points.size()));
        for (std::uint32_t v = 0; v < solid.points.size(); ++v) drawn += at(10, local(v));
        drawn += group(93, std::to_string(numbers)) + faces + group(94, "0") + group(95, "0") + group(90, "0");
      }
      choices += std::string(placed ? " placed" : " drawn") + (mirrored ? " mirrored" : "") + std::to_string(form);
      if (!placed) {
        entities += drawn;
        continue;
      }
      const std::string name = "B" + solid.name;
      blocks += group(0, "BLOCK") + group(8, "0") + group(2, name) + group(70, "0") + at(10, glm::dvec3(0)) + drawn +
                group(0, "ENDBLK");
      entities += group(0, "INSERT") + group(8, by_insert ? solid.name : "0") + group(2, name) + at(10, origin) +
                  group(41, mirrored ? "-1" : "1") + group(50, text_of(angle * 180 / std::numbers::pi));
    }
    const auto section = [&](const std::string& name, const std::string& content) {
      return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
    };
    save("dxf",
         section("HEADER", group(9, "$INSUNITS") + group(70, std::to_string(unit.code))) + section("BLOCKS", blocks) +
             section("ENTITIES", entities) + group(0, "EOF"),
         " unit " + std::to_string(unit.code) + choices);
  }

  std::mt19937_64 rng_;
  const std::uint64_t seed_;
  const std::filesystem::path folder_;
  bool national_ = false;
  glm::dvec3 site_{0};
  std::vector<Solid> solids_;
  RandomMeshFile out_;
};

}  // namespace

RandomMeshFile write_random_mesh(std::uint64_t seed, const std::filesystem::path& folder) {
  return Generator(seed, folder).write();
}

std::map<std::string, Measures> measures_of(const Scene& scene, bool all) {
  std::map<std::string, Measures> out;
  const SceneData& data = scene.data();
  for (std::size_t m = 0; m < data.ranges.size(); ++m) {
    Measures& to = out[all ? "" : data.meshes[m].name];
    const MeshRange& range = data.ranges[m];
    if (range.triangle_count == 0) continue;
    const glm::dvec3 from = corners_of(data, range.first_triangle)[0];  // of a closed solid, any point will do
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
      const auto [a, b, c] = corners_of(data, t);
      const glm::dvec3 area = cross(b - a, c - a) * 0.5;
      to.area_m2 += length(area);
      to.volume_m3 += dot(a - from, area) / 3;
      for (const glm::dvec3& p : {a, b, c}) to.bounds.extend(to_vec3(p) + data.origin);
    }
  }
  return out;
}

}  // namespace vantage::test
