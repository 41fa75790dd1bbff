// The check against messages that LCM's own generated code encoded.
#include "tunnel/policy/layout_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <dancelcm/pose_t.hpp>
#include <dancelcm/stats_t.hpp>
#include <limits>
#include <testlcm/arm_t.hpp>
#include <vector>

#include "core/base/random.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using Message = std::vector<std::uint8_t>;

constexpr const char* kArmLayout =
    "utime:i64,joints:i32,f64[joints],rows:i8,columns:i16,f32[rows][columns],string,"
    "string[joints],bool,bytes[3]";

LayoutCheck layout(std::string_view text) {
  auto parsed = LayoutCheck::parse(text);
  EXPECT_TRUE(parsed) << text << ": " << parsed.error().what;
  return parsed ? *parsed : LayoutCheck();
}

template <class T>
Message lcm_bytes(const T& message) {
  Message bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  return bytes;
}

testlcm::arm_t arm(int joints, int rows, int columns) {
  testlcm::arm_t arm;
  arm.utime = 1'234'567;
  arm.joints = joints;
  arm.rows = static_cast<std::int8_t>(rows);
  arm.columns = static_cast<std::int16_t>(columns);
  for (int i = 0; i < joints; ++i) {
    arm.angle.push_back(0.5 * i);
    arm.joint_name.push_back("joint " + std::to_string(i));
  }
  arm.grid.resize(static_cast<std::size_t>(rows));
  for (auto& row : arm.grid) row.resize(static_cast<std::size_t>(columns), 1.5f);
  arm.name = "left";
  arm.moving = 1;
  for (auto& flag : arm.flags) flag = 255;
  return arm;
}

TEST(LayoutCheck, AcceptsWhatLcmEncodes) {
  const LayoutCheck check = layout(kArmLayout);
  for (int joints : {0, 1, 7, 20})
    for (int rows : {0, 1, 3})
      for (int columns : {0, 1, 5}) {
        const Message bytes = lcm_bytes(arm(joints, rows, columns));
        EXPECT_TRUE(check.accepts(bytes)) << joints << " " << rows << " " << columns;
        const AllocationGuard guard;
        check.accepts(bytes);
        EXPECT_EQ(guard.allocations(), 0u);
      }
  EXPECT_TRUE(layout("i64,i64,i64[6],i32,i32,f32[22][4],f32[3],f32,f64")
                  .accepts(lcm_bytes(dancelcm::pose_t{})));
  EXPECT_TRUE(layout("i64[22]").accepts(lcm_bytes(dancelcm::stats_t{})));
  EXPECT_FALSE(layout("i64[21]").accepts(lcm_bytes(dancelcm::stats_t{})));
}

TEST(LayoutCheck, WantsTheFingerprintThatItWasGiven) {
  const Message bytes = lcm_bytes(arm(2, 1, 1));
  LayoutCheck check = layout(kArmLayout), any = layout("any");
  const auto right = static_cast<std::uint64_t>(testlcm::arm_t::getHash());
  check.require_fingerprint(right);
  any.require_fingerprint(right);
  EXPECT_TRUE(check.accepts(bytes));
  EXPECT_TRUE(any.accepts(bytes));
  EXPECT_FALSE(any.accepts(Message(7)));
  check.require_fingerprint(right ^ 1);
  any.require_fingerprint(right ^ 1);
  EXPECT_FALSE(check.accepts(bytes));
  EXPECT_FALSE(any.accepts(bytes));
}

TEST(LayoutCheck, RefusesEveryOtherLength) {
  const LayoutCheck check = layout(kArmLayout);
  Message bytes = lcm_bytes(arm(3, 2, 2));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(check.accepts(std::span(bytes).first(size))) << size;
  bytes.push_back(0);
  EXPECT_FALSE(check.accepts(bytes));
}

// Whatever passes, LCM's own decoder reads to the last byte, and makes the same bytes of it.
TEST(LayoutCheck, LetsNothingThroughThatTheDecoderDoesNotReadWhole) {
  const LayoutCheck check = layout(kArmLayout);
  Random random(97);
  std::size_t passed = 0;
  for (int round = 0; round < 20'000; ++round) {
    Message bytes =
        lcm_bytes(arm(static_cast<int>(random.below(4)), static_cast<int>(random.below(3)),
                      static_cast<int>(random.below(3))));
    for (std::uint64_t flips = 1 + random.below(3); flips > 0; --flips) {
      const std::size_t at = 8 + random.below(bytes.size() - 8);
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << random.below(8)));
    }
    if (!check.accepts(bytes)) continue;
    ++passed;
    testlcm::arm_t decoded;
    ASSERT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
              static_cast<int>(bytes.size()));
    EXPECT_EQ(lcm_bytes(decoded), bytes);
  }
  EXPECT_GT(passed, 1000u);
}

void put_i32(Message& bytes, std::size_t at, std::int32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * (3 - i)));
}

TEST(LayoutCheck, RefusesImpossibleCounts) {
  const LayoutCheck check = layout("n:i32,f64[n]");
  Message bytes(8 + 4 + 16);
  put_i32(bytes, 8, 2);
  EXPECT_TRUE(check.accepts(bytes));
  for (const std::int32_t count : {-1, 0, 1, 3, 0x20000002, std::numeric_limits<int>::max(),
                                   std::numeric_limits<int>::min()}) {
    put_i32(bytes, 8, count);
    EXPECT_FALSE(check.accepts(bytes)) << count;
  }
  // An i64 whose low half is the right count.
  const LayoutCheck wide = layout("n:i64,f64[n]");
  Message more(8 + 8 + 16);
  put_i32(more, 12, 2);
  EXPECT_TRUE(wide.accepts(more));
  put_i32(more, 8, 1);
  EXPECT_FALSE(wide.accepts(more));
  put_i32(more, 8, -1);
  EXPECT_FALSE(wide.accepts(more));
  const LayoutCheck narrow = layout("n:i8,i8[n]");
  Message few(8 + 1 + 128);
  few[8] = 0x80;  // -128, not 128
  EXPECT_FALSE(narrow.accepts(few));
}

// An inner count of 0 takes no bytes, but a generated decoder would make the rows all the same.
TEST(LayoutCheck, RefusesRowsWithoutEnd) {
  const LayoutCheck check = layout("n:i32,m:i32,f64[n][m]");
  Message bytes(8 + 8);
  EXPECT_TRUE(check.accepts(bytes));
  put_i32(bytes, 8, 2'000'000'000);
  EXPECT_FALSE(check.accepts(bytes));
  put_i32(bytes, 8, 0);
  put_i32(bytes, 12, 2'000'000'000);
  EXPECT_FALSE(check.accepts(bytes));
  const LayoutCheck cube = layout("a:i32,b:i32,c:i32,f64[a][b][c]");
  Message three(8 + 12);
  put_i32(three, 8, 10);
  put_i32(three, 12, 10);
  EXPECT_FALSE(cube.accepts(three));  // a hundred rows in 20 bytes
}

TEST(LayoutCheck, RefusesStringsWithoutTheirEnd) {
  const LayoutCheck check = layout("string");
  const auto text = [](std::int32_t size, std::string_view characters) {
    Message bytes(12 + characters.size());
    put_i32(bytes, 8, size);
    std::copy(characters.begin(), characters.end(), bytes.begin() + 12);
    return bytes;
  };
  using std::literals::operator""sv;
  EXPECT_TRUE(check.accepts(text(1, "\0"sv)));
  EXPECT_TRUE(check.accepts(text(4, "abc\0"sv)));
  EXPECT_FALSE(check.accepts(text(4, "abcd"sv)));    // no 0
  EXPECT_FALSE(check.accepts(text(4, "a\0c\0"sv)));  // ends twice
  EXPECT_FALSE(check.accepts(text(3, "abc\0"sv)));
  EXPECT_FALSE(check.accepts(text(5, "abc\0"sv)));
  EXPECT_FALSE(check.accepts(text(0, ""sv)));
  EXPECT_FALSE(check.accepts(text(-1, "abc\0"sv)));
  EXPECT_FALSE(check.accepts(text(std::numeric_limits<int>::max(), "abc\0"sv)));
}

TEST(LayoutCheck, KnowsOnlyTwoTruths) {
  const LayoutCheck check = layout("bool");
  Message bytes(9);
  EXPECT_TRUE(check.accepts(bytes));
  bytes[8] = 1;
  EXPECT_TRUE(check.accepts(bytes));
  bytes[8] = 2;
  EXPECT_FALSE(check.accepts(bytes));
}

TEST(LayoutCheck, NamesTheWordThatItCannotRead) {
  const auto expect_error = [](std::string_view text, std::string_view word,
                               std::string_view hint) {
    const auto parsed = LayoutCheck::parse(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_NE(parsed.error().what.find(word), std::string::npos) << parsed.error().what;
    EXPECT_NE(parsed.error().what.find(hint), std::string::npos) << parsed.error().what;
  };
  expect_error("", "", "no such type");
  expect_error("i64,", "", "no such type");
  expect_error("i64,u8", "u8", "no such type");
  expect_error("i64,any", "any", "no such type");
  expect_error("f64[n]", "f64[n]", "a field before it");
  expect_error("n:i32[2],f64[n]", "f64[n]", "one integer");
  expect_error("n:f32,f64[n]", "f64[n]", "one integer");
  expect_error("f64[n],n:i32", "f64[n]", "a field before it");
  expect_error("n:i32,n:i32", "n:i32", "given to a field before");
  expect_error("2:i32", "2:i32", "a name");
  expect_error(":i32", ":i32", "a name");
  expect_error("f64[]", "f64[]", "a number");
  expect_error("f64[0]", "f64[0]", "1 to");
  expect_error("f64[5000]", "f64[5000]", "1 to");
  expect_error("f64[-1]", "f64[-1]", "a number");
  expect_error("f64[3", "f64[3", "brackets");
  expect_error("f64[3]x", "f64[3]x", "brackets");
  expect_error("f64[1][1][1][1]", "f64[1]", "at most 3");
  std::string many = "i8";
  for (std::size_t i = 0; i < LayoutCheck::kMaxFields; ++i) many += ",i8";
  expect_error(many, "i8", "32 fields");
}

}  // namespace
}  // namespace dance
