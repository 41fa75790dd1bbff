// States that are repeated until the other side has them.
#include "tunnel/session/state_replicator.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

constexpr wire::StateName kAvatar{wire::StateKind::kAvatar, 0};
constexpr wire::StateName kMusic{wire::StateKind::kMusic, 0};

using Datagram = std::vector<std::uint8_t>;

struct Box {
  std::vector<Datagram>* datagrams;
  void operator()(wire::Bytes bytes) const { datagrams->emplace_back(bytes.begin(), bytes.end()); }
};

wire::State state_of(std::uint8_t slot, std::uint32_t version, wire::Bytes payload) {
  return {kAvatar, {slot, 9}, {}, version, payload};
}
wire::Bytes body_of(const Datagram& datagram) { return wire::Bytes(datagram).subspan(1); }

TEST(ReplicatedState, CountsChangesAndNothingElse) {
  const std::array<std::uint8_t, 2> a{1, 2}, b{1, 3};
  ReplicatedState state;
  EXPECT_TRUE(state.change(a));
  EXPECT_FALSE(state.change(a)) << "said again";
  EXPECT_EQ(state.version, 1u);
  EXPECT_TRUE(state.change(b));
  EXPECT_EQ(state.version, 2u);
  state.set(UINT32_MAX, a);
  EXPECT_TRUE(state.change(b));
  EXPECT_EQ(state.version, 1u) << "0 is no version";
}

TEST(ReplicatedState, OnlyALaterVersionIsNewer) {
  ReplicatedState state;
  EXPECT_TRUE(state.is_newer(5)) << "nothing is known yet";
  state.set(5, {});
  EXPECT_FALSE(state.is_newer(5));
  EXPECT_FALSE(state.is_newer(4));
  EXPECT_TRUE(state.is_newer(6));
}

TEST(StateReplicator, KnowsWhatTheOtherSideHasOfEachGuestAndOfTheRoom) {
  StateReplicator states;
  EXPECT_FALSE(states.has(kAvatar, 3, 1));
  states.take({kAvatar, {3, 0}, 1, {}});
  states.take({kMusic, {}, 8, {}});
  EXPECT_TRUE(states.has(kAvatar, 3, 1));
  EXPECT_FALSE(states.has(kAvatar, 3, 2)) << "a change is to be told";
  EXPECT_FALSE(states.has(kAvatar, 4, 1));
  EXPECT_TRUE(states.has(kMusic, 0, 8));
  states.forget(3);
  EXPECT_FALSE(states.has(kAvatar, 3, 1)) << "another guest has the slot";
  EXPECT_TRUE(states.has(kMusic, 0, 8));
}

TEST(StateWriter, PacksAsManyAsFitAndNoMoreDatagramsThanAllowed) {
  const std::array<std::uint8_t, 300> payload{};
  std::vector<Datagram> datagrams;
  std::uint8_t taken = 0;
  {
    StateWriter writer(Box{&datagrams}, 2);
    while (writer.add(state_of(taken, 1, payload))) ++taken;
    EXPECT_EQ(datagrams.size(), 2u);
  }
  EXPECT_EQ(datagrams.size(), 2u);
  EXPECT_GE(taken, 4);
  std::uint8_t read = 0;
  for (const Datagram& datagram : datagrams)
    EXPECT_TRUE(answer_states(
        body_of(datagram),
        [&](const wire::State& state) -> std::optional<wire::StateAck> {
          EXPECT_EQ(state.slot.slot, read++);
          return std::nullopt;
        },
        [](wire::Bytes) { FAIL() << "nothing to acknowledge"; }));
  EXPECT_EQ(read, taken) << "each once, in order";
}

TEST(StateWriter, SendsNothingWhereThereIsNothing) {
  std::vector<Datagram> datagrams;
  { StateWriter writer(Box{&datagrams}); }
  EXPECT_TRUE(datagrams.empty());
}

TEST(AnswerStates, AcknowledgesWhatWasTakenInOneDatagram) {
  const std::array<std::uint8_t, 4> payload{};
  std::vector<Datagram> datagrams, answers;
  {
    StateWriter writer(Box{&datagrams});
    for (std::uint8_t slot = 0; slot < 3; ++slot) writer.add(state_of(slot, 7u + slot, payload));
  }
  ASSERT_EQ(datagrams.size(), 1u);
  EXPECT_TRUE(answer_states(
      body_of(datagrams[0]),
      [](const wire::State& state) -> std::optional<wire::StateAck> {
        if (state.slot.slot == 1) return std::nullopt;
        return wire::StateAck{state.name, state.slot, state.version, {}};
      },
      Box{&answers}));
  ASSERT_EQ(answers.size(), 1u);
  StateReplicator states;
  EXPECT_TRUE(take_state_acks(body_of(answers[0]), [&](const auto& ack) { states.take(ack); }));
  EXPECT_TRUE(states.has(kAvatar, 0, 7));
  EXPECT_FALSE(states.has(kAvatar, 1, 8)) << "it comes again";
  EXPECT_TRUE(states.has(kAvatar, 2, 9));
}

TEST(AnswerStates, TakesNothingOfADamagedDatagram) {
  const std::array<std::uint8_t, 4> payload{};
  std::vector<Datagram> datagrams;
  {
    StateWriter writer(Box{&datagrams});
    for (std::uint8_t slot = 0; slot < 2; ++slot) writer.add(state_of(slot, 1, payload));
  }
  datagrams[0].pop_back();
  int taken = 0;
  EXPECT_FALSE(answer_states(
      body_of(datagrams[0]),
      [&](const wire::State&) -> std::optional<wire::StateAck> {
        ++taken;
        return std::nullopt;
      },
      [](wire::Bytes) {}));
  EXPECT_FALSE(take_state_acks(body_of(datagrams[0]), [&](const auto&) { ++taken; }));
  EXPECT_FALSE(take_state_acks({}, [&](const auto&) { ++taken; }));
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace dance
