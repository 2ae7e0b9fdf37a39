// SPDX-License-Identifier: Apache-2.0
#include "candidates/somewhere_to_stand.hpp"

#include <cmath>
#include <sstream>

#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::size_t kTriedPlaces = 20'000;

double area_of(const SearchMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
  const double area = 0.5 * std::sqrt(dot(n, n));
  return std::isfinite(area) ? area : 0;
}

}  // namespace

void require_somewhere_to_stand(Site& site, std::span<const double> heights_m) {
  const SearchArea& area = site.area();
  const ClashChecker& clash = site.clash();
  const SearchMesh& mesh = area.mesh();
  double total = 0;
  for (const auto& t : mesh.triangles) total += area_of(mesh, t);
  // Places lie at equal shares of the area along the list of triangles; within a triangle they follow two sequences
  // without a common period.
  const double share = total / static_cast<double>(kTriedPlaces);
  double due = 0.5 * share, passed = 0;
  std::size_t places = 0, holes = 0, k = 0;
  for (const auto& t : mesh.triangles) {
    passed += area_of(mesh, t);
    for (; due < passed && places < kTriedPlaces; due += share, ++k) {
      double s = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(k + 1), 1.0);
      double r = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(k + 1), 1.0);
      if (s + r > 1) s = 1 - s, r = 1 - r;
      const Uv a = mesh.uvs[t[0]], b = mesh.uvs[t[1]], c = mesh.uvs[t[2]];
      const auto ground = area.locate({(1 - s - r) * a.u + s * b.u + r * c.u, (1 - s - r) * a.v + s * b.v + r * c.v});
      ++places;
      if (!ground) {
        ++holes;
        continue;
      }
      for (const double height : heights_m)
        if (!clash.clashes(*ground, height)) return;
    }
  }
  const SecurityVolume& volume = clash.volume();
  std::ostringstream text;
  text << "there is no place to stand: of " << places << " places spread over the search area of " << total
       << " m², every one clashes with something";
  if (holes > 0) text << " or lies outside of the limits (" << holes << ")";
  text << "; a smaller security volume than " << volume.lower_m << "," << volume.upper_m << "," << volume.radius_m
       << ", another search area or fewer meshes around it would help";
  throw Error(Errc::malformed_file, text.str());
}

}  // namespace vantage
