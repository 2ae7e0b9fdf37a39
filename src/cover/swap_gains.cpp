// SPDX-License-Identifier: Apache-2.0
#include "cover/swap_gains.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

}  // namespace

SwapGains::SwapGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> network)
    : matrix_(matrix),
      columns_(columns),
      gains_(matrix, columns, network),
      holders_of_(matrix.elements(), kNobody),
      touched_(network.size()),
      changed_(matrix.candidates(), 0) {
  for (std::size_t at = 0; at < network.size(); ++at) {
    members_.push_back({.candidate = network[at]});
    hold(at);
  }
  parallel::for_all(std::size_t{0}, members_.size(), [&](std::size_t at) { measure(members_[at]); });
}

void SwapGains::hold(std::size_t at) {
  for (const CoverageMatrix::Entry& one : matrix_.column(members_[at].candidate)) {
    const Holder holder{static_cast<std::uint32_t>(at), one.amount, holders_of_[one.element]};
    if (unused_.empty()) {
      holders_of_[one.element] = static_cast<std::uint32_t>(holders_.size());
      holders_.push_back(holder);
    } else {
      holders_of_[one.element] = unused_.back();
      holders_[unused_.back()] = holder;
      unused_.pop_back();
    }
  }
}

void SwapGains::release(std::size_t at) {
  for (const CoverageMatrix::Entry& one : matrix_.column(members_[at].candidate)) {
    std::uint32_t* link = &holders_of_[one.element];
    while (holders_[*link].at != at) link = &holders_[*link].next;
    unused_.push_back(std::exchange(*link, holders_[*link].next));
  }
}

void SwapGains::measure(Member& member) const {
  std::vector<CoverUnits> more(matrix_.candidates(), 0);
  gains_.for_gains_without(member.candidate, [&](std::size_t k, CoverUnits gain) { more[k] += gain; });
  member.loss = gains_.loss(member.candidate);
  member.more.clear();
  for (std::size_t k = 0; k < more.size(); ++k)
    if (more[k] != 0) member.more.push_back({static_cast<std::uint32_t>(k), more[k]});
}

// For each element, the further gain of a candidate without the member is min(gives, missing without it) − min(gives,
// missing with it).
void SwapGains::update(Member& member, std::span<const Touched> touched) {
  for (const auto& [change, amount] : touched) {
    const ColumnIndex::Element element = columns_.element(change.element);
    const CoverUnits had = element.missing(change.had), had_without = element.missing(change.had - amount);
    const CoverUnits has = element.missing(change.has), has_without = element.missing(change.has - amount);
    member.loss += (has_without - has) - (had_without - had);
    for (const ColumnIndex::Column& other : columns_.of(change.element)) {
      const CoverUnits gives = element.by(other.amount);
      changed_[other.candidate] +=
          (std::min(gives, has_without) - std::min(gives, has)) - (std::min(gives, had_without) - std::min(gives, had));
    }
  }
  std::vector<More> more;
  more.reserve(member.more.size());
  auto known = member.more.begin();
  for (std::size_t k = 0; k < changed_.size(); ++k) {
    const bool is_known = known != member.more.end() && known->candidate == k;
    const CoverUnits changed = std::exchange(changed_[k], 0);
    if (is_known || changed != 0)
      more.push_back({static_cast<std::uint32_t>(k), (is_known ? (known++)->gain : 0) + changed});
  }
  member.more = std::move(more);
}

void SwapGains::replace(std::size_t at, std::size_t joining) {
  release(at);
  const std::size_t leaving = std::exchange(members_[at].candidate, joining);
  for (const CoverGains::Change& change : gains_.replace(leaving, joining)) {
    const ColumnIndex::Element element = columns_.element(change.element);
    for (std::uint32_t k = holders_of_[change.element]; k != kNobody; k = holders_[k].next)
      if (element.missing(std::min(change.had, change.has) - holders_[k].amount) > 0)
        touched_[holders_[k].at].push_back({change, holders_[k].amount});
  }
  hold(at);
  for (std::size_t other = 0; other < members_.size(); ++other) {
    if (touched_[other].empty()) continue;
    update(members_[other], touched_[other]);
    touched_[other].clear();
  }
  measure(members_[at]);
}

}  // namespace vantage
