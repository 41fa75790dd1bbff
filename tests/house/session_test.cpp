#include "house/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "consumers/consumer_table.h"

namespace dance {
namespace {

constexpr const char* kHouse = "[house]\nguest = \"alice\"\nserver = \"example.org:7400\"\n";

std::string error_of(const std::string& text) {
  const auto session = parse_session(text, "s.toml");
  return session ? "no error" : session.error().what;
}

TEST(HouseFile, ReadsAWholeHouse) {
  const auto session =
      parse_session(std::string(kHouse) +
                        "room = \"salsa\"\n[[route]]\nfrom = \"POSE/guest/*\"\n"
                        "through = [\"hold 20ms\"]\nto = \"POSE/stage/*\"\nrate = 30\n"
                        "[[produce]]\nkind = \"replay\"\nguest = \"bob\"\nfile = \"b.bvh\"\n"
                        "[[listen]]\nto = \"csv\"\nfile = \"out.csv\"\n",
                    "/home/alice/s.toml");
  ASSERT_TRUE(session) << session.error().what;
  EXPECT_EQ(session->guests.size(), 1u);
  EXPECT_EQ(session->room, "salsa");
  ASSERT_EQ(session->routes.size(), 1u);
  EXPECT_EQ(session->routes[0].rate_hz, 30.0);
  EXPECT_EQ(session->routes[0].from.where, Where::kGuest);
  EXPECT_FALSE(session->routes[0].from.guest.is_set());
  EXPECT_EQ(session->producers[0].file, "/home/alice/b.bvh") << "taken from the session's folder";
  EXPECT_EQ(session->consumers[0].options.file, "/home/alice/out.csv");
}

TEST(HouseFile, ReadsHowGuestsAreDrawn) {
  const auto session =
      parse_session(std::string(kHouse) +
                        "avatar_bytes_per_second = 0\n"
                        "[[avatar]]\nguest = \"alice\"\nfile = \"me.vrm\"\nheight = 1.1\n"
                        "[[avatar]]\nguest = \"ann\"\nlook = \"dress-bun\"\ncolour = \"#e04080\"\n"
                        "[[avatar]]\nguest = \"bob\"\nname = \"marisol\"\n",
                    "/home/alice/s.toml");
  ASSERT_TRUE(session) << session.error().what;
  EXPECT_EQ(session->avatar_bytes_per_second, 0.0);
  ASSERT_EQ(session->avatars.size(), 3u);
  EXPECT_EQ(session->avatars[0].guest.view(), "alice");
  EXPECT_EQ(session->avatars[0].choice.what, "/home/alice/me.vrm");
  EXPECT_EQ(session->avatars[0].choice.height, 1.1);
  EXPECT_EQ(session->avatars[1].choice.look, "dress-bun");
  EXPECT_EQ(session->avatars[2].choice.what, "marisol");
  const std::string avatar = std::string(kHouse) + "[[avatar]]\nguest = \"alice\"\n";
  EXPECT_NE(error_of(avatar + "file = \"a.vrm\"\nname = \"b\"\n").find("not both"),
            std::string::npos);
  EXPECT_NE(error_of(avatar + "height = 9.0\n").find("height"), std::string::npos);
  EXPECT_NE(error_of(avatar + "hieght = 1.0\n").find("hieght"), std::string::npos);
  EXPECT_NE(error_of(std::string(kHouse) + "[[avatar]]\nfile = \"a.vrm\"\n").find("guest"),
            std::string::npos);
}

TEST(HouseFile, HoldHandsKeepsTheRateOfPosesUnlessTheyArePredicted) {
  const std::string route =
      std::string(kHouse) + "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
  const auto session = parse_session(route + "through = [\"hold-hands\"]\n", "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  EXPECT_EQ(session->routes[0].rate_hz, 0.0);
  const auto predicted =
      parse_session(route + "through = [\"predict\", \"hold-hands\"]\n", "s.toml");
  ASSERT_TRUE(predicted) << predicted.error().what;
  EXPECT_EQ(predicted->routes[0].rate_hz, 60.0);
  EXPECT_NE(error_of(route + "through = [\"hold-hands\", \"predict\"]\n").find("right order"),
            std::string::npos);
  EXPECT_NE(error_of(route + "through = [\"hold-hands feet=1\"]\n").find("feet"),
            std::string::npos);
}

// toml++'s texts about its grammar never reach a user.
TEST(HouseFile, SyntaxErrorsNameThePlaceAndTheCure) {
  EXPECT_EQ(error_of("[house]\n\tquality_mm == 3\n"),
            "s.toml:2:14: no TOML can be read from here on in 'quality_mm == 3'; write NAME = "
            "VALUE, and texts in quotes");
  EXPECT_EQ(error_of("[house]\nname = \n\x1b[2J = 1\n").find('\x1b'), std::string::npos);
  EXPECT_NE(error_of("[house]\nquality_mm = 1\nquality_mm = 2\n")
                .find(": this name is there already; keep one of the two"),
            std::string::npos);
  EXPECT_NE(error_of("[house]\nname = \"alice").find(": the file ends within a value; close"),
            std::string::npos);
  EXPECT_NE(error_of("[house]\nname = \"J\xf6rg\"\n").find("save the file as UTF-8"),
            std::string::npos);
  for (const char* broken : {"=", "[", "a = [1,", "a = 'x", "a = 1 b = 2", "a.b = 1\na = 2\n"})
    EXPECT_EQ(error_of(broken).find("Error while"), std::string::npos) << error_of(broken);
}

TEST(HouseFile, AnUnknownConsumerIsAnErrorThatListsAllConsumers) {
  const std::string error = error_of(std::string(kHouse) + "[[listen]]\nto = \"smoke\"\n");
  EXPECT_EQ(error.rfind("s.toml:5:", 0), 0u) << error;
  for (const std::string& name : consumer_names())
    EXPECT_NE(error.find(name), std::string::npos) << error;
}

TEST(HouseFile, NeedsHiddenGuestsForConsumersOtherThanWindows) {
  const std::string channel =
      "[[channel]]\nname = \"LIGHT/desk\"\nclass = \"state\"\nrate = 5\n"
      "size = 300\nlayout = \"i32\"\ndirection = ";
  const std::pair<std::string, bool> cases[] = {
      {"", false},
      {channel + "\"out\"\n", false},
      {channel + "\"in\"\n", true},
      {"[[haptics]]\nguest = \"alice\"\nto = \"evdev\"\n", true},
      {"[[listen]]\nto = \"text\"\n", true},
  };
  for (const auto& [table, needs] : cases) {
    const auto session = parse_session(kHouse + table, "s.toml");
    ASSERT_TRUE(session) << session.error().what;
    EXPECT_EQ(session->needs_hidden_guests(), needs) << table;
  }
}

TEST(HouseFile, ReadsThePrecisionAndByteRateOfPoses) {
  const auto usual = parse_session(kHouse, "s.toml");
  ASSERT_TRUE(usual);
  EXPECT_EQ(usual->quality_mm, 1.0);
  EXPECT_EQ(usual->pose_bytes_per_second, 0.0);
  const auto given = parse_session(
      std::string(kHouse) + "quality_mm = 2\npose_bytes_per_second = 900.0\n", "s.toml");
  ASSERT_TRUE(given) << given.error().what;
  EXPECT_EQ(given->quality_mm, 2.0);
  EXPECT_EQ(given->pose_bytes_per_second, 900.0);
  const std::string error = error_of(std::string(kHouse) + "quality_mm = 0.01\n");
  EXPECT_EQ(error.rfind("s.toml:4:14: ", 0), 0u) << error;
  EXPECT_NE(error.find("0.125"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(HouseFile, ReadsInterestInTheSyntaxOfTheCommandLine) {
  const GuestId bob = *GuestId::parse("bob"), carol = *GuestId::parse("carol");
  const auto usual = parse_session(kHouse, "s.toml");
  ASSERT_TRUE(usual);
  EXPECT_EQ(usual->interest.divider_of(bob), 1) << "all of everybody";
  const auto given =
      parse_session(std::string(kHouse) + "want = [\"default=4\", \"bob=0\"]\n", "s.toml");
  ASSERT_TRUE(given) << given.error().what;
  EXPECT_EQ(given->interest.divider_of(bob), 0);
  EXPECT_EQ(given->interest.divider_of(carol), 4);
}

TEST(HouseFile, ErrorsQuoteTheWrongWordOfAnInterest) {
  const std::string house = kHouse;
  std::string error = error_of(house + "want = [\"bob=256\"]\n");
  EXPECT_EQ(error.rfind("s.toml:4:8: [house] want: 'bob=256': write NAME=N", 0), 0u) << error;
  error = error_of(house + "want = [\"bob=1\", \"bob=2\"]\n");
  EXPECT_EQ(error, "s.toml:4:8: [house] want: 'bob=2': bob is given twice");
  error = error_of(house + "want = \"bob=1\"\n");
  EXPECT_EQ(error.rfind("s.toml:4:8: [house] want: ", 0), 0u) << error;
  EXPECT_NE(error.find("[\"default=4\", \"bob=1\"]"), std::string::npos) << error;
  error = error_of(house + "want = [\"bob=1\", 2]\n");
  EXPECT_EQ(error.rfind("s.toml:4:18: [house] want: ", 0), 0u) << error;
}

TEST(HouseFile, ReadsChannels) {
  const auto session = parse_session(
      std::string(kHouse) +
          "[[channel]]\nname = \"LIGHT/desk\"\nclass = \"state\"\nsize = 300\nrate = 2.5\n"
          "layout = \"n:i32,f32[n]\"\nfingerprint = \"0123456789abcdef\"\n"
          "[[channel]]\nname = \"ROBOT/*\"\nclass = \"newest\"\nlayout = \"any\"\n"
          "unchecked = true\nguest = \"alice\"\n",
      "s.toml");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->channels.size(), 2u);
  EXPECT_EQ(session->channels[0].kind, ChannelClass::kState);
  EXPECT_EQ(session->channels[0].max_bytes, 300u);
  EXPECT_EQ(session->channels[0].rate_hz, 2.5);
  EXPECT_TRUE(session->channels[1].pattern.matches("ROBOT/arm"));
  EXPECT_EQ(session->channels[1].guest.view(), "alice");
}

TEST(HouseFile, ErrorsNameTheFaultOfAChannel) {
  const std::string channel = std::string(kHouse) + "[[channel]]\nname = \"LIGHT/desk\"\n";
  std::string error = error_of(channel + "class = \"state\"\n");
  EXPECT_EQ(error.rfind("s.toml:5:8: ", 0), 0u) << error;
  EXPECT_NE(error.find("say layout="), std::string::npos) << error;
  error = error_of(channel + "class = \"state\"\nlayout = \"i8\"\nsize = 700\n");
  EXPECT_EQ(error.rfind("s.toml:8:8: ", 0), 0u) << error;
  error = error_of(channel + "clas = \"state\"\nlayout = \"i8\"\n");
  EXPECT_EQ(error.rfind("s.toml:6:1: ", 0), 0u) << error;
  std::string many = kHouse;
  for (int i = 0; i < 17; ++i)
    many +=
        "[[channel]]\nname = \"A/" + std::to_string(i) + "\"\nclass = \"state\"\nlayout = \"i8\"\n";
  EXPECT_NE(error_of(many).find("at most 16"), std::string::npos) << error_of(many);
}

TEST(HouseFile, ReadsTheMusicWhichFollowsItsRoomByDefault) {
  const auto alone = parse_session("[house]\n[music]\nfile = \"a.ogg\"\n", "h/s.toml");
  ASSERT_TRUE(alone) << alone.error().what;
  ASSERT_TRUE(alone->music);
  EXPECT_EQ(alone->music->file, "h/a.ogg");
  EXPECT_FALSE(alone->music->follow);
  EXPECT_FALSE(alone->music->guest.is_set()) << "nobody dances";
  EXPECT_TRUE(alone->music->is_alone);

  const auto in_room = parse_session(
      "[house]\nguest = \"ann\"\nserver = \"h:1\"\n[music]\nfile = \"a.ogg\"\nloop = true\n"
      "trim_ms = 20\nvolume = 0.5\nsteps_bpm = 96\n",
      "s.toml");
  ASSERT_TRUE(in_room) << in_room.error().what;
  EXPECT_TRUE(in_room->music->follow);
  EXPECT_FALSE(in_room->music->is_alone) << "the room's music is not stopped by one house";
  EXPECT_EQ(in_room->music->guest.view(), "ann");
  EXPECT_TRUE(in_room->music->loop);
  EXPECT_EQ(in_room->music->trim_ms, 20.0);
  EXPECT_EQ(in_room->music->steps_bpm, 96.0);

  const auto error_of = [](const std::string& music) {
    const auto session = parse_session("[house]\n" + music, "s.toml");
    return session ? "no error" : session.error().what;
  };
  EXPECT_NE(error_of("[music]\n").find("microphone = true"), std::string::npos);
  EXPECT_NE(error_of("[music]\nfile = \"a\"\nvolume = 2\n").find("s.toml:4"), std::string::npos);
  EXPECT_NE(error_of("[[music]]\nfile = \"a\"\n").find("[music], once"), std::string::npos);
  EXPECT_NE(error_of("[music]\nfil = \"a\"\n").find("'fil'"), std::string::npos);
}

TEST(HouseFile, ReadsTheStyleOfTheHouseBandOrNone) {
  const auto with = [](const std::string& music) {
    return parse_session("[house]\nguest = \"ann\"\nserver = \"h:1\"\n[music]\n" + music, "s.toml");
  };
  const auto band = with("band = \"bachata\"\n");
  ASSERT_TRUE(band) << band.error().what;
  EXPECT_EQ(band->music->band, "bachata");
  EXPECT_TRUE(band->music->follow);
  EXPECT_EQ(band->music->guest.view(), "ann");
  EXPECT_EQ(band->music->volume, HostedMusic::kBandVolume);
  const auto none = with("band = \"none\"\n");
  ASSERT_TRUE(none) << none.error().what;
  EXPECT_FALSE(none->music);
  EXPECT_TRUE(none->has_no_band);
  const auto error_of = [&](const std::string& music) {
    const auto session = with(music);
    return session ? "no error" : session.error().what;
  };
  EXPECT_NE(error_of("band = \"polka\"\n").find("cha-cha"), std::string::npos);
  EXPECT_NE(error_of("band = \"swing\"\nfile = \"a.ogg\"\n").find("in the place of a file"),
            std::string::npos);
}

TEST(HouseFile, ReadsTheVoiceOfAGuest) {
  const auto plain = parse_session(std::string(kHouse) + "[voice]\n", "s.toml");
  ASSERT_TRUE(plain) << plain.error().what;
  ASSERT_TRUE(plain->voice);
  EXPECT_EQ(plain->voice->guest.view(), "alice") << "the first guest";
  EXPECT_EQ(voice_arguments(*plain->voice, "bus"),
            (std::vector<std::string>{"--bus", "bus", "--guest", "alice", "--quiet"}));
  const auto all = parse_session(
      "[house]\nguests = [\"alice\", \"ann\"]\n"
      "[voice]\nguest = \"ann\"\nmicrophone = \"-m\"\nheadphones = true\n"
      "push_to_talk = true\nwith_picture = true\nvolumes = [\"bob=0.5\"]\nbuffer_ms = 30\n",
      "s.toml");
  ASSERT_TRUE(all) << all.error().what;
  const auto rare = parse_session(std::string(kHouse) +
                                      "[voice]\ndeafened = true\nlow_delay = true\n"
                                      "no_cleaning = true\nreference = \"room\"\n",
                                  "s.toml");
  ASSERT_TRUE(rare) << rare.error().what;
  const auto rare_words = voice_arguments(*rare->voice, "bus");
  for (const char* word : {"--deafen", "--low-delay", "--no-cleaning", "--reference=room"})
    EXPECT_NE(std::find(rare_words.begin(), rare_words.end(), word), rare_words.end()) << word;
  const auto words = voice_arguments(*all->voice, "bus");
  for (const char* word : {"ann", "--microphone=-m", "--to-headphones", "--push-to-talk",
                           "--with-picture", "--volume=bob=0.5"})
    EXPECT_NE(std::find(words.begin(), words.end(), word), words.end()) << word;
  const auto with = [](const std::string& voice) { return error_of(kHouse + voice); };
  for (const char* wrong : {"bob", "bob=3", "bob=0.5x"})
    EXPECT_NE(with("[voice]\nvolumes = [\"" + std::string(wrong) + "\"]\n").find("s.toml:5"),
              std::string::npos)
        << wrong;
  EXPECT_NE(with("[voice]\nmute = true\n").find("'mute'"), std::string::npos);
  EXPECT_NE(with("[[voice]]\n").find("[voice], once"), std::string::npos);
  // Whom no link takes to the others.
  const std::string zed = with("[voice]\nguest = \"zed\"\n");
  EXPECT_NE(zed.find("s.toml:5"), std::string::npos) << zed;
  EXPECT_NE(zed.find("'zed' is no guest of this house"), std::string::npos) << zed;
  EXPECT_NE(zed.find("there are: alice"), std::string::npos) << zed;
  EXPECT_TRUE(parse_session("[house]\n[voice]\nguest = \"zed\"\n", "s.toml"))
      << "a house without dancers hears";
  EXPECT_NE(error_of("[house]\n[voice]\n").find("who speaks"), std::string::npos);
}

TEST(HouseFile, HasTwoRoutesByDefault) {
  const auto session = parse_session(kHouse, "s.toml");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->routes.size(), 2u);
  EXPECT_TRUE(session->routes[0].through.empty());
  EXPECT_EQ(session->routes[1].through,
            (std::vector<std::string>{"predict", "bridge", "rhythm", "stylize"}));
}

TEST(HouseFile, ErrorsNameFileLineAndColumn) {
  EXPECT_EQ(error_of("[house]\nguest = 7\n").rfind("s.toml:2:9: ", 0), 0u)
      << error_of("[house]\nguest = 7\n");
  EXPECT_EQ(error_of("[house]\nguest = \"alice\nroom = 1\n").rfind("s.toml:2:", 0), 0u);
}

TEST(HouseFile, RefusesAMisspeltKeyAndListsTheKnownOnes) {
  const std::string error = error_of("[house]\nguest = \"alice\"\nsever = \"x:1\"\n");
  EXPECT_EQ(error.rfind("s.toml:3:1: ", 0), 0u) << error;
  EXPECT_NE(error.find("sever"), std::string::npos);
  EXPECT_NE(error.find("server"), std::string::npos);
}

TEST(HouseFile, RefusesImpossibleValues) {
  const std::string house = kHouse;
  const std::string route = house + "[[route]]\n";
  for (const std::string& text :
       {std::string(""),
        std::string("[house]\nguest = \"Alice\"\n"),
        house + "[hose]\n",
        std::string("house = 3\n"),
        route + "from = \"POSE/guest/*\"\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/alice\"\n",
        route + "from = \"POSE/stage/*\"\nto = \"POSE/stage/*\"\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/guest/*\"\n",
        route + "from = \"POSE/nowhere/*\"\nto = \"POSE/stage/*\"\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\nthrough = [\"fly\"]\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\nthrough = \"hold 20ms\"\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\n"
                "through = [\"stylize\", \"rhythm\"]\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\nrate = 60\n",
        route +
            "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\nthrough = [\"hold 1ms\"]\nrate = 0\n",
        route + "from = \"POSE/guest/*\"\nto = \"POSE/stage/*\"\nthrough = [\"hold 1ms\"]\nrate = "
                "nan\n",
        house + "[[produce]]\nkind = \"camel\"\nguest = \"a\"\n",
        house + "[[produce]]\nkind = \"salsa\"\nguest = \"a\"\nrole = \"judge\"\n",
        house + "[[produce]]\nkind = \"camera\"\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\nmodel = \"best\"\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\nheight = 0.3\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\npartners = [\"b=0.3\"]\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\npartners = [\"b=tall\"]\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\npartners = [\"B!\"]\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\npartners = [\"b\", \"c\", \"d\", "
                "\"e\"]\n",
        house + "[[produce]]\nkind = \"camera\"\nguest = \"a\"\nrole = \"lead\"\n",
        house + "[[listen]]\nto = \"fax\"\n",
        house + "[[listen]]\nto = \"text\"\nrate = 1e-12\n",
        house + "[[listen]]\nto = \"csv\"\nrate = 1001\n",
        house + "[[listen]]\nto = \"csv\"\nrate = nan\n",
        house + "route = 3\n",
        house + "room = \"No Spaces\"\n",
        house + "quality_mm = 0\n",
        house + "quality_mm = 21\n",
        house + "quality_mm = \"fine\"\n",
        house + "quality_mm = nan\n",
        house + "pose_bytes_per_second = -1\n",
        house + "pose_bytes_per_second = inf\n"}) {
    const std::string error = error_of(text);
    EXPECT_EQ(error.rfind("s.toml:", 0), 0u) << text << " -> " << error;
  }
}

TEST(HouseFile, RefusesMoreGuestsThanALinkCarries) {
  std::string text = "[house]\nguests = [";
  for (int i = 0; i < 17; ++i) text += (i ? ", \"g" : "\"g") + std::to_string(i) + "\"";
  EXPECT_NE(error_of(text + "]\n").find("16"), std::string::npos);
}

TEST(LoadSession, NamesAMissingFileAFolderAndAFileTooLarge) {
  EXPECT_FALSE(load_session("/nonexistent/s.toml"));
  const auto folder = std::filesystem::temp_directory_path();
  EXPECT_NE(load_session(folder.string()).error().what.find("folder"), std::string::npos);
  const std::string large = (folder / "dance-session-test-large.toml").string();
  std::ofstream(large) << std::string(2 << 20, '#');
  EXPECT_NE(load_session(large).error().what.find("1 MiB"), std::string::npos);
  std::filesystem::remove(large);
}

TEST(LoadSession, TakesTheSessionsThatComeWithTheTree) {
  for (const char* name : {"/sessions/alice.toml", "/sessions/bob.toml"}) {
    const auto session = load_session(std::string(DANCE_SOURCE_DIR) + name);
    EXPECT_TRUE(session) << session.error().what;
  }
}

}  // namespace
}  // namespace dance
