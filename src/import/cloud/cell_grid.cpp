// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/cell_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vantage::importer {
namespace {

// More points say nothing new of a cell, and sums of floats would no longer be exact enough.
constexpr std::uint32_t kMostPoints = 1 << 14;
constexpr int kBits = 21;

}  // namespace

void Moments::add(const Moments& other, const Eigen::Vector3d& shift) {
  count += other.count;
  sum += other.sum + other.count * shift;
  products += other.products + other.sum * shift.transpose() + shift * other.sum.transpose() +
              other.count * shift * shift.transpose();
}

double Moments::square_distance(const Eigen::Vector3d& normal, double offset) const {
  return (normal.dot(products * normal) - 2 * offset * normal.dot(sum)) / count + offset * offset;
}

Moments Cell::moments() const {
  Moments m;
  m.count = count;
  m.sum = {sum[0], sum[1], sum[2]};
  m.products << products[0], products[1], products[2], products[1], products[3], products[4], products[2], products[4],
      products[5];
  return m;
}

CellGrid::CellGrid(const Eigen::Vector3d& middle, double cell_m)
    : middle_(middle), cell_m_(cell_m), slots_(std::size_t{1} << 12, kNone) {}

std::optional<std::uint64_t> CellGrid::key_of(const CellIndex& index) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (index[axis] < -kReach || index[axis] >= kReach) return {};
    key = key << kBits | static_cast<std::uint64_t>(index[axis] + kReach);
  }
  return key;
}

CellIndex CellGrid::index_of(const Cell& cell) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  const auto part = [&](int shift) { return static_cast<int>(cell.key >> shift & kMask) - kReach; };
  return {part(2 * kBits), part(kBits), part(0)};
}

std::size_t CellGrid::slot_of(std::uint64_t key) const {
  const int shift = 64 - std::countr_zero(slots_.size());
  std::size_t slot = (key ^ (key >> 32)) * 0x9E3779B97F4A7C15 >> shift;
  while (slots_[slot] != kNone && cells_[slots_[slot]].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void CellGrid::grow() {
  const std::size_t size = 2 * slots_.size();
  slots_.clear();
  slots_.shrink_to_fit();
  slots_.assign(size, kNone);
  for (std::uint32_t k = 0; k < cells_.size(); ++k) slots_[slot_of(cells_[k].key)] = k;
}

std::uint32_t CellGrid::find(const CellIndex& index) const {
  const auto key = key_of(index);
  return key ? slots_[slot_of(*key)] : kNone;
}

bool CellGrid::add(const Eigen::Vector3d& p, std::uint16_t scan, const Eigen::Vector3d& towards) {
  const Eigen::Vector3d place = in_cells(p);
  if (!(place.cwiseAbs().maxCoeff() < kReach - 1)) return false;
  const Eigen::Vector3d corner = place.array().floor();
  const std::uint64_t key = *key_of(corner.cast<int>());
  std::size_t slot = slot_of(key);
  if (slots_[slot] == kNone) {
    if (10 * (cells_.size() + 1) > 7 * slots_.size()) grow(), slot = slot_of(key);
    slots_[slot] = size();
    cells_.push_back({.key = key, .scan = scan});
  }
  Cell& cell = cells_[slots_[slot]];
  if (cell.scan != scan) cell.scan = Cell::kSeveralScans;
  if (cell.count == kMostPoints) return true;
  ++cell.count;
  const Eigen::Vector3f d = (place - corner).cast<float>().array() - 0.5F;
  const std::array<float, 6> products{d.x() * d.x(), d.x() * d.y(), d.x() * d.z(),
                                      d.y() * d.y(), d.y() * d.z(), d.z() * d.z()};
  for (std::size_t k = 0; k < 6; ++k) cell.products[k] += products[k];
  for (int axis = 0; axis < 3; ++axis) {
    cell.sum[static_cast<std::size_t>(axis)] += d[axis];
    cell.towards[static_cast<std::size_t>(axis)] += static_cast<float>(towards[axis]);
  }
  return true;
}

Moments CellGrid::around(std::uint32_t k) const {
  const CellIndex index = index_of(cells_[k]);
  Moments all = cells_[k].moments();
  for_neighbours(index, [&](std::uint32_t beside, const CellIndex& at) {
    all.add(cells_[beside].moments(), (at - index).cast<double>());
  });
  return all;
}

}  // namespace vantage::importer
