#include "tunnel/wire/wire_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace dance::wire {
namespace {

std::vector<State> every_state(Bytes payload) {
  std::vector<State> states;
  for (std::size_t place = 0; place < kGuestStates; ++place)
    states.push_back({guest_state_at(place), {63, 54'321}, {}, 7, payload});
  for (std::size_t place = 0; place < kRoomStates; ++place)
    states.push_back({room_state_at(place), {}, *GuestId::parse("alice"), 0xffffffff, payload});
  return states;
}

std::vector<std::uint8_t> written(const State& state) {
  std::array<std::uint8_t, kMaxPlain> bytes;
  ByteWriter out(bytes);
  add_state(state, out);
  EXPECT_TRUE(out.ok());
  EXPECT_LE(out.size(), size_of(state));
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(out.size())};
}

TEST(WireState, ComesBackAsItWas) {
  const std::vector<std::uint8_t> payload(kMaxStatePayload, 9);
  for (const State& state : every_state(payload)) {
    const auto bytes = written(state);
    ByteReader in(bytes);
    const auto back = parse_state(in);
    ASSERT_TRUE(back);
    EXPECT_TRUE(in.is_exhausted());
    EXPECT_EQ(back->name, state.name);
    EXPECT_EQ(back->slot.slot, state.slot.slot);
    EXPECT_EQ(back->slot.generation, state.slot.generation);
    EXPECT_EQ(back->setter, state.setter);
    EXPECT_EQ(back->version, state.version);
    EXPECT_TRUE(std::equal(back->payload.begin(), back->payload.end(), payload.begin()));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ByteReader cut(Bytes(bytes).first(size));
      EXPECT_FALSE(parse_state(cut)) << size;
    }
  }
}

TEST(WireState, AcknowledgementsComeBackAsTheyWere) {
  for (const State& state : every_state({})) {
    for (const auto verdict :
         {StateVerdict::kAccepted, StateVerdict::kOverruled, StateVerdict::kNotAllowed}) {
      std::array<std::uint8_t, 16> bytes;
      ByteWriter out(bytes);
      add_state_ack({state.name, state.slot, state.version, verdict}, out);
      EXPECT_LE(out.size(), kMaxStateAckBytes);
      ByteReader in(out.written());
      const auto back = parse_state_ack(in);
      ASSERT_TRUE(back && in.is_exhausted());
      EXPECT_EQ(back->name, state.name);
      EXPECT_EQ(back->version, state.version);
      EXPECT_EQ(back->verdict, verdict);
      for (std::size_t size = 0; size < out.size(); ++size) {
        ByteReader cut(out.written().first(size));
        EXPECT_FALSE(parse_state_ack(cut));
      }
    }
  }
}

TEST(WireState, RefusesWhatNobodyBuilds) {
  const std::vector<std::uint8_t> payload(10, 1);
  const auto is_refused = [](std::vector<std::uint8_t> bytes, std::size_t at, std::uint8_t value) {
    bytes[at] = value;
    ByteReader in(bytes);
    return !parse_state(in);
  };
  const auto guests = written({{StateKind::kAvatar, 0}, {3, 4}, {}, 1, payload});
  EXPECT_TRUE(is_refused(guests, 0, 0));     // no kind
  EXPECT_TRUE(is_refused(guests, 0, 9));     // an unknown one
  EXPECT_TRUE(is_refused(guests, 0, 0x14));  // an avatar has no index
  EXPECT_TRUE(is_refused(guests, 0, 0x87));  // a ninth channel
  EXPECT_TRUE(is_refused(guests, 1, 128));   // no slot
  EXPECT_TRUE(is_refused(guests, 4, 0));     // version 0
  EXPECT_TRUE(is_refused(guests, 8, 0));     // nothing in it
  EXPECT_TRUE(is_refused(guests, 9, 2));     // too long
  const auto rooms = written({{StateKind::kMusic, 0}, {}, *GuestId::parse("alice"), 1, payload});
  EXPECT_TRUE(is_refused(rooms, 1, 0));    // nobody's
  EXPECT_TRUE(is_refused(rooms, 1, 255));  // a name beyond the end
  EXPECT_TRUE(is_refused(rooms, 2, 'A'));
}

TEST(WireState, ChannelsSayClassNameAndMessage) {
  std::array<std::uint8_t, kMaxStatePayload> bytes;
  ChannelPayload channel;
  ASSERT_TRUE(channel.name.assign(std::string(kMaxForeignName, 'L')));
  const std::vector<std::uint8_t> message(kMaxChannelStateBytes, 5);
  channel.message = message;
  std::size_t size = build(channel, bytes);
  EXPECT_EQ(size, kMaxStatePayload);
  const auto back = parse_channel({bytes.data(), size});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->name, channel.name);
  EXPECT_EQ(back->message.size(), message.size());
  bytes[0] = 2;  // of class newest nothing may follow the name
  EXPECT_FALSE(parse_channel({bytes.data(), size}));
  EXPECT_TRUE(parse_channel({bytes.data(), 2 + kMaxForeignName}));
  bytes[0] = 3;
  EXPECT_FALSE(parse_channel({bytes.data(), 2 + kMaxForeignName}));
  bytes[0] = 1;
  // Neither our own signals, nor what has come from a guest.
  for (const char* name : {"POSE/stage/alice", "LIGHT/desk/guest/bob", "a b", "", "/", "\x1b[2J"}) {
    const std::string_view text = name;
    ByteWriter out(bytes);
    out.u8(1);
    out.short_text(text);
    out.u8(0);
    EXPECT_FALSE(parse_channel(out.written())) << name;
  }
}

}  // namespace
}  // namespace dance::wire
