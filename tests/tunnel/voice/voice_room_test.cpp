// Voices through link, server and link: how they come, who gets them, and that no pose is told of
// them.
#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/tunnel/voice/voices.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class VoiceRoom : public ::testing::Test {
 protected:
  VoiceRoom() { tunnel.run(Duration::ms(200)); }
  const ServerCounters& counters() { return tunnel.server().counters(); }
  std::uint64_t rejected(ServerReject cause) { return counters().of(cause); }
  // A datagram of voices as the link of `from` would send it.
  void inject(const House& from, const std::vector<wire::VoiceRecord>& records) {
    std::array<std::uint8_t, wire::kMaxPlain> buffer;
    ByteWriter out(buffer);
    wire::begin_voices(out);
    for (const auto& record : records) wire::add_voice(record, out);
    tunnel.inject(from.peer, out.written());
  }
  wire::VoiceRecord record_of(const std::string& name) {
    static const std::vector<std::uint8_t> packet(20, 3);
    for (const ServerRoom& room : tunnel.server().rooms())
      for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot)
        if (room.in_use && room.guests[slot].in_use && room.guests[slot].id == guest(name))
          return {
              {slot, room.guests[slot].generation}, 1, tunnel.now().since_zero_us(), -30, packet};
    std::abort();
  }

  SimulatedTunnel tunnel;
  House& a = tunnel.add_house("salsa", {"alice"}, Duration::s(1000));
  House& b = tunnel.add_house("salsa", {"bob"}, Duration::s(-500));
  House& c = tunnel.add_house("salsa", {});
};

TEST_F(VoiceRoom, EachComesByteForByteInTheHousesOwnTimeAndAtOnce) {
  Talk talk{tunnel, {{&a, guest("alice"), -17, 53}}};
  talk.run(Duration::s(1));
  tunnel.run(Duration::ms(20));
  ASSERT_EQ(b.voices.size(), 100u);
  EXPECT_EQ(c.voices.size(), 100u) << "who only listens hears too";
  EXPECT_TRUE(a.voices.empty()) << "nobody hears itself";
  for (std::size_t i = 0; i < b.voices.size(); ++i) {
    const House::HeardVoice& heard = b.voices[i];
    const auto sequence = static_cast<std::uint32_t>(i + 1);
    const Voice sent = voice_number(sequence, {}, 0, 53);
    EXPECT_EQ(heard.guest, guest("alice"));
    EXPECT_EQ(heard.voice.sequence, sequence);
    EXPECT_EQ(heard.voice.level_dbfs, -17);
    EXPECT_EQ(heard.voice.data, sent.data);
    EXPECT_EQ(heard.voice.size_bytes, 53);
    EXPECT_EQ(heard.voice.clock_id, b.clock_id);
    // 10 old, 5 up, 5 down, and the millisecond in which the link's turn ends.
    const double age_ms = (heard.at - heard.voice.capture_time).as_ms();
    EXPECT_GE(age_ms, 19.5);
    EXPECT_LE(age_ms, 21.5);
  }
  for (const auto& stats : b.link->remote_stats()) {
    if (stats.guest != guest("alice")) continue;
    EXPECT_EQ(stats.voices, 100u);
    EXPECT_EQ(stats.voice_bytes, 100u * (wire::kVoiceRecordHeader + 53));
  }
}

TEST_F(VoiceRoom, PosesOfATurnGoFirst) {
  Talk talk{tunnel, {{&a, guest("alice")}}};
  std::vector<wire::Type> up, down;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    const bool is_of_dance = type == wire::Type::kRecords || type == wire::Type::kVoices;
    if (to_server && peer == a.peer && is_of_dance) up.push_back(type);
    if (!to_server && peer == b.peer && is_of_dance) down.push_back(type);
    return true;
  };
  for (int i = 0; i < 20; ++i) {
    talk.say(talk.talkers[0]);  // before the pose, in the same turn
    tunnel.dance(a, guest("alice"));
    tunnel.run(Duration::ms(30));
  }
  for (const auto* way : {&up, &down}) {
    std::size_t voices = 0;
    for (std::size_t i = 0; i < way->size(); ++i) {
      if ((*way)[i] != wire::Type::kVoices) continue;
      ++voices;
      ASSERT_GT(i, 0u);
      EXPECT_EQ((*way)[i - 1], wire::Type::kRecords) << i;
    }
    EXPECT_EQ(voices, 20u);
  }
}

// The same dance twice, once with people talking: each datagram of records is the same.
TEST(VoiceBesidePoses, NoPoseIsToldOfThem) {
  const auto records_of_dance = [](bool with_voices) {
    SimulatedTunnel tunnel;
    House& a = tunnel.add_house("salsa", {"alice"});
    House& b = tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(200));
    std::vector<std::vector<std::uint8_t>> records;
    tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
      if (wire::parse_opening(bytes)->type == wire::Type::kRecords)
        records.emplace_back(bytes.begin(), bytes.end());
      return true;
    };
    Talk talk{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
    tunnel.run(Duration::s(3), [&] {
      const auto ms = tunnel.now().since_zero_us() / 1000;
      if (with_voices && ms % 10 == 0)
        for (auto& talker : talk.talkers) talk.say(talker);
      if (ms % 16 != 0) return;
      tunnel.dance(a, guest("alice"));
      tunnel.dance(b, guest("bob"));
    });
    EXPECT_EQ(b.voices.empty(), !with_voices);
    return records;
  };
  const auto silent = records_of_dance(false);
  EXPECT_GT(silent.size(), 700u);
  EXPECT_EQ(records_of_dance(true), silent);
}

TEST_F(VoiceRoom, WhoIsMutedIsNotSentAtAll) {
  Talk talk{tunnel, {{&a, guest("alice")}}};
  std::size_t sent_to_b = 0;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (!to_server && peer == b.peer && wire::parse_opening(bytes)->type == wire::Type::kVoices)
      ++sent_to_b;
    return true;
  };
  const auto voices_in = [&](const std::vector<std::string>& words) {
    b.link->set_hearing(hearing(words), tunnel.time_in(b));
    talk.run(Duration::ms(100));
    sent_to_b = 0;
    c.voices.clear();
    talk.run(Duration::ms(500));
    EXPECT_EQ(c.voices.size(), 50u) << "the others hear on";
    return sent_to_b;
  };
  EXPECT_EQ(voices_in({}), 50u);
  EXPECT_EQ(voices_in({"alice=0"}), 0u);
  EXPECT_EQ(voices_in({"carla=0"}), 50u);
  EXPECT_EQ(voices_in({"default=0"}), 0u);
  EXPECT_EQ(voices_in({"default=0", "alice=1"}), 50u);
  // Whom a house wants nothing of it does not want to hear either.
  Interest nobody;
  nobody.others = 0;
  b.link->set_interest(nobody, tunnel.time_in(b));
  EXPECT_EQ(voices_in({}), 0u);
}

TEST_F(VoiceRoom, IsMutedAlsoForWhoComesLaterAndAfterALapse) {
  b.link->set_hearing(hearing({"dora=0"}), tunnel.time_in(b));
  House& d = tunnel.add_house("salsa", {"dora"});
  tunnel.run(Duration::ms(300));
  Talk talk{tunnel, {{&a, guest("alice")}, {&d, guest("dora")}}};
  talk.run(Duration::ms(300));
  EXPECT_EQ(voices_of(b, "dora"), 0u);
  EXPECT_GT(voices_of(b, "alice"), 25u);
  EXPECT_GT(voices_of(c, "dora"), 25u);
  tunnel.seal_anew(b);  // another epoch: all is told anew
  talk.run(Duration::ms(300));
  EXPECT_EQ(voices_of(b, "dora"), 0u);
  EXPECT_GT(voices_of(b, "alice"), 45u);
}

TEST_F(VoiceRoom, WhoOnlySpeaksIsAGuestAsLongAsThatGoesOn) {
  Talk talk{tunnel, {{&c, guest("carla")}}};
  talk.run(Duration::ms(500));
  EXPECT_TRUE(b.saw("+carla"));
  EXPECT_GT(voices_of(b, "carla"), 40u);
  tunnel.run(Duration::s(11));
  EXPECT_TRUE(b.saw("-carla"));
}

TEST_F(VoiceRoom, AFloodCostsItsSenderAlone) {
  Talk talk{tunnel, {{&a, guest("alice")}}};
  Dance dance{tunnel, {{&b, guest("bob")}}};
  dance.run(Duration::s(1));
  tunnel.run(Duration::ms(50));
  const std::size_t poses = a.heard_of(guest("bob"));
  std::size_t bob_danced = 0;
  tunnel.run(Duration::s(1), [&] {
    for (int i = 0; i < 20; ++i) talk.say(talk.talkers[0]);
    if (tunnel.now().since_zero_us() / 1000 % Dance::kFrame_ms != 0) return;
    tunnel.dance(b, guest("bob"));
    ++bob_danced;
  });
  tunnel.run(Duration::ms(50));
  // Its own link lets no more through than a microphone makes.
  EXPECT_LE(b.voices.size(), 151u);
  EXPECT_GT(a.link->counters().voices_limited, 19'000u);
  EXPECT_EQ(a.heard_of(guest("bob")) - poses, bob_danced);
  // A link that does not.
  b.voices.clear();
  const std::uint64_t before = rejected(ServerReject::kVoiceRate);
  for (int i = 0; i < 500; ++i) inject(a, {record_of("alice")});
  tunnel.run(Duration::ms(50));
  EXPECT_LE(b.voices.size(), 40u);
  EXPECT_GE(rejected(ServerReject::kVoiceRate) - before, 460u);
  // Bytes have a bound too.
  tunnel.run(Duration::s(1));
  b.voices.clear();
  const std::vector<std::uint8_t> longest(kMaxVoiceBytes, 1);
  for (int i = 0; i < 30; ++i) {
    auto record = record_of("alice");
    record.packet = longest;
    inject(a, {record});
  }
  tunnel.run(Duration::ms(50));
  EXPECT_EQ(b.voices.size(), 25u);
}

TEST_F(VoiceRoom, WhatIsNotTheSendersIsCountedAndGoesNowhere) {
  inject(a, {record_of("bob")});
  EXPECT_EQ(rejected(ServerReject::kForeignSlot), 1u);
  auto record = record_of("alice");
  ++record.slot.generation;
  inject(a, {record});
  EXPECT_EQ(rejected(ServerReject::kForeignSlot), 2u) << "of the guest before";
  record = record_of("alice");
  record.capture_us -= 6'000'000;
  inject(a, {record});
  record.capture_us += 8'000'000;
  inject(a, {record});
  EXPECT_EQ(rejected(ServerReject::kBadTime), 2u);
  inject(a, {});
  EXPECT_EQ(rejected(ServerReject::kMalformed), 1u) << "an empty one";
  inject(c, {record_of("alice")});
  EXPECT_EQ(rejected(ServerReject::kForeignSlot), 3u);
  // All of a datagram or nothing.
  std::vector<std::uint8_t> damaged{30};
  std::array<std::uint8_t, 64> buffer;
  ByteWriter out(buffer);
  wire::add_voice(record_of("alice"), out);
  damaged.insert(damaged.end(), out.written().begin(), out.written().end());
  damaged.push_back(1);
  tunnel.inject(a.peer, damaged);
  EXPECT_EQ(rejected(ServerReject::kMalformed), 2u);
  tunnel.run(Duration::ms(50));
  EXPECT_TRUE(b.voices.empty());
  EXPECT_EQ(counters().voices_in, 0u);
}

TEST_F(VoiceRoom, ALinkTakesOnlyVoicesOfGuestsThatItKnowsAndOfNow) {
  std::array<std::uint8_t, wire::kMaxPlain> buffer;
  const auto receive = [&](const wire::VoiceRecord& record) {
    ByteWriter out(buffer);
    wire::begin_voices(out);
    wire::add_voice(record, out);
    b.link->receive(out.written(), tunnel.time_in(b), tunnel.time_in(b));
  };
  receive(record_of("alice"));
  EXPECT_EQ(b.voices.size(), 1u);
  auto record = record_of("alice");
  ++record.slot.generation;
  receive(record);
  record = record_of("alice");
  record.slot.slot = 99;
  receive(record);
  receive(record_of("bob"));
  EXPECT_EQ(b.link->counters().voices_unrouted, 3u);
  record = record_of("alice");
  record.capture_us -= 11'000'000;
  receive(record);
  record.capture_us += 14'000'000;
  receive(record);
  EXPECT_EQ(b.link->counters().voices_invalid, 2u);
  EXPECT_EQ(b.voices.size(), 1u);
  const std::uint64_t rejected_before = b.link->counters().rejected_datagrams;
  const std::uint8_t empty[] = {30};
  b.link->receive(empty, tunnel.time_in(b), tunnel.time_in(b));
  EXPECT_EQ(b.link->counters().rejected_datagrams, rejected_before + 1);
}

TEST_F(VoiceRoom, ALinkSendsNoVoiceThatIsNone) {
  Voice voice = voice_number(1, tunnel.time_in(a), a.clock_id);
  voice.size_bytes = 0;
  a.link->send(guest("alice"), voice, tunnel.time_in(a));
  voice = voice_number(1, tunnel.time_in(a) - Duration::s(3), a.clock_id);
  a.link->send(guest("alice"), voice, tunnel.time_in(a));
  EXPECT_EQ(a.link->counters().voices_invalid, 2u);
  // Of a clock that is not known here: made now.
  voice = voice_number(1, MonoTime::from_us(1), 4711);
  a.link->send(guest("alice"), voice, tunnel.time_in(a));
  tunnel.run(Duration::ms(50));
  ASSERT_EQ(b.voices.size(), 1u);
  EXPECT_LT((b.voices[0].at - b.voices[0].voice.capture_time).as_ms(), 15.0);
}

}  // namespace
}  // namespace dance
