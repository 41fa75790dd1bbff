// What links and server do for a codec that refers to earlier frames: acknowledgements of what all
// receivers have, intra frames for those who have nothing, and datagrams that are shared.
#include <gtest/gtest.h>

#include <set>

#include "tests/tunnel/referring_codec.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class ReferencesTest : public ::testing::Test {
 protected:
  House& add(const std::vector<std::string>& guests) {
    logs.push_back(std::make_unique<ReferringLog>());
    use_referring_codec(tunnel.link_options, *logs.back());
    return tunnel.add_house("salsa", guests);
  }
  ReferringLog& log(std::size_t house) { return *logs[house]; }
  void lose(double share, const House* only_to = nullptr) {
    tunnel.on_datagram = [this, share, only_to](bool to_server, PeerId peer, wire::Bytes) {
      const bool is_meant = only_to == nullptr || (!to_server && peer == only_to->peer);
      return !is_meant || random.uniform() >= share;
    };
  }
  static std::set<std::uint32_t> heard_by(const House& house) {
    std::set<std::uint32_t> heard;
    for (const auto& one : house.poses) heard.insert(one.pose.sequence);
    return heard;
  }

  // What one pose alone comes to: repetition has tests of its own.
  SimulatedTunnel tunnel{{.repeats = false}};
  std::vector<std::unique_ptr<ReferringLog>> logs;
  Random random{17};
};

TEST_F(ReferencesTest, FramesThatAllReceiversHaveAreAcknowledgedAndNoOthers) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  House& c = add({});  // only listens, and acknowledges all the same
  tunnel.run(Duration::ms(200));
  lose(0.2, &c);
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(5));
  tunnel.run(Duration::ms(200));
  const auto at_b = heard_by(b), at_c = heard_by(c);
  ASSERT_GT(log(0).acknowledged.size(), 100u);
  std::set<std::uint32_t> once;
  for (const std::uint32_t sequence : log(0).acknowledged) {
    EXPECT_TRUE(at_b.contains(sequence)) << sequence;
    EXPECT_TRUE(at_c.contains(sequence)) << sequence;
    EXPECT_TRUE(once.insert(sequence).second) << "told twice: " << sequence;
  }
  EXPECT_GT(at_b.size(), at_c.size() + 20);
  EXPECT_EQ(a.link->local_stats().at(0).acked, log(0).acknowledged.size());
}

TEST_F(ReferencesTest, AfterALossWhateverArrivesDecodesByAcknowledgedFrames) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  tunnel.run(Duration::ms(200));
  lose(0.08);
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(10));
  EXPECT_EQ(a.link->local_stats().at(0).references, References::kAcknowledged)
      << "20 ms there and back";
  const auto missing = b.link->counters().reference_missing;
  dance.run(Duration::s(5));
  EXPECT_EQ(b.link->counters().reference_missing, missing);
  EXPECT_GT(a.link->path().loss, 0.08);
  EXPECT_NEAR(a.link->path().round_trip.as_ms(), 20.0, 1.0);
}

TEST_F(ReferencesTest, AWayWithoutLossNeedsNoAcknowledgedFrames) {
  House& a = add({"alice"});
  add({"bob"});
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(90));
  EXPECT_EQ(a.link->local_stats().at(0).references, References::kPrevious);
}

TEST_F(ReferencesTest, ANewcomerDecodesWithinARoundTripOverItsSender) {
  tunnel.link_options.intra_frame_period = Duration();
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(2));
  const int before = log(0).intra_frames_wanted;
  House& c = add({"carol"});
  // With the hello, 5 ms, the newcomer is known. To the sender 5 ms, up to a frame, to the server 5
  // ms, down 5 ms.
  dance.run(Duration::ms(1 + 5 + 5 + 17 + 5 + 5));
  EXPECT_GE(c.heard_of(guest("alice")), 1u);
  EXPECT_EQ(log(0).intra_frames_wanted, before + 1) << "one, not many";
  dance.run(Duration::s(1));
  EXPECT_EQ(log(0).intra_frames_wanted, before + 1);
  EXPECT_EQ(b.link->counters().reference_missing, 0u);
}

// Where nothing was lost before, each frame refers to the one before it.
TEST_F(ReferencesTest, AfterACutTheFirstPoseThatArrivesDecodes) {
  tunnel.link_options.intra_frame_period = Duration();
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  for (const int cut_ms : {150, 400, 850}) {
    dance.run(Duration::s(120));
    ASSERT_EQ(a.link->local_stats().at(0).references, References::kPrevious);
    const auto missing = b.link->counters().reference_missing;
    b.is_cut = true;
    dance.run(Duration::ms(cut_ms));
    b.is_cut = false;
    const auto before = b.heard_of(guest("alice"));
    // A frame, and 10 ms of way.
    dance.run(Duration::ms(Dance::kFrame_ms + 10 + 1));
    EXPECT_GT(b.heard_of(guest("alice")), before) << cut_ms;
    dance.run(Duration::s(1));
    EXPECT_EQ(b.link->counters().reference_missing, missing) << cut_ms;
  }
}

TEST_F(ReferencesTest, ARequestWhoseAnswerIsLostIsMadeAgain) {
  tunnel.link_options.intra_frame_period = Duration();
  House& a = add({"alice"});
  House& b = add({"bob"});
  // Too far for acknowledged frames, once it is known that little is lost.
  a.up = a.down = b.up = b.down = Duration::ms(40);
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(40));
  ASSERT_EQ(a.link->local_stats().at(0).references, References::kPreviousTwice);
  // Shorter than the sender takes to notice by itself.
  b.is_cut = true;
  dance.run(Duration::ms(120));
  // Feedback does not come through at first.
  MonoTime blocked_until = tunnel.now() + Duration::ms(150);
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    return to_server || peer != a.peer || opening->type != wire::Type::kRecords ||
           tunnel.now() > blocked_until;
  };
  b.is_cut = false;
  dance.run(Duration::ms(600));
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
  EXPECT_GE(b.link->counters().intra_frames_asked, 1u);
  EXPECT_GE(b.link->remote_stats().at(0).reference_missing, 1u);
}

TEST_F(ReferencesTest, HoweverManyAskIntraFramesComeTenTimesASecondAtMost) {
  tunnel.link_options.intra_frame_period = Duration();
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  dance.run(Duration::ms(300));
  const int before = log(0).intra_frames_wanted;
  tunnel.run(Duration::s(2), [&] {
    if (tunnel.now().since_zero_us() / 1000 % 16 == 0) tunnel.dance(a, guest("alice"));
    wire::RecordsHeader header;
    for (const std::uint8_t slot : std::array<std::uint8_t, 3>{0, 1, 63})
      ASSERT_TRUE(header.wants.try_push(slot));
    std::array<std::uint8_t, 64> out;
    ByteWriter writer(out);
    wire::begin_records(header, writer);
    tunnel.inject(b.peer, writer.written());
  });
  EXPECT_LE(log(0).intra_frames_wanted - before, 21);
  EXPECT_GE(log(0).intra_frames_wanted - before, 15);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kForeignSlot), 1u) << "one's own, and none";
}

TEST_F(ReferencesTest, AnIntraFrameComesEveryTwoSecondsUnasked) {
  House& a = add({"alice"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(9));
  EXPECT_EQ(log(0).intra_frames_wanted, 4);
  EXPECT_EQ(log(0).intra_frames_encoded, 5);
  add({"bob"});
  dance.run(Duration::s(9));
  EXPECT_EQ(a.link->local_stats().at(0).references, References::kAcknowledged);
  EXPECT_EQ(log(0).intra_frames_wanted, 5) << "acknowledged frames need none but the newcomer's";
}

TEST_F(ReferencesTest, AProducerStartedAgainRestartsBothEnds) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  a.next_sequence = 5000;
  dance.run(Duration::s(1));
  const int before = log(1).decoder_restarts;
  a.next_sequence = 1;
  dance.run(Duration::s(1));
  EXPECT_EQ(log(0).encoder_restarts, 1);
  EXPECT_EQ(log(1).decoder_restarts, before + 1);
  EXPECT_EQ(b.link->counters().reference_missing, 0u);
  EXPECT_TRUE(std::find(log(0).acknowledged.begin(), log(0).acknowledged.end(), 30u) !=
              log(0).acknowledged.end());
}

TEST_F(ReferencesTest, DatagramNumbersWrapUnnoticed) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  while (b.link->counters().datagrams_out < 70'000) {
    dance.run(Duration::s(10));
    a.poses.clear();
    b.poses.clear();
  }
  const auto acked = a.link->local_stats().at(0).acked;
  dance.run(Duration::s(1));
  EXPECT_GE(a.link->local_stats().at(0).acked, acked + 60);
  EXPECT_GE(a.heard_of(guest("bob")), 60u);
  EXPECT_EQ(a.link->counters().reference_missing + b.link->counters().reference_missing, 0u);
  EXPECT_LT(a.link->path().loss, 0.001);
}

TEST_F(ReferencesTest, SequencesWrapUnnoticed) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  tunnel.run(Duration::ms(200));
  a.next_sequence = UINT32_MAX - 100;
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(4));
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(b.heard_of(guest("alice")), a.link->counters().poses_sent);
  EXPECT_TRUE(std::find(log(0).acknowledged.begin(), log(0).acknowledged.end(), UINT32_MAX - 1) !=
              log(0).acknowledged.end());
  EXPECT_TRUE(std::find(log(0).acknowledged.begin(), log(0).acknowledged.end(), 5u) !=
              log(0).acknowledged.end());
}

TEST_F(ReferencesTest, BothEndsHaveTheSameProportionsThroughSessionsAndChanges) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  log(1).needs_skeleton = true;
  tunnel.run(Duration::ms(200));
  a.link->send(guest("alice"), average_skeleton(1.6543f), tunnel.time_in(a));
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  EXPECT_EQ(b.link->counters().skeleton_missing, 0u);
  EXPECT_GE(b.heard_of(guest("alice")), 60u);
  tunnel.seal_anew(b);
  dance.run(Duration::s(1));
  const auto before = b.heard_of(guest("alice"));
  a.link->send(guest("alice"), average_skeleton(1.7f), tunnel.time_in(a));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 55);
  EXPECT_EQ(b.link->counters().invalid, 0u);
}

TEST_F(ReferencesTest, WithoutProportionsNothingIsDecodedAndThatIsCounted) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  log(1).needs_skeleton = true;
  tunnel.run(Duration::ms(200));
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    return wire::parse_opening(bytes)->type != wire::Type::kState;
  };
  a.link->send(guest("alice"), average_skeleton(1.65f), tunnel.time_in(a));
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  EXPECT_EQ(b.heard_of(guest("alice")), 0u);
  EXPECT_GE(b.link->remote_stats().at(0).skeleton_missing, 60u);
  EXPECT_EQ(b.link->counters().invalid, 0u);
  EXPECT_TRUE(log(0).acknowledged.empty()) << "what does not decode is not acknowledged";
  tunnel.on_datagram = {};
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), 30u);
}

TEST_F(ReferencesTest, AGuestWhoCannotBeDecodedKeepsNobodyElseFromBeingAcknowledged) {
  House& a = add({"alice", "anna"});
  House& b = add({"bob"});
  log(1).needs_skeleton = true;
  tunnel.run(Duration::ms(200));
  a.link->send(guest("anna"), average_skeleton(1.65f), tunnel.time_in(a));
  tunnel.run(Duration::ms(100));
  bool is_blocked = true;
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    return !is_blocked || wire::parse_opening(bytes)->type != wire::Type::kState;
  };
  a.link->send(guest("alice"), average_skeleton(1.75f), tunnel.time_in(a));
  Dance{tunnel, {{&a, guest("alice")}, {&a, guest("anna")}}}.run(Duration::s(2));
  EXPECT_EQ(b.heard_of(guest("alice")), 0u);
  const auto stats = a.link->local_stats();
  EXPECT_EQ(stats.at(0).acked, 0u);
  EXPECT_GE(stats.at(1).acked, 100u);
}

TEST_F(ReferencesTest, AReceiverThatFellSilentIsWaitedForNoMore) {
  House& a = add({"alice"});
  add({"bob"});
  House& c = add({});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  c.is_running = false;
  dance.run(Duration::ms(700));
  const auto before = log(0).acknowledged.size();
  dance.run(Duration::ms(500));
  EXPECT_GE(log(0).acknowledged.size(), before + 25);
}

TEST_F(ReferencesTest, AReceiverWhoGetsNothingCostsTheOthersNoReferences) {
  House& a = add({"alice"});
  add({"bob"});
  House& c = add({});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  // It pings on, so it is there; but no pose comes to it.
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    return to_server || peer != c.peer || wire::parse_opening(bytes)->type != wire::Type::kRecords;
  };
  dance.run(Duration::s(2));
  const auto before = log(0).acknowledged.size();
  dance.run(Duration::s(1));
  EXPECT_GE(log(0).acknowledged.size(), before + 50);
}

TEST_F(ReferencesTest, AcknowledgementsOfWhatWasNeverSentDoNothing) {
  House& a = add({"alice"});
  House& b = add({"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(1));
  const auto sent_by_a = a.next_sequence;
  for (int i = 0; i < 20'000; ++i) {
    wire::RecordsHeader header;
    header.number = static_cast<std::uint16_t>(random.next_u64());
    header.has_acks = true;
    header.acks.newest = static_cast<std::uint16_t>(random.next_u64());
    header.acks.before = static_cast<std::uint32_t>(random.next_u64());
    header.has_feedback = i % 2 == 0;  // a server that lies, then a link
    header.feedback.loss = static_cast<std::uint16_t>(random.next_u64());
    header.feedback.in_a_row = static_cast<std::uint16_t>(random.next_u64());
    header.feedback.round_trip = static_cast<std::uint16_t>(random.next_u64());
    (void)header.feedback.guests.try_push({static_cast<std::uint8_t>(random.below(64)),
                                           static_cast<std::uint8_t>(random.below(3)),
                                           static_cast<std::uint8_t>(random.below(4)), true,
                                           static_cast<std::uint16_t>(random.next_u64()),
                                           static_cast<std::uint16_t>(random.next_u64())});
    std::array<std::uint8_t, 128> out;
    ByteWriter writer(out);
    wire::begin_records(header, writer);
    if (header.has_feedback)
      a.link->receive(writer.written(), tunnel.time_in(a), tunnel.time_in(a));
    else
      tunnel.inject(b.peer, writer.written());
    if (i % 50 == 0) dance.run(Duration::ms(1));
  }
  for (const std::uint32_t sequence : log(0).acknowledged) EXPECT_LT(sequence, a.next_sequence);
  EXPECT_GT(a.next_sequence, sent_by_a);
  dance.run(Duration::s(1));
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(3));
  EXPECT_GE(b.heard_of(guest("alice")), before + 120);
}

TEST_F(ReferencesTest, ALinkThatDoesNotKnowTheRoomsModelIsRefused) {
  add({"alice"});
  tunnel.run(Duration::ms(100));
  ReferringLog other;
  use_referring_codec(tunnel.link_options, other);
  tunnel.link_options.codecs[0].model = 5;
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(b.saw("refused 6 "));
}

}  // namespace
}  // namespace dance
