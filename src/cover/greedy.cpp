// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <queue>
#include <utility>

#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {
namespace {

// A candidate and its last known gain, an upper bound for its gain with any larger network.
struct KnownGain {
  double gain;
  std::size_t candidate, network_size;  // of the network that it was computed for
  bool operator<(const KnownGain& other) const {
    return gain != other.gain ? gain < other.gain : candidate > other.candidate;
  }
};

}  // namespace

std::vector<std::size_t> greedy(const CoverProblem& problem) {
  check(problem);
  std::vector<std::size_t> chosen = problem.existing;
  PartialCover cover(problem.matrix, chosen);
  Joinable joinable(problem, chosen);
  std::optional<NetworkLinks> links(std::in_place, problem, chosen, problem.link);
  Components components = links->components();
  std::priority_queue<KnownGain> queue;
  for (const std::size_t k : free_candidates(problem)) queue.push({cover.gain(k), k, chosen.size()});

  std::vector<KnownGain> refused;  // not allowed now; may be once the network has grown
  double covered = cover.value();
  const auto enough = [&] { return problem.coverage < 1 && covered >= problem.coverage; };
  while (chosen.size() - problem.existing.size() < problem.most && !queue.empty() && !enough()) {
    const KnownGain best = queue.top();
    queue.pop();
    if (best.gain <= 0) break;
    if (!joinable.may_stand(best.candidate) ||
        links->count_with(components, best.candidate) > std::max<std::size_t>(components.count, 1)) {
      refused.push_back(best);
      continue;
    }
    if (best.network_size < chosen.size()) {
      queue.push({cover.gain(best.candidate), best.candidate, chosen.size()});
      continue;
    }
    cover.add(best.candidate);
    covered = cover.value();
    chosen.push_back(best.candidate);
    joinable.add(best.candidate);
    if (problem.link > 0) components = links.emplace(problem, chosen, problem.link).components();
    for (const KnownGain& again : refused) queue.push(again);
    refused.clear();
  }
  return chosen;
}

}  // namespace vantage
