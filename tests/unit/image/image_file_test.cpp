// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/image.hpp"

namespace vantage {
namespace {

// Every byte unlike its neighbours, alpha too.
Image counting_image(std::uint32_t width, std::uint32_t height) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  std::iota(image.rgba.begin(), image.rgba.end(), std::uint8_t{0});
  return image;
}

TEST(ImageFile, PngRoundTrip) {
  const test::TemporaryFolder folder;
  const Image image = counting_image(40, 20);
  write_png(folder / "a.png", image);
  const Image back = read_image(folder / "a.png");
  EXPECT_EQ(back.width, 40u);
  EXPECT_EQ(back.height, 20u);
  EXPECT_EQ(back.rgba, image.rgba);
}

TEST(ImageFile, SaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(read_image(folder / "none.png"), Error);
  std::ofstream(folder / "text.png") << "no picture";
  try {
    read_image(folder / "text.png");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::malformed_file);
    EXPECT_NE(std::string(e.what()).find("text.png"), std::string::npos);
  }
  EXPECT_THROW(write_png(folder / "b.png", Image{2, 2, {1, 2, 3}}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
  EXPECT_THROW(write_png(folder.path() / "no" / "where.png", counting_image(2, 2)), Error);
}

}  // namespace
}  // namespace vantage
