// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>

#include "image/decode.hpp"
#include "image/encode.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/image.hpp"

namespace vantage {
namespace {

// Every byte differs from its neighbours, alpha included.
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

// A file may claim that a Huffman table has more codes than possible.
TEST(ImageFile, RefusesJpegsWithDamagedTables) {
  const test::TemporaryFolder folder;
  Image image{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 200)};
  const std::vector<std::uint8_t> whole = encode_jpeg(image, 80);
  std::size_t tables = 0;
  for (std::size_t at = 0; at + 21 < whole.size(); ++at) {
    if (whole[at] != 0xff || whole[at + 1] != 0xc4) continue;
    ++tables;
    std::vector<std::uint8_t> damaged = whole;
    for (std::size_t length = 0; length < 16; ++length) damaged[at + 5 + length] = 255;
    std::ofstream(folder / "damaged.jpg", std::ios::binary)
        .write(reinterpret_cast<const char*>(damaged.data()), static_cast<std::streamsize>(damaged.size()));
    EXPECT_THROW(read_image(folder / "damaged.jpg"), Error);
  }
  EXPECT_GT(tables, 0u);
}

TEST(ImageFile, JpegsAreReadBackNearlyAsTheyWere) {
  const test::TemporaryFolder folder;
  Image image{48, 32, {}};
  for (std::uint32_t y = 0; y < 32; ++y)
    for (std::uint32_t x = 0; x < 48; ++x)
      for (const std::uint32_t v : {5 * x, 7 * y, 128u, 255u}) image.rgba.push_back(static_cast<std::uint8_t>(v));
  const auto bytes = encode_jpeg(image, 95), small = encode_jpeg(image, 10);
  EXPECT_LT(small.size(), bytes.size());
  std::ofstream(folder / "a.jpg", std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  const Image again = read_image(folder / "a.jpg");
  ASSERT_EQ(again.width, 48u);
  ASSERT_EQ(again.rgba.size(), image.rgba.size());
  for (std::size_t k = 0; k < image.rgba.size(); ++k) ASSERT_NEAR(again.rgba[k], image.rgba[k], 12) << k;
  EXPECT_THROW(encode_jpeg(Image{2, 2, {}}, 80), Error);
  EXPECT_THROW(encode_jpeg(image, 0), Error);
}

// A chunk claims a gigabyte, which the decoder would allocate before looking at it.
TEST(ImageFile, RefusesPngsWhoseChunksClaimMoreThanThereIs) {
  const test::TemporaryFolder folder;
  write_png(folder / "a.png", counting_image(40, 20));
  std::ifstream file(folder / "a.png", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t type = bytes.find("IDAT");
  ASSERT_NE(type, std::string::npos);
  for (const std::string_view length : {"\x41\x54\x01\x1a", "\xff\xff\xff\xff"}) {
    bytes.replace(type - 4, 4, length);
    std::ofstream(folder / "b.png", std::ios::binary) << bytes;
    try {
      read_image(folder / "b.png");
      FAIL() << "it was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::malformed_file) << error.what();
      EXPECT_NE(std::string(error.what()).find("b.png is no PNG or JPEG that can be read: "), std::string::npos)
          << error.what();
    }
  }
}

TEST(ImageFile, TellsWhatDecodingTakesFromTheHeader) {
  const test::TemporaryFolder folder;
  write_png(folder / "a.png", counting_image(40, 20));
  std::ifstream file(folder / "a.png", std::ios::binary);
  const std::vector<char> png{std::istreambuf_iterator<char>(file), {}};
  const auto jpeg = encode_jpeg(counting_image(48, 32), 90);
  const auto header = [](const auto& bytes) {
    return read_image_header({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  };
  EXPECT_EQ(header(png).width, 40u);
  EXPECT_EQ(header(png).height, 20u);
  EXPECT_GE(header(png).decoding_bytes, 4u * 40 * 20);
  EXPECT_LT(header(png).decoding_bytes, 10u << 20);
  EXPECT_EQ(header(jpeg).width, 48u);
  EXPECT_EQ(header(jpeg).decoding_bytes, 12u * 48 * 32);
  EXPECT_EQ(header(std::string("no picture")).decoding_bytes, 0u);
  EXPECT_EQ(header(std::string()).decoding_bytes, 0u);
}

// The format allows them, mostly at the beginning.
TEST(ImageFile, PngsMayHaveChunksWithoutData) {
  const test::TemporaryFolder folder;
  const Image image = counting_image(40, 20);
  write_png(folder / "a.png", image);
  std::ifstream file(folder / "a.png", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string nothing("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12);
  const std::size_t data = bytes.find("IDAT"), end = bytes.find("IEND");
  ASSERT_NE(data, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  bytes.insert(end - 4, nothing);
  bytes.insert(data - 4, nothing + nothing);
  std::ofstream(folder / "b.png", std::ios::binary) << bytes;
  EXPECT_EQ(read_image(folder / "b.png").rgba, image.rgba);
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
