// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cover/partial_cover.hpp"

namespace vantage {

// Gains of all candidates to a network, and to it without each of its members, updated by swaps. A swap costs the
// matrix entries of its two columns' elements, once more for each member that has the element.
class SwapGains {
 public:
  // Additional gain of a candidate if a member leaves.
  struct More {
    std::uint32_t candidate;
    CoverUnits gain;
  };

  // Keeps references. A candidate may be in the network more than once.
  SwapGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> network);
  // Another candidate takes the place of a member.
  void replace(std::size_t at, std::size_t joining);

  const CoverGains& now() const { return gains_; }
  CoverUnits loss(std::size_t at) const { return members_[at].loss; }  // if the member at `at` leaves
  // Candidates that may gain more without the member at `at`, rising; all others gain the same as with it.
  std::span<const More> without(std::size_t at) const { return members_[at].more; }

 private:
  struct Member {
    std::size_t candidate;
    CoverUnits loss = 0;
    std::vector<More> more = {};
  };
  // A member that has an element, and the next one in its list.
  struct Holder {
    std::uint32_t at, amount, next;
  };
  struct Touched {
    CoverGains::Change change;
    std::uint32_t amount;  // of the member
  };
  void hold(std::size_t at);
  void release(std::size_t at);
  void measure(Member& member) const;
  void update(Member& member, std::span<const Touched> touched);

  const CoverageMatrix& matrix_;
  const ColumnIndex& columns_;
  CoverGains gains_;
  std::vector<Member> members_;
  std::vector<std::uint32_t> holders_of_;  // by element: its first holder
  std::vector<Holder> holders_;
  std::vector<std::uint32_t> unused_;          // holders
  std::vector<std::vector<Touched>> touched_;  // by place; empty between swaps
  std::vector<CoverUnits> changed_;            // by candidate; 0 between swaps
};

}  // namespace vantage
