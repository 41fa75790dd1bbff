// A dance without others, and the [window] of a session file.
#include "house/dancer/session_partner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "house/dancer/dancer_file.h"
#include "house/house_music.h"

namespace dance {
namespace {

const std::string kCouple = DANCE_SOURCE_DIR "/logs/couple.lcm";

HouseConfig house_with_partner(const std::string& text) {
  const auto house =
      parse_session("[house]\nguest = \"ann\"\nserver = \"a.org\"\n" + text, "h.toml");
  EXPECT_TRUE(house) << house.error().what;
  return house.value_or(HouseConfig());
}

TEST(SessionPartner, AMadeUpOneDancesInTheSameTempo) {
  HouseConfig house = house_with_partner(
      "[[produce]]\nkind = \"salsa\"\nguest = \"ann\"\ntempo = 200\n[music]\n"
      "follow = true\n");
  dance_alone(house);
  EXPECT_TRUE(house.server.empty());
  EXPECT_FALSE(house.music) << "there is nobody to follow";
  ASSERT_TRUE(add_partner(house, "follow"));
  ASSERT_EQ(house.producers.size(), 2u);
  EXPECT_EQ(house.producers[1].role, "follow");
  EXPECT_EQ(house.producers[1].tempo_bpm, 200.0);
  EXPECT_EQ(house.guests.back().view(), "partner");
}

TEST(SessionPartner, OfARecordedCoupleEachIsAnother) {
  HouseConfig house = house_with_partner(
      "[[produce]]\nkind = \"replay\"\nguest = \"ann\"\nfile = \"" + kCouple + "\"\n");
  ASSERT_TRUE(add_partner(house, kCouple));
  const HostedProducer& own = house.producers[0];
  const HostedProducer& partner = house.producers[1];
  const auto first = load_dancer_of(own.file, own.dancer, own.guest);
  const auto second = load_dancer_of(partner.file, partner.dancer, partner.guest);
  ASSERT_TRUE(first) << first.error().what;
  ASSERT_TRUE(second) << second.error().what;
  EXPECT_NE(first->name, second->name);
  EXPECT_GT(second->clip.frames.size(), 60u);
}

TEST(SessionPartner, SaysWhatIsWrongWithAFile) {
  HouseConfig house = house_with_partner("");
  const auto added = add_partner(house, "/nowhere/x.bvh");
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().what.find("/nowhere/x.bvh"), std::string::npos);
  const auto none = load_dancer_of(kCouple, "carol", *GuestId::parse("ann"));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("there are"), std::string::npos);
}

TEST(SessionPartner, WhatIsPractisedToIsAsLoudAsItWasLeft) {
  const auto volume_of = [](const char* tables) {
    HouseConfig house = house_with_partner(tables);
    dance_alone(house);
    practise_to(house, "song.ogg");
    return house.music->volume;
  };
  EXPECT_EQ(volume_of(""), 1.0);
  EXPECT_EQ(volume_of("[window]\nvolume = 0.4\n"), 0.4);
  EXPECT_EQ(volume_of("[music]\nfollow = true\nvolume = 0.7\n[window]\nvolume = 0.4\n"), 0.7);
}

TEST(SessionPartner, ASongToPractiseToIsTitledAndControlledInAHouseThatIsAlone) {
  HouseConfig house = house_with_partner("");
  practise_to(house, "song.ogg");
  EXPECT_FALSE(house.music->is_alone) << "the house is in a room";
  EXPECT_FALSE(house.music->guest.is_set());
  dance_alone(house);
  practise_to(house, "song.ogg");
  EXPECT_TRUE(house.music->is_alone);
  EXPECT_EQ(house.music->guest.view(), "ann");
  const auto words = music_arguments(*house.music, "bus");
  EXPECT_NE(std::find(words.begin(), words.end(), "--alone"), words.end());
}

TEST(SessionPartner, ASongToPractiseToIsHeardThroughTheSameLoudspeakerAsOtherMusic) {
  HouseConfig house = house_with_partner("[music]\nband = \"salsa\"\ntrim_ms = 180\n");
  dance_alone(house);
  practise_to(house, "song.ogg");
  EXPECT_EQ(house.music->file, "song.ogg");
  EXPECT_EQ(house.music->trim_ms, 180.0);
}

TEST(SessionPartner, AddsTheBandUnlessTheHouseHasMusicOrExcludesIt) {
  HouseConfig house = house_with_partner("");
  let_band_play(house, "swing");
  ASSERT_TRUE(house.music);
  EXPECT_EQ(house.music->band, "swing");
  EXPECT_TRUE(house.music->follow);
  EXPECT_EQ(house.music->guest.view(), "ann");
  for (const char* music : {"[music]\nfile = \"a.ogg\"\n", "[music]\nmicrophone = true\n",
                            "[music]\nband = \"none\"\n"}) {
    HouseConfig other = house_with_partner(music);
    let_band_play(other, "swing");
    EXPECT_TRUE(!other.music || other.music->band.empty()) << music;
  }
  HouseConfig alone = house_with_partner("[music]\nband = \"tango\"\n");
  dance_alone(alone);
  ASSERT_TRUE(alone.music);
  EXPECT_EQ(alone.music->band, "tango");
  EXPECT_FALSE(alone.music->follow);
}

TEST(SessionWindow, IsReadAndItsErrorsHaveAPlace) {
  const HouseConfig house = house_with_partner(
      "[window]\nlanguage = \"de\"\nrooms = [\"salsa@a.org:7400\"]\nmirror = false\n"
      "place = \"bar\"\nteacher = \"/dances/lesson.bvh\"\n");
  EXPECT_EQ(house.window.teacher, "/dances/lesson.bvh");
  EXPECT_EQ(house.window.language, "de");
  ASSERT_EQ(house.window.rooms.size(), 1u);
  EXPECT_EQ(house.window.rooms[0].server, "a.org:7400");
  EXPECT_FALSE(house.window.mirror);
  EXPECT_EQ(house.window.place, "bar");
  EXPECT_EQ(house_with_partner("").window.place, "studio") << "the default";
  for (const char* wrong :
       {"langage = \"de\"", "language = \"fr\"", "rooms = [\"salsa\"]", "rooms = [\"S@a\"]",
        "width = 3", "mirror = 1", "volume = 2", "partner = \"\"", "band = \"polka\""}) {
    const auto read =
        parse_session("[house]\nguest = \"ann\"\n[window]\n" + std::string(wrong) + "\n", "h.toml");
    ASSERT_FALSE(read) << wrong;
    EXPECT_TRUE(read.error().what.starts_with("h.toml:4:")) << read.error().what;
  }
  const auto beach =
      parse_session("[house]\nguest = \"ann\"\n[window]\nplace = \"beach\"\n", "h.toml");
  ASSERT_FALSE(beach);
  EXPECT_NE(beach.error().what.find("studio, bar, terrace, plain"), std::string::npos);
}

}  // namespace
}  // namespace dance
