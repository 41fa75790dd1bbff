// The lobby's dancers: when their pictures are drawn, and their content.
#include "lobby/figures/lobby_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>
#include <thread>

#include "lobby/run/lobby_painter.h"
#include "tests/test_folder.h"
#include "tests/viewer/offscreen_test.h"
#include "viewer/gl/picture.h"
#include "viewer/gl/picture_target.h"

namespace dance {
namespace {

MonoTime figures_ms(std::int64_t ms) { return MonoTime() + Duration::s(100) + Duration::ms(ms); }

TEST(DrawingPace, UsesAFifthOfACoreInSoftware) {
  DrawingPace pace;
  pace.set_software(true);
  pace.note_input(figures_ms(0));
  EXPECT_TRUE(pace.is_due(figures_ms(0)));
  pace.note_drawn(Duration::ms(100), figures_ms(0));
  EXPECT_FALSE(pace.is_due(figures_ms(499)));
  EXPECT_EQ(pace.left(figures_ms(300)), Duration::ms(200));
  EXPECT_TRUE(pace.is_due(figures_ms(500)));
  pace.note_drawn(Duration::ms(1), figures_ms(500));
  EXPECT_FALSE(pace.is_due(figures_ms(600)));
  EXPECT_TRUE(pace.is_due(figures_ms(625)));
  pace.note_drawn(Duration::s(9), figures_ms(700));
  EXPECT_TRUE(pace.is_due(figures_ms(1700))) << "it never stops altogether";
}

TEST(DrawingPace, PausesInSoftwareWithoutInput) {
  DrawingPace pace;
  pace.note_input(figures_ms(0));
  EXPECT_TRUE(pace.is_due(figures_ms(200'000))) << "a graphics card goes on";
  pace.set_software(true);
  EXPECT_TRUE(pace.rests(figures_ms(121'000)));
  EXPECT_FALSE(pace.is_due(figures_ms(121'000)));
  pace.note_input(figures_ms(121'000));
  EXPECT_TRUE(pace.is_due(figures_ms(121'001)));
}

class LobbyFiguresTest : public OffscreenTest {
 protected:
  LobbyFiguresTest() {
    model_.settings.name = "alice";
    model_.avatars = {"marisol", "teo"};
  }
  // Steps until the condition holds, for a minute at most. The figures' clock advances by 1.1 s a
  // step.
  bool step_until(const std::function<bool()>& condition) {
    for (int i = 0; i < 6000; ++i) {
      now_ += Duration::ms(1100);
      figures_.note_input(now_);
      figures_.step(model_, 1.0f, now_);
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  static Picture read(void* texture, float width_u, float height_u) {
    const auto name = static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(texture));
    int width = 0, height = 0;
    glBindTexture(GL_TEXTURE_2D, name);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    EXPECT_NEAR(static_cast<float>(width) / static_cast<float>(height), width_u / height_u, 0.05f);
    GlFramebuffer framebuffer = GlFramebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    return read_bound_framebuffer(width, height);
  }
  Picture chosen() const {
    return read(model_.figures.chosen_texture, FigureFacts::kChosenWidth_u,
                FigureFacts::kChosenHeight_u);
  }
  bool has_all_portraits() const {
    return !model_.figures.options.empty() &&
           std::ranges::all_of(model_.figures.options,
                               [](const auto& it) { return it.texture != nullptr; });
  }

  TestFolder folder_{"lobby-figures"};
  LobbyModel model_;
  LobbyFigures figures_{AvatarStore(folder_.path("own"), folder_.path("foreign")),
                        DANCE_SOURCE_DIR "/data/avatars"};
  MonoTime now_ = figures_ms(0);
};

TEST_F(LobbyFiguresTest, PageDanceHasADancingCouple) {
  model_.screen = LobbyScreen::kDance;
  ASSERT_TRUE(step_until([&] { return model_.figures.couple_texture != nullptr; }));
  const auto picture = [&] {
    return read(model_.figures.couple_texture, FigureFacts::kCoupleWidth_u,
                FigureFacts::kCoupleHeight_u)
        .rgb;
  };
  const auto before = picture();
  const int drawn = figures_.drawn();
  ASSERT_TRUE(step_until([&] { return figures_.drawn() > drawn; }));
  EXPECT_NE(picture(), before) << "they move";
  EXPECT_TRUE(model_.figures.options.empty()) << "portraits are of another page";
}

TEST_F(LobbyFiguresTest, EachFigureHasAPortraitAndTheChosenOneDances) {
  model_.screen = LobbyScreen::kYou;
  ASSERT_TRUE(
      step_until([&] { return has_all_portraits() && model_.figures.chosen_texture != nullptr; }));
  ASSERT_EQ(model_.figures.options.size(), 3u);
  std::set<std::vector<std::uint8_t>> portraits;
  for (const FigureOption& option : model_.figures.options)
    portraits.insert(
        read(option.texture, FigureFacts::kPortraitWidth_u, FigureFacts::kPortraitHeight_u).rgb);
  EXPECT_EQ(portraits.size(), 3u) << "each shows another figure";
  const int drawn = figures_.drawn();
  const auto before = chosen().rgb;
  ASSERT_TRUE(step_until([&] { return figures_.drawn() > drawn; }));
  EXPECT_NE(chosen().rgb, before);
}

// Face, hands and forearms show skin, so darker skin makes a darker picture.
TEST_F(LobbyFiguresTest, DrawsAPortraitAgainWithTheChosenLook) {
  model_.screen = LobbyScreen::kYou;
  model_.settings.look = "trousers-crop-bare-s1-h1";
  ASSERT_TRUE(step_until([&] { return has_all_portraits(); }));
  const auto portrait = [&] {
    return read(model_.figures.options.front().texture, FigureFacts::kPortraitWidth_u,
                FigureFacts::kPortraitHeight_u)
        .rgb;
  };
  const auto light = portrait();
  model_.settings.look = "trousers-crop-bare-s6-h1";
  ASSERT_TRUE(step_until([&] { return portrait() != light; })) << "it is drawn again";
  const auto sum = [](const std::vector<std::uint8_t>& bytes) {
    return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
  };
  EXPECT_LT(sum(portrait()), sum(light));
}

TEST_F(LobbyFiguresTest, AnUnreadableFileIsReportedAndOtherFiguresAreShown) {
  model_.screen = LobbyScreen::kYou;
  model_.settings.avatar = folder_.path("no-such.vrm");
  ASSERT_TRUE(step_until([&] { return model_.figures.is_unreadable; }));
  EXPECT_EQ(model_.figures.options.back().name, "no-such.vrm");
  model_.settings.avatar = "teo";
  ASSERT_TRUE(step_until([&] { return !model_.figures.is_unreadable; }));
  ASSERT_TRUE(step_until([&] { return model_.figures.chosen_texture != nullptr; }));
}

TEST_F(LobbyFiguresTest, DrawsNothingBeforeItIsDueOrWhileGoingIn) {
  model_.screen = LobbyScreen::kHost;
  EXPECT_FALSE(figures_.time_until_due(model_, now_));
  EXPECT_FALSE(figures_.step(model_, 1.0f, now_));
  model_.screen = LobbyScreen::kDance;
  ASSERT_TRUE(step_until([&] { return model_.figures.couple_texture != nullptr; }));
  EXPECT_FALSE(figures_.step(model_, 1.0f, now_)) << "at the same moment";
  model_.is_going_in = true;
  EXPECT_FALSE(figures_.step(model_, 1.0f, now_ + Duration::s(5)));
  model_.is_going_in = false;
  figures_.release(model_);
  EXPECT_EQ(model_.figures.couple_texture, nullptr);
  ASSERT_TRUE(step_until([&] { return model_.figures.couple_texture != nullptr; }))
      << "it begins again after a dance";
}

// The pages are written to the folder DANCE_PICTURES, if it is set; the documents show them.
TEST_F(LobbyFiguresTest, PagesWithPicturesFitInEachLanguage) {
  model_.knows_cameras = true;
  for (const LobbyScreen screen : {LobbyScreen::kDance, LobbyScreen::kYou}) {
    const bool is_you = screen == LobbyScreen::kYou;
    model_.screen = screen;
    model_.settings.source = DancerSource::kSynthetic;
    ASSERT_TRUE(step_until([&] {
      return is_you ? has_all_portraits() && model_.figures.chosen_texture != nullptr
                    : model_.figures.couple_texture != nullptr;
    }));
    for (const LanguageName& language : kLanguages)
      for (const int width_px : {1280, 800}) {
        auto painter = LobbyPainter::create(1.0f);
        ASSERT_TRUE(painter);
        PictureTarget target(1);
        ASSERT_TRUE(target.resize(width_px, 900));
        model_.set_language(language.language);
        std::vector<std::string> clipped;
        for (int frame = 0; frame < 3; ++frame) {
          clipped.clear();
          target.bind_finished();
          (*painter)->draw(model_, width_px, 900, Duration::ms(16), &clipped);
        }
        EXPECT_EQ(clipped, std::vector<std::string>()) << language.code << width_px;
        const char* folder = std::getenv("DANCE_PICTURES");
        if (folder == nullptr) continue;
        glBindFramebuffer(GL_READ_FRAMEBUFFER, target.finished().name());
        const std::string name = std::string(is_you ? "figures" : "couple") + "-" +
                                 std::string(language.code) + std::to_string(width_px);
        EXPECT_TRUE(
            write_png(folder + ("/lobby-" + name + ".png"), read_bound_framebuffer(width_px, 900)));
      }
  }
}

}  // namespace
}  // namespace dance
