// SPDX-License-Identifier: Apache-2.0
#include "cli/parse.hpp"

#include <gtest/gtest.h>

#include "vantage/error.hpp"

namespace vantage::cli {
namespace {

template <class F>
std::string refusal(F&& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    return error.what();
  }
  return "accepted";
}

TEST(Parse, NumbersAreWholeTexts) {
  EXPECT_EQ(parse_number("1.5", "--x"), 1.5);
  EXPECT_EQ(parse_number(" +2e-3 ", "--x"), 2e-3);
  EXPECT_EQ(parse_number("-.5", "--x"), -0.5);
  for (const char* text : {"", " ", "abc", "1.5m", "1,5", "0x10", "+-1", "--1", "1 2"})
    EXPECT_NE(refusal([&] { parse_number(text, "--x"); }).find("is not a number"), std::string::npos) << text;
}

TEST(Parse, NumbersAreFinite) {
  for (const char* text : {"nan", "inf", "-inf", "NaN"})
    EXPECT_NE(refusal([&] { parse_number(text, "--x"); }).find("is not a finite number"), std::string::npos) << text;
  EXPECT_NE(refusal([] { parse_number("1e999", "--x"); }).find("too large"), std::string::npos);
}

TEST(Parse, RefusalsNameOptionValueAndInterval) {
  EXPECT_EQ(refusal([] { parse_number("0", "--step", kPositive); }), "--step: '0' must be above 0");
  EXPECT_EQ(refusal([] { parse_number("-1", "--height", kNotNegative); }), "--height: '-1' must be at least 0");
  EXPECT_EQ(refusal([] { parse_number("361", "--horizontal", {.low = 0, .high = 360, .low_included = false}); }),
            "--horizontal: '361' must be above 0 and at most 360");
}

TEST(Parse, CountsAreWholeNumbersInRange) {
  EXPECT_EQ(parse_count("18446744073709551615", "--seed"), 18446744073709551615u);
  EXPECT_EQ(refusal([] { parse_count("18446744073709551616", "--seed"); }),
            "--seed: '18446744073709551616' must be at least 0 and fit in 64 bits");
  EXPECT_EQ(refusal([] { parse_count("65", "--stations", 1, 64); }), "--stations: '65' must lie between 1 and 64");
  for (const char* text : {"", "-1", "1.5", "1e3", "eight"})
    EXPECT_NE(refusal([&] { parse_count(text, "--n"); }).find("is not a whole number"), std::string::npos) << text;
}

TEST(Parse, StationsAreHeadsOrUvs) {
  EXPECT_EQ(parse_station("1,-2,3.5", "--station").position, (Vec3{1, -2, 3.5}));
  EXPECT_EQ(parse_station("0.25,0.5", "--station").pair, (std::array{0.25, 0.5}));
  EXPECT_EQ(parse_station("u=0.25,v=0.5", "--station").uv, (Uv{0.25, 0.5}));
  EXPECT_EQ(parse_station("y=3.6, x=5", "--station").xy, (std::array{5.0, 3.6}));
  EXPECT_EQ(parse_station("x=5,y=3.6,z=1.85", "--station").position, (Vec3{5, 3.6, 1.85}));
  EXPECT_EQ(parse_station("x=5,y=3.6,ground=-1", "--station").ground, (Vec3{5, 3.6, -1}));
  const auto part = parse_station(
      "x=5,y=3,z=2,step=0.2,zenith-step=0.3,horizontal=90,vertical=160,zenith-start=40,nearest=1,farthest=80,name=P 1",
      "--station");
  EXPECT_EQ(part.name, "P 1");
  EXPECT_EQ(part.step, Angle::degrees(0.2));
  EXPECT_EQ(part.view.zenith_step, Angle::degrees(0.3));
  EXPECT_EQ(part.view.horizontal, Angle::degrees(90));
  EXPECT_EQ(part.view.vertical, Angle::degrees(160));
  EXPECT_EQ(part.view.zenith_start, Angle::degrees(40));
  EXPECT_EQ(part.view.nearest_m, 1);
  EXPECT_EQ(part.view.farthest_m, 80);
  const auto lying = parse_station("x=5,y=3,z=2,heading=30,tilt=90,step=0.2,scanner=rtc360@6mm", "--station");
  EXPECT_EQ(lying.position, (Vec3{5, 3, 2}));
  EXPECT_EQ(lying.setup, (StationSetup{.heading = Angle::degrees(30), .tilt = Angle::degrees(90)}));
  EXPECT_EQ(lying.step, Angle::degrees(0.2));
  EXPECT_EQ(lying.scanner, "rtc360@6mm");
  for (const char* text :
       {"x=5", "x=5,z=1", "u=1", "u=1,v=2,x=3", "x=1,y=2,z=3,ground=1", "x=1,2", "a=1,b=2", "x=1,x=2"})
    EXPECT_NE(refusal([&] { parse_station(text, "--station"); }), "accepted") << text;
  for (const char* text : {"1", "1,2,3,4", "", "1;2;3", "5;3,6;1,85"})
    EXPECT_NE(refusal([&] { parse_station(text, "--station"); }).find("is no station"), std::string::npos) << text;
  EXPECT_NE(refusal([] { parse_station("1,nan,3", "--station"); }).find("'nan' is not a finite number"),
            std::string::npos);
}

TEST(Parse, CountRanges) {
  const auto one = parse_count_range("8", "--stations", 1, 64), many = parse_count_range("8..20", "--stations", 1, 64);
  EXPECT_EQ(one.low, 8u);
  EXPECT_EQ(one.high, 8u);
  EXPECT_EQ(many.low, 8u);
  EXPECT_EQ(many.high, 20u);
  EXPECT_NE(refusal([] { parse_count_range("8..4", "--stations", 1, 64); }).find("must not fall"), std::string::npos);
  for (const char* text : {"0", "65", "0..4", "4..65", "..4", "4..", "4...6", "a..b", "4-6"})
    EXPECT_NE(refusal([&] { parse_count_range(text, "--stations", 1, 64); }), "accepted") << text;
}

TEST(Parse, SamplesAreNumbersOrShares) {
  EXPECT_EQ(parse_sample("20000", "--sample").of(1'000'000), 20'000u);
  EXPECT_EQ(parse_sample("20000", "--sample").of(500), 500u);
  EXPECT_EQ(parse_sample("5%", "--sample").of(1000), 50u);
  EXPECT_EQ(parse_sample("0.25", "--sample").of(1000), 250u);
  EXPECT_EQ(parse_sample("100%", "--sample").of(1000), 1000u);
  EXPECT_EQ(parse_sample("0.0001", "--sample").of(1000), 1u);
  for (const char* text : {"0", "0%", "101%", "1.5", "-1", "%"})
    EXPECT_NE(refusal([&] { parse_sample(text, "--sample"); }), "accepted") << text;
}

TEST(Parse, Devices) {
  const DeviceList several = parse_devices("0,3,cpu", "--device");
  EXPECT_EQ(several.numbers, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_TRUE(several.cpu);
  EXPECT_FALSE(several.all);
  EXPECT_TRUE(parse_devices("all", "--device").all);
  for (const char* text : {"", ",", "0,", "0,0", "all,all", "all,2", "cpu,cpu", "gpu", "-1", "65536", "1.5"})
    EXPECT_NE(refusal([&] { parse_devices(text, "--device"); }), "accepted") << text;
}

TEST(Parse, Durations) {
  EXPECT_EQ(parse_bytes("4G", "--memory"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_bytes("1.5 GiB", "--memory"), std::uint64_t{3} << 29);
  EXPECT_EQ(parse_bytes("500MB", "--memory"), std::uint64_t{500} << 20);
  EXPECT_EQ(parse_bytes("2e9", "--memory"), 2'000'000'000u);
  for (const char* text : {"", "G", "0", "-1G", "4X", "1e30", "nan", "4GG"})
    EXPECT_NE(refusal([&] { parse_bytes(text, "--memory"); }), "accepted") << text;
  EXPECT_EQ(parse_duration("90", "--max-time"), 90);
  EXPECT_EQ(parse_duration("90s", "--max-time"), 90);
  EXPECT_EQ(parse_duration("1.5min", "--max-time"), 90);
  EXPECT_EQ(parse_duration("2m", "--max-time"), 120);
  EXPECT_EQ(parse_duration("2h", "--max-time"), 7200);
  for (const char* text : {"0", "-1s", "soon", "h", "1d"})
    EXPECT_NE(refusal([&] { parse_duration(text, "--max-time"); }), "accepted") << text;
  EXPECT_EQ(parse_duration("+90 s", "--max-time"), 90);
  EXPECT_EQ(refusal([&] { parse_duration("5parsec", "--max-time"); }),
            "--max-time: '5parsec' is no time; write a number and s, min or h: 90s, 15min or 2h");
}

}  // namespace
}  // namespace vantage::cli
