// Videos and images as frame sources.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/net/mono_clock.h"
#include "producers/camera/files/image_reel.h"
#include "producers/camera/files/open_frame_source.h"
#include "tests/producers/camera/files/written_pictures.h"
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
    write_video(in(name), hz, pictures, {kFileWidth_px, kFileHeight_px}, [](int i) {
      return drawn_grey(kFileWidth_px, kFileHeight_px, level_of_picture(i));
    });
    return in(name);
  }
  std::string image(const std::string& name, int number) const {
    std::string path = in(name);
    const cv::Mat grey = drawn_grey(kFileWidth_px, kFileHeight_px, level_of_picture(number));
    write_picture(path, grey);
    return path;
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

class VideoSource : public FileSource {
 protected:
  void SetUp() override {
    FileSource::SetUp();
    SKIP_WITHOUT_MEDIA();
  }
};

TEST_F(VideoSource, AVideoAsFastAsPossibleGivesEveryPictureWithItsTime) {
  const auto source = opened(video("a.mkv", 25.0), kFast);
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, kFileWidth_px);
  EXPECT_EQ(source->format().height_px, kFileHeight_px);
  EXPECT_EQ(source->format().hz, 25.0);
  EXPECT_EQ(source->format().encoding, "mjpeg");
  EXPECT_EQ(source->name(), "a.mkv");
  EXPECT_EQ(line_on(*source), "a.mkv: 64x48 mjpeg at 25 Hz");
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

TEST_F(VideoSource, InRealTimeASlowReaderGetsTheNewest) {
  const auto source = opened(video("a.mkv", 100.0), {});
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

TEST_F(VideoSource, InRealTimeAPictureIsNotEarlyAndWaitingEnds) {
  const auto source = opened(video("a.mkv", 0.01, 2), {});
  ASSERT_NE(source, nullptr);
  Frame frame;
  ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
  EXPECT_EQ(source->next(Duration::ms(1), frame), FrameState::kNone);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
}

TEST_F(VideoSource, ALoopGoesOnInTimeAndCount) {
  PlayOptions play = kFast;
  play.loops = true;
  const auto source = opened(video("a.mkv", 25.0), play);
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

TEST_F(VideoSource, ALoopInRealTimeKeepsItsPace) {
  PlayOptions play;
  play.loops = true;
  const auto source = opened(video("a.mkv", 500.0), play);
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

TEST_F(VideoSource, AVideoThatIsCutOffSaysSo) {
  const std::string whole = video("a.mkv", 25.0, 2 * kFilePictures);
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
  EXPECT_EQ(why_not(text("b.mp4", "")), in("b.mp4") + ": is empty; fetch it again");
  fs::create_directory(in("empty"));
  EXPECT_EQ(why_not(in("empty")),
            in("empty") + ": has no pictures; they are called .jpg, .png or .webp");
  const std::string good = image("good.png", 0);
  const std::string bad = text("bad.png", "no picture");
  EXPECT_EQ(why_not(good + "," + bad),
            bad + ": is no picture that can be read; make it a .png or .jpg, or leave it out");
  EXPECT_EQ(why_not(good + "," + in("gone.png")),
            in("gone.png") + ": there is no such file; check the name");
  fs::resize_file(good, 50);
  const std::string damaged = why_not(good);
  EXPECT_TRUE(damaged.starts_with(good + ": a PNG that cannot be read: ")) << damaged;
  EXPECT_TRUE(damaged.ends_with("; fetch it again or leave it out")) << damaged;
  EXPECT_EQ(why_not(text("old.tif", "II*") + "," + good),
            in("old.tif") +
                ": is no picture that can be read; make it a .png or .jpg, or leave it "
                "out");
  EXPECT_NE(why_not("no such camera name").find("no camera is called 'no such camera name'"),
            std::string::npos);
}

TEST_F(VideoSource, WhatIsNoVideoIsRefused) {
  const std::string none = why_not(text("a.mp4", "no video at all"));
  EXPECT_TRUE(none.starts_with(
      in("a.mp4") + ": is no picture that can be read; as a video: no video that can be read ("))
      << none;
  EXPECT_TRUE(none.ends_with("; copy it again, or convert it to .mp4")) << none;
  // A playlist of other files, and a film without pictures.
  text("list.m3u8", "#EXTM3U\n#EXTINF:1,\n" + video("a.mkv", 25.0) + "\n");
  EXPECT_NE(why_not(in("list.m3u8")).find("no video that can be read"), std::string::npos);
  const std::string cut = video("b.mkv", 25.0);
  fs::resize_file(cut, 600);
  EXPECT_NE(why_not(cut).find(cut), std::string::npos);
}

// What lies in the middle of the left, upper, right and lower quarter.
std::array<int, 4> levels_around(const cv::Mat& picture) {
  const auto at = [&](double x, double y) {
    return picture.at<cv::Vec3b>(static_cast<int>(y * picture.rows),
                                 static_cast<int>(x * picture.cols))[1] /
           64;
  };
  return {at(0.125, 0.5), at(0.5, 0.125), at(0.875, 0.5), at(0.5, 0.875)};
}

// Bright at the left, dark at the right, the rest between.
cv::Mat lying_picture() {
  cv::Mat picture(kFileHeight_px, kFileWidth_px, CV_8UC3, cv::Scalar::all(100));
  picture.colRange(0, kFileWidth_px / 4).setTo(cv::Scalar::all(230));
  picture.colRange(kFileWidth_px * 3 / 4, kFileWidth_px).setTo(cv::Scalar::all(20));
  return picture;
}

TEST_F(VideoSource, IsTurnedAsItsTelephoneWasHeld) {
  write_video(in("lying.mkv"), 25.0, 2, {kFileWidth_px, kFileHeight_px},
              [](int) { return lying_picture(); });
  // A quarter to the right: as an option since FFmpeg 6, as a tag until then.
  const std::string turn =
      "cd '" + folder_.string() +
      "' && { ffmpeg -nostdin -v fatal -display_rotation -90 -i lying.mkv -c copy turned.mp4 || "
      "ffmpeg -nostdin -v error -i lying.mkv -c copy -metadata:s:v:0 rotate=90 turned.mp4; } && "
      "ffmpeg -nostdin -v error -i turned.mp4 -frames:v 1 upright.png";
  if (std::system(turn.c_str()) != 0)
    GTEST_SKIP() << "no ffmpeg program, which makes the film; apt-get install ffmpeg";
  const auto upright = read_bgr_picture(in("upright.png"));
  ASSERT_TRUE(upright) << upright.error().what;
  EXPECT_EQ(levels_around(lying_picture()), (std::array<int, 4>{3, 1, 0, 1}));
  ASSERT_NE(levels_around(*upright), levels_around(lying_picture()));
  const auto source = opened(in("turned.mp4"), kFast);
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, kFileHeight_px);
  EXPECT_EQ(source->format().height_px, kFileWidth_px);
  Frame frame;
  ASSERT_EQ(source->next(Duration(), frame), FrameState::kFrame);
  ASSERT_EQ(frame.image.size(), upright->size());
  EXPECT_EQ(levels_around(frame.image), levels_around(*upright)) << "as ffmpeg turns it";
}

TEST_F(FileSource, APhotographStandsAsItsCameraWasHeld) {
  const auto jpeg = jpeg_of_bgr(lying_picture());
  ASSERT_TRUE(jpeg);
  const std::string whole(jpeg->begin(), jpeg->end());
  // Left, upper, right and lower side as they are seen, by the orientation that is noted.
  const std::array<std::array<int, 4>, 8> seen{{{3, 1, 0, 1},
                                                {0, 1, 3, 1},
                                                {0, 1, 3, 1},
                                                {3, 1, 0, 1},
                                                {1, 3, 1, 0},
                                                {1, 3, 1, 0},
                                                {1, 0, 1, 3},
                                                {1, 0, 1, 3}}};
  for (char noted = 1; noted <= 8; ++noted) {
    // A segment of 34 bytes: Exif's head, and a directory of one entry.
    std::string note("\xff\xe1\0\x22", 4);
    note += std::string("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 24);
    note += noted;
    note += std::string(7, '\0');
    const std::string path = text("held.jpg", whole.substr(0, 2) + note + whole.substr(2));
    const auto picture = read_bgr_picture(path);
    ASSERT_TRUE(picture) << picture.error().what;
    EXPECT_EQ(levels_around(*picture), seen[static_cast<std::size_t>(noted - 1)])
        << static_cast<int>(noted);
  }
}

TEST_F(VideoSource, ARealVideoPlaysWhole) {
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
