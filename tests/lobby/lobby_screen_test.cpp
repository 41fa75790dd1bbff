// Every screen in three languages, off screen: no text is wider than its place, and each is drawn.
// With DANCE_PICTURES=DIR the pictures are kept there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "core/net/mono_clock.h"
#include "lobby/run/lobby_painter.h"
#include "tests/viewer/offscreen_test.h"
#include "viewer/gl/picture.h"
#include "viewer/gl/picture_target.h"

namespace dance {
namespace {

struct Shown {
  Picture picture;
  std::vector<std::string> clipped;
};

LobbyModel full_model(Language language) {
  LobbyModel model;
  LobbySettings settings;
  settings.name = "alice";
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
  model.rooms.resize(2);
  model.rooms[0] = {
      RoomFact::State::kAnswers, Duration::ms(23), RoomFact::Who::kKnown, 2, {"bob", "carla"}, {}};
  model.rooms[1].state = RoomFact::State::kSilent;
  model.advice = {Text::kCameraTooDark, Text::kCameraFeetCutOff};
  model.host.state = HostFacts::State::kOpen;
  model.host.addresses = {"192.168.1.23"};
  model.host.guests = {"alice (salsa)", "bob (salsa)"};
  model.host.invited = {"bob", "carol"};
  return model;
}

class LobbyScreenTest : public OffscreenTest {
 protected:
  Shown show(LobbyModel& model, int width_px, int height_px, float scale,
             const std::string& name = "") {
    auto painter = LobbyPainter::create(scale);
    EXPECT_TRUE(painter) << painter.error().what;
    PictureTarget target(1);
    EXPECT_TRUE(target.resize(width_px, height_px));
    Shown shown;
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

constexpr std::array kScreens{LobbyScreen::kYou, LobbyScreen::kDance, LobbyScreen::kHost};
constexpr std::array<const char*, 3> kScreenNames{"you", "dance", "host"};

int inks(const Picture& picture) {
  int bright = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) bright += picture.rgb[i] > 200 ? 1 : 0;
  return bright;
}

TEST_F(LobbyScreenTest, NoTextIsWiderThanItsPlaceInAnyLanguageAndSize) {
  struct Size {
    int width_px, height_px;
    float scale;
    const char* name;
  };
  for (const LanguageName& language : kLanguages)
    for (const Size& size :
         {Size{1280, 720, 1.0f, ""}, Size{2560, 1440, 2.0f, "-2x"}, Size{800, 600, 1.0f, "-small"}})
      for (std::size_t i = 0; i < kScreens.size(); ++i) {
        LobbyModel model = full_model(language.language);
        model.screen = kScreens[i];
        const std::string name =
            std::string(kScreenNames[i]) + "-" + std::string(language.code) + size.name;
        const Shown shown = show(model, size.width_px, size.height_px, size.scale, name);
        for (const std::string& text : shown.clipped) ADD_FAILURE() << name << ": " << text;
        EXPECT_GT(inks(shown.picture), 2000) << name << " is drawn";
      }
}

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
    model.command_for = LobbyWish::kAlone;
    const std::string code(language.code);
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "trouble-" + code).clipped, std::vector<std::string>());
    model.is_going_in = true;
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "going-in-" + code).clipped, std::vector<std::string>());
    model.is_going_in = false;
    model.chooser.open(ChooserPurpose::kMotion, DANCE_SOURCE_DIR "/logs/couple.lcm");
    EXPECT_EQ(show(model, 1280, 720, 1.0f, "file-" + code).clipped, std::vector<std::string>());
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
      const Shown shown = show(model, 960, 1100, 1.0f, kept_as);
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
