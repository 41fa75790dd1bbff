// Every screen in three languages, off screen: no text is wider than its place, and each is drawn.
// With DANCE_PICTURES=DIR the pictures are kept there.
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/net/mono_clock.h"
#include "lobby/run/lobby_painter.h"
#include "tests/test_folder.h"
#include "tests/viewer/offscreen_test.h"
#include "viewer/gl/picture.h"
#include "viewer/gl/picture_target.h"

namespace dance {
namespace {

struct ShownScreen {
  Picture picture;
  std::vector<std::string> clipped;
};

LobbyModel full_model(Language language) {
  LobbyModel model;
  LobbySettings settings;
  settings.name = "alice";
  settings.shown_name = "Alicia L\u00f3pez";
  settings.source = DancerSource::kCamera;
  settings.height_m = 1.68;
  settings.speaks = true;
  settings.window.rooms = {{"salsa", "dance.example.org:7400"}, {"tango", "192.0.2.7"}};
  model.take(settings);
  model.set_language(language);
  model.settings_path = "~/.config/dancegraph/house.toml";
  model.knows_cameras = true;
  model.cameras = {{"/dev/video0", "HD Webcam", ""}, {"/dev/video2", "Action camera", ""}};
  model.avatars = {"marisol", "teo"};
  model.figures.options = {
      {"", "", nullptr},
      {"marisol", "marisol", nullptr},
      {"teo", "teo", nullptr},
      {"/home/alice/a figure with a long name.vrm", "a figure with a long name.vrm", nullptr}};
  model.host.invitation = "dance://192.168.1.23/salsa?v=2&guest=carol&server=A2sX0fLhLEJH&key=AAAA";
  model.host.invited_guest = "carol";
  model.host.is_for_home_only = true;
  model.host.page = "~/Videos/DanceGraph/invitation-carol.html";
  model.host.router = HostFacts::Router::kBehindAnother;
  model.host.router_address = "100.64.3.7";
  model.rooms.resize(2);
  model.rooms[0] = {
      RoomFact::State::kAnswers, Duration::ms(23), RoomFact::Who::kKnown, 2, {"bob", "carla"}, {}};
  model.rooms[1].state = RoomFact::State::kSilent;
  model.advice = {Text::kCameraTooDark, Text::kCameraFeetCutOff};
  model.host.state = HostFacts::State::kOpen;
  model.host.addresses = {"192.168.1.23"};
  model.host.guests = {"alice (salsa)", "bob (salsa)"};
  using State = InvitedGuest::State;
  model.host.invited = {{"bob", State::kUsed, ""},
                        {"carol", State::kInvited, "2026-12-01 08:00 UTC"},
                        {"dora", State::kExpired, ""}};
  constexpr std::int64_t kNow_us = 1'790'000'000'000'000;
  model.shelf.now_us = kNow_us;
  model.shelf.folder = "~/Videos/DanceGraph";
  const std::string folder = "/home/alice/Videos/DanceGraph/";
  model.shelf.dances = {
      {folder + "Salsa con Bob.lcm",
       0,
       kNow_us - 60'000'000,
       Duration::s(205),
       {"alice", "bob"},
       {{"bob", "Bob"}},
       "Cuarto de luna",
       180.0,
       true,
       true},
      {folder + "dance-2026-09-20-2114.lcm",
       0,
       kNow_us - 86'400'000'000,
       Duration::s(3725),
       {"alice", "bob", "carla", "dora", "emil", "fritz"},
       {},
       "",
       92.4,
       true,
       true},
      {folder + "broken.lcm", 0, kNow_us - 864'000'000'000, {}, {}, {}, "", 0.0, true, false}};
  model.shelf.chosen = model.shelf.dances[0].path;
  return model;
}

class LobbyScreenTest : public OffscreenTest {
 protected:
  ShownScreen show(LobbyModel& model, int width_px, int height_px, float scale,
                   const std::string& name = "") {
    auto painter = LobbyPainter::create(scale);
    EXPECT_TRUE(painter) << painter.error().what;
    PictureTarget target(1);
    EXPECT_TRUE(target.resize(width_px, height_px));
    ShownScreen shown;
    for (int frame = 0; frame < 3; ++frame) {  // Dear ImGui settles
      shown.clipped.clear();
      target.bind_finished();
      (*painter)->draw(model, width_px, height_px, Duration::ms(16), &shown.clipped);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.finished().name());
    shown.picture = read_bound_framebuffer(width_px, height_px);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const char* folder = std::getenv("DANCE_PICTURES");
    if (folder != nullptr && !name.empty()) {
      EXPECT_TRUE(write_png(folder + ("/lobby-" + name + ".png"), shown.picture));
    }
    return shown;
  }
};

constexpr std::array kScreens{LobbyScreen::kYou, LobbyScreen::kDance, LobbyScreen::kHost,
                              LobbyScreen::kShelf};
constexpr std::array<const char*, 4> kScreenNames{"you", "dance", "host", "shelf"};

int inks(const Picture& picture) {
  int bright = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) bright += picture.rgb[i] > 200 ? 1 : 0;
  return bright;
}

// Draws each page in several sizes and fails for each text that is cut off.
class LobbyScreenFitTest : public LobbyScreenTest,
                           public testing::WithParamInterface<LanguageName> {};

TEST_P(LobbyScreenFitTest, NoTextIsWiderThanItsPlaceAtAnySize) {
  struct Size {
    int width_px, height_px;
    float scale;
    const char* name;
  };
  const LanguageName& language = GetParam();
  for (const Size& size :
       {Size{1280, 720, 1.0f, ""}, Size{2560, 1440, 2.0f, "-2x"}, Size{800, 600, 1.0f, "-small"}})
    for (std::size_t i = 0; i < kScreens.size(); ++i) {
      LobbyModel model = full_model(language.language);
      model.screen = kScreens[i];
      const std::string name =
          std::string(kScreenNames[i]) + "-" + std::string(language.code) + size.name;
      const ShownScreen shown = show(model, size.width_px, size.height_px, size.scale, name);
      for (const std::string& text : shown.clipped) ADD_FAILURE() << name << ": " << text;
      EXPECT_GT(inks(shown.picture), 2000) << name << " is drawn";
    }
}
INSTANTIATE_TEST_SUITE_P(InEachLanguage, LobbyScreenFitTest, testing::ValuesIn(kLanguages),
                         [](const auto& language) { return std::string(language.param.code); });

TEST_F(LobbyScreenTest, BannersCommandsAndSheetsFitToo) {
  for (const LanguageName& language : kLanguages) {
    LobbyModel model = full_model(language.language);
    model.tell({LobbyBanner::Kind::kTrouble,
                Text::kLobbyCameraTaken,
                {"/dev/video0"},
                "/dev/video0: in use; close the program that has it (fuser -v /dev/video0)",
                Text::kLobbyLookAgain,
                LobbyWish::kLookAgain});
    model.tell({LobbyBanner::Kind::kGood, Text::kLobbyNoGraphics, {}, ""});
    model.shows_command = true;
    const std::string code(language.code);
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "trouble-" + code).clipped, std::vector<std::string>());
    model.is_going_in = true;
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "going-in-" + code).clipped, std::vector<std::string>());
    model.is_going_in = false;
    model.chooser.open(ChooserPurpose::kMotion, DANCE_SOURCE_DIR "/logs/couple.lcm");
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "file-" + code).clipped, std::vector<std::string>());
  }
}

TEST_F(LobbyScreenTest, NamesOfFilesChangeNoDirectionOfText) {
  const TestFolder folder("names");
  LobbyModel model = full_model(Language::kEnglish);
  const auto picture_with = [&](const std::string& name) {
    std::filesystem::remove_all(folder.path("files"));
    std::filesystem::create_directories(folder.path("files"));
    std::ofstream(folder.path("files/" + name)) << "x";
    model.chooser.open(ChooserPurpose::kMotion, folder.path("files/" + name));
    EXPECT_EQ(model.chooser.entries().size(), 1u) << name;
    return show(model, 1280, 720, 1.0f).picture.rgb;
  };
  // An override would show the end of the name backwards.
  const auto escaped = picture_with("song?mcl.lcm");
  EXPECT_EQ(picture_with("song\u202emcl.lcm"), escaped);
  EXPECT_EQ(picture_with("song\x1bmcl.lcm"), escaped);
  EXPECT_NE(picture_with("song-mcl.lcm"), escaped) << "pictures can differ";
}

TEST_F(LobbyScreenTest, AJoinRequestFitsAndSaysWhetherTheVoiceIsSent) {
  for (const LanguageName& language : kLanguages) {
    LobbyModel model = full_model(language.language);
    model.screen = LobbyScreen::kDance;
    const std::string code(language.code);
    model.join_request = {"salsa", "dance.example.org", "alice", true};
    const ShownScreen speaks = show(model, 1280, 720, 1.0f, "join-" + code);
    EXPECT_EQ(speaks.clipped, std::vector<std::string>());
    model.join_request->speaks = false;
    const ShownScreen is_silent = show(model, 1280, 720, 1.0f);
    EXPECT_EQ(is_silent.clipped, std::vector<std::string>());
    EXPECT_NE(speaks.picture.rgb, is_silent.picture.rgb);
    model.join_request->has_new_key = true;
    const ShownScreen warns = show(model, 1280, 720, 1.0f, "join-new-key-" + code);
    EXPECT_EQ(warns.clipped, std::vector<std::string>());
    EXPECT_NE(warns.picture.rgb, is_silent.picture.rgb);
    // The longest texts that a link can have.
    model.join_request = {std::string(24, 'm'), std::string(253, 'w') + ":65535",
                          std::string(24, 'm'), true};
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "join-long-" + code).clipped,
              std::vector<std::string>());
  }
}

TEST_F(LobbyScreenTest, WhoIsInARoomIsShownOrWhyItIsNot) {
  using Who = RoomFact::Who;
  for (const LanguageName& language : kLanguages) {
    LobbyModel model = full_model(language.language);
    RoomFact& room = model.rooms[0];
    std::set<std::vector<std::uint8_t>> pictures;
    const auto look = [&](Who who, std::size_t count, std::vector<std::string> names,
                          const std::string& kept_as = "") {
      room.who = who;
      room.guest_count = count;
      room.guests = std::move(names);
      const ShownScreen shown = show(model, 960, 1600, 1.0f, kept_as);
      EXPECT_EQ(shown.clipped, std::vector<std::string>());
      pictures.insert(shown.picture.rgb);
    };
    look(Who::kUnknown, 0, {});
    look(Who::kNoKey, 0, {});
    look(Who::kRefused, 0, {});
    look(Who::kKnown, 0, {});
    look(Who::kKnown, 2, {"bob", "carla"}, "rooms-" + std::string(language.code));
    look(Who::kKnown, 48, std::vector<std::string>(32, "a-guest-with-a-long-name"));
    EXPECT_EQ(pictures.size(), 6u) << language.code;
  }
}

// Join, far down on the page, fails: the reason stands at its top.
TEST_F(LobbyScreenTest, AnErrorIsVisibleOnAScrolledPage) {
  constexpr int kWidth_px = 960, kHeight_px = 500;
  const LobbyBanner fault{
      LobbyBanner::Kind::kTrouble, Text::kLobbyNotBegun, {}, "", Text::kCount, LobbyWish::kNone};
  auto painter = LobbyPainter::create(1.0f);
  ASSERT_TRUE(painter) << painter.error().what;
  PictureTarget target(1);
  ASSERT_TRUE(target.resize(kWidth_px, kHeight_px));
  LobbyModel model = full_model(Language::kEnglish);
  const auto look = [&](float wheel = 0.0f) {
    for (int frame = 0; frame < 4; ++frame) {
      ImGui::GetIO().MousePos = ImVec2(0.6f * kWidth_px, 0.5f * kHeight_px);
      ImGui::GetIO().MouseWheel = wheel;
      target.bind_finished();
      (*painter)->draw(model, kWidth_px, kHeight_px, Duration::ms(16), nullptr);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.finished().name());
    return read_bound_framebuffer(kWidth_px, kHeight_px).rgb;
  };
  const auto top = look();
  look(-2.0f);
  EXPECT_NE(look(), top) << "the page scrolls";
  model.tell(fault);
  const auto told = look();
  look(-2.0f);
  const auto scrolled = look();
  EXPECT_NE(scrolled, told);
  model.tell(fault);
  EXPECT_EQ(look(), scrolled) << "what is shown already leaves the page where it is";
  model.banners.clear();
  model.tell(fault);
  EXPECT_EQ(look(), told);
  model.show(LobbyScreen::kHost);
  model.show(LobbyScreen::kDance);
  EXPECT_EQ(look(), told) << "each page begins at its top";
}

TEST_F(LobbyScreenTest, EachQuestionAboutARecordingFits) {
  using Question = ShelfFacts::Question;
  for (const LanguageName& language : kLanguages) {
    LobbyModel model = full_model(language.language);
    model.screen = LobbyScreen::kShelf;
    std::set<std::vector<std::uint8_t>> pictures;
    const std::string code(language.code);
    const auto look = [&](const std::string& name) {
      const ShownScreen shown = show(model, 1280, 720, 1.0f, name);
      EXPECT_EQ(shown.clipped, std::vector<std::string>());
      pictures.insert(shown.picture.rgb);
    };
    model.shelf.has_opener = true;
    for (const Question question : {Question::kNone, Question::kExport, Question::kRename,
                                    Question::kDelete, Question::kFile}) {
      model.shelf.question = question;
      model.shelf.name_typed = "Salsa con Bob";
      look("shelf-" + std::to_string(static_cast<int>(question)) + "-" + code);
    }
    model.shelf.question = Question::kNone;
    model.shelf.exported_name = "Salsa con Bob.mp4";
    model.shelf.percent = 45;
    look("shelf-video-" + code);
    model.tell({LobbyBanner::Kind::kGood,
                Text::kLobbySavedDance,
                {},
                "~/Videos/DanceGraph/a.lcm",
                Text::kLobbyWatch,
                LobbyWish::kWatch});
    model.shelf.dances.clear();
    look("shelf-empty-" + code);
    EXPECT_EQ(pictures.size(), 7u) << code;
  }
}

TEST_F(LobbyScreenTest, ATextThatDoesNotFitIsNoted) {
  LobbyModel model = full_model(Language::kEnglish);
  EXPECT_FALSE(show(model, 420, 600, 2.0f).clipped.empty()) << "the measure itself works";
}

TEST_F(LobbyScreenTest, ScreensAreDifferentPictures) {
  LobbyModel model = full_model(Language::kEnglish);
  std::vector<Picture> pictures;
  for (const LobbyScreen screen : kScreens) {
    model.show(screen);
    pictures.push_back(show(model, 1280, 720, 1.0f).picture);
  }
  EXPECT_NE(pictures[0].rgb, pictures[1].rgb);
  EXPECT_NE(pictures[1].rgb, pictures[2].rgb);
}

}  // namespace
}  // namespace dance
