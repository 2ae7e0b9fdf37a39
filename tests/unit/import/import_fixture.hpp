// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {

// A folder for models, a cache of its own, and the importers of the build.
class ImportTest : public testing::Test {
 protected:
  ImportTest();
  ~ImportTest() override;

  std::filesystem::path write(const std::string& name, std::string_view content) const;
  // A shell script as the importer of meshes, the only one there is from here on.
  void use_script(const std::string& body) const;
  std::filesystem::path cache() const { return folder_ / "cache/vantage/imports"; }

  TemporaryFolder folder_;
};

// As a scene; an importer gets so many seconds of computing.
Scene load_within(const std::filesystem::path& file, unsigned cpu_s);

// Runs `call`, which must throw an Error of that code with `words` in its message; returns the message.
template <class Call>
std::string expect_error(Errc code, const std::string& words, Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.code(), code) << message;
    EXPECT_NE(message.find(words), std::string::npos) << "'" << words << "' is not in: " << message;
    return message;
  }
  ADD_FAILURE() << "no error; expected: " << words;
  return {};
}

}  // namespace vantage::test
