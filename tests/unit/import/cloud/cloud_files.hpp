// SPDX-License-Identifier: Apache-2.0
// Small point clouds by hand, and the results of reading them.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "import/cloud/points.hpp"
#include "import/program.hpp"
#include "support/temporary_folder.hpp"

namespace vantage::test {

template <class T>
void put(std::string& to, T value, bool big_endian = false) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  for (std::size_t k = 0; k < sizeof(T); ++k) to += bytes[big_endian ? sizeof(T) - 1 - k : k];
}

struct ReadPoint {
  Eigen::Vector3d position;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::uint32_t scan = 0;
};

inline std::vector<ReadPoint> points_of(importer::PointSource& source) {
  std::vector<ReadPoint> points;
  source.read([&](const importer::PointBlock& block) {
    for (std::size_t k = 0; k < block.positions.size(); ++k)
      points.push_back(
          {block.positions[k], block.normals.empty() ? Eigen::Vector3f::Zero().eval() : block.normals[k], block.scan});
  });
  return points;
}

class CloudTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  static std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  TemporaryFolder folder_;
};

template <class Call>
void expect_refused_for(const std::string& words, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "not refused; expected: " << words;
  } catch (const importer::Refused& why) {
    EXPECT_NE(std::string(why.what()).find(words), std::string::npos) << why.what();
  }
}

inline void expect_at(const ReadPoint& point, double x, double y, double z, double within = 1e-12) {
  EXPECT_LE((point.position - Eigen::Vector3d(x, y, z)).norm(), within) << point.position.transpose();
}

}  // namespace vantage::test
