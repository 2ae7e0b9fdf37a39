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

  void read(const PointSink& sink) override {
    scans_.clear(), notes_.clear();
    for (const auto& source : sources_) {
      const auto first = static_cast<std::uint32_t>(scans_.size());
      scans_.insert(scans_.end(), source->scans().begin(), source->scans().end());
      source->read([&](const PointBlock& block) {
        while (scans_.size() < first + source->scans().size())  // it learns of them as it reads
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

}  // namespace

std::unique_ptr<PointSource> joined(std::vector<std::unique_ptr<PointSource>> sources) {
  if (sources.size() == 1) return std::move(sources.front());
  return std::make_unique<JoinedSource>(std::move(sources));
}

}  // namespace vantage::importer
