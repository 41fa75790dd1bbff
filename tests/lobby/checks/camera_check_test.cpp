// The preview with the program that makes it: before a preloaded camera, and of a video.
#include "lobby/checks/camera_check.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>

#include "core/net/mono_clock.h"
#include "lobby/checks/camera_list.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

const std::string kVideo = DANCE_SOURCE_DIR "/../shared/data/video/taiji.mp4";

// Variables of this process that children get, as long as it lives.
class Environment {
 public:
  Environment(std::initializer_list<std::pair<const char*, std::string>> variables) {
    for (const auto& [name, value] : variables) {
      ::setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread
      names_.emplace_back(name);
    }
  }
  ~Environment() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
    for (const std::string& name : names_) ::unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::string> names_;
};

Environment before_shim(const std::string& words) {
  return {{"LD_PRELOAD", DANCE_VIDEO_SHIM_PRELOAD},
          {"DANCE_VIDEO_SHIM", words},
          {"DANCE_POSE_MODELS", "/nonexistent"}};
}

class CameraCheckTest : public testing::Test {
 protected:
  void start(const std::string& device) {
    auto started = CameraCheck::start({device, bin("dance-capture"), "lite"});
    ASSERT_TRUE(started) << started.error().what;
    check_ = std::move(*started);
  }
  void work() {
    if (check_->fd() >= 0) {
      pollfd ready{check_->fd(), POLLIN, 0};
      ::poll(&ready, 1, 20);
    }
    check_->read(mono_now());
    if (check_->take(picture_)) ++pictures_;
  }
  bool is_told(Text text) {
    work();
    return std::find(check_->advice().begin(), check_->advice().end(), text) !=
           check_->advice().end();
  }
  std::string told() const { return Texts(Language::kEnglish)[check_->advice().front()]; }

  TestFolder folder_{"camera-check"};
  std::unique_ptr<CameraCheck> check_;
  PreviewPicture picture_;
  int pictures_ = 0;
};

TEST_F(CameraCheckTest, ShowsWhatACameraSees) {
  // Two halves, dark above and bright below.
  std::string picture(2UL * 640 * 360, '\x80');
  for (std::size_t i = 0; i < picture.size(); i += 2)
    picture[i] = i < picture.size() / 2 ? 50 : '\xc8';
  std::ofstream(folder_.path("film.yuyv"), std::ios::binary) << picture;
  const Environment shim =
      before_shim("modes=YUYV:640x360@30 card=HD_Webcam hz=30 file=" + folder_.path("film.yuyv"));
  start("42");
  ASSERT_TRUE(wait_for([&] { return work(), pictures_ >= 12; })) << told();
  EXPECT_EQ(picture_.width, 320);
  EXPECT_EQ(picture_.height, 180);
  const auto at = [&](int x, int y) {
    return picture_.rgb[3UL * static_cast<std::size_t>(y * 320 + x)];
  };
  EXPECT_LT(at(160, 40), 80);
  EXPECT_GT(at(160, 140), 180);
  EXPECT_EQ(check_->status().state, CameraState::kRunning);
  EXPECT_EQ(check_->status().name.view(), "HD Webcam (/dev/video42)");
  EXPECT_EQ(check_->status().width_px, 640);
  EXPECT_GT(check_->facts().light.spread, 0.4f);
  EXPECT_FALSE(check_->facts().body.is_found);
  EXPECT_FALSE(check_->status().has_network);
  EXPECT_TRUE(wait_for([&] { return is_told(Text::kCameraNoNetwork); })) << told();
}

TEST_F(CameraCheckTest, SaysWhatIsWrongWithACameraAndItsCure) {
  const std::pair<const char*, Text> troubles[]{{"busy=1", Text::kCameraInUse},
                                                {"denied=1", Text::kCameraNoPermission},
                                                {"absent=1", Text::kCameraNone}};
  for (const auto& [words, text] : troubles) {
    const Environment shim = before_shim(std::string("modes=YUYV:64x48@30 ") + words);
    start("42");
    EXPECT_TRUE(wait_for([&, cure = text] { return is_told(cure); })) << words << ": " << told();
    EXPECT_FALSE(check_->is_good());
    EXPECT_FALSE(check_->status().words.empty());
  }
}

TEST_F(CameraCheckTest, WaitsForACameraThatWasUnplugged) {
  std::ofstream(folder_.path("film.yuyv"), std::ios::binary) << std::string(2UL * 64 * 48, '\x60');
  const Environment shim = before_shim("modes=YUYV:64x48@30 hz=30 unplug=20 replug_ms=1500 file=" +
                                       folder_.path("film.yuyv"));
  start("42");
  ASSERT_TRUE(wait_for([&] { return is_told(Text::kCameraUnplugged); })) << told();
  const int before = pictures_;
  EXPECT_TRUE(wait_for([&] { return work(), pictures_ > before + 5; })) << told();
  EXPECT_EQ(check_->status().state, CameraState::kRunning);
}

TEST_F(CameraCheckTest, APersonInAVideoIsSeenFromHeadToFeet) {
  if (!std::filesystem::exists(DANCE_SOURCE_DIR "/models/pose/pose_landmark_lite.tflite"))
    GTEST_SKIP() << "the pose network is not here; ./dance setup fetches it";
  if (!std::filesystem::exists(kVideo)) GTEST_SKIP() << "there is no " << kVideo;
  start(kVideo);
  EXPECT_TRUE(wait_for([&] { return is_told(Text::kCameraSeenWhole); })) << told();
  EXPECT_TRUE(check_->is_good());
  EXPECT_TRUE(check_->facts().body.is_found);
}

TEST_F(CameraCheckTest, AProgramThatIsNotThereOrAnotherIsTold) {
  auto absent = CameraCheck::start({"", "/nonexistent/dance-capture", "lite"});
  ASSERT_TRUE(absent);
  EXPECT_EQ((*absent)->advice().front(), Text::kCameraNotBuilt);
  EXPECT_EQ((*absent)->fd(), -1);
  auto other = CameraCheck::start({"", "/bin/echo", "lite"});
  ASSERT_TRUE(other);
  check_ = std::move(*other);
  EXPECT_TRUE(wait_for([&] { return is_told(Text::kCameraEnded); })) << told();
  EXPECT_EQ(check_->fd(), -1);
}

// As a driver does that hangs.
TEST_F(CameraCheckTest, AProgramThatSaysNothingIsToldOnceItHasHadItsTime) {
  const std::string program = folder_.path("hangs");
  std::ofstream(program) << "#!/bin/sh\nexec sleep 100\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  auto started = CameraCheck::start({"", program, "lite"});
  ASSERT_TRUE(started);
  check_ = std::move(*started);
  const MonoTime begin = mono_now();
  check_->read(begin);
  check_->read(begin + Duration::s(5));
  EXPECT_EQ(check_->advice().front(), Text::kCameraOpening);
  check_->read(begin + Duration::s(7));
  EXPECT_EQ(check_->advice().front(), Text::kCameraSilent);
}

TEST_F(CameraCheckTest, CamerasAreListedWithTheirNames) {
  const Environment shim = before_shim("modes=YUYV:640x360@30,MJPG:1280x720@30 card=HD_Webcam");
  auto list = CameraList::start(bin("dance-capture"));
  ASSERT_TRUE(list) << list.error().what;
  ASSERT_TRUE(wait_for([&] { return (*list)->read(), (*list)->is_done(); }));
  EXPECT_FALSE((*list)->has_failed());
  const auto cameras = (*list)->cameras();
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [](const ListedCamera& c) { return c.device == "/dev/video42"; });
  ASSERT_NE(found, cameras.end());
  EXPECT_EQ(found->name, "HD Webcam");
  EXPECT_EQ(found->mode, "1280x720 MJPG at 30 Hz");
  EXPECT_EQ(found->trouble, "");
  auto absent = CameraList::start("/nonexistent/dance-capture");
  ASSERT_TRUE(absent);
  EXPECT_TRUE((*absent)->is_done() && (*absent)->has_failed());
}

TEST_F(CameraCheckTest, TheProgramPrintsItsAdviceInTheLanguageOfTheUser) {
  std::ofstream(folder_.path("film.yuyv"), std::ios::binary) << [] {
    std::string black(2UL * 64 * 48, '\x80');
    for (std::size_t i = 0; i < black.size(); i += 2) black[i] = 16;
    return black;
  }();
  const Environment shim =
      before_shim("modes=YUYV:64x48@30 hz=30 file=" + folder_.path("film.yuyv"));
  const Finished said =
      run("LC_ALL=es_ES.UTF-8 " + bin("dance-capture") + " 42 --check --text --seconds 4");
  EXPECT_EQ(said.exit_code, 0) << said.talk;
  EXPECT_NE(said.output.find(Texts(Language::kSpanish)[Text::kCameraLensCovered]),
            std::string::npos)
      << said.output;
  EXPECT_NE(said.output.find("pictures looked at"), std::string::npos) << said.output;
  const Finished nothing = run(bin("dance-capture") + " /dev/video63 --check --text --seconds 1");
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_NE(nothing.talk.find("there is no such camera"), std::string::npos) << nothing.talk;
}

}  // namespace
}  // namespace dance
