// What is exported is read again by the readers of its format.
#include "viewer/replay/export/replay_export.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "formats/bvh/bvh.h"
#include "formats/gltf/glb.h"
#include "tests/test_folder.h"
#include "tests/viewer/driver_memory.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/gl/offscreen.h"
#include "viewer/program/view_program.h"
#include "viewer/replay/index_builder.h"
#include "viewer/replay/replay_feed.h"

namespace dance {
namespace {

class ReplayExportTest : public ::testing::Test {
 protected:
  ReplayExportTest() {
    std::filesystem::copy_file(std::string(DANCE_SOURCE_DIR) + "/logs/couple-packed.lcm", log_);
    auto index = build_index(log_, false, {});
    EXPECT_TRUE(index) << index.error().what;
    index_ = std::make_shared<const ReplayIndex>(std::move(*index));
  }

  ExportWish wish(const std::string& name, double from_s, double to_s) {
    ExportWish wish;
    wish.log = log_;
    wish.index = index_;
    wish.from = index_->begin + Duration::seconds(from_s);
    wish.to = index_->begin + Duration::seconds(to_s);
    wish.path = folder_.path() + "/" + name;
    wish.kind = *export_kind(wish.path);
    return wish;
  }
  // A small picture of its own for each moment.
  static Result<Picture> paint(SceneState& scene, Duration) {
    Picture picture;
    picture.width_px = 64;
    picture.height_px = 48;
    picture.rgb.assign(std::size_t{3} * 64 * 48,
                       static_cast<std::uint8_t>(40 * scene.guests.size()));
    return picture;
  }
  static Result<std::string> finish(const ExportWish& wish, ReplayExport::Paint how = paint) {
    auto work = ReplayExport::begin(wish, std::move(how));
    if (!work) return tl::make_unexpected(work.error());
    for (double progress = 0.0;;) {
      const auto stepped = (*work)->step();
      if (!stepped) return tl::make_unexpected(stepped.error());
      EXPECT_GE((*work)->progress(), progress);
      progress = (*work)->progress();
      if (*stepped) return (*work)->outcome();
    }
  }
  std::size_t files_in(const std::string& path) const {
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(path)) ++files;
    return files;
  }

  TestFolder folder_{"replay-export"};
  std::string log_ = folder_.path("couple.lcm");
  std::shared_ptr<const ReplayIndex> index_;
};

TEST_F(ReplayExportTest, ABvhIsReadWithTheFramesOfTheRange) {
  ExportWish one = wish("bob.bvh", 2.0, 4.0);
  one.guest = *GuestId::parse("bob");
  const auto outcome = finish(one);
  ASSERT_TRUE(outcome) << outcome.error().what;
  const auto bvh = read_bvh(text_of(one.path));
  ASSERT_TRUE(bvh) << bvh.error().what;
  EXPECT_NEAR(bvh->frame_hz, 60.0, 0.01);
  EXPECT_NEAR(static_cast<double>(bvh->frame_count), 120.0, 2.0);
  EXPECT_GE(bvh->joints.size(), kBoneCount);
  EXPECT_EQ(*outcome, std::to_string(bvh->frame_count) + " frames of bob");
}

TEST_F(ReplayExportTest, ABvhOfSeveralAsksForOneAndLeavesNothing) {
  const ExportWish all = wish("all.bvh", 2.0, 3.0);
  const auto outcome = finish(all);
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().what.find("--focus"), std::string::npos) << outcome.error().what;
  EXPECT_NE(outcome.error().what.find("alice"), std::string::npos) << outcome.error().what;
  EXPECT_EQ(files_in(folder_.path()), 1u);  // the log
}

TEST_F(ReplayExportTest, AGlbIsReadWithAllDancersWhoStandWhereTheyStood) {
  ExportWish both = wish("couple.glb", 1.0, 3.0);
  both.hz = 30.0;
  ASSERT_TRUE(finish(both));
  const auto clips = read_glb(bytes_in(both.path));
  ASSERT_TRUE(clips) << clips.error().what;
  ASSERT_EQ(clips->size(), 2u);
  for (const NamedClip& named : *clips) {
    EXPECT_NEAR(named.clip.frame_hz, 30.0, 0.1);
    EXPECT_NEAR(static_cast<double>(named.clip.frames.size()), 60.0, 2.0);
  }
  // Against the recording itself, at the range's middle.
  GuestBoard board(index_->clock_id, false);
  StageRoster roster(board);
  auto feed = ReplayFeed::open(log_, index_, board);
  ASSERT_TRUE(feed);
  const MonoTime middle = both.from + Duration::s(1);
  feed->show(middle);
  SceneState scene;
  roster.update(middle, scene);
  for (const SceneGuest& guest : scene.guests) {
    double nearest_m = 1e9;
    for (const NamedClip& named : *clips) {
      if (named.name != guest.id.view()) continue;
      for (std::size_t i = 25; i <= 35; ++i)
        nearest_m =
            std::min(nearest_m,
                     static_cast<double>((named.clip.frames[i].p_WH_m - guest.pose.p_WH_m).norm()));
    }
    EXPECT_LT(nearest_m, 0.02) << guest.id.view();
  }
}

TEST_F(ReplayExportTest, PicturesAreAsManyAsTheRangeHas) {
  ExportWish pictures = wish("pictures/", 1.0, 3.0);
  pictures.hz = 10.0;
  const auto outcome = finish(pictures);
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(*outcome, "20 pictures, 10 a second");
  EXPECT_EQ(files_in(pictures.path), 20u);
  EXPECT_TRUE(std::filesystem::exists(pictures.path + "000001.png"));
  EXPECT_TRUE(std::filesystem::exists(pictures.path + "000020.png"));
}

TEST_F(ReplayExportTest, NothingIsOverwritten) {
  for (const char* name : {"x.glb", "x.bvh", "x.mp4"}) {
    ExportWish again = wish(name, 1.0, 1.5);
    again.guest = *GuestId::parse("bob");
    std::FILE* file = std::fopen(again.path.c_str(), "w");
    ASSERT_NE(file, nullptr);
    std::fputs("mine", file);
    std::fclose(file);
    const auto outcome = finish(again);
    ASSERT_FALSE(outcome) << name;
    EXPECT_NE(outcome.error().what.find("is there already"), std::string::npos)
        << outcome.error().what;
    EXPECT_EQ(text_of(again.path), "mine");
  }
  ExportWish pictures = wish("pictures/", 1.0, 1.2);
  ASSERT_TRUE(finish(pictures));
  EXPECT_FALSE(finish(pictures));
  // Nor where only a later picture of another export is left.
  for (int i = 1; i <= 5; ++i)
    std::filesystem::remove(pictures.path + "00000" + std::to_string(i) + ".png");
  ASSERT_EQ(files_in(pictures.path), 1u);
  EXPECT_FALSE(finish(pictures));
  EXPECT_EQ(files_in(pictures.path), 1u);
}

TEST_F(ReplayExportTest, APictureThatCameMeanwhileIsNeitherOverwrittenNorRemoved) {
  const ExportWish pictures = wish("pictures/", 1.0, 2.0);
  const std::string foreign = pictures.path + "000002.png";
  {
    auto work = ReplayExport::begin(pictures, paint);
    ASSERT_TRUE(work);
    ASSERT_TRUE((*work)->step());
    std::FILE* file = std::fopen(foreign.c_str(), "w");
    ASSERT_NE(file, nullptr);
    std::fputs("mine", file);
    std::fclose(file);
    EXPECT_FALSE((*work)->step());
  }
  EXPECT_EQ(text_of(foreign), "mine");
  EXPECT_EQ(files_in(pictures.path), 1u);
}

TEST_F(ReplayExportTest, WhatIsNotFinishedIsRemoved) {
  for (const char* name : {"half.glb", "half/", "half.mkv"}) {
    const ExportWish half = wish(name, 0.0, 9.0);
    {
      auto work = ReplayExport::begin(half, paint);
      ASSERT_TRUE(work) << work.error().what;
      for (int i = 0; i < 3; ++i) {
        const auto stepped = (*work)->step();
        if (!stepped) break;  // FFmpeg's libraries are not here
        ASSERT_FALSE(*stepped);
      }
    }
    EXPECT_EQ(files_in(folder_.path()), 1u) << name;
  }
}

TEST_F(ReplayExportTest, ARangeOfNothingAndAnUnknownEndingAreRefused) {
  EXPECT_FALSE(finish(wish("x.glb", 2.0, 2.0)));
  const auto kind = export_kind("dance.avi");
  ASSERT_FALSE(kind);
  EXPECT_NE(kind.error().what.find(".bvh"), std::string::npos);
}

// Frames, width and height as another program counts them: "60,64,48"; "" where it is not here.
std::string probe(const std::string& path) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
      path + "' 2>/dev/null";
  std::FILE* said = popen(command.c_str(), "r");
  if (said == nullptr) return "";
  std::array<char, 256> line{};
  if (std::fgets(line.data(), line.size(), said) == nullptr) line[0] = '\0';
  pclose(said);
  std::string text = line.data();
  while (!text.empty() && (text.back() == '\n' || text.back() == ',')) text.pop_back();
  return text;
}

TEST_F(ReplayExportTest, AVideoHasItsPicturesAsFfprobeCountsThem) {
  if (std::system("ffprobe -version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "ffprobe is not installed; apt-get install ffmpeg";
  std::size_t written = 0;
  for (const char* name : {"x.mp4", "x.webm", "x.mkv"}) {
    ExportWish video = wish(name, 1.0, 3.0);
    video.hz = 25.0;
    const auto outcome = finish(video);
    if (!outcome) {
      EXPECT_NE(outcome.error().what.find("cannot write"), std::string::npos)
          << outcome.error().what;
      continue;
    }
    ++written;
    EXPECT_EQ(probe(video.path), "64,48,25/1,50") << name;
  }
  if (written == 0) GTEST_SKIP() << "this build writes no video";
}

TEST_F(ReplayExportTest, TheProgramDrawsTheStageOfEachMoment) {
  if (const auto context = OffscreenContext::create(); !context)
    GTEST_SKIP() << context.error().what;
  else
    keep_drivers_loaded();
  ViewOptions options;
  options.log = log_;
  options.headless = true;
  options.export_to = folder_.path() + "/stage/";
  options.export_from_s = 2.0;
  options.export_until_s = 2.3;
  options.export_hz = 10.0;
  options.size = {160, 90};
  options.quality = QualityWish::kLow;
  const auto done = run_export(options);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(files_in(options.export_to), 3u);
  // They dance: no picture is as the one before.
  EXPECT_NE(bytes_in(options.export_to + "000001.png"), bytes_in(options.export_to + "000002.png"));
  EXPECT_NE(bytes_in(options.export_to + "000002.png"), bytes_in(options.export_to + "000003.png"));
}

}  // namespace
}  // namespace dance
