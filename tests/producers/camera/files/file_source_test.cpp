// Videos and images as frame sources.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "core/net/mono_clock.h"
#include "producers/camera/files/image_reel.h"
#include "producers/camera/files/open_frame_source.h"
#include "tests/producers/camera/v4l2/drawn_pictures.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr int kFileWidth_px = 64;
constexpr int kFileHeight_px = 48;
constexpr int kFilePictures = 12;

class FileSource : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("dance_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string in(const std::string& name) const { return folder_ / name; }
  // Pictures that tell by their grey which they are.
  std::string video(const std::string& name, double hz, int pictures = kFilePictures) const {
    cv::VideoWriter writer(in(name), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           hz, cv::Size(kFileWidth_px, kFileHeight_px));
    EXPECT_TRUE(writer.isOpened());
    for (int i = 0; i < pictures; ++i)
      writer.write(drawn_grey(kFileWidth_px, kFileHeight_px, level_of_picture(i)));
    return in(name);
  }
  std::string image(const std::string& name, int number) const {
    cv::imwrite(in(name), drawn_grey(kFileWidth_px, kFileHeight_px, level_of_picture(number)));
    return in(name);
  }
  std::string text(const std::string& name, const std::string& content) const {
    std::ofstream(in(name)) << content;
    return in(name);
  }
  static int number_of(const Frame& frame) {
    return static_cast<int>((mean_level(frame.image) - level_of_picture(0)) / 10.0 + 0.5);
  }
  static std::unique_ptr<FrameSource> opened(const std::string& called, const PlayOptions& play) {
    auto source = open_frame_source(called, {{}, play});
    EXPECT_TRUE(source.has_value()) << (source ? "" : source.error().what);
    return source ? std::move(*source) : nullptr;
  }
  static std::string why_not(const std::string& called) {
    const auto source = open_frame_source(called);
    return source ? "it was opened" : source.error().what;
  }

  static constexpr PlayOptions kFast{false, false, 0.0};
  fs::path folder_;
};

TEST_F(FileSource, AVideoAsFastAsPossibleGivesEveryPictureWithItsTime) {
  const auto source = opened(video("a.avi", 25.0), kFast);
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, kFileWidth_px);
  EXPECT_EQ(source->format().height_px, kFileHeight_px);
  EXPECT_EQ(source->format().hz, 25.0);
  EXPECT_EQ(source->format().encoding, "MJPG");
  EXPECT_EQ(source->name(), "a.avi");
  EXPECT_EQ(line_on(*source), "a.avi: 64x48 MJPG at 25 Hz");
  Frame frame;
  MonoTime start;
  for (int i = 0; i < kFilePictures; ++i) {
    const MonoTime asked = mono_now();
    ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
    EXPECT_GE(frame.fetched, asked);
    EXPECT_LE(frame.fetched, mono_now());
    if (i == 0) start = frame.capture_time;
    EXPECT_EQ(number_of(frame), i);
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i + 1));
    EXPECT_EQ(frame.capture_time - start, Duration::ms(40) * i);
  }
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kOver);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kOver);
  EXPECT_EQ(source->counters().taken, static_cast<std::uint64_t>(kFilePictures));
  EXPECT_EQ(source->counters().outrun, 0u);
  EXPECT_EQ(source->counters().damaged, 0u);
}

TEST_F(FileSource, InRealTimeASlowReaderGetsTheNewest) {
  const auto source = opened(video("a.avi", 100.0), {});
  ASSERT_NE(source, nullptr);
  const Duration period = Duration::ms(10);
  Frame frame;
  MonoTime start;
  std::uint64_t shown = 0;
  bool stood_still = false;
  for (;;) {
    const MonoTime asked = mono_now();
    const FrameState state = source->next(Duration::s(60), frame);
    if (state == FrameState::kOver) break;
    ASSERT_EQ(state, FrameState::kFrame);
    const Duration due = period * static_cast<std::int64_t>(frame.sequence - 1);
    if (shown++ == 0) start = frame.capture_time - due;
    EXPECT_EQ(number_of(frame), static_cast<int>(frame.sequence) - 1);
    // The film waits only for a machine that stood still within a call for about a second.
    stood_still = stood_still || mono_now() - asked > Duration::ms(900);
    if (stood_still) {
      EXPECT_GE(frame.capture_time - start, due);
    } else {
      EXPECT_EQ(frame.capture_time - start, due);
    }
    EXPECT_GE(frame.fetched, asked);
    EXPECT_GE(frame.fetched, frame.capture_time);
    EXPECT_LE(frame.fetched, mono_now());
    EXPECT_GT(frame.capture_time + period, asked) << "there was a newer one";
    ::usleep(35'000);
  }
  EXPECT_EQ(source->counters().taken, shown);
  EXPECT_EQ(source->counters().taken + source->counters().outrun,
            static_cast<std::uint64_t>(kFilePictures));
  EXPECT_GT(source->counters().outrun, 0u);
}

TEST_F(FileSource, InRealTimeAPictureIsNotEarlyAndWaitingEnds) {
  const auto source = opened(video("a.avi", 0.01, 2), {});
  ASSERT_NE(source, nullptr);
  Frame frame;
  ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
  EXPECT_EQ(source->next(Duration::ms(1), frame), FrameState::kNone);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
}

TEST_F(FileSource, ALoopGoesOnInTimeAndCount) {
  PlayOptions play = kFast;
  play.loops = true;
  const auto source = opened(video("a.avi", 25.0), play);
  ASSERT_NE(source, nullptr);
  Frame frame;
  MonoTime before;
  for (int i = 0; i < 3 * kFilePictures; ++i) {
    ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
    EXPECT_EQ(number_of(frame), i % kFilePictures);
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i + 1));
    if (i > 0) {
      EXPECT_EQ(frame.capture_time - before, Duration::ms(40));
    }
    before = frame.capture_time;
  }
}

TEST_F(FileSource, ALoopInRealTimeKeepsItsPace) {
  PlayOptions play;
  play.loops = true;
  const auto source = opened(video("a.avi", 500.0), play);
  ASSERT_NE(source, nullptr);
  Frame frame;
  MonoTime start;
  std::uint64_t last = 0;
  while (last < 3 * kFilePictures) {
    ASSERT_EQ(source->next(Duration::s(60), frame), FrameState::kFrame);
    if (last == 0)
      start = frame.capture_time - Duration::ms(2) * static_cast<std::int64_t>(frame.sequence - 1);
    EXPECT_GT(frame.sequence, last);
    last = frame.sequence;
    // Later only where this machine slept.
    EXPECT_GE(frame.capture_time - start,
              Duration::ms(2) * static_cast<std::int64_t>(last - 1) - Duration::us(1));
    EXPECT_EQ(number_of(frame), static_cast<int>((last - 1) % kFilePictures));
  }
}

TEST_F(FileSource, AVideoThatIsCutOffSaysSo) {
  const std::string whole = video("a.avi", 25.0, 2 * kFilePictures);
  fs::resize_file(whole, fs::file_size(whole) * 2 / 3);
  const auto source = opened(whole, kFast);
  ASSERT_NE(source, nullptr);
  Frame frame;
  int shown = 0;
  while (source->next(Duration(), frame) == FrameState::kFrame) ++shown;
  EXPECT_GT(shown, 0);
  EXPECT_LT(shown, 2 * kFilePictures);
  EXPECT_GE(source->counters().damaged, 1u);
}

TEST_F(FileSource, AFolderPlaysItsPicturesInOrder) {
  image("10.png", 2);
  image("2.PNG", 1);
  image("1.jpg", 0);
  text("notes.txt", "not a picture");
  PlayOptions play = kFast;
  play.hz = 10.0;
  const auto source = opened(folder_, play);
  ASSERT_NE(source, nullptr);
  Frame frame;
  MonoTime start;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
    if (i == 0) start = frame.capture_time;
    EXPECT_EQ(number_of(frame), i);
    EXPECT_EQ(frame.capture_time - start, Duration::ms(100) * i);
  }
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kOver);
  EXPECT_EQ(picture_files({folder_}).value(),
            (std::vector<std::string>{in("1.jpg"), in("2.PNG"), in("10.png")}));
}

TEST_F(FileSource, AListPlaysInTheOrderGiven) {
  const std::string one = image("one.png", 1), two = image("two.png", 2),
                    three = image("three.png", 3);
  for (const bool by_comma : {true, false}) {
    const SourceOptions options{{}, kFast};
    auto source = by_comma ? open_frame_source(three + "," + one + "," + two, options)
                           : open_frame_source(std::vector<std::string>{three, one, two}, options);
    ASSERT_TRUE(source.has_value()) << source.error().what;
    Frame frame;
    for (const int number : {3, 1, 2}) {
      ASSERT_EQ((*source)->next(Duration(), frame), FrameState::kFrame);
      EXPECT_EQ(number_of(frame), number);
    }
    EXPECT_EQ((*source)->next(Duration(), frame), FrameState::kOver);
    EXPECT_EQ((*source)->name(), "three.png and 2 more");
  }
}

TEST_F(FileSource, APictureThatIsDamagedInsideIsLeftOutAndCounted) {
  image("1.png", 0);
  image("2.png", 1);
  image("3.png", 2);
  fs::resize_file(in("2.png"), 50);
  const auto source = opened(folder_, kFast);
  ASSERT_NE(source, nullptr);
  Frame frame;
  ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
  ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 2);
  EXPECT_EQ(frame.sequence, 3u);
  EXPECT_EQ(source->counters().damaged, 1u);
}

TEST_F(FileSource, ErrorsNameTheFileTheReasonAndTheCure) {
  EXPECT_EQ(why_not(in("missing.mp4")),
            in("missing.mp4") + ": there is no such file; check the name");
  EXPECT_EQ(why_not(text("a.mp4", "no video at all")),
            in("a.mp4") +
                ": is neither a video nor a picture that can be read; make it one with ffmpeg -i " +
                in("a.mp4") + " dance.mp4");
  EXPECT_EQ(why_not(text("b.mp4", "")), in("b.mp4") + ": is empty; fetch it again");
  fs::create_directory(in("empty"));
  EXPECT_EQ(why_not(in("empty")),
            in("empty") +
                ": has no pictures; they are called .jpg, .png, .bmp, .webp, .tif, .pgm or .ppm");
  const std::string good = image("good.png", 0);
  const std::string bad = text("bad.png", "no picture");
  EXPECT_EQ(why_not(good + "," + bad),
            bad + ": is no picture that can be read; make it a .png or .jpg, or leave it out");
  EXPECT_EQ(why_not(good + "," + in("gone.png")),
            in("gone.png") + ": there is no such file; check the name");
  fs::resize_file(good, 50);
  EXPECT_EQ(why_not(good), good + ": is damaged; fetch it again or leave it out");
  EXPECT_NE(why_not("no such camera name").find("no camera is called 'no such camera name'"),
            std::string::npos);
}

TEST_F(FileSource, ARealVideoPlaysWhole) {
  const std::string path = DANCE_SOURCE_DIR "/../shared/data/video/taiji.mp4";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is missing: no real video beside this tree";
  const auto source = opened(path, kFast);
  ASSERT_NE(source, nullptr);
  EXPECT_NEAR(source->format().hz, 23.976, 0.001);
  Frame frame;
  MonoTime start;
  int shown = 0;
  while (source->next(Duration(), frame) == FrameState::kFrame) {
    if (shown++ == 0) start = frame.capture_time;
    ASSERT_EQ(frame.image.rows, 720);
    ASSERT_EQ(frame.image.cols, 1280);
  }
  EXPECT_EQ(shown, 412);
  EXPECT_NEAR((frame.capture_time - start).as_seconds(), 411 / 23.976, 0.01);
  EXPECT_EQ(source->counters().damaged, 0u);
}

}  // namespace
}  // namespace dance
