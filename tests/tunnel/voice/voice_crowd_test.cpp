// Many guests speak at once: each receiver gets eight talkers, and all talkers get turns.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/allocation_guard.h"
#include "tests/tunnel/voice/voices.h"
#include "tunnel/server/voice/talker_places.h"
#include "tunnel/server/voice/voice_queue.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

OwnerKey person(int number) { return {guest("key-" + std::to_string(number)), false}; }
const OwnerKey kRoomKey{guest("party"), true};

// A talker who sends a packet every `interval`.
struct Speaker {
  std::uint8_t slot = 0;
  OwnerKey key;
  std::uint64_t link = 0;
  Duration interval = kVoiceFrame;
};

class TalkerPlacesTest : public ::testing::Test {
 protected:
  // A guest of a person's key; slot and key have the same number unless stated.
  std::size_t take(std::uint8_t slot, int key) { return take({slot, person(key), 1}); }
  std::size_t take(const Speaker& who) {
    return places.take(who.slot, who.key, who.link, audible, now);
  }
  // Lets these guests speak; returns how many packets of each slot were sent.
  std::map<std::uint8_t, int> speak(const std::vector<Speaker>& speakers, Duration duration) {
    std::map<std::uint8_t, int> sent;
    for (const MonoTime end = now + duration; now < end; now += kVoiceFrame)
      for (const Speaker& who : speakers)
        if (now.since_zero_us() % who.interval.count_us() == 0)
          sent[who.slot] += take(who) < audible ? 1 : 0;
    return sent;
  }
  static std::vector<Speaker> people(int count, Duration interval = kVoiceFrame) {
    std::vector<Speaker> all;
    for (int i = 0; i < count; ++i)
      all.push_back({static_cast<std::uint8_t>(i), person(i), 1, interval});
    return all;
  }
  // `honest` speaks for `duration`, while eight links of one key speak and are replaced by links
  // with new tokens each 1.5 s. Returns how many packets of `honest` were sent.
  int speak_beside_changing_links(const OwnerKey& attacker, const Speaker& honest,
                                  Duration duration) {
    int sent = 0;
    for (const MonoTime end = now + duration; now < end;) {
      std::vector<Speaker> speakers;
      for (std::uint8_t slot = 0; slot < kMaxTalkers; ++slot)
        speakers.push_back({slot, attacker, next_token++});
      speakers.push_back(honest);
      sent += speak(speakers, Duration::ms(1500))[honest.slot];
    }
    return sent;
  }

  std::size_t audible = kMaxTalkers;  // voices that the receiver's line bears
  TalkerPlaces places;
  MonoTime now = MonoTime::from_us(1'000'000);
  std::uint64_t next_token = 100;
};

TEST_F(TalkerPlacesTest, ATalkerKeepsItsPlaceUntilItIsSilent) {
  for (std::uint8_t slot = 0; slot < kMaxTalkers; ++slot) EXPECT_EQ(take(slot, slot), slot);
  EXPECT_EQ(take(3, 3), 3u);
  EXPECT_EQ(take(9, 9), kMaxTalkers) << "all places are taken";
  now += TalkerPlaces::kLeavesAfter + Duration::ms(1);
  for (std::uint8_t slot = 1; slot < kMaxTalkers; ++slot) take(slot, slot);
  EXPECT_LT(take(9, 9), kMaxTalkers) << "0 is silent";
}

TEST_F(TalkerPlacesTest, APersonsKeyHasOnePlaceHoweverManyLinksAndGuestsUseIt) {
  EXPECT_EQ(take({0, person(77), 1}), 0u);
  for (std::uint8_t slot = 1; slot < 8; ++slot)
    EXPECT_EQ(take({slot, person(77), slot}), kMaxTalkers);
  EXPECT_EQ(take(20, 5), 1u);
  now += TalkerPlaces::kLeavesAfter + Duration::ms(1);
  EXPECT_EQ(take({1, person(77), 1}), 0u) << "the first guest is silent: another takes its place";
  EXPECT_EQ(take({0, person(77), 1}), kMaxTalkers);
}

TEST_F(TalkerPlacesTest, ANewTalkerTakesThePlaceOfTheTalkerHeardMost) {
  speak(people(kMaxTalkers), Duration::s(1));
  EXPECT_EQ(take(9, 9), kMaxTalkers) << "nobody has had a whole turn";
  speak(people(kMaxTalkers), Duration::s(2));
  EXPECT_LT(take(9, 9), kMaxTalkers);
}

TEST_F(TalkerPlacesTest, ConstantTalkersShareThePlacesInTurns) {
  const auto sent = speak(people(12), Duration::s(60));
  for (const auto& [slot, packets] : sent) {
    EXPECT_GT(packets, 6000 * 8 / 12 / 2) << int{slot};
    EXPECT_LT(packets, 6000 * 8 / 12 * 3 / 2) << int{slot};
  }
}

// An attack: eight places were kept with two packets a second, which counted as 20 ms of speech. An
// honest talker got none of 12,000 packets.
TEST_F(TalkerPlacesTest, APlaceThatIsKeptWithFewPacketsCountsAsTalkTime) {
  std::vector<Speaker> speakers = people(kMaxTalkers, Duration::ms(450));
  speak(speakers, Duration::s(3));
  speakers.push_back({20, person(20), 1});
  EXPECT_GT(speak(speakers, Duration::s(120))[20], 12'000 * 8 / 9 / 2);
}

TEST_F(TalkerPlacesTest, ATalkerIsChargedForTheSilenceBeforeItsPlaceIsFree) {
  std::vector<Speaker> speakers = people(kMaxTalkers, Duration::ms(510));
  speakers.push_back({20, person(20), 1});
  // Places that fall free at once are taken again at once: that is a turn, too.
  EXPECT_GT(speak(speakers, Duration::s(120))[20], 12'000 * 8 / 9 / 2);
}

// A talker with two packets a second once kept the only voice that a narrow line carries.
TEST_F(TalkerPlacesTest, OnANarrowLineTalkersHaveTurns) {
  audible = 1;
  std::vector<Speaker> speakers{{0, person(0), 1, Duration::ms(450)}};
  speak(speakers, Duration::s(3));
  speakers.push_back({20, person(20), 1});
  EXPECT_GT(speak(speakers, Duration::s(120))[20], 12'000 / 2 / 2);
  audible = 0;
  EXPECT_EQ(speak(speakers, Duration::s(1))[20], 0);
  audible = 2;
  EXPECT_EQ(speak(speakers, Duration::s(1))[20], 100);
}

// An attack: eight links of one key spoke and got new tokens each 1.5 s, for which no talk time was
// known. An honest talker got none of 9,999 packets.
TEST_F(TalkerPlacesTest, LinksOfOneKeyThatChangeTheirTokensTakeNobodysPlace) {
  EXPECT_EQ(speak_beside_changing_links(person(77), {20, person(20), 1}, Duration::s(90)), 9000);
}

TEST_F(TalkerPlacesTest, AKeyThatReturnsWithANewLinkHasTheTalkTimeThatItLeftWith) {
  std::vector<Speaker> speakers = people(kMaxTalkers);
  speak(speakers, Duration::s(5));
  speakers.erase(speakers.begin());
  speakers.push_back({20, person(20), 1});
  speak(speakers, Duration::s(1));
  EXPECT_EQ(take({0, person(0), 2}), kMaxTalkers);
  EXPECT_LT(take(21, 21), kMaxTalkers) << "a key that was not heard before";
}

TEST_F(TalkerPlacesTest, APersonsKeyTakesAPlaceOfARoomsKeyAtOnce) {
  for (std::uint8_t slot = 0; slot < kMaxTalkers; ++slot)
    EXPECT_EQ(take({slot, kRoomKey, slot}), slot);
  EXPECT_LT(take(20, 20), kMaxTalkers);
  EXPECT_EQ(take({0, kRoomKey, 0}), kMaxTalkers) << "the places of the room's key are in use";
  EXPECT_EQ(speak_beside_changing_links(kRoomKey, {20, person(20), 1}, Duration::s(90)), 9000);
}

TEST_F(TalkerPlacesTest, LinksOfARoomsKeyShareItsPlacesInTurns) {
  std::vector<Speaker> speakers;
  for (std::uint8_t slot = 0; slot < 12; ++slot) speakers.push_back({slot, kRoomKey, slot});
  const auto sent = speak(speakers, Duration::s(60));
  for (const auto& [slot, packets] : sent) {
    EXPECT_GT(packets, 6000 * 8 / 12 / 2) << int{slot};
    EXPECT_LT(packets, 6000 * 8 / 12 * 3 / 2) << int{slot};
  }
}

TEST_F(TalkerPlacesTest, NewTokensOfARoomsKeyGainNoTalkTime) {
  const Speaker honest{20, kRoomKey, 1};
  speak_beside_changing_links(kRoomKey, {21, kRoomKey, 2}, Duration::s(30));
  EXPECT_GT(speak_beside_changing_links(kRoomKey, honest, Duration::s(90)), 9000 * 8 / 9 / 2);
}

TEST_F(TalkerPlacesTest, APlaceThatALinkOfARoomsKeyKeepsWithFewPacketsCountsAsTalkTime) {
  std::vector<Speaker> speakers;
  for (std::uint8_t slot = 0; slot < kMaxTalkers; ++slot)
    speakers.push_back({slot, kRoomKey, slot, Duration::ms(450)});
  speak(speakers, Duration::s(30));
  speakers.push_back({20, kRoomKey, 20});
  EXPECT_GT(speak(speakers, Duration::s(120))[20], 12'000 * 8 / 9 / 2);
}

TEST(VoiceQueue, TheNewestStayAndNothingStaysLong) {
  VoiceQueue queue;
  const MonoTime begin = MonoTime::from_us(1'000'000);
  std::array<std::uint8_t, 4> packet{1, 2, 3, 4};
  std::size_t left = 0;
  for (std::uint32_t i = 0; i < VoiceQueue::kCapacity + 5; ++i) {
    packet[0] = static_cast<std::uint8_t>(i);
    left += queue.push({{1, 1}, i, 0, -3, packet}, begin + Duration::ms(i)) ? 1 : 0;
  }
  EXPECT_EQ(left, 5u);
  EXPECT_EQ(queue.size(), VoiceQueue::kCapacity);
  EXPECT_EQ(queue.front().sequence, 5u);
  EXPECT_EQ(queue.front().packet[0], 5);
  EXPECT_EQ(queue.front().packet.size(), 4u);
  EXPECT_EQ(queue.drop_late(begin + Duration::ms(65)), 0u);
  EXPECT_EQ(queue.drop_late(begin + Duration::ms(70)), 5u);
  EXPECT_EQ(queue.front().sequence, 10u);
  EXPECT_EQ(queue.drop_late(begin + Duration::s(9)), VoiceQueue::kCapacity - 5);
  EXPECT_TRUE(queue.is_empty());
}

class VoiceCrowd : public ::testing::Test {
 protected:
  static constexpr int kTalkers = 12;
  VoiceCrowd() {
    for (int i = 0; i < kTalkers; ++i) {
      House& house = tunnel.add_house("salsa", {"t" + std::to_string(i)});
      talk.talkers.push_back({&house, guest("t" + std::to_string(i)), -30});
    }
    tunnel.run(Duration::ms(200));
  }
  std::set<std::string> received_within(Duration duration) {
    listener.voices.clear();
    talk.run(duration);
    std::set<std::string> names;
    for (const auto& heard : listener.voices) names.emplace(heard.guest.view());
    return names;
  }
  SimulatedTunnel tunnel;
  House& listener = tunnel.add_house("salsa", {});
  Talk talk{tunnel, {}};
};

TEST_F(VoiceCrowd, EightAreHeardWholeAndTheOthersNot) {
  received_within(Duration::ms(100));
  EXPECT_EQ(received_within(Duration::s(1)).size(), kMaxTalkers);
  // Whole voices: eight hundred packets of the eight.
  EXPECT_EQ(listener.voices.size(), 100u * kMaxTalkers);
  EXPECT_GT(tunnel.server().counters().voices_crowded, 400u);
  // Those who speak have seven others' places and their own voice.
  std::set<std::string> at_first;
  for (const auto& heard : talk.talkers[0].house->voices) at_first.emplace(heard.guest.view());
  EXPECT_EQ(at_first.size(), kMaxTalkers);
  EXPECT_FALSE(at_first.contains("t0"));
}

TEST_F(VoiceCrowd, LoudnessTakesNobodysPlace) {
  received_within(Duration::ms(100));
  EXPECT_FALSE(received_within(Duration::ms(100)).contains("t11"));
  talk.talkers[11].level_dbfs = 0;
  EXPECT_FALSE(received_within(Duration::ms(300)).contains("t11"));
}

// An attack: all eight places went to eight loud guests of one link.
TEST(VoiceFairness, EightGuestsOfOneLinkLeaveTheOthersTheirPlaces) {
  SimulatedTunnel tunnel;
  House& listener = tunnel.add_house("salsa", {});
  std::vector<std::string> names;
  for (int i = 0; i < 8; ++i) names.push_back("m" + std::to_string(i));
  House& mallory = tunnel.add_house("salsa", names);
  House& alice = tunnel.add_house("salsa", {"alice"});
  Talk talk{tunnel, {}};
  for (const std::string& name : names) talk.talkers.push_back({&mallory, guest(name), 0});
  tunnel.run(Duration::ms(200));
  talk.run(Duration::s(1));
  talk.talkers.push_back({&alice, guest("alice"), -40});
  listener.voices.clear();
  talk.run(Duration::s(1));
  EXPECT_GE(voices_of(listener, "alice"), 98u);
  std::size_t of_mallory = 0;
  for (const std::string& name : names) of_mallory += voices_of(listener, name);
  EXPECT_LE(of_mallory, 102u) << "one place";
}

// An attack: eight links of one key took all places of each receiver.
TEST(VoiceFairness, EightLinksOfOneKeyLeaveTheOthersTheirPlaces) {
  SimulatedTunnel tunnel;
  const auto key_named = [](const std::string& name) { return Access{.name = guest(name)}; };
  House& listener = tunnel.add_house("salsa", {}, {}, key_named("bob"));
  House& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  Talk talk{tunnel, {}};
  std::vector<std::string> names;
  for (int i = 0; i < 8; ++i) {
    names.push_back("mallory-" + std::to_string(i));
    House& house = tunnel.add_house("salsa", {names.back()}, {}, key_named("mallory"));
    talk.talkers.push_back({&house, guest(names.back()), 0});
  }
  tunnel.run(Duration::ms(200));
  talk.run(Duration::s(1));
  talk.talkers.push_back({&alice, guest("alice"), -40});
  listener.voices.clear();
  talk.run(Duration::s(10));
  EXPECT_GE(voices_of(listener, "alice"), 998u);
  std::size_t of_mallory = 0;
  for (const std::string& name : names) of_mallory += voices_of(listener, name);
  EXPECT_GE(of_mallory, 900u) << "the key has its place";
  EXPECT_LE(of_mallory, 1002u) << "and no more";
}

TEST_F(VoiceCrowd, WhoIsMutedTakesNoPlace) {
  listener.link->set_hearing(hearing({"t0=0", "t1=0", "t2=0", "t3=0"}), tunnel.time_in(listener));
  tunnel.run(Duration::ms(100));
  const auto names = received_within(Duration::ms(300));
  EXPECT_EQ(names.size(), kMaxTalkers);
  EXPECT_TRUE(names.contains("t11"));
}

}  // namespace
}  // namespace dance
