// SPDX-License-Identifier: Apache-2.0
#include "report/page.hpp"

#include <gtest/gtest.h>

#include <array>

namespace vantage {
namespace {

// SHA-256 of "abc" and of the empty text (FIPS 180-2, appendix B).
constexpr PageText kAbc{"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
    kEmpty{"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"};
constexpr PageText kMarkup{"<title>{{title}}</title>{{policy}}|{{styles}}|{{scripts}}|{{data}}.", ""};

std::string page_of(const std::string& title, const nlohmann::ordered_json& data) {
  return make_page(kMarkup, {&kEmpty, 1}, {&kAbc, 1}, title, data);
}

TEST(Page, HasItsPartsAndRunsNothingElse) {
  EXPECT_EQ(page_of("a", {{"b", 1}}),
            "<title>a</title>default-src 'none'; script-src 'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='; "
            "style-src 'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='; img-src data: blob:; base-uri 'none'; "
            "form-action 'none'|<style></style>\n|<script>abc</script>\n|{\"b\":1}.");
}

// A scene may be called like a mark.
TEST(Page, WhatIsPutInHasNoMarks) {
  for (const std::string mark :
       {"{{title}}", "{{policy}}", "{{styles}}", "{{scripts}}", "{{data}}", "{{", "{{none}}"}) {
    const std::string page = page_of(mark, {{"name", mark}});
    EXPECT_TRUE(page.starts_with("<title>" + mark + "</title>default-src")) << page;
    EXPECT_TRUE(page.ends_with("|{\"name\":\"" + mark + "\"}.")) << page;
  }
}

}  // namespace
}  // namespace vantage
