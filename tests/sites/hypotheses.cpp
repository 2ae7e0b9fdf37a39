// SPDX-License-Identifier: Apache-2.0
// hypotheses [--features] [--as-is] UNIT AXIS FILE...: models whose true unit and up axis are known, written in every
// unit and with each axis up, or as they are alone. Prints for each whether they are recognised, asked for, or wrong.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "scene/positions.hpp"
#include "scene/recognise_units.hpp"
#include "vantage/scene.hpp"

int main(int argc, char** argv) {
  using namespace vantage;
  bool features = false, as_is = false;
  int first = 1;
  for (; first < argc && argv[first][0] == '-'; ++first) {
    features = features || std::strcmp(argv[first], "--features") == 0;
    as_is = as_is || std::strcmp(argv[first], "--as-is") == 0;
  }
  if (argc < first + 3) {
    std::fprintf(stderr, "usage: hypotheses [--features] [--as-is] UNIT AXIS FILE...\n");
    return 2;
  }
  int right = 0, asked = 0, wrong = 0;
  for (int i = first + 2; i < argc; ++i) try {
      const Scene scene =
          Scene::load(argv[i], {.unit = unit_from_string(argv[first]), .up = up_axis_from_string(argv[first + 1])});
      for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot})
        for (const UpAxis up : {UpAxis::y, UpAxis::z, UpAxis::x}) {
          if (as_is && (std::string(to_string(unit)) != argv[first] || std::string(to_string(up)) != argv[first + 1]))
            continue;
          RawScene raw;
          for (const Float3& p : scene.data().positions) {
            const glm::dvec3 q = (to_glm(p) + to_glm(scene.data().origin)) / metres_in(unit);
            raw.positions.push_back(up == UpAxis::x   ? glm::dvec3{q.z, q.y, -q.x}
                                    : up == UpAxis::y ? q
                                                      : glm::dvec3{q.x, -q.z, q.y});
          }
          raw.triangles = scene.data().triangles;
          raw.ranges = scene.data().ranges, raw.meshes = scene.data().meshes;
          const auto begun = std::chrono::steady_clock::now();
          const Recognised found = recognise(raw, {}, {});
          const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
          const bool question = !found.question.empty(), good = found.unit == unit && found.up == up;
          (question ? asked : good ? right : wrong) += 1;
          std::printf("%s in %s, %s up: %s, %.2f s: %s\n", argv[i], to_string(unit), to_string(up),
                      question ? "asked"
                      : good   ? "right"
                               : "WRONG",
                      took, (found.question + found.note).c_str());
          for (const std::string& choice : found.choices) std::printf("    %s\n", choice.c_str());
          if (!features) continue;
          for (const Hypothesis& h : weigh_hypotheses(raw, {}, {})) {
            std::printf("  %d %s %s %6.2f", h.unit == unit && h.up == up, to_string(h.unit), to_string(h.up), h.score);
            for (const double f : features_of(h)) std::printf(" %.3f", f);
            std::printf("  %.4g x %.4g x %.4g m, floor %.4g, headroom %.3g, doors %.1f, flights %.1f\n", h.size.x,
                        h.size.y, h.size.z, h.floor_m2, h.headroom_m, h.doors, h.flights);
          }
        }
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", argv[i], error.what());
    }
  std::printf("%d right, %d asked, %d wrong\n", right, asked, wrong);
}
