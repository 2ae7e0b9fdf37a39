// SPDX-License-Identifier: Apache-2.0
// vantage-stress: prints the tables of docs/evidence/stability.md, each under its command.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "stress/coplanar.hpp"
#include "stress/leaks.hpp"
#include "stress/many_points.hpp"
#include "stress/moved_scene.hpp"
#include "stress/odd_rays.hpp"
#include "stress/reference_differences.hpp"
#include "stress/search_area_points.hpp"
#include "stress/swept_wall.hpp"
#include "support/engines.hpp"
#include "vantage/error.hpp"

namespace vantage::test {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}
std::string count(std::uint64_t value) { return std::to_string(value); }
std::string share(std::uint64_t part, std::uint64_t whole) {
  if (part == whole) return count(part) + " (100 %)";
  return count(part) + " (" + number(100 * static_cast<double>(part) / static_cast<double>(whole)) + " %)";
}

void row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::printf("| %s ", cell.c_str());
  std::printf("|\n");
  std::fflush(stdout);
}
void head(const std::vector<std::string>& cells) {
  row(cells);
  row(std::vector<std::string>(cells.size(), "---"));
}

void leaks(const std::vector<EngineInfo>& engines, double size) {
  head({"mesh", "engine", "rays at edges", "escaped", "rays at vertices", "escaped"});
  for (const ClosedMesh& mesh : closed_meshes()) {
    for (const EngineInfo& engine : engines) {
      const Leaks l = count_leaks(engine, mesh, static_cast<std::uint64_t>(1e7 * size));
      row({mesh.name, to_string(engine.engine), count(l.edge_rays), share(l.edge_escapes, l.edge_rays),
           count(l.vertex_rays), share(l.vertex_escapes, l.vertex_rays)});
    }
  }
}

void moved(const std::vector<EngineInfo>& engines, double size) {
  const double step = 0.25 / size;
  head({"moved by", "engine", "rays", "rays that differ", "counts", "points apart by up to (m)", "coverage"});
  for (const Move& move : shifts_and_scales()) {
    for (const EngineInfo& engine : engines) {
      const MovedFigures f = compare_moved(engine, move, step);
      row({move.name, to_string(engine.engine), count(f.rays), share(f.differing, f.rays),
           f.counts_equal ? "equal" : "differ", number(f.farthest_m), number(f.moved_coverage - f.coverage)});
    }
  }
}

void turned(const std::vector<EngineInfo>& engines, double size) {
  const double step = 0.25 / size;
  head({"turned by", "engine", "rays", "hits that differ", "points apart by up to (m)", "change of coverage",
        "not explained by the new cut"});
  for (const Move& move : turns()) {
    for (const EngineInfo& engine : engines) {
      const MovedFigures f = compare_moved(engine, move, step);
      row({move.name, to_string(engine.engine), count(f.rays), share(f.differing_hits, f.rays), number(f.farthest_m),
           number(f.moved_coverage - f.coverage), number(f.moved_coverage - f.predicted_coverage)});
    }
  }
}

void baked(const std::vector<EngineInfo>&, double) {
  head({"baked into float32 vertices at", "note of the load"});
  for (const Move& move : {Move{"(0, 0, 0)", {}}, Move{"1 km", {1000, 1000, 0}}, Move{"100 km", {100'000, 100'000, 0}},
                           Move{"UTM (500 000, 4 500 000)", {500'000, 4'500'000, 230}}}) {
    const Scene scene = yard(move, true);
    std::string notes;
    for (const std::string& note : scene.notes()) notes += (notes.empty() ? "" : "; ") + note;
    row({move.name, notes.empty() ? "nothing" : notes});
  }
}

void sweep(const std::vector<EngineInfo>& engines, double size) {
  head({"axis", "engine", "steps", "least coverage", "most", "varies by"});
  for (const int axis : {0, 1, 2}) {
    for (const EngineInfo& engine : engines) {
      const int steps = std::max(4, static_cast<int>(200 * size));
      const SweepFigures s = sweep_wall(engine, axis, steps);
      char least[16], most[16];
      std::snprintf(least, sizeof least, "%.5f", s.least);
      std::snprintf(most, sizeof most, "%.5f", s.most);
      row({std::string(1, "xyz"[axis]), to_string(engine.engine), count(static_cast<std::uint64_t>(steps)), least, most,
           number(100 * s.spread()) + " %"});
    }
  }
}

void coplanar(const std::vector<EngineInfo>& engines, double size) {
  head({"surveyed sheet and blocking wall", "engine", "rays into the wall", "hit nothing", "into the sheet",
        "counted there", "counted beside it", "off the plane by up to (m)"});
  for (const EngineInfo& engine : engines)
    for (const CoplanarFigures& f : measure_coplanar(engine, 0.25 / size))
      row({f.name, to_string(engine.engine), count(f.wall_rays), count(f.missed), count(f.sheet_rays),
           share(f.counted, f.sheet_rays), count(f.strayed), number(f.off_m)});
}

void odd(const std::vector<EngineInfo>& engines, double size) {
  head({"rays", "engine", "rays", "hits", "differ from the reference", "of these not at an edge, face or end of range",
        "broken", "range off by (m)", "relative"});
  for (const OddRays& rays : odd_rays(1 / size)) {
    for (const EngineInfo& engine : engines) {
      const auto tracer = make_tracer(engine, rays.scene);
      Comparison c;
      for (const TraceStation& station : rays.stations) c.add(compare(*tracer, rays.scene, station));
      row({rays.name, to_string(engine.engine), count(c.rays), count(c.hits), count(c.differing), count(c.unexplained),
           count(c.broken), number(c.range_m), number(c.relative_range)});
    }
  }
}

void edges(const std::vector<EngineInfo>&, double size) {
  head({"search area", "points on edges", "lost", "off the edge by up to (m)", "jump across it up to (m)"});
  for (const EdgePoints& e : locate_edge_points(static_cast<std::uint64_t>(1e6 * size)))
    row({e.name, count(e.points), count(e.lost), number(e.farthest_m), number(e.jump_m)});
}

void reference(const std::vector<EngineInfo>& engines, double) {
  head({"site", "engine", "rays", "rays that differ", "range (m)", "σ (m)", "coverage", "pair overlap",
        "clustering coefficient"});
  for (const TestSite& site : sites()) {
    for (const EngineInfo& engine : engines) {
      const ReferenceDifferences d = compare_with_reference(engine, site);
      row({site.name, to_string(engine.engine), count(d.rays.rays), count(d.rays.differing), number(d.rays.range_m),
           number(d.rays.sigma_m), number(d.coverage), number(d.overlap), number(d.clustering)});
    }
  }
}

void many(const std::vector<EngineInfo>& engines, double size) {
  head({"stations", "engine", "rays", "points", "the voxel's count", "goal", "coverage", "from 64 bits",
        "from wrapped 32 bits"});
  for (const EngineInfo& engine : engines)
    for (const ManyPoints& m : trace_many_points(engine, 0.028 / std::sqrt(size)))
      row({count(m.stations), to_string(engine.engine), count(m.rays), count(m.points), count(m.count), number(m.goal),
           number(m.coverage), number(m.wanted()), number(m.wrapped())});
}

int run(int argc, char** argv) {
  using Part = std::function<void(const std::vector<EngineInfo>&, double)>;
  const std::vector<std::pair<std::string, Part>> parts{
      {"moved", moved},       {"turned", turned}, {"baked", baked}, {"sweep", sweep},         {"leaks", leaks},
      {"coplanar", coplanar}, {"odd", odd},       {"edges", edges}, {"reference", reference}, {"many", many}};
  const std::string costly = "many";  // minutes on a graphics card: only on request
  std::vector<std::string> wanted, wanted_engines;
  double size = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--size" && i + 1 < argc) {
      size = std::atof(argv[++i]);
    } else if (argument == "--engine" && i + 1 < argc) {
      wanted_engines.push_back(argv[++i]);
    } else {
      wanted.push_back(argument);
    }
  }
  bool known = size > 0 && size <= 1;
  for (const std::string& name : wanted) {
    bool found = false;
    for (const auto& part : parts) found |= part.first == name;
    known &= found;
  }
  if (!known) {
    std::fprintf(
        stderr,
        "usage: vantage-stress [--size SHARE] [--engine NAME]... [PART...]\nprints tables as Markdown; SHARE of the "
        "full size in (0, 1]; %s only where asked for; parts:",
        costly.c_str());
    for (const auto& part : parts) std::fprintf(stderr, " %s", part.first.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  std::vector<EngineInfo> engines = usable_engines();
  if (!wanted_engines.empty())
    std::erase_if(engines, [&](const EngineInfo& engine) {
      return std::find(wanted_engines.begin(), wanted_engines.end(), to_string(engine.engine)) == wanted_engines.end();
    });
  for (const auto& [name, part] : parts) {
    if (wanted.empty() ? name == costly : std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    std::printf("\n`vantage-stress %s`\n\n", name.c_str());
    part(engines, size);
  }
  return 0;
}

}  // namespace
}  // namespace vantage::test

int main(int argc, char** argv) {
  try {
    return vantage::test::run(argc, argv);
  } catch (const vantage::Error& error) {
    std::fprintf(stderr, "vantage-stress: %s\n", error.what());
    return 1;
  }
}
