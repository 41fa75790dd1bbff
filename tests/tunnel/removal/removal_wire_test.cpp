// The datagrams of removals, byte by byte.
#include <gtest/gtest.h>

#include <vector>

#include "tunnel/wire/wire_removal.h"

namespace dance::wire {
namespace {

using Bytes8 = std::vector<std::uint8_t>;

template <class Message>
Bytes8 written(const Message& message) {
  std::array<std::uint8_t, 64> out;
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(build(message, out))};
}

template <class Parse>
void expect_refused_when_damaged(const Bytes8& datagram, Parse parse) {
  for (std::size_t size = 1; size < datagram.size(); ++size)
    EXPECT_FALSE(parse(Bytes(datagram).subspan(1, size - 1))) << "cut to " << size;
  Bytes8 longer = datagram;
  longer.push_back(0);
  EXPECT_FALSE(parse(Bytes(longer).subspan(1)));
  Bytes8 other_form = datagram;
  other_form[1] = kRemovalForm + 1;
  EXPECT_FALSE(parse(Bytes(other_form).subspan(1)));
}

TEST(RemovalWire, IsAsDocumented) {
  const Bytes8 request = written(RemovalRequest{0x01020304, *GuestId::parse("bob")});
  EXPECT_EQ(request, (Bytes8{31, 1, 4, 3, 2, 1, 3, 'b', 'o', 'b'}));
  const auto asked = parse_removal_request(Bytes(request).subspan(1));
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->number, 0x01020304u);
  EXPECT_EQ(asked->guest.view(), "bob");
  const Bytes8 answer = written(RemovalAnswer{7, RemovalResult::kPassedOn});
  EXPECT_EQ(answer, (Bytes8{32, 1, 7, 0, 0, 0, 4}));
  const auto answered = parse_removal_answer(Bytes(answer).subspan(1));
  ASSERT_TRUE(answered);
  EXPECT_EQ(answered->number, 7u);
  EXPECT_EQ(answered->result, RemovalResult::kPassedOn);
  const Bytes8 rights = written(Rights{true});
  EXPECT_EQ(rights, (Bytes8{33, 1, 1}));
  ASSERT_TRUE(parse_rights(Bytes(rights).subspan(1)));
  EXPECT_TRUE(parse_rights(Bytes(rights).subspan(1))->may_remove);
}

TEST(RemovalWire, RefusesWhatIsNeverWritten) {
  expect_refused_when_damaged(written(RemovalRequest{7, *GuestId::parse("bob")}),
                              parse_removal_request);
  expect_refused_when_damaged(written(RemovalAnswer{7, RemovalResult::kDone}),
                              parse_removal_answer);
  expect_refused_when_damaged(written(Rights{true}), parse_rights);
  const auto refuses = [](auto parse, Bytes8 body) { EXPECT_FALSE(parse(Bytes(body))); };
  refuses(parse_removal_request, {1, 0, 0, 0, 0, 3, 'b', 'o', 'b'});
  refuses(parse_removal_request, {1, 7, 0, 0, 0, 3, 'b', 'o', 27});
  refuses(parse_removal_request, {1, 7, 0, 0, 0, 0});
  refuses(parse_removal_answer, {1, 7, 0, 0, 0, 0});
  refuses(parse_removal_answer, {1, 7, 0, 0, 0, 6});
  refuses(parse_rights, {1, 2});
}

TEST(RemovalWire, ARefusalOfOneWhoWasRemovedSaysForHowLong) {
  RefusalNotice notice;
  notice.cause = Refusal::kRemoved;
  notice.nonce = 9;
  notice.seconds = 600;
  const Bytes8 datagram = written(notice);
  EXPECT_EQ(datagram, (Bytes8{3, kWireVersion, 11, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0x58, 0x02}));
  const auto read = parse_refusal(Bytes(datagram).subspan(1));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->seconds, 600);
  notice.seconds = 0;
  EXPECT_FALSE(parse_refusal(Bytes(written(notice)).subspan(1)));
  notice.seconds = kMostRemoved_s + 1;
  EXPECT_FALSE(parse_refusal(Bytes(written(notice)).subspan(1)));
  notice.cause = Refusal::kListenersFull;
  const Bytes8 older = written(notice);
  EXPECT_EQ(older.size(), datagram.size() - 2) << "the other causes are as they were";
}

}  // namespace
}  // namespace dance::wire
