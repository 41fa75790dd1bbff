// Tests the payload of a guest's chat: its bytes, and which payloads are refused.
#include "tunnel/wire/wire_chat.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/allocation_guard.h"

namespace dance::wire {
namespace {

constexpr MonoTime kNow = MonoTime::from_us(0x0102030405);

Chat chat_of(ChatKind kind, std::string_view text, Duration age = {}) {
  Chat chat;
  chat.time = kNow - age;
  chat.kind = kind;
  EXPECT_TRUE(chat.text.assign(text));
  return chat;
}

ChatHistory history_of(std::initializer_list<Chat> entries) {
  ChatHistory history;
  history.sequence = 0x0a0b0c0d;
  for (const Chat& entry : entries) EXPECT_TRUE(history.entries.try_push(entry));
  return history;
}

std::vector<std::uint8_t> written(const ChatHistory& history) {
  std::array<std::uint8_t, kMaxStatePayload> bytes;
  const std::size_t size = build(history, bytes);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<std::uint8_t> golden() {
  return {0x0d, 0x0c, 0x0b, 0x0a,                       // sequence of the newest
          0x05, 0x04, 0x03, 0x02, 0x01, 0,   0,   0,    // its time
          0,    0,    2,    0,    0,                    // a heart
          0xdc, 0x05, 0,    3,    0,    'h', 'e', 'y',  // 1.5 s before, a line
          0xff, 0xff, 1,    0,    0};                   // a minute before that and longer: applause
}

TEST(WireChat, HistoriesAreWrittenAndReadByteForByte) {
  const ChatHistory history = history_of({chat_of(ChatKind::kApplause, "", Duration::s(70)),
                                          chat_of(ChatKind::kLine, "hey", Duration::ms(1500)),
                                          chat_of(ChatKind::kHeart, "")});
  EXPECT_EQ(written(history), golden());
  const auto back = parse_chat(golden());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->sequence, history.sequence);
  ASSERT_EQ(back->entries.size(), 3u);
  EXPECT_EQ(back->entries[0].kind, ChatKind::kApplause);
  EXPECT_EQ(back->entries[0].time, kNow - Duration::ms(65535)) << "the longest age";
  EXPECT_EQ(back->entries[1].text, "hey");
  EXPECT_EQ(back->entries[1].time, kNow - Duration::ms(1500));
  EXPECT_EQ(back->entries[2].kind, ChatKind::kHeart);
  EXPECT_EQ(back->entries[2].time, kNow);
}

TEST(WireChat, LeavesOutTheOldestEntriesThatDoNotFit) {
  const std::string longest(kMaxChatCharacters, 'x');
  std::string widest;
  for (std::size_t i = 0; i < kMaxChatCharacters; ++i) widest += "\xc3\xb1";
  const auto one = parse_chat(
      written(history_of({chat_of(ChatKind::kLine, longest), chat_of(ChatKind::kHeart, ""),
                          chat_of(ChatKind::kLine, widest)})));
  ASSERT_TRUE(one);
  ASSERT_EQ(one->entries.size(), 2u);
  EXPECT_EQ(one->entries[1].text, widest);
  const auto two = parse_chat(
      written(history_of({chat_of(ChatKind::kLine, "the first of all"),
                          chat_of(ChatKind::kLine, longest), chat_of(ChatKind::kLine, longest)})));
  ASSERT_TRUE(two);
  EXPECT_EQ(two->entries.size(), 2u);
}

TEST(WireChat, CountsTheEntriesThatAreNewToAReceiver) {
  ChatHistory history = history_of({chat_of(ChatKind::kHeart, ""), chat_of(ChatKind::kHeart, ""),
                                    chat_of(ChatKind::kHeart, "")});
  history.sequence = 1;  // after a wrap
  EXPECT_EQ(history.count_new(1), 0u);
  EXPECT_EQ(history.count_new(0), 1u);
  EXPECT_EQ(history.count_new(0xffffffff), 2u);
  EXPECT_EQ(history.count_new(0xfffffff0), 3u) << "more than the history holds were lost";
  EXPECT_EQ(history.count_new(2), 0u) << "an older one";
  EXPECT_EQ(history.count_new(4), 0u);
  EXPECT_EQ(history.count_new(0x70000000), 3u) << "of another run of the house";
}

TEST(WireChat, RefusesCutAndInvalidPayloads) {
  const auto bytes = golden();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A cut at the end of an entry leaves a shorter, valid history.
    const bool is_whole = size == 17 || size == 25;
    EXPECT_EQ(parse_chat(Bytes(bytes).first(size)).has_value(), is_whole) << size;
  }
  const auto outcome_of = [&](auto change) {
    auto changed = bytes;
    change(changed);
    return parse_chat(changed).has_value();
  };
  EXPECT_TRUE(outcome_of([](auto&) {}));
  EXPECT_FALSE(outcome_of([](auto& b) { b[12] = 1; })) << "the newest is older than the newest";
  EXPECT_FALSE(outcome_of([](auto& b) { b[14] = 3; })) << "an unknown kind";
  EXPECT_FALSE(outcome_of([](auto& b) { b[14] = 0; })) << "a line without text";
  EXPECT_FALSE(outcome_of([](auto& b) { b[19] = 1; })) << "a sign with text";
  EXPECT_FALSE(outcome_of([](auto& b) { b[11] = 0x7f; })) << "a time out of all bounds";
  EXPECT_FALSE(outcome_of([](auto& b) { b[25] = b[26] = 0; })) << "not in the order of time";
  for (const char bad : {'\0', '\n', '\x1b', '\x7f', '\x80', '\xff'})
    EXPECT_FALSE(outcome_of([&](auto& b) { b[23] = static_cast<std::uint8_t>(bad); })) << bad;
  EXPECT_FALSE(outcome_of([](auto& b) { b[22] = 0xe2, b[23] = 0x80, b[24] = 0xae; }))
      << "turns the direction of text";
  EXPECT_FALSE(outcome_of([](auto& b) { b[21] = 0xff; })) << "longer than it is";
  std::vector<std::uint8_t> many(bytes.begin(), bytes.begin() + 12);
  for (std::size_t i = 0; i < kMostChatEntries; ++i) many.insert(many.end(), {0, 0, 2, 0, 0});
  EXPECT_TRUE(parse_chat(many));
  many.insert(many.end(), {0, 0, 2, 0, 0});
  EXPECT_FALSE(parse_chat(many)) << "more than a history holds";
}

TEST(WireChat, SurvivesEverySingleBitFlipWithoutAllocating) {
  auto bytes = golden();
  const AllocationGuard guard;
  std::size_t invalid = 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    const auto flip = [&] {
      bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << (bit % 8)));
    };
    flip();
    if (const auto read = parse_chat(bytes))
      for (const Chat& chat : read->entries) invalid += is_valid(chat) ? 0 : 1;
    flip();
  }
  EXPECT_EQ(invalid, 0u);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance::wire
