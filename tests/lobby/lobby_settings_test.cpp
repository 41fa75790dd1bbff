// What a dancer chooses in the window stands in the session file and comes back, and what was
// written by hand stays; a broken file is told and kept.
#include "lobby/settings/lobby_settings.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "lobby/settings/settings_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kByHand = R"(# my house
[house]
guest = "alice"   # that is me
bus   = "udpm://239.255.76.67:7999?ttl=0"

[[route]]
from = "POSE/capture/alice"
to   = "POSE/stage/alice"

# before the camera
[[produce]]
kind   = "camera"
guest  = "alice"
model  = "full"      # I have time
mirror = true

[[haptics]]
guest = "alice"
to    = "evdev"

[[avatar]]
guest  = "alice"
name   = "marisol"
height = 1.1         # in heels

[voice]
muted = true
)";

LobbySettings read(const std::string& text) {
  const auto house = parse_session(text, "/home/alice/house.toml");
  EXPECT_TRUE(house) << house.error().what << "\n" << text;
  return house ? settings_of(*house) : LobbySettings();
}

std::string write(const std::string& text, const LobbySettings& wanted) {
  const auto edited = edit_settings(text, wanted, "/home/alice/house.toml");
  EXPECT_TRUE(edited) << edited.error().what << "\n" << text;
  return edited.value_or(text);
}

TEST(LobbySettings, AreReadFromASessionFileThatWasWrittenByHand) {
  const LobbySettings settings = read(kByHand);
  EXPECT_EQ(settings.name, "alice");
  EXPECT_EQ(settings.source, DancerSource::kCamera);
  EXPECT_EQ(settings.avatar, "marisol");
  EXPECT_TRUE(settings.speaks);
  EXPECT_EQ(write(kByHand, settings), kByHand) << "nothing is new";
}

TEST(LobbySettings, KeepWhatTheWindowDoesNotKnow) {
  LobbySettings wanted = read(kByHand);
  wanted.height_m = 1.64;
  wanted.camera = "/dev/video2";
  wanted.avatar = "teo";
  wanted.room = "salsa";
  wanted.has_headphones = true;
  const std::string text = write(kByHand, wanted);
  for (const char* kept :
       {"# my house", "# that is me", "udpm://239.255.76.67:7999", "# before the camera",
        "model  = \"full\"      # I have time", "mirror = true", "height = 1.1         # in heels",
        "muted = true", "[[haptics]]", "POSE/stage/alice"})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << "\n" << text;
  EXPECT_EQ(read(text), wanted);
}

TEST(LobbySettings, WriteTheChosenFigureToTheHouseFile) {
  LobbySettings wanted = read("[house]\nguest = \"alice\"\n");
  wanted.look = "flared-tail-s5-h1";
  wanted.colour = "#2f7fd1";
  wanted.figure_height = 1.05;
  const std::string text = write("[house]\nguest = \"alice\"\n", wanted);
  const auto house = parse_session(text, "house.toml");
  ASSERT_TRUE(house) << text;
  ASSERT_EQ(house->avatars.size(), 1u) << text;
  const AvatarChoice& choice = house->avatars[0].choice;
  EXPECT_EQ(choice.look, "flared-tail-s5-h1");
  EXPECT_EQ(choice.colour, "#2f7fd1");
  EXPECT_DOUBLE_EQ(choice.height, 1.05);
  // An avatar has its own clothes, so no look is written for it.
  wanted.avatar = "teo";
  const LobbySettings teo = read(write(text, wanted));
  EXPECT_EQ(teo.avatar, "teo");
  EXPECT_EQ(teo.look, "");
  EXPECT_DOUBLE_EQ(teo.figure_height, 1.05);
  EXPECT_EQ(write(write(text, wanted), read("[house]\nguest = \"alice\"\n")).find("[[avatar]]"),
            std::string::npos);
}

TEST(LobbySettings, ReadALookInPlaceOfAnAvatarsNameAsTheMannequins) {
  const std::string text =
      "[house]\nguest = \"alice\"\n[[avatar]]\nguest = \"alice\"\nname = \"dress-bun\"\n";
  LobbySettings settings = read(text);
  EXPECT_EQ(settings.avatar, "");
  EXPECT_EQ(settings.look, "dress-bun");
  EXPECT_EQ(write(text, settings), text);
  settings.look = "dress-bob";
  EXPECT_EQ(read(write(text, settings)), settings);
}

TEST(LobbySettings, WhoDoesNotSpeakKeepsWhatWasWrittenOfTheVoice) {
  LobbySettings wanted = read(kByHand);
  wanted.speaks = false;
  const std::string silent = write(kByHand, wanted);
  EXPECT_NE(silent.find("muted = true"), std::string::npos) << silent;
  EXPECT_FALSE(read(silent).speaks);
  EXPECT_FALSE(parse_session(silent, "house.toml")->voice->enabled);
  wanted.speaks = true;
  const std::string again = write(silent, wanted);
  EXPECT_TRUE(read(again).speaks);
  EXPECT_TRUE(parse_session(again, "house.toml")->voice->muted);
}

TEST(LobbySettings, WhatTakesATableOutOfTheFileWaits) {
  const LobbySettings written = read(kByHand);
  LobbySettings later = written;
  later.camera = "/dev/video2";
  EXPECT_FALSE(loses_a_table(written, later));
  later.source = DancerSource::kSynthetic;
  EXPECT_TRUE(loses_a_table(written, later));
}

TEST(LobbySettings, AnotherNameIsAnotherNameEverywhere) {
  LobbySettings wanted = read(kByHand);
  wanted.name = "ann";
  const std::string text = write(kByHand, wanted);
  EXPECT_EQ(text.find("alice"), std::string::npos) << text;
  const auto house = parse_session(text, "house.toml");
  ASSERT_TRUE(house) << house.error().what;
  EXPECT_EQ(house->cameras[0].guest.view(), "ann");
  EXPECT_EQ(house->haptics[0].guest.view(), "ann");
  EXPECT_EQ(house->routes[0].to.guest.view(), "ann");
}

TEST(LobbySettings, RenamesTheFirstOfSeveralGuestsAndNotTheOthers) {
  const std::string text = "[house]\nguests = [\"alice\", \"bob\"]\n";
  LobbySettings wanted = read(text);
  wanted.name = "ann";
  const auto house = parse_session(write(text, wanted), "house.toml");
  ASSERT_TRUE(house);
  ASSERT_EQ(house->guests.size(), 2u);
  EXPECT_EQ(house->guests[0].view(), "ann");
  EXPECT_EQ(house->guests[1].view(), "bob");
}

TEST(LobbySettings, AHouseThatOnlyWatchesStaysOneUntilANameIsChosen) {
  const std::string text = "[house]\nserver = \"example.org\"\n";
  LobbySettings wanted = read(text);
  wanted.room = "salsa";
  EXPECT_TRUE(parse_session(write(text, wanted), "h.toml")->guests.empty());
  wanted.name = "ann";
  EXPECT_EQ(parse_session(write(text, wanted), "h.toml")->guests.size(), 1u);
  wanted.name = LobbySettings().name;
  wanted.shown_name = "\u821e";  // no id can be made from it
  EXPECT_EQ(parse_session(write(text, wanted), "h.toml")->guests.size(), 1u);
}

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  template <class T>
  T one_of(std::initializer_list<T> choices) {
    return *(choices.begin() + random_() % choices.size());
  }

 private:
  std::mt19937 random_;
};

LobbySettings any_settings(Dice& dice) {
  using enum DancerSource;
  using S = std::string;
  LobbySettings it;
  it.name = dice.one_of<S>({"alice", "ann-2", "b"});
  it.shown_name = dice.one_of<S>({"", "Alicia \"Ali\" López", "B"});
  it.source = dice.one_of({kCamera, kFile, kHeadset, kSynthetic, kWatch});
  it.camera = dice.one_of<S>({"", "/dev/video0", "HD Webcam"});
  it.height_m = dice.one_of({0.0, 0.8, 1.64, 2.5});
  it.motion_file = dice.one_of<S>({"/a/take.bvh", "/ü/night \"x\".lcm"});
  it.role = dice.one_of<S>({"any", "lead", "follow"});
  it.avatar = dice.one_of<S>({"", "marisol", "/home/a b/me.vrm"});
  it.look = dice.one_of<S>({"", "dress-bun", "s4-h1"});
  it.colour = dice.one_of<S>({"", "#e04080"});
  it.figure_height = dice.one_of({1.0, 0.95, 1.1});
  it.speaks = dice.one_of({true, false});
  it.has_headphones = dice.one_of({true, false});
  it.microphone = dice.one_of<S>({"", "alsa_input.usb"});
  it.loudspeaker = dice.one_of<S>({"", "sink # 1"});
  it.server = dice.one_of<S>({"", "dance.example.org", "127.0.0.1:7400"});
  it.room = dice.one_of<S>({"dance", "salsa"});
  it.window.language = dice.one_of<S>({"", "de", "es"});
  if (dice.one_of({true, false})) it.window.rooms = {{"salsa", "a.org:7400"}, {"x", "[::1]:1"}};
  it.window.partner = dice.one_of<S>({"lead", "follow", "/p/couple.lcm"});
  it.window.music = dice.one_of<S>({"", "/m/song.ogg"});
  it.window.band = dice.one_of<S>({"salsa", "tango", "none"});
  it.window.mirror = dice.one_of({true, false});
  it.window.teacher = dice.one_of<S>({"", "/m/lesson.bvh"});
  it.window.place = dice.one_of<S>({"studio", "bar", "plain"});
  it.window.letters = dice.one_of({1.0, 0.9, 1.3});
  it.window.width_px = dice.one_of({1280, 1921});
  it.window.height_px = dice.one_of({720, 1000});
  return only_what_counts(it);
}

TEST(LobbySettings, WhateverIsChosenComesBackFromTheFile) {
  Dice dice(7);
  std::string by_hand = kByHand;
  std::string fresh = "[house]\nguest = \"alice\"\n";
  for (int i = 0; i < 400; ++i) {
    const LobbySettings wanted = any_settings(dice);
    for (std::string* text : {&by_hand, &fresh}) {
      *text = write(*text, wanted);
      ASSERT_EQ(read(*text), wanted) << *text;
      ASSERT_EQ(write(*text, wanted), *text) << "and then nothing is new";
    }
  }
  EXPECT_NE(by_hand.find("# my house"), std::string::npos);
  EXPECT_LT(fresh.size(), 2000u) << "edits do not pile up";
}

TEST(WindowChoices, DefaultSizeFitsASmallScreenWithFrameAndTaskBar) {
  constexpr int kFrame_px = 40, kTaskBar_px = 60;
  EXPECT_LE(WindowChoices().width_px, 1366);
  EXPECT_LE(WindowChoices().height_px, 768 - kFrame_px - kTaskBar_px);
}

TEST(LobbySettings, WatchingKeepsTheCameraForALaterDance) {
  const std::string camera =
      "[house]\nguest = \"alice\"\n[[produce]]\nkind = \"camera\"\nguest = \"alice\"\n"
      "device = \"/dev/video2\"\nmodel = \"lite\"\n";
  LobbySettings dancer = read(camera);
  LobbySettings watcher = dancer;
  watcher.source = DancerSource::kWatch;
  const std::string watches = write(camera, watcher);
  EXPECT_TRUE(parse_session(watches, "h.toml")->watch);
  EXPECT_NE(watches.find("model = \"lite\""), std::string::npos);
  EXPECT_FALSE(loses_a_table(dancer, watcher));
  EXPECT_EQ(write(watches, dancer), camera);
}

TEST(LobbySettings, WhatIsWrittenInAWayThatCannotBeChangedIsTold) {
  LobbySettings wanted = read("house = { guest = \"alice\" }\n");
  wanted.server = "example.org";
  const auto edited = edit_settings("house = { guest = \"alice\" }\n", wanted, "h.toml");
  ASSERT_FALSE(edited);
  EXPECT_NE(edited.error().what.find("h.toml"), std::string::npos);
}

TEST(LobbySettings, ANameIsMadeOfWhateverIsTyped) {
  EXPECT_EQ(name_from("Anna Maria"), "anna-maria");
  EXPECT_EQ(name_from("  --x--  "), "x");
  EXPECT_EQ(name_from("Zoë!"), "zoe");
  EXPECT_EQ(name_from("???"), "");
  EXPECT_EQ(name_from(std::string(50, 'a')).size(), 24u);
  EXPECT_EQ(further_name("ana"), "ana-2");
  EXPECT_EQ(further_name(std::string(24, 'a')), std::string(24, 'a'));
}

class SettingsFileTest : public testing::Test {
 protected:
  std::string path() const { return folder_.path("config/dancegraph/house.toml"); }
  void put(const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(path()).parent_path());
    std::ofstream(path()) << text;
  }
  TestFolder folder_{"lobby-settings"};
};

TEST_F(SettingsFileTest, IsMadeWithItsFolderAndReadAgain) {
  SettingsFile file(path());
  auto opened = file.open();
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_TRUE(opened->is_new);
  LobbySettings settings = opened->settings;
  settings.server = "example.org";
  ASSERT_TRUE(file.save(settings));
  opened = file.open();
  ASSERT_TRUE(opened);
  EXPECT_FALSE(opened->is_new);
  EXPECT_EQ(opened->settings, settings);
  EXPECT_TRUE(load_session(path())) << "dance join takes it as it is";
}

TEST_F(SettingsFileTest, ATrialLeavesTheFileAloneAndIsRemoved) {
  SettingsFile file(folder_.path("dancegraph/house.toml"));
  LobbySettings settings = first_settings();
  ASSERT_TRUE(file.save(settings));
  const std::string before = text_of(file.path());
  settings.server = "dance.example.org:7400";
  const auto trial = file.save_trial(settings);
  ASSERT_TRUE(trial) << trial.error().what;
  EXPECT_EQ(text_of(file.path()), before);
  EXPECT_EQ(load_session(*trial)->server, "dance.example.org:7400");
  file.remove_trial();
  EXPECT_FALSE(std::filesystem::exists(*trial));
}

TEST_F(SettingsFileTest, ABrokenFileIsToldWithItsLineAndKept) {
  const std::string broken = "[house]\nguest = \"alice\"\nrom = \"salsa\"\n";
  put(broken);
  SettingsFile file(path());
  const auto opened = file.open();
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_NE(opened->trouble.find("house.toml:3:"), std::string::npos) << opened->trouble;
  EXPECT_NE(opened->trouble.find("rom"), std::string::npos) << opened->trouble;
  EXPECT_NE(opened->kept_as.find("house.toml.broken-20"), std::string::npos) << opened->kept_as;
  EXPECT_EQ(text_of(opened->kept_as), broken);
  ASSERT_TRUE(file.save(opened->settings));
  EXPECT_EQ(text_of(opened->kept_as), broken) << "never overwritten";
  EXPECT_TRUE(load_session(path()));
}

TEST_F(SettingsFileTest, AFileThatIsBrokenMeanwhileIsKeptToo) {
  SettingsFile file(path());
  LobbySettings settings = first_settings();
  ASSERT_TRUE(file.save(settings));
  std::vector<std::string> kept;
  for (const std::string& broken : {std::string("[hou"), std::string("[house]\nguest = 3\n")}) {
    put(broken);
    settings.room += "a";
    const auto saved = file.save(settings);
    ASSERT_TRUE(saved) << saved.error().what;
    EXPECT_FALSE(saved->trouble.empty());
    EXPECT_EQ(text_of(saved->kept_as), broken);
    kept.push_back(saved->kept_as);
  }
  EXPECT_NE(kept[0], kept[1]) << "both within a second";
  EXPECT_EQ(settings_of(*load_session(path())), only_what_counts(settings));
}

TEST_F(SettingsFileTest, WhatWasEditedByHandMeanwhileStays) {
  SettingsFile file(path());
  LobbySettings settings = first_settings();
  ASSERT_TRUE(file.save(settings));
  put(text_of(path()) + "# by hand\n[[haptics]]\nguest = \"" + settings.name +
      "\"\nto = \"evdev\"\n");
  settings.room = "salsa";
  ASSERT_TRUE(file.save(settings));
  const auto house = load_session(path());
  ASSERT_TRUE(house);
  EXPECT_EQ(house->haptics.size(), 1u);
  EXPECT_EQ(house->room, "salsa");
  EXPECT_NE(text_of(path()).find("# by hand"), std::string::npos);
}

TEST_F(SettingsFileTest, AFolderInTheFilesPlaceIsAnErrorAndStays) {
  std::filesystem::create_directories(path() + "/x");
  SettingsFile file(path());
  EXPECT_FALSE(file.open());
  EXPECT_FALSE(file.save(first_settings()));
  EXPECT_TRUE(std::filesystem::exists(path() + "/x"));
}

}  // namespace
}  // namespace dance
