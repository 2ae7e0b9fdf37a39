// SPDX-License-Identifier: Apache-2.0
#include "sites/random_site.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "generate/sites/shapes.hpp"
#include "sites/strange_sites.hpp"

namespace vantage::test {
namespace {

using sites::add_block;
using sites::add_part;
using sites::block;
using sites::carve;

constexpr double kOuter = 0.3, kInner = 0.15;
constexpr std::array<std::array<const char*, 6>, 5> kWords{{{"wall", "floor", "stair", "table", "door", "column"},
                                                            {"Wand", "Decke", "Treppe", "Tisch", "Tür", "Stütze"},
                                                            {"mur", "dalle", "escalier", "table", "porte", "poteau"},
                                                            {"стена", "плита", "лестница", "стол", "дверь", "колонна"},
                                                            {"壁", "床", "階段", "机", "ドア", "柱"}}};
enum Word { wall_, floor_, stair_, table_, door_, column_ };

class Maker {
 public:
  // `together`: all leaves of doors are one mesh.
  Maker(std::uint64_t seed, bool together) : random_(seed), together_(together) {
    language_ = below(kWords.size() + 1);
    made_.site.name = "random";
  }

  // `strange`: one of these kinds.
  RandomSite make(std::optional<std::size_t> strange) {
    const double kind = uniform(0, 1);
    if (strange)
      make_strange(made_, *strange,
                   {[this](double low, double high) { return uniform(low, high); },
                    [this](const char* english) { return word(english); }});
    else if (kind < 0.7)
      building();
    else if (kind < 0.85)
      hall();
    else
      tunnel();
    constexpr double kUnits[] = {1, 100, 1000, 1 / 0.0254, 1 / 0.3048};
    const std::size_t unit = chance(0.4) ? 0 : below(5);
    made_.variant.per_metre = kUnits[unit];
    made_.variant.z_up = chance(0.5), made_.variant.utm = chance(0.3),
    made_.variant.nameless = chance(0.2) && !made_.named;
    if (made_.variant.utm) made_.site.offset = {500000, 5400000, 400};
    constexpr const char* kNames[] = {"m", "cm", "mm", "in", "ft"};
    made_.told += std::string(", in ") + kNames[unit] + (made_.variant.z_up ? ", Z up" : ", Y up") +
                  (made_.variant.utm ? ", UTM" : "") + (made_.variant.nameless ? ", nameless" : "");
    return std::move(made_);
  }

 private:
  double uniform(double low, double high) {
    random_ = random_ * 6364136223846793005ULL + 1442695040888963407ULL;
    std::uint64_t x = random_ ^ (random_ >> 33);
    x *= 0xff51afd7ed558ccdULL, x ^= x >> 33;
    return low + (high - low) * static_cast<double>(x >> 11) / 9007199254740992.0;
  }
  bool chance(double share) { return uniform(0, 1) < share; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform(0, static_cast<double>(n))); }

  // Returns a name in the site's language, or something like a GUID.
  std::string name(Word word) {
    const std::string number = std::to_string(++named_);
    if (language_ < kWords.size()) return std::string(kWords[language_][word]) + " " + number;
    return "3vB2YO$MX4xv5uCqZZG0" + number;
  }

  // The same for words of strange sites, in which only the name tells water.
  std::string word(const char* english) {
    constexpr std::array<const char*, 5> kWater{"water", "Wasser", "eau", "вода", "水"};
    const std::string number = " " + std::to_string(++named_);
    if (std::string_view(english) == "water") return kWater[language_ % kWater.size()] + number;
    return english + number;
  }

  // A rectangular building of rooms in rows; storeys over each other, with stairs in the first room.
  void building() {
    const std::size_t columns = 1 + below(4), rows = 1 + below(3), storeys = 1 + below(3);
    const bool lawn = chance(0.6), stairs = storeys > 1 && chance(0.8), entrance = chance(0.9);
    const double height = uniform(2.5, 3.3), slab = uniform(0.2, 0.3);
    std::vector<double> x{0}, y{0};
    for (std::size_t i = 0; i < columns; ++i) x.push_back(x.back() + (i == 0 ? uniform(3.9, 5) : uniform(2.6, 6)));
    for (std::size_t i = 0; i < rows; ++i) y.push_back(y.back() + (i == 0 ? uniform(7.6, 9) : uniform(2.8, 6)));
    const double x1 = x.back(), y1 = y.back(), storey = height + slab;
    const int rises = static_cast<int>(std::ceil(storey / 0.18));
    const double going = 0.26, rise = storey / rises, flight = going * rises;
    std::vector<Box> slabs, holes_in_slabs;
    for (std::size_t s = 0; s <= storeys; ++s)
      slabs.push_back(block(0, x1, 0, y1, static_cast<double>(s) * storey - slab, static_cast<double>(s) * storey));
    std::vector<Box> walls, openings;
    std::vector<std::array<double, 4>> middles;
    const std::size_t rooms = columns * rows;
    std::vector<std::size_t> group(rooms * storeys);
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (group[i] != i) i = group[i];
      return i;
    };
    std::vector<Box> leaves;
    const auto opening = [&](double a0, double a1, double at, double thick, bool along_x, double z, bool leaf) {
      const double wide = uniform(0.8, 1.1), high = uniform(2.0, 2.15);
      const double from = a0 + 0.3 + uniform(0, std::max(0.01, a1 - a0 - 0.6 - wide));
      const Box hole = along_x ? block(from, from + wide, at, at + thick, z, z + high)
                               : block(at, at + thick, from, from + wide, z, z + high);
      openings.push_back(hole);
      const double middle = at + thick / 2;
      if (leaf)
        leaves.push_back(along_x ? block(from, from + wide, middle - 0.02, middle + 0.02, z, z + high)
                                 : block(middle - 0.02, middle + 0.02, from, from + wide, z, z + high));
    };
    for (std::size_t s = 0; s < storeys; ++s) {
      const double z = static_cast<double>(s) * storey, top = z + height;
      walls.push_back(block(0, x1, 0, kOuter, z, top)), walls.push_back(block(0, x1, y1 - kOuter, y1, z, top));
      walls.push_back(block(0, kOuter, 0, y1, z, top)), walls.push_back(block(x1 - kOuter, x1, 0, y1, z, top));
      for (std::size_t i = 1; i < columns; ++i) walls.push_back(block(x[i], x[i] + kInner, 0, y1, z, top));
      for (std::size_t j = 1; j < rows; ++j) walls.push_back(block(0, x1, y[j], y[j] + kInner, z, top));
      const auto low_x = [&](std::size_t i) { return i == 0 ? kOuter : x[i] + kInner; };
      const auto low_y = [&](std::size_t j) { return j == 0 ? kOuter : y[j] + kInner; };
      const auto high_x = [&](std::size_t i) { return i + 1 == columns ? x1 - kOuter : x[i + 1]; };
      const auto high_y = [&](std::size_t j) { return j + 1 == rows ? y1 - kOuter : y[j + 1]; };
      for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
          const std::size_t room = s * rooms + j * columns + i;
          made_.site.places.push_back({.name = "room " + std::to_string(room),
                                       .storey = static_cast<int>(s),
                                       .x0 = low_x(i),
                                       .x1 = high_x(i),
                                       .y0 = low_y(j),
                                       .y1 = high_y(j),
                                       .z = z});
          if (i > 0 && chance(0.75)) {
            opening(low_y(j), high_y(j), x[i], kInner, false, z, chance(0.3));
            group[root(room)] = root(room - 1);
          }
          if (j > 0 && chance(0.75)) {
            opening(low_x(i), high_x(i), y[j], kInner, true, z, chance(0.3));
            group[root(room)] = root(room - columns);
          }
          if (chance(0.6) && j + 1 == rows)  // a window
            openings.push_back(block(low_x(i) + 0.7, low_x(i) + 1.7, y1 - kOuter, y1, z + 0.9, z + 2.1));
          if (chance(0.5) && i + j > 0 && high_x(i) - low_x(i) > 2.8 && high_y(j) - low_y(j) > 2.8) {
            const double cx = (low_x(i) + high_x(i)) / 2, cy = (low_y(j) + high_y(j)) / 2;
            add_table(made_.site, name(table_), block(cx - 0.5, cx + 0.5, cy - 0.3, cy + 0.3, z, z + 0.74));
          }
        }
      if (s > 0 && stairs) {
        const double from = s % 2 == 1 ? 0.4 : 1.7, below = z - storey;
        holes_in_slabs.push_back(block(from, from + 1.1, 1.2, 1.2 + flight, z - slab, z));
        add_flight(add_part(made_.site, name(stair_), sites::kConcrete, Surface::floor), from, from + 1.1, 1.2, below,
                   rises, rise, going);
        group[root(s * rooms)] = root((s - 1) * rooms);
      }
    }
    if (entrance) {  // into the first room, at the end of the flight
      opening(0.3, std::min(x[1], x1), 0, kOuter, true, 0, chance(0.2));
    }
    carve(add_part(made_.site, name(floor_), sites::kConcrete, Surface::floor), slabs, holes_in_slabs);
    carve(add_part(made_.site, name(wall_), sites::kPlaster, Surface::wall_top), walls, openings);
    for (const Box& leaf : leaves) {
      if (made_.leaves.empty() || !together_)
        made_.leaves.push_back({.name = name(together_ ? table_ : door_), .colour = sites::kWood});
      add_box(made_.leaves.back(), leaf);
    }
    if (lawn)
      add_box(add_part(made_.site, "lawn", sites::kGrass, Surface::floor), block(-8, x1 + 6, -8, y1 + 7, -0.5, -slab));
    // The entrance decides which rooms are entered; without one, only the settings do.
    if (entrance || lawn)
      for (std::size_t i = 0; i < rooms * storeys; ++i)
        if (!entrance || root(i) != root(0)) made_.shut.insert("room " + std::to_string(i));
    if (lawn && slab > 0.24) {  // a step that a person does not take: a ramp of one more
      add_box(add_part(made_.site, "step", sites::kConcrete, Surface::floor), block(0, x1, -1, 0, -slab, -slab / 2));
    }
    std::ostringstream text;
    text << "building of " << columns << " x " << rows << " rooms on " << storeys << " storeys"
         << (stairs ? " with stairs" : "") << (lawn ? " on a lawn" : "") << (entrance ? "" : " without an entrance")
         << ", " << leaves.size() << (together_ ? " leaves in one mesh" : " leaves");
    made_.told = text.str();
  }

  // One hall with columns or racks, and an open gate.
  void hall() {
    const double x1 = uniform(15, 60), y1 = uniform(12, 40), height = uniform(4.5, 9);
    carve(add_part(made_.site, name(floor_), sites::kConcrete, Surface::floor),
          {block(0, x1, 0, y1, -0.3, 0), block(0, x1, 0, y1, height, height + 0.3)});
    const double gate = uniform(1, 4);
    carve(
        add_part(made_.site, name(wall_), sites::kPlaster, Surface::wall_top),
        {block(0, x1, 0, kOuter, 0, height), block(0, x1, y1 - kOuter, y1, 0, height),
         block(0, kOuter, 0, y1, 0, height), block(x1 - kOuter, x1, 0, y1, 0, height)},
        {block(4, 4 + gate, 0, kOuter, 0, std::min(height - 0.5, 2 + gate / 2)), block(8.5, 9.4, 0, kOuter, 0, 2.05)});
    const bool racks = chance(0.5);
    for (double x = 4; x < x1 - 4; x += 6)
      for (double y = 4; y < y1 - 4; y += 6) {
        if (!racks) {
          add_cylinder(add_part(made_.site, name(column_), sites::kConcrete, Surface::wall_top), {x, y, 0}, 2, 0.25,
                       height);
          continue;
        }
        Part& rack = add_part(made_.site, "rack " + std::to_string(++named_), sites::kSteel, Surface::furniture);
        std::vector<Box> boards;
        for (double z = 0.1; z < std::min(height - 1, 4.0); z += 1.2)
          boards.push_back(block(x, x + 1, y, y + 3, z, z + 0.08));
        boards.push_back(block(x, x + 0.08, y, y + 3, 0, boards.back().max.z));
        carve(rack, boards);
      }
    if (chance(0.5))
      add_box(add_part(made_.site, "yard", sites::kGrass, Surface::floor),
              block(-15, x1 + 15, -20, y1 + 10, -0.6, -0.15));
    made_.site.places.push_back({.name = "hall", .x0 = kOuter, .x1 = x1 - kOuter, .y0 = kOuter, .y1 = y1 - kOuter});
    made_.told = std::string("hall with ") + (racks ? "racks" : "columns");
  }

  // A bent tunnel of sheets, open at both ends.
  void tunnel() {
    const double half = uniform(2, 4), height = uniform(3.5, 6);
    made_.turned = chance(0.5);
    std::vector<Vec3> axis{{0, 0, 0}};
    double heading = uniform(0, 6.28);
    for (std::size_t i = 0, n = 6 + below(8); i < n; ++i) {
      heading += uniform(-0.25, 0.25);
      const double step = uniform(8, 15);
      axis.push_back(axis.back() + Vec3{step * std::cos(heading), step * std::sin(heading), uniform(-0.3, 0.3)});
    }
    add_part(made_.site, name(floor_), sites::kConcrete, Surface::floor);
    add_part(made_.site, name(wall_), sites::kPlaster, Surface::roof);
    Part &floor = made_.site.parts[0], &shell = made_.site.parts[1];
    std::vector<std::array<Vec3, 4>> rings;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const Vec3 along = axis[std::min(i + 1, axis.size() - 1)] - axis[i > 0 ? i - 1 : 0];
      const double size = std::hypot(along.x, along.y);
      const Vec3 side{-along.y / size * half, along.x / size * half, 0}, up{0, 0, height};
      rings.push_back({axis[i] + side, axis[i] - side, axis[i] - side + up, axis[i] + side + up});
    }
    const auto quad = [&](Part& part, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
      const auto first = static_cast<std::uint32_t>(part.positions.size());
      part.positions.insert(part.positions.end(), {a, b, c, d});
      part.triangles.push_back({first, first + 1, first + 2}), part.triangles.push_back({first, first + 2, first + 3});
    };
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 &a = rings[i][k], &b = rings[i][(k + 1) % 4], &c = rings[i + 1][(k + 1) % 4], &d = rings[i + 1][k];
        quad(k == 0 ? floor : shell, a, b, c, d);  // k = 0: left to right on the floor, then ahead: normals inward
      }
    made_.told = std::string("tunnel of sheets") + (made_.turned ? ", normals outward" : "");
  }

  RandomSite made_;
  std::uint64_t random_;
  bool together_;
  std::size_t language_ = 0;
  int named_ = 0;
};

}  // namespace

RandomSite make_random_site(std::uint64_t seed) {
  std::optional<std::size_t> strange;
  if (seed >= kFirstStrange) strange = (seed - kFirstStrange) % kStrangeKinds;
  return Maker(seed * 2 + 1, seed % 3 == 0).make(strange);
}

void write_site(const RandomSite& random, const std::filesystem::path& file) {
  KnownSite site = random.site;
  for (Part& part : site.parts)
    if (const auto drawn = random.drawn.find(part.name); drawn != random.drawn.end()) part = drawn->second;
  site.parts.insert(site.parts.end(), random.leaves.begin(), random.leaves.end());
  if (random.turned)
    for (Part& part : site.parts)
      for (auto& t : part.triangles) std::swap(t[1], t[2]);
  write_site(site, random.variant, file);
}

}  // namespace vantage::test
