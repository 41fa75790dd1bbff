// How sealed datagrams look from outside.
#include <gtest/gtest.h>

#include <vector>

#include "tunnel/seal/seal_format.h"

namespace dance {
namespace {

TEST(SealFormat, OpeningComesBack) {
  std::vector<std::uint8_t> bytes(40, 1);
  for (const auto form : {seal::Form::kRecords, seal::Form::kCompact}) {
    seal::write_opening(0x123456789abcdef0, form, bytes);
    const auto opening = seal::parse(bytes);
    ASSERT_TRUE(opening);
    EXPECT_EQ(opening->id, 0x123456789abcdef0u);
    EXPECT_EQ(opening->form, form);
    EXPECT_EQ(opening->body.size(), 32u);
  }
  seal::write_opening(4, seal::Form::kNotice, bytes);
  EXPECT_FALSE(seal::parse(bytes));  // a notice says nothing more
  EXPECT_TRUE(seal::parse(seal::Bytes(bytes).first(8)));
  bytes[0] |= 3;
  EXPECT_FALSE(seal::parse(seal::Bytes(bytes).first(8)));
  EXPECT_FALSE(seal::parse(seal::Bytes(bytes).first(7)));
  EXPECT_EQ(seal::id_of(3), 0u);
  EXPECT_EQ(seal::id_of(0xffff'ffff'5247'4344u), 0u);
}

TEST(SealFormat, SequencesAreTheNearest) {
  for (const std::uint64_t newest : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{40'000},
                                     std::uint64_t{65'535}, std::uint64_t{1} << 32}) {
    for (const std::int64_t ahead : {-30'000, -1, 0, 1, 2, 500, 32'767}) {
      if (ahead < 0 && newest < static_cast<std::uint64_t>(-ahead)) continue;
      const auto sequence = static_cast<std::uint64_t>(static_cast<std::int64_t>(newest) + ahead);
      EXPECT_EQ(seal::nearest_sequence(static_cast<std::uint16_t>(sequence), newest), sequence);
    }
  }
}

TEST(SealFormat, WindowTakesEachSequenceOnce) {
  seal::ReplayWindow window;
  EXPECT_TRUE(window.may_take(0));
  window.take(5);
  EXPECT_FALSE(window.may_take(5));
  EXPECT_TRUE(window.may_take(4));
  window.take(4);
  EXPECT_FALSE(window.may_take(4));
  window.take(68);
  EXPECT_FALSE(window.may_take(5));
  EXPECT_TRUE(window.may_take(6));
  EXPECT_FALSE(window.may_take(4));  // too old to tell
  window.take(1000);
  EXPECT_FALSE(window.may_take(68));
  EXPECT_TRUE(window.may_take(999));
  EXPECT_EQ(window.newest(), 1000u);
}

TEST(SealFormat, RecordsAreTakenOffOneByOne) {
  std::vector<std::uint8_t> bytes(seal::kRecordHeader);
  seal::write_record_header(0x010203040506, 3, bytes);
  bytes.insert(bytes.end(), {7, 8, 9});
  const auto one = bytes;
  bytes.insert(bytes.end(), one.begin(), one.end() - 1);
  seal::Bytes rest = bytes;
  const auto first = seal::take_record(rest);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->type, seal::kApplicationData);
  EXPECT_EQ(first->epoch, 1);
  EXPECT_EQ(first->sequence, 0x010203040506u);
  EXPECT_EQ(first->body().size(), 3u);
  EXPECT_FALSE(seal::take_record(rest));  // the second is cut
}

}  // namespace
}  // namespace dance
