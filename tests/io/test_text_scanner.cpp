// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/text/number_text.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <cstring>

namespace tetskin::io {
namespace {

TEST(ParseDouble, ReadsEveryFormOfNumber) {
  const std::pair<const char*, double> cases[] = {{"1", 1},          {"+1.5", 1.5}, {"-.5", -0.5}, {"1e-3", 0.001},
                                                  {"-2.5E+2", -250}, {"5.", 5},     {"0", 0},      {"0.1", 0.1}};
  for (const auto& [text, expected] : cases) {
    double value = 99;
    EXPECT_TRUE(parseDouble(text, value)) << text;
    EXPECT_EQ(value, expected) << text;
  }
}

TEST(ParseDouble, RejectsWhatIsNoNumber) {
  for (const char* text : {"", "+", "-", "+-1", "++1", "--1", "1,5", "1.0x", "x", "1 ", "0x10", "1e"}) {
    double value = 0;
    EXPECT_FALSE(parseDouble(text, value)) << text;
  }
}

TEST(ParseDouble, OverflowIsInfiniteAndUnderflowIsZero) {
  double value = 1;
  ASSERT_TRUE(parseDouble("1e999", value));
  EXPECT_TRUE(std::isinf(value));
  ASSERT_TRUE(parseDouble("1e-999", value));
  EXPECT_EQ(value, 0.0);
  ASSERT_TRUE(parseDouble("4.9e-324", value));
  EXPECT_EQ(value, 4.9406564584124654e-324);
  ASSERT_TRUE(parseDouble("nan", value));
  EXPECT_TRUE(std::isnan(value));
}

TEST(ParseDouble, TellsOverflowFromUnderflowByTheDigits) {
  const std::string zeros(400, '0'), ones(400, '1');
  const auto read = [](const std::string& text) {
    double value = 99;
    EXPECT_TRUE(parseDouble(text, value)) << text;
    return value;
  };
  EXPECT_EQ(read("0." + zeros + "1"), 0.0);
  EXPECT_EQ(read("0." + zeros + "1e+2"), 0.0);
  EXPECT_EQ(read("-0." + zeros + "1"), 0.0);
  EXPECT_EQ(read("." + zeros + "1"), 0.0);
  EXPECT_EQ(read("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(read("1e-9223372036854775808"), 0.0);
  EXPECT_EQ(read(ones), HUGE_VAL);
  EXPECT_EQ(read(ones + "e-5"), HUGE_VAL);
  EXPECT_EQ(read(ones + ".5E-5"), HUGE_VAL);
  EXPECT_EQ(read("+" + ones), HUGE_VAL);
  EXPECT_EQ(read("-" + ones + "e-5"), -HUGE_VAL);
  EXPECT_EQ(read("1e99999999999999999999"), HUGE_VAL);
  EXPECT_EQ(read("0." + zeros + "1e401"), 1.0);
  EXPECT_EQ(read("1" + zeros + "e-400"), 1.0);
  EXPECT_EQ(read("0" + zeros + "1"), 1.0);
}

TEST(ParseInteger, RejectsFractionsAndWhatDoesNotFit) {
  int value = 0;
  EXPECT_TRUE(parseInteger("+7", value));
  EXPECT_EQ(value, 7);
  EXPECT_TRUE(parseInteger("-2147483648", value));
  for (const char* text : {"", "1.0", "2147483648", "7a", "+-7"}) EXPECT_FALSE(parseInteger(text, value)) << text;
  unsigned count = 0;
  EXPECT_FALSE(parseInteger("-1", count));
}

template <class Number, class Bits>
void expectRoundTrips(unsigned seed) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < 20000; ++i) {
    const Bits bits = static_cast<Bits>(random());
    Number value;
    std::memcpy(&value, &bits, sizeof(value));
    if (!std::isfinite(value)) continue;
    char text[kNumberRoom];
    const char* end = formatNumber(text, value);
    double back = 0;
    ASSERT_TRUE(parseDouble({text, static_cast<std::size_t>(end - text)}, back));
    ASSERT_EQ(static_cast<Number>(back), value);
  }
}

TEST(FormatNumber, ReadsBackAsTheSameNumber) {
  expectRoundTrips<float, std::uint32_t>(1);
  expectRoundTrips<double, std::uint64_t>(2);
}

TEST(FormatNumber, IsShortest) {
  std::string text;
  appendNumber(text, 0.1f);
  text += ' ';
  appendNumber(text, 0.1);
  EXPECT_EQ(text, "0.1 0.1");
}

TEST(TextScanner, KnowsTheLineOfTheLastWord) {
  TextScanner in("one two\n\n  three\r\nfour");
  EXPECT_EQ(in.word(), "one");
  EXPECT_EQ(in.word(), "two");
  EXPECT_EQ(in.line(), 1u);
  EXPECT_EQ(in.word(), "three");
  EXPECT_EQ(in.line(), 3u);
  EXPECT_EQ(in.word(), "four");
  EXPECT_EQ(in.line(), 4u);
  EXPECT_EQ(in.word(), "");
  EXPECT_EQ(in.remaining(), 0u);
}

TEST(TextScanner, ReadsLinesWithoutTheirBreaks) {
  TextScanner in("a b\r\n\nc");
  EXPECT_EQ(in.word(), "a");
  EXPECT_EQ(in.restOfLine(), " b");
  EXPECT_EQ(in.restOfLine(), "");
  EXPECT_EQ(in.line(), 3u);
  EXPECT_EQ(in.restOfLine(), "c");
  EXPECT_EQ(in.restOfLine(), "");
}

TEST(TextScanner, HasRoomForWhatTheTextCanHold) {
  EXPECT_TRUE(TextScanner("1 2 3").hasRoomFor(3));
  EXPECT_FALSE(TextScanner("1 2 3").hasRoomFor(4));
  EXPECT_FALSE(TextScanner("1 2 3").hasRoomFor(~std::uint64_t(0)));
}

}  // namespace
}  // namespace tetskin::io
