// SPDX-License-Identifier: Apache-2.0
#include "optimise/steady_front.hpp"

#include <algorithm>

#include "optimise/hypervolume.hpp"
#include "optimise/mo_common.hpp"

namespace vantage::optimise {
namespace {

bool dominates(const double* a, const double* b, std::size_t m) {
  bool better = false;
  for (std::size_t j = 0; j < m; ++j) {
    if (a[j] > b[j]) return false;
    better |= a[j] < b[j];
  }
  return better;
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

}  // namespace

SteadyFront::SteadyFront(std::size_t objectives, std::span<const double> reference)
    : m_(objectives), reference_(reference.begin(), reference.end()) {}

void SteadyFront::assign(std::span<const double> fitness, std::span<const double> contributions) {
  values_.assign(fitness.begin(), fitness.end());
  rank_ = ranks({values_, m_});
  reach_ = reach();
  if (contributions.empty()) {
    recount();
  } else {
    contributions_.assign(contributions.begin(), contributions.end());
  }
}

std::vector<double> SteadyFront::reach() const {
  std::vector<double> front;
  for (std::size_t i = 0; i < rank_.size(); ++i)
    if (rank_[i] == 0)
      front.insert(front.end(), values_.begin() + static_cast<std::ptrdiff_t>(i * m_),
                   values_.begin() + static_cast<std::ptrdiff_t>((i + 1) * m_));
  return reach_over(front, reference_);
}

void SteadyFront::recount() {
  std::vector<double> front;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < rank_.size(); ++i) {
    if (rank_[i] != 0) continue;
    index.push_back(i);
    const auto f = fitness(i);
    front.insert(front.end(), f.begin(), f.end());
  }
  reach_ = reach_over(front, reference_);
  const auto counted = optimise::contributions({front, m_}, reach_);
  contributions_.assign(rank_.size(), 0.0);
  for (std::size_t i = 0; i < index.size(); ++i) contributions_[index[i]] = counted[i];
}

void SteadyFront::rank_newcomer() {
  const std::size_t last = rank_.size() - 1;
  const double* p = values_.data() + last * m_;
  std::size_t rank = 0;
  for (std::size_t i = 0; i < last; ++i)
    if (rank_[i] >= rank && dominates(values_.data() + i * m_, p, m_)) rank = rank_[i] + 1;
  rank_[last] = rank;
  raised_.assign(1, last);
  // Front by front: points new to a front push the points they dominate there into the next.
  for (; !raised_.empty(); ++rank, std::swap(raised_, next_raised_)) {
    next_raised_.clear();
    for (std::size_t i = 0; i < last; ++i) {
      if (rank_[i] != rank || std::ranges::find(raised_, i) != raised_.end()) continue;
      const bool falls = std::ranges::any_of(
          raised_, [&](std::size_t q) { return dominates(values_.data() + q * m_, values_.data() + i * m_, m_); });
      if (falls) next_raised_.push_back(i);
    }
    for (const std::size_t i : next_raised_) ++rank_[i];
  }
}

void SteadyFront::bound(std::size_t p, std::size_t skipped, bool second) {
  first_ = bound_ = reach_;
  const double* a = values_.data() + p * m_;
  for (std::size_t i = 0; i < rank_.size(); ++i) {
    if (rank_[i] != 0 || i == p || i == skipped) continue;
    const double* q = values_.data() + i * m_;
    std::size_t above = 0, axis = 0;
    for (std::size_t d = 0; d < m_; ++d) {
      const bool over = q[d] > a[d];
      above += over;
      axis = over ? d : axis;
    }
    if (above != 1) continue;
    if (q[axis] < first_[axis]) {
      bound_[axis] = first_[axis];
      first_[axis] = q[axis];
    } else if (q[axis] < bound_[axis]) {
      bound_[axis] = q[axis];
    }
  }
  if (!second) bound_ = first_;
  near_.clear();
  local_.clear();
  for (std::size_t i = 0; i < rank_.size(); ++i) {
    if (rank_[i] != 0 || i == p || i == skipped) continue;
    const double* q = values_.data() + i * m_;
    bool reaches = true;
    for (std::size_t d = 0; d < m_; ++d) reaches &= q[d] < bound_[d];
    if (!reaches) continue;
    near_.push_back(i);
    for (std::size_t d = 0; d < m_; ++d) local_.push_back(std::max(a[d], q[d]));
  }
}

double SteadyFront::exclusive(std::size_t p, std::size_t skipped) {
  if (!inside(fitness(p), reach_)) return 0;
  bound(p, skipped, false);
  double box = 1;
  for (std::size_t d = 0; d < m_; ++d) box *= bound_[d] - values_[p * m_ + d];
  return std::max(0.0, box - volume({local_, m_}, bound_));
}

void SteadyFront::measure_heirs(std::size_t p, std::size_t skipped) {
  near_.clear();
  gains_.clear();
  if (!inside(fitness(p), reach_)) return;
  bound(p, skipped, true);
  gains_ = optimise::contributions({local_, m_}, bound_);
}

// Least contributor of the front of that rank.
std::size_t SteadyFront::least_of(std::size_t rank) const {
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < rank_.size(); ++i)
    if (rank_[i] == rank) index.push_back(i);
  if (index.size() == 1) return index.front();
  std::vector<double> front;
  for (const std::size_t i : index) front.insert(front.end(), fitness(i).begin(), fitness(i).end());
  return index[surplus(front, reference_, 1).front()];
}

SteadyFront::Verdict SteadyFront::offer(std::span<const double> fitness, std::size_t parent) {
  const std::size_t mu = rank_.size();
  old_rank_ = rank_;
  values_.insert(values_.end(), fitness.begin(), fitness.end());
  rank_.push_back(0);
  contributions_.push_back(0);
  rank_newcomer();
  const std::size_t worst = *std::max_element(rank_.begin(), rank_.end());
  Verdict verdict{mu, rank_[mu], parent < mu ? rank_[parent] : rank_[mu]};

  const bool joins = rank_[mu] == 0;
  const auto next_reach = joins ? reach() : reach_;
  const bool local = m_ > 1 && next_reach == reach_;
  if (joins && local) {
    // Points that leave the first front hand over their contributions one by one, before the newcomer is added.
    raised_.clear();
    for (std::size_t i = 0; i < mu; ++i)
      if (old_rank_[i] == 0 && rank_[i] != 0) raised_.push_back(i);
    for (const std::size_t i : raised_) std::swap(rank_[i], old_rank_[i]);
    for (const std::size_t i : raised_) {
      std::swap(rank_[i], old_rank_[i]);
      measure_heirs(i, mu);
      for (std::size_t k = 0; k < near_.size(); ++k) contributions_[near_[k]] += gains_[k];
    }
    for (const std::size_t i : raised_) contributions_[i] = 0;
    const double own = exclusive(mu, kNone);
    measure_heirs(mu, kNone);
    if (worst == 0) {
      // The least contributor if the newcomer is in: if that is the newcomer, nothing changes.
      std::size_t least = mu;
      double lowest = own;
      std::size_t heir = 0;
      for (std::size_t i = 0; i < mu; ++i) {
        double c = contributions_[i];
        if (heir < near_.size() && near_[heir] == i) c -= gains_[heir++];
        if (c < lowest || (c == lowest && least != mu)) {
          lowest = c;
          least = i;
        }
      }
      verdict.removed = least;
    } else {
      verdict.removed = least_of(worst);
    }
    if (verdict.removed != mu) {
      for (std::size_t k = 0; k < near_.size(); ++k)
        contributions_[near_[k]] = std::max(0.0, contributions_[near_[k]] - gains_[k]);
      contributions_[mu] = own;
    }
  } else {
    verdict.removed = least_of(worst);
  }

  const std::size_t removed = verdict.removed;
  if (removed == mu) {
    erase_last();
    rank_ = old_rank_;
    return verdict;
  }
  const bool from_first = rank_[removed] == 0;
  if (from_first && local) {
    rank_[removed] = kNone;  // removed
    measure_heirs(removed, removed);
    for (std::size_t k = 0; k < near_.size(); ++k) contributions_[near_[k]] += gains_[k];
  }
  std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(mu * m_), m_,
              values_.begin() + static_cast<std::ptrdiff_t>(removed * m_));
  rank_[removed] = rank_[mu];
  contributions_[removed] = contributions_[mu];
  erase_last();
  if ((joins || from_first) && (!local || reach() != reach_)) recount();
  return verdict;
}

}  // namespace vantage::optimise
