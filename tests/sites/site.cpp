// SPDX-License-Identifier: Apache-2.0
#include "sites/site.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <tuple>

#include "support/glb_builder.hpp"

namespace vantage::sites {

const char* to_string(Surface surface) {
  switch (surface) {
    case Surface::floor: return "floor";
    case Surface::covered: return "covered";
    case Surface::furniture: return "furniture";
    case Surface::equipment: return "equipment";
    case Surface::car: return "car";
    case Surface::tree: return "tree";
    case Surface::roof: return "roof";
    case Surface::wall_top: return "wall top";
    case Surface::sealed: return "sealed";
    case Surface::inside: return "inside";
    case Surface::air: return "air";
    case Surface::outside: return "outside";
  }
  return "?";
}

}  // namespace vantage::sites

namespace vantage::test {
namespace {

constexpr Vec3 kUtm{500000, 5400000, 400};

// True if p lies left of the line through a and b, seen from above. Each edge is tested in one direction only, so that
// a point on it is in exactly one of its two triangles.
bool left_of(const Vec3& a, const Vec3& b, const Vec3& p) {
  if (std::tie(b.x, b.y) < std::tie(a.x, a.y)) return !left_of(b, a, p);
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0;
}

struct Crossing {
  double z;
  bool upward;  // the upper side of something
};

// Intersections of the vertical line through p with the part.
std::vector<Crossing> crossings(const Part& part, const Vec3& p) {
  std::vector<Crossing> out;
  for (const auto& t : part.triangles) {
    const Vec3 &a = part.positions[t[0]], &b = part.positions[t[1]], &c = part.positions[t[2]];
    if (p.x < std::min({a.x, b.x, c.x}) || p.x > std::max({a.x, b.x, c.x})) continue;
    const bool side = left_of(a, b, p);
    if (side != left_of(b, c, p) || side != left_of(c, a, p)) continue;
    const Vec3 normal = cross(b - a, c - a);
    if (normal.z == 0) continue;
    out.push_back({a.z - (normal.x * (p.x - a.x) + normal.y * (p.y - a.y)) / normal.z, normal.z > 0});
  }
  return out;
}

}  // namespace

Standing KnownSite::at(const Vec3& ground) const {
  const Vec3 p = ground - offset;
  const double above = p.z + 1.01 * kTouch_m;
  const Part* under = nullptr;
  double under_z = 0, ceiling = std::numeric_limits<double>::infinity();
  bool on_site = false;
  for (const Part& part : parts) {
    int shells = 0;  // shells around the point above the ground
    for (const Crossing& c : crossings(part, p)) {
      on_site = true;
      if (c.z > above) {
        shells += c.upward ? 1 : -1;
        if (!c.upward) ceiling = std::min(ceiling, c.z);
      } else if (c.upward && c.z >= p.z - kTouch_m && (!under || c.z > under_z)) {
        under = &part, under_z = c.z;
      }
    }
    if (shells > 0) return {Surface::inside, part.name, 0};
  }
  if (!on_site) return {};
  if (!under) return {Surface::air, {}, 0};
  Standing standing{under->top, under->name, 0};
  for (const Place& place : places)
    if (p.x >= place.x0 && p.x <= place.x1 && p.y >= place.y0 && p.y <= place.y1 &&
        std::abs(p.z - place.z) <= kTouch_m && under->top == Surface::floor) {
      standing.place = place.name, standing.storey = place.storey;
      break;
    }
  if (standing.surface == Surface::floor && ceiling - p.z < kUpright_m) standing.surface = Surface::covered;
  return standing;
}

std::span<const char* const> site_names() {
  static constexpr const char* kNames[] = {"office", "house", "street", "plant"};
  return kNames;
}

KnownSite make_site(const std::string& name, const Variant& variant) {
  KnownSite site{name == "office"   ? sites::office()
                 : name == "house"  ? sites::house()
                 : name == "street" ? sites::street()
                 : name == "plant"  ? sites::plant()
                                    : throw std::invalid_argument("no site is called " + name)};
  site.name = name;
  if (variant.utm) site.offset = kUtm;
  site.entry = site.entry + site.offset;
  return site;
}

void write_site(const KnownSite& site, const Variant& variant, const std::filesystem::path& file) {
  const double unit = variant.millimetres ? 1000 : variant.per_metre;
  const auto file_from_survey = [&](const Vec3& p) { return variant.z_up ? p * unit : Vec3{p.x, p.z, -p.y} * unit; };
  GlbBuilder glb;
  const Vec3 root = file_from_survey(site.offset);
  nlohmann::json top = nlohmann::json::object();
  if (!variant.nameless) top["name"] = site.name;
  if (variant.utm) top["translation"] = {root.x, root.y, root.z};
  const int parent = glb.node(top);
  std::mt19937 turns(variant.wound);
  for (const Part& part : site.parts) {
    std::vector<float> positions;
    Box bounds;
    for (const Vec3& p : part.positions) {
      const Vec3 q = file_from_survey(p);
      for (const double v : {q.x, q.y, q.z}) positions.push_back(static_cast<float>(v));
      bounds.extend({positions.end()[-3], positions.end()[-2], positions.end()[-1]});
    }
    std::vector<std::uint32_t> indices;
    for (const auto& t : part.triangles) indices.insert(indices.end(), t.begin(), t.end());
    if (variant.wound != 0)
      for (std::size_t face = 0; face < indices.size(); face += 6)
        if (turns() % 2)
          for (std::size_t t = face; t < std::min(face + 6, indices.size()); t += 3)
            std::swap(indices[t + 1], indices[t + 2]);
    const int points = glb.positions(positions);
    glb.json["accessors"].back()["min"] = {bounds.min.x, bounds.min.y, bounds.min.z};
    glb.json["accessors"].back()["max"] = {bounds.max.x, bounds.max.y, bounds.max.z};
    const int corners = glb.accessor(indices, 5125, "SCALAR");
    const int material = static_cast<int>(glb.json["materials"].size());
    glb.json["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {part.colour[0], part.colour[1], part.colour[2], 1}}}}});
    const int mesh = glb.mesh({{"attributes", {{"POSITION", points}}}, {"indices", corners}, {"material", material}});
    nlohmann::json node{{"mesh", mesh}};
    if (!variant.nameless) node["name"] = part.name;
    glb.child(parent, node);
  }
  glb.write_glb(file);
}

}  // namespace vantage::test
