// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

std::vector<StationLinks::Gap> gaps_between(std::span<const std::vector<std::size_t>> parts, const PairMatrix& values) {
  std::vector<StationLinks::Gap> gaps;
  for (std::size_t p = 1; p < parts.size(); ++p) {
    StationLinks::Gap best{.inside = parts[p].front(), .outside = parts[0].front(), .value = 0};
    for (const std::size_t inside : parts[p])
      for (std::size_t other = 0; other < parts.size(); ++other)
        for (const std::size_t outside : parts[other])
          if (other != p && values(inside, outside) > best.value)
            best = {.inside = inside, .outside = outside, .value = values(inside, outside)};
    gaps.push_back(best);
  }
  return gaps;
}

StationLinks links_by(LinkMeasure measure, const PairMatrix& values, double least,
                      std::span<const PlacedStation> stations) {
  // the graph of the active stations, by their places among all
  std::vector<std::size_t> station;
  for (std::size_t k = 0; k < stations.size(); ++k)
    if (active(stations[k])) station.push_back(k);
  PairMatrix matrix(station.size());
  for (std::size_t i = 0; i < station.size(); ++i)
    for (std::size_t j = i + 1; j < station.size(); ++j) matrix.set(i, j, values(station[i], station[j]));
  const Connectivity graph = connectivity(matrix, least);

  StationLinks links{.measure = measure, .least = least, .values = values};
  links.parts.resize(graph.parts);
  for (std::size_t i = 0; i < station.size(); ++i) links.parts[graph.part[i]].push_back(station[i]);
  std::ranges::stable_sort(links.parts, std::ranges::greater{}, &std::vector<std::size_t>::size);
  if (graph.parts == 1 && station.size() > 1) {
    links.weakest = {station[graph.weakest_link.first], station[graph.weakest_link.second]};
    links.weakest_value = graph.weakest_overlap;
  }
  links.gaps = gaps_between(links.parts, values);
  return links;
}

}  // namespace

std::string to_string(LinkMeasure measure) { return measure == LinkMeasure::overlap ? "overlap" : "scan overlap"; }

StationLinks station_links(const OverlapMatrix& overlap, double least, std::span<const PlacedStation> stations) {
  return links_by(LinkMeasure::overlap, overlap, least, stations);
}

StationLinks station_links(const ScanOverlapMatrix& overlap, double least, std::span<const PlacedStation> stations) {
  return links_by(LinkMeasure::scan_overlap, overlap, least, stations);
}

std::optional<StationLinks> Evaluation::links() const {
  if (scan_overlap_matrix.size() > 0) {
    StationLinks found = station_links(scan_overlap_matrix, link, stations);
    if (through_glass.size() > 0) {
      found.through_glass = gaps_between(found.parts, through_glass);
      std::erase_if(found.through_glass,
                    [&](const StationLinks::Gap& gap) { return !(gap.value > 0 && gap.value >= link); });
    }
    return found;
  }
  if (overlap_matrix.size() > 0) return station_links(overlap_matrix, link_overlap, stations);
  return std::nullopt;
}

}  // namespace vantage
