// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "import/cloud/points.hpp"

namespace vantage::importer {
namespace {

class JoinedSource : public PointSource {
 public:
  explicit JoinedSource(std::vector<std::unique_ptr<PointSource>> sources) : sources_(std::move(sources)) {}

  std::uint64_t announced() const override {
    std::uint64_t sum = 0;
    for (const auto& source : sources_) {
      if (source->announced() == 0) return 0;
      sum += source->announced();
    }
    return sum;
  }

  bool metric() const override {
    return std::ranges::all_of(sources_, [](const auto& source) { return source->metric(); });
  }
  bool floats() const override {
    return std::ranges::any_of(sources_, [](const auto& source) { return source->floats(); });
  }

  void read(const PointSink& sink) override {
    scans_.clear(), notes_.clear();
    for (const auto& source : sources_) {
      const auto first = static_cast<std::uint32_t>(scans_.size());
      scans_.insert(scans_.end(), source->scans().begin(), source->scans().end());
      source->read([&](const PointBlock& block) {
        while (scans_.size() < first + source->scans().size())  // a source may find scans while it reads
          scans_.push_back(source->scans()[scans_.size() - first]);
        sink({block.positions, block.normals, first + block.scan});
      });
      if (crs_.empty()) crs_ = source->crs();
      for (const std::string& note : source->notes())
        if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(note);
    }
  }

 private:
  std::vector<std::unique_ptr<PointSource>> sources_;
};

class MovedSource : public PointSource {
 public:
  MovedSource(std::unique_ptr<PointSource> source, const Eigen::Matrix3d& turn, double factor)
      : source_(std::move(source)), turn_(turn), factor_(factor) {
    take_scans();
  }

  std::uint64_t announced() const override { return source_->announced(); }
  bool metric() const override { return source_->metric(); }
  bool floats() const override { return source_->floats(); }

  void read(const PointSink& sink) override {
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector3f> normals;
    const Eigen::Matrix3d moves = factor_ * turn_;
    const Eigen::Matrix3f turns = turn_.cast<float>();
    source_->read([&](const PointBlock& block) {
      if (scans_.size() != source_->scans().size()) take_scans();
      positions.assign(block.positions.begin(), block.positions.end());
      for (Eigen::Vector3d& p : positions) p = moves * p;
      normals.assign(block.normals.begin(), block.normals.end());
      for (Eigen::Vector3f& n : normals) n = turns * n;
      sink({positions, normals, block.scan, block.cells});
    });
    notes_ = source_->notes();
  }

 private:
  void take_scans() {
    scans_ = source_->scans();
    for (CloudScan& scan : scans_)
      scan.position = factor_ * turn_ * scan.position, scan.rotation = Eigen::Quaterniond(turn_) * scan.rotation;
  }

  std::unique_ptr<PointSource> source_;
  Eigen::Matrix3d turn_;
  double factor_;
};

}  // namespace

std::unique_ptr<PointSource> moved(std::unique_ptr<PointSource> source, const Eigen::Matrix3d& turn, double factor) {
  return std::make_unique<MovedSource>(std::move(source), turn, factor);
}

std::unique_ptr<PointSource> joined(std::vector<std::unique_ptr<PointSource>> sources) {
  if (sources.size() == 1) return std::move(sources.front());
  return std::make_unique<JoinedSource>(std::move(sources));
}

}  // namespace vantage::importer
