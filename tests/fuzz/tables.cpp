// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "fuzz/target.hpp"
#include "placement/area_limits.hpp"
#include "vantage/export.hpp"
#include "vantage/scanner.hpp"

namespace vantage::fuzz {
namespace {

void region(Bytes bytes, const char* name) {
  const std::string file = file_of(bytes, name);
  accepts([&] {
    const PlanRegion found = read_region(file);
    require(!found.rings.empty(), "a region has a ring");
    for (const auto& ring : found.rings) {
      require(ring.size() >= 3, "a ring has three corners");
      for (const auto& [x, y] : ring) require_finite(x, "a corner"), require_finite(y, "a corner");
    }
  });
}

}  // namespace

void stations_csv(Bytes bytes) {
  const auto file = file_of(bytes, "stations.csv");
  accepts([&] {
    for (const StationRow& row : read_stations_csv(file)) {
      require(row.position || row.uv || row.ground || row.xy, "a row says where");
      for (const auto& p : {row.position, row.ground})
        if (p) require_finite(p->x, "x"), require_finite(p->y, "y"), require_finite(p->z, "z");
      if (row.uv) require_finite(row.uv->u, "u"), require_finite(row.uv->v, "v");
      if (row.xy) require_finite((*row.xy)[0], "x"), require_finite((*row.xy)[1], "y");
      require_finite(row.setup.heading.in_degrees(), "heading");
      require_finite(row.setup.tilt.in_degrees(), "tilt");
      if (row.step) require_finite(row.step->in_degrees(), "step");
    }
  });
}

void noise_csv(Bytes bytes) {
  const std::string file = file_of(bytes, "noise.csv");
  accepts([&] {
    const NoiseTable table = load_noise(file);
    require(table.sigma_m.size() == table.distances_m.size() * table.reflectivities.size(), "a table is full");
    require(std::is_sorted(table.distances_m.begin(), table.distances_m.end()), "distances rise");
    for (const auto* values : {&table.distances_m, &table.reflectivities, &table.sigma_m})
      for (const double value : *values) require_finite(value, "a number of the table");
  });
}

void scanners_json(Bytes bytes) {
  const auto file = file_of(bytes, "scanners.json");
  accepts([&] {
    for (const ScannerPreset& preset : list_scanners(file)) accepts([&] { load_scanner(preset.key, file).check(); });
  });
}

void region_geojson(Bytes bytes) { region(bytes, "region.geojson"); }
void region_csv(Bytes bytes) { region(bytes, "region.csv"); }

void crs(Bytes bytes) {
  const std::string file = file_of(bytes, "system.prj");
  accepts([&] { require(!coordinate_system(file).empty(), "a coordinate system has words"); });
}

}  // namespace vantage::fuzz
