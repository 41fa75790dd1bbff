// What the window makes of clicks, of what programs say, and which command does the same.
#include "lobby/screen/lobby_model.h"

#include <gtest/gtest.h>

#include "lobby/run/child_words.h"
#include "lobby/run/room_host.h"
#include "lobby/run/trouble_words.h"
#include "tests/test_folder.h"
#include "tunnel/link/core/link_options.h"

namespace dance {
namespace {

LobbyModel model_at(const char* server) {
  LobbyModel model;
  LobbySettings settings;
  settings.name = "alice";
  settings.source = DancerSource::kSynthetic;
  settings.server = server;
  model.take(settings);
  model.settings_path = "~/.config/dancegraph/house.toml";
  return model;
}

TEST(LobbyModel, TakesWhatWasChangedDuringADanceAndNothingElse) {
  LobbyModel model = model_at("example.org");
  const LobbySettings before = model.settings;
  model.settings.room = "tango";  // not saved yet
  LobbySettings after = before;
  after.shown_name = "Alicia";
  after.avatar = "teo";
  after.figure_height = 1.1;
  after.speaks = true;
  after.has_headphones = true;
  after.server = "elsewhere.org";
  model.take_changes(before, after);
  EXPECT_EQ(model.settings.shown_name, "Alicia");
  EXPECT_EQ(model.name_typed, "Alicia");
  EXPECT_EQ(model.settings.avatar, "teo");
  EXPECT_EQ(model.settings.figure_height, 1.1);
  EXPECT_TRUE(model.settings.speaks && model.settings.has_headphones);
  EXPECT_EQ(model.settings.room, "tango");
  EXPECT_EQ(model.settings.server, "example.org");
}

TEST(LobbyModel, EachClickHasItsCommand) {
  LobbyModel model = model_at("");
  EXPECT_EQ(model.command(LobbyWish::kJoin), "dance join ~/.config/dancegraph/house.toml");
  model.settings.window.partner = "/my dances/it's.bvh";
  EXPECT_EQ(model.command(LobbyWish::kAlone),
            "dance join ~/.config/dancegraph/house.toml --alone --partner "
            "'/my dances/it'\\''s.bvh'");
  model.settings.window.music = "song.ogg";
  EXPECT_EQ(model.command(LobbyWish::kPractise),
            "dance join ~/.config/dancegraph/house.toml --alone --music song.ogg --view mirror");
  model.settings.window.mirror = false;
  EXPECT_EQ(model.command(LobbyWish::kPractise).find("--view"), std::string::npos);
  model.settings.window.teacher = "lesson one.bvh";
  EXPECT_TRUE(model.command(LobbyWish::kPractise)
                  .ends_with(" --music song.ogg --teacher 'lesson one.bvh'"));
  model.host.guest = "Bob";
  model.host.address = "example.org";
  EXPECT_EQ(model.command(LobbyWish::kInvite),
            "dance server --invite bob --room dance --address example.org");
}

TEST(LobbyModel, TheIdFollowsTheTypedNameUntilARoomIsKnown) {
  LobbyModel model;
  model.take(LobbySettings());
  for (const char* typed : {"", "A", "An", "Ana L\u00f3pez"}) {
    model.name_typed = typed;
    model.take_typed_name();
  }
  EXPECT_EQ(model.settings.name, "ana-lopez");
  EXPECT_EQ(model.shown_name(), "Ana L\u00f3pez");
  model.choose_room({"salsa", "a.org"});
  model.remember_room();
  model.name_typed = "La Ni\u00f1a";
  model.take_typed_name();
  EXPECT_EQ(model.settings.name, "ana-lopez") << "the key is for it";
  EXPECT_EQ(model.settings.shown_name, "La Ni\u00f1a");
  LobbyModel again;
  again.take(model.settings);
  EXPECT_EQ(again.name_typed, "La Ni\u00f1a");
}

TEST(LobbyModel, AnIdThatDiffersFromTheNameStays) {
  LobbyModel model = model_at("");
  EXPECT_EQ(model.name_typed, "alice");
  model.name_typed = "Alicia";
  model.take_typed_name();
  EXPECT_EQ(model.settings.name, "alice");
  EXPECT_EQ(model.settings.shown_name, "Alicia");
  for (const char* typed : {"", "  ", "\u202e"}) {
    model.name_typed = typed;
    model.take_typed_name();
    EXPECT_EQ(model.shown_name(), "alice") << typed;
  }
}

TEST(LobbyModel, KnowsRoomsTheLastOneFirstAndNoMoreThanFit) {
  LobbyModel model = model_at("");
  const auto join = [&](const KnownRoom& room) {
    model.choose_room(room);
    model.remember_room();
  };
  for (int i = 0; i < 40; ++i) join({"r" + std::to_string(i), "a.org"});
  join({"r20", "a.org"});
  EXPECT_EQ(model.settings.window.rooms.size(), WindowChoices::kMostRooms);
  EXPECT_EQ(model.settings.window.rooms.front().room, "r20");
  EXPECT_EQ(model.rooms.size(), WindowChoices::kMostRooms);
  model.rooms[0].guest_count = 20;
  model.rooms[1].guest_count = 39;
  join({"r39", "a.org:7400"});
  EXPECT_EQ(model.rooms[0].guest_count, 39u) << "what is known goes with the room";
  EXPECT_EQ(model.rooms[1].guest_count, 20u);
  model.forget_room(0);
  EXPECT_EQ(model.settings.window.rooms.front().room, "r20");
  EXPECT_EQ(model.rooms[0].guest_count, 20u);
  EXPECT_EQ(model.rooms.size(), WindowChoices::kMostRooms - 1);
}

TEST(LobbyModel, ShowsARoomOnceWithAndWithoutTheUsualPort) {
  LobbySettings settings;
  settings.window.rooms = {{"salsa", "a.org:7400"}, {"salsa", "a.org"}, {"salsa", "a.org:7401"}};
  LobbyModel model;
  model.take(settings);
  ASSERT_EQ(model.settings.window.rooms.size(), 2u);
  EXPECT_EQ(model.settings.window.rooms[1].server, "a.org:7401");
}

TEST(LobbyModel, RemembersARoomOnlyAfterJoiningIt) {
  LobbyModel model = model_at("");
  model.choose_room({"salsa", "a.org"});
  EXPECT_TRUE(model.settings.window.rooms.empty());
  model.remember_room();
  EXPECT_EQ(model.settings.window.rooms.size(), 1u);
}

TEST(LobbyModel, ReportsAKnownRoomThatIsSilentAtOnceAndOffersToTry) {
  LobbyModel model = model_at("");
  model.settings.window.rooms = {{"salsa", "a.org"}};
  model.rooms.resize(1);
  model.join_known_room(0);
  EXPECT_EQ(model.wish, LobbyWish::kJoin) << "it was not asked yet";
  model.wish = LobbyWish::kNone;
  model.rooms[0].state = RoomFact::State::kSilent;
  model.join_known_room(0);
  EXPECT_EQ(model.wish, LobbyWish::kNone);
  ASSERT_EQ(model.banners.size(), 1u);
  EXPECT_EQ(model.banners[0].text, Text::kLobbyRoomNotOpen);
  EXPECT_EQ(model.banners[0].wish, LobbyWish::kJoin);
  EXPECT_EQ(model.settings.server, "a.org") << "trying joins that room";
}

TEST(LobbyModel, OpensARoomOfItsOwnThatIsClosed) {
  LobbyModel model = model_at("");
  model.settings.window.rooms = {{"salsa", "127.0.0.1:7400"}};
  model.rooms.resize(1);
  model.rooms[0].state = RoomFact::State::kSilent;
  EXPECT_TRUE(model.is_own_room({"salsa", "localhost"}));
  EXPECT_FALSE(model.is_own_room({"salsa", "127.0.0.1:7499"}));
  EXPECT_FALSE(model.is_own_room({"salsa", "a.org"}));
  model.join_known_room(0);
  EXPECT_EQ(model.wish, LobbyWish::kOpenRoom);
  EXPECT_EQ(model.screen, LobbyScreen::kHost);
  EXPECT_EQ(model.settings.room, "salsa");
}

TEST(LobbyModel, JoinsNoRoomThatIsNone) {
  LobbyModel model = model_at("");
  ASSERT_TRUE(model.start_error(LobbyWish::kJoin));
  EXPECT_EQ(model.start_error(LobbyWish::kJoin)->text, Text::kLobbyNoRoomYet);
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone));
  model.room_typed = "Salsa Night";
  model.server_typed = "bad server";
  EXPECT_FALSE(model.choose_typed_room());
  model.server_typed = "dance.example.org";
  EXPECT_TRUE(model.choose_typed_room());
  EXPECT_EQ(model.settings.room, "salsa-night");
  EXPECT_FALSE(model.start_error(LobbyWish::kJoin));
}

TEST(LobbyModel, SaysWhatIsWrongWithTheCameraBeforeAnythingStarts) {
  LobbyModel model = model_at("");
  model.settings.source = DancerSource::kCamera;
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone)) << "cameras are not known yet";
  model.knows_cameras = true;
  EXPECT_EQ(model.start_error(LobbyWish::kAlone)->text, Text::kLobbyNoCamera);
  model.cameras = {{"/dev/video0", "HD", "in use"}};
  EXPECT_EQ(model.start_error(LobbyWish::kAlone)->text, Text::kLobbyCameraTaken);
  model.cameras[0].trouble.clear();
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone));
}

TEST(LobbyModel, AcceptsAVideoFileAsTheCamera) {
  LobbyModel model = model_at("");
  model.settings.source = DancerSource::kCamera;
  model.knows_cameras = true;
  model.settings.camera = "/home/alice/Salsa.MP4";
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone));
  EXPECT_FALSE(is_video_file("/dev/video0"));
  EXPECT_FALSE(is_video_file(""));
}

TEST(LobbyModel, OffersToWatchWhereTheCameraCannotBeUsed) {
  LobbyModel model = model_at("a.org");
  model.settings.source = DancerSource::kCamera;
  model.knows_cameras = true;
  const auto trouble = model.start_error(LobbyWish::kJoin);
  ASSERT_TRUE(trouble);
  EXPECT_EQ(trouble->other_request, LobbyWish::kWatchRoom);
  EXPECT_EQ(model.start_error(LobbyWish::kAlone)->other_button, Text::kCount)
      << "alone there is nothing to see";
  model.settings.source = DancerSource::kWatch;
  EXPECT_FALSE(model.start_error(LobbyWish::kJoin));
}

TEST(LobbyModel, ReportsAHeadsetThatIsNotReadyBeforeAnythingStarts) {
  LobbyModel model = model_at("a.org");
  model.headset_error = "no OpenXR runtime is active";
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone)) << "it is not wanted";
  model.settings.source = DancerSource::kHeadset;
  const auto trouble = model.start_error(LobbyWish::kJoin);
  ASSERT_TRUE(trouble);
  EXPECT_EQ(trouble->text, Text::kLobbyNoHeadset);
  EXPECT_EQ(trouble->wish, LobbyWish::kLookAgain);
  model.headset_error.clear();
  EXPECT_FALSE(model.start_error(LobbyWish::kJoin));
  model.has_headset = false;
  EXPECT_EQ(model.start_error(LobbyWish::kJoin)->text, Text::kLobbyNoHeadsetBuilt);
}

TEST(LobbyModel, ReportsAMicrophoneThatCannotBeReachedBeforeARoomIsEntered) {
  LobbyModel model = model_at("a.org");
  model.sound_error = "no sound server";
  EXPECT_FALSE(model.start_error(LobbyWish::kJoin)) << "no voice is wanted";
  model.settings.speaks = true;
  EXPECT_FALSE(model.start_error(LobbyWish::kAlone)) << "nobody would hear it";
  const auto trouble = model.start_error(LobbyWish::kJoin);
  ASSERT_TRUE(trouble);
  EXPECT_EQ(trouble->text, Text::kLobbyMicrophoneUnreachable);
  EXPECT_EQ(trouble->wish, LobbyWish::kWithoutVoice);
}

TEST(LobbyModel, WhileItGoesInOnlyTheWayBackIsOpen) {
  LobbyModel model = model_at("a.org");
  model.is_going_in = true;
  model.ask(LobbyWish::kAlone);
  EXPECT_EQ(model.wish, LobbyWish::kNone);
  model.ask(LobbyWish::kCancel);
  EXPECT_EQ(model.wish, LobbyWish::kCancel);
}

TEST(LobbyModel, AJoinRequestCanOnlyBeConfirmedOrCancelled) {
  LobbyModel model = model_at("a.org");
  model.join_request = JoinRequest{"salsa", "b.org", "ann"};
  for (const LobbyWish wish : {LobbyWish::kJoin, LobbyWish::kAlone, LobbyWish::kOpenInvitation}) {
    model.ask(wish);
    EXPECT_EQ(model.wish, LobbyWish::kNone);
  }
  model.ask(LobbyWish::kConfirmJoin);
  EXPECT_EQ(model.wish, LobbyWish::kConfirmJoin);
}

TEST(LobbyModel, TellsEachTroubleOnceAndNotTooMany) {
  LobbyModel model = model_at("");
  for (int i = 0; i < 3; ++i)
    model.tell({LobbyBanner::Kind::kTrouble, Text::kLobbyNoCamera, {}, ""});
  EXPECT_EQ(model.banners.size(), 1u);
  for (const Text text : {Text::kLobbyRoomFull, Text::kLobbyVersions, Text::kLobbyNotSaved})
    model.tell({LobbyBanner::Kind::kTrouble, text, {}, ""});
  EXPECT_EQ(model.banners.size(), LobbyModel::kMostBanners);
  EXPECT_EQ(model.banners.front().text, Text::kLobbyNotSaved);
}

// The lines are those that the programs write, so that another wording fails here.
TEST(TroubleWords, KnowWhatALinkSays) {
  const LobbySettings settings = model_at("dance.example.org").settings;
  const auto text_in = [&](const std::string& line) {
    const auto trouble = trouble_in(line, settings);
    return trouble ? trouble->banner.text : Text::kCount;
  };
  EXPECT_EQ(text_in(no_answer_line(Address::loopback(7400))), Text::kLobbyServerSilent);
  EXPECT_EQ(text_in(no_entry_line(SealTrouble::kWrongKey, "a.org")), Text::kLobbyKeyRefused);
  EXPECT_EQ(text_in(no_entry_line(SealTrouble::kServerKeyChanged, "a.org")),
            Text::kLobbyServerKeyChanged);
  EXPECT_EQ(text_in(no_entry_line(SealTrouble::kInterrupted, "a.org")), Text::kLobbyServerSilent);
  const wire::RoomName room = *wire::RoomName::parse("salsa");
  const auto refused = [&](wire::Refusal cause) {
    wire::RefusalNotice notice;
    notice.cause = cause;
    return text_in(refusal_line(notice, room));
  };
  EXPECT_EQ(refused(wire::Refusal::kNameTaken), Text::kLobbyNameTaken);
  EXPECT_EQ(refused(wire::Refusal::kRoomFull), Text::kLobbyRoomFull);
  EXPECT_EQ(refused(wire::Refusal::kVersion), Text::kLobbyVersions);
  EXPECT_EQ(refused(wire::Refusal::kRemoved), Text::kLobbyRemoved);
  EXPECT_EQ(refused(wire::Refusal::kKeyExpired), Text::kLobbyKeyExpired);
  EXPECT_EQ(refused(wire::Refusal::kKeyGuests), Text::kLobbyKeyBusy);
  for (int cause = 1; cause <= static_cast<int>(wire::Refusal::kKeyGuests); ++cause)
    EXPECT_NE(refused(static_cast<wire::Refusal>(cause)), Text::kCount) << cause;
  EXPECT_FALSE(trouble_in(no_answer_line(Address::loopback(7400)), settings)->is_fatal)
      << "the next of its addresses may answer";
  EXPECT_EQ(text_in("the sound server does not answer"), Text::kCount);
  EXPECT_EQ(text_in("dance voice: no sound server: start PulseAudio or PipeWire"),
            Text::kLobbyMicrophoneUnreachable);
  EXPECT_EQ(text_in("dance music: no sound server: start PulseAudio or PipeWire"), Text::kCount);
  EXPECT_EQ(text_in("bob is here"), Text::kCount);
  EXPECT_EQ(trouble_in(no_entry_line(SealTrouble::kWrongKey, "a.org"), settings)->banner.values,
            std::vector<std::string>{"dance.example.org"});
}

TEST(TroubleWords, TellAnEndByWhatWasSaidBefore) {
  const LobbySettings settings = model_at("a.org").settings;
  const std::deque<std::string> lines{"there is no key for a.org:7400 and room 'dance' in x",
                                      "something else"};
  EXPECT_EQ(end_error_of(lines, settings).text, Text::kLobbyNoKey);
  const std::deque<std::string> other{"out of memory"};
  EXPECT_EQ(end_error_of(other, settings).text, Text::kLobbyDanceEnded);
  EXPECT_EQ(end_error_of(other, settings).detail, "out of memory");
}

TEST(TroubleWords, TellWhyADanceDidNotBegin) {
  const LobbySettings settings = model_at("a.org").settings;
  const std::deque<std::string> silent{no_answer_line(Address::loopback(7400)), "bob is here"};
  EXPECT_EQ(start_error_of(silent, settings).text, Text::kLobbyServerSilent);
  const std::deque<std::string> other{"the sound server does not answer"};
  EXPECT_EQ(start_error_of(other, settings).text, Text::kLobbyNotBegun);
  EXPECT_EQ(start_error_of(other, settings).detail, other.front());
}

TEST(TroubleWords, KnowWhenAHouseDances) {
  EXPECT_TRUE(says_it_is_in("the house is open on udpm://…; Ctrl-C ends it", true));
  EXPECT_FALSE(says_it_is_in("the house is open on udpm://…; Ctrl-C ends it", false));
  EXPECT_TRUE(says_it_is_in("in room 'salsa' on a.org", false));
}

TEST(ChildWords, LeavesTimeAndNameOut) {
  EXPECT_EQ(without_prefix("12:00:00.123 dance join: bob is here"), "bob is here");
  EXPECT_EQ(without_prefix("bob: is here"), "bob: is here");
  EXPECT_EQ(without_prefix(""), "");
}

TEST(RoomHost, ReadsWhoIsThereAndWhetherAnybodyCameFromElsewhere) {
  const auto status = [](const std::string& peer) {
    return guests_of_status(R"({"rooms":[{"name":"salsa","links":[{"peer":")" + peer +
                            R"( bob","guests":[{"name":"bob"}]}]}]})");
  };
  EXPECT_EQ(status("192.168.1.4:9").guests, std::vector<std::string>{"bob (salsa)"});
  EXPECT_FALSE(status("192.168.1.4:9").was_reached_from_elsewhere);
  EXPECT_FALSE(status("[::1]:9").was_reached_from_elsewhere);
  EXPECT_TRUE(status("203.0.113.5:4711").was_reached_from_elsewhere);
  EXPECT_TRUE(status("[2001:db8::1]:9").was_reached_from_elsewhere);
  for (const char* broken : {"", "{", "[]", "{\"rooms\":3}", "{\"rooms\":[{\"links\":[7]}]}"})
    EXPECT_TRUE(guests_of_status(broken).guests.empty()) << broken;
}

TEST(RoomHost, ReadsWhichInvitationsWereUsedAndWhenTheyEnd) {
  using State = InvitedGuest::State;
  const auto guests = invited_guests(
      "name                      kind      room\n"
      "bob                       guest     salsa\n"
      "carol                     guest     every room                invited, until 2026-12-01 "
      "08:00 UTC\n"
      "dora                      host      salsa                     invitation expired 2026-11-01 "
      "08:00 UTC\n"
      "emil                      guest     salsa                     key until 2027-01-01 08:00 "
      "UTC\n"
      "Bad name\n\n");
  EXPECT_EQ(guests, (std::vector<InvitedGuest>{{"bob", State::kUsed, ""},
                                               {"carol", State::kInvited, "2026-12-01 08:00 UTC"},
                                               {"dora", State::kExpired, ""},
                                               {"emil", State::kUsed, "2027-01-01 08:00 UTC"}}));
}

TEST(FileChooser, ShowsFoldersAndTheFilesThatAreOfUse) {
  const TestFolder folder("file-chooser");
  std::filesystem::create_directories(folder.path("Zoo"));
  for (const char* name : {"b.bvh", "A.BVH", "song.ogg", ".hidden.bvh"})
    std::ofstream(folder.path(name)) << "x";
  FileChooser chooser;
  chooser.open(ChooserPurpose::kMotion, folder.path("b.bvh"));
  ASSERT_EQ(chooser.entries().size(), 3u);
  EXPECT_EQ(chooser.entries()[0].name, "Zoo");
  EXPECT_EQ(chooser.entries()[1].name, "A.BVH");
  chooser.enter(folder.path("nowhere"));
  EXPECT_TRUE(chooser.entries().empty());
  EXPECT_FALSE(chooser.trouble().empty());
}

}  // namespace
}  // namespace dance
