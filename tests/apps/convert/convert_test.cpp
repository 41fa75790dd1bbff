// dance-convert as a user runs it: from any format to any other and back.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/kind/file_kind.h"
#include "formats/recording/log_sink.h"
#include "formats/recording/log_source.h"
#include "formats/recording/steady_clip.h"
#include "tests/apps/run_program.h"
#include "tests/formats/recording/recorded_night.h"

namespace dance {
namespace {

const std::string kCouple = DANCE_SOURCE_DIR "/logs/couple-packed.lcm";
const std::string kForeignBvh = "/usr/share/assimp/models/BVH/01_01.bvh";
constexpr float kTenthOfAMillimetre_m = 1e-4f;

Recording log_at(const std::string& path) {
  Recording night;
  auto source = LogSource::open(path);
  EXPECT_TRUE(source.has_value()) << source.error().what;
  if (source) {
    EXPECT_TRUE(source->read_into(night).has_value());
  }
  return night;
}

// A guest of a log on the grid of a clip, as bvh and glb have it.
MotionClip clip_of(const Recording& night, const GuestId& guest) {
  SteadyClip clip(60.0);
  const RecordedGuest* of = night.find(guest);
  EXPECT_NE(of, nullptr);
  clip.set_skeleton(of->skeleton());
  for (const auto& pose : of->poses) clip.add(pose.value);
  for (const auto& hands : of->hands) clip.add(hands.value);
  return clip.with_hands();
}

void expect_clip_in_log(const MotionClip& clip, const Recording& read, const GuestId& guest) {
  const RecordedGuest* of = read.find(guest);
  ASSERT_NE(of, nullptr);
  ASSERT_EQ(of->poses.size(), clip.frames.size());
  for (std::size_t i = 0; i < clip.frames.size(); ++i)
    ASSERT_LT(largest_distance_m(clip.skeleton, clip.frames[i], of->skeleton(), of->poses[i].value),
              kTenthOfAMillimetre_m)
        << guest.view() << " frame " << i;
}

class Convert : public testing::Test {
 protected:
  Finished convert(const std::string& from, const std::string& to, const std::string& more = "") {
    return run(bin("dance-convert") + " " + from + " " + to + " " + more);
  }
  nlohmann::json report_of(const Finished& finished) {
    EXPECT_EQ(finished.exit_code, 0) << finished.talk;
    return nlohmann::json::parse(finished.output, nullptr, false);
  }
  // There and back, and what is then in the log.
  Recording there_and_back(const std::string& end, const std::string& more = "") {
    const std::string there = folder_.path("there" + end),
                      back = folder_.path("back" + end + ".lcm");
    EXPECT_EQ(convert(kCouple, there, more).exit_code, 0);
    EXPECT_EQ(convert(there, back, more).exit_code, 0);
    EXPECT_TRUE(is_private(there)) << there;
    EXPECT_TRUE(is_private(back)) << back;
    return log_at(back);
  }
  TestFolder folder_{"convert"};
};

TEST_F(Convert, ReportsFramesGuestsAndSecondsAsJson) {
  const nlohmann::json report = report_of(convert(kCouple, folder_.path("couple.mcap"), "--json"));
  EXPECT_EQ(report["frames"], 1280);
  EXPECT_EQ(report["guests"], 2);
  EXPECT_NEAR(report["seconds"].get<double>(), 10.65, 0.01);
  EXPECT_EQ(report["out"], folder_.path("couple.mcap"));
}

TEST_F(Convert, ThroughMcapAndTablesAndBackKeepsEveryPoseAndItsTime) {
  const Recording couple = log_at(kCouple);
  for (const char* end : {".mcap", ".csv", ".lcm"}) {
    SCOPED_TRACE(end);
    expect_same_poses(couple, there_and_back(end));
  }
  expect_same_hands_and_beats(couple, log_at(folder_.path("back.mcap.lcm")));
}

TEST_F(Convert, ThroughGlbAndBackKeepsEveryJointAndFinger) {
  const Recording couple = log_at(kCouple);
  const Recording read = there_and_back(".glb");
  ASSERT_EQ(read.guests().size(), 2u);
  for (const GuestId& guest : {kAlice, kBob}) {
    const MotionClip clip = clip_of(couple, guest);
    expect_clip_in_log(clip, read, guest);
    const RecordedGuest* of = read.find(guest);
    ASSERT_EQ(of->hands.size(), clip.hands.size());
    for (std::size_t i = 0; i < clip.hands.size(); i += 17)
      for (std::size_t b = 0; b < kFingerBoneCount; ++b)
        EXPECT_TRUE(is_same_rotation(of->hands[i].value.R_PB[b], clip.hands[i].R_PB[b]));
  }
}

TEST_F(Convert, ThroughBvhAndBackKeepsEveryJointOfTheChosenGuest) {
  const Recording couple = log_at(kCouple);
  const Recording read = there_and_back(".bvh", "--guest alice");
  ASSERT_EQ(read.guests().size(), 1u);
  expect_clip_in_log(clip_of(couple, kAlice), read, kAlice);
}

TEST_F(Convert, ForeignBvhGoesThroughEveryFormat) {
  if (!std::filesystem::exists(kForeignBvh)) GTEST_SKIP() << "apt-get install assimp-testmodels";
  const std::string first = folder_.path("first.lcm");
  ASSERT_EQ(convert(kForeignBvh, first).exit_code, 0);
  const Recording night = log_at(first);
  const GuestId guest = GuestId::parse("01-01").value();  // by the file's name
  ASSERT_NE(night.find(guest), nullptr);
  SteadyClip steady(120.0);
  steady.set_skeleton(night.find(guest)->skeleton());
  for (const auto& pose : night.find(guest)->poses) steady.add(pose.value);
  for (const char* end : {".mcap", ".csv", ".glb", ".bvh"}) {
    SCOPED_TRACE(end);
    const std::string there = folder_.path("there" + std::string(end));
    const std::string back = folder_.path("back" + std::string(end) + ".lcm");
    const bool is_clip = std::string(end) == ".glb" || std::string(end) == ".bvh";
    ASSERT_EQ(convert(kForeignBvh, there, is_clip ? "--hz 120" : "").exit_code, 0);
    ASSERT_EQ(convert(there, back, "--guest 01-01").exit_code, 0);
    const Recording read = log_at(back);
    if (is_clip)
      expect_clip_in_log(steady.body(), read, guest);
    else
      for (std::size_t i = 0; i < night.find(guest)->poses.size(); ++i)
        ASSERT_LT(
            largest_distance_m(night.find(guest)->skeleton(), night.find(guest)->poses[i].value,
                               read.find(guest)->skeleton(), read.find(guest)->poses[i].value),
            kTenthOfAMillimetre_m);
  }
}

TEST_F(Convert, ThinsTablesAndResamplesClips) {
  EXPECT_NEAR(report_of(convert(kCouple, folder_.path("a.csv"), "--hz 10 --json"))["frames"], 214,
              4);
  EXPECT_NEAR(report_of(convert(kCouple, folder_.path("a.glb"), "--hz 30 --json"))["frames"], 640,
              4);
}

TEST_F(Convert, NamesTheGuestsThatABvhCannotHoldAndLeavesNoFile) {
  const Finished finished = convert(kCouple, folder_.path("couple.bvh"));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("bob, alice; choose with --guest"), std::string::npos)
      << finished.talk;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Convert, OverwritesNothing) {
  const std::string out = folder_.path("kept.mcap");
  std::ofstream(out) << "a year of dancing";
  const Finished finished = convert(kCouple, out);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("is there already"), std::string::npos);
  EXPECT_EQ(text_of(out), "a year of dancing");
}

TEST_F(Convert, LeavesThePartFilesOfOthersAlone) {
  for (const char* end : {".lcm", ".mcap", ".csv", ".glb", ".bvh"}) {
    const std::string out = folder_.path("couple" + std::string(end));
    std::ofstream(out + ".part") << "being written";
    const Finished finished = convert(kCouple, out, "--guest alice");
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.talk.find(".part: is there already"), std::string::npos) << finished.talk;
    EXPECT_EQ(text_of(out + ".part"), "being written");
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST_F(Convert, GuestsBeyondABoundAreSaidAndExitWithOneAsDamageDoes) {
  // A log of 64 guests, and one of two more behind it: an MCAP file has places for 64.
  const std::string many = folder_.path("many.lcm");
  std::string all;
  for (const int first : {0, 64}) {
    const std::string part = folder_.path("part" + std::to_string(first) + ".lcm");
    LogSink log(LogWriter::create(part).value(), Where::kStage);
    for (int i = first; i < std::min(first + 64, 66); ++i)
      log.on_pose(GuestId::parse("g" + std::to_string(i)).value(), Pose(), kNight_us);
    ASSERT_TRUE(log.finish().has_value());
    all += text_of(part);
  }
  std::ofstream(many, std::ios::binary) << all;
  const Finished finished = convert(many, folder_.path("many.mcap"), "--json");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("left out: 2 messages of too many guests"), std::string::npos)
      << finished.talk;
  EXPECT_EQ(nlohmann::json::parse(finished.output)["frames"], 64);
  EXPECT_TRUE(std::filesystem::exists(folder_.path("many.mcap")));
}

TEST_F(Convert, SaysWhatIsWrongAndTheCure) {
  const auto talk = [&](const std::string& from, const std::string& to,
                        const std::string& more = "") {
    const Finished finished = convert(from, folder_.path(to), more);
    EXPECT_EQ(finished.exit_code, 1) << finished.talk;
    EXPECT_FALSE(std::filesystem::exists(folder_.path(to)));
    return finished.talk;
  };
  EXPECT_NE(talk(kCouple, "x.mp3").find("what can be written: .lcm .bvh .glb .mcap .csv"),
            std::string::npos);
  EXPECT_NE(talk(kCouple, "x.csv", "--guest eve").find("there are bob, alice"), std::string::npos);
  EXPECT_NE(talk("/no/such.mcap", "x.csv").find("/no/such.mcap"), std::string::npos);
  EXPECT_NE(talk(kCouple, "x.csv", "--where stage").find("POSE/stage"), std::string::npos);
  EXPECT_NE(talk(DANCE_SOURCE_DIR "/README.md", "x.csv").find("that can be read: .lcm"),
            std::string::npos);
  EXPECT_EQ(convert(kCouple, folder_.path("x.csv"), "--hz -1").exit_code, 2);
}

TEST_F(Convert, KeepsWhatIsWholeOfADamagedFileAndExitsWithOne) {
  const std::string mcap = folder_.path("night.mcap");
  ASSERT_EQ(convert(kCouple, mcap).exit_code, 0);
  std::vector<std::uint8_t> bytes = bytes_in(mcap);
  bytes[bytes.size() / 8] ^= 0x10;  // within the first of its chunks
  const std::string damaged = folder_.path("damaged.mcap");
  std::ofstream(damaged, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  const Finished finished = convert(damaged, folder_.path("rest.lcm"), "--json");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.talk.find("1 damaged chunks"), std::string::npos) << finished.talk;
  const nlohmann::json report = nlohmann::json::parse(finished.output, nullptr, false);
  EXPECT_GT(report["frames"].get<int>(), 100);
  EXPECT_LT(report["frames"].get<int>(), 1280);
}

const std::string kClip = DANCE_SOURCE_DIR "/tests/formats/bvh/data/vrm.bvh";  // 3 frames

TEST_F(Convert, KeepsTheWholeFramesOfACutClipAndExitsWithOne) {
  const std::string text = text_of(kClip);
  const std::string cut = folder_.path("cut.bvh"), packed = folder_.path("whole.bvh.xz");
  std::ofstream(cut, std::ios::binary) << text.substr(0, text.size() - 40);
  Finished finished = convert(cut, folder_.path("cut.lcm"), "--json");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(finished.output, nullptr, false)["frames"], 2);
  EXPECT_NE(finished.talk.find("the file ends in frame 3 of 3; it was cut short"),
            std::string::npos)
      << finished.talk;

  ASSERT_EQ(run("xz -zc " + kClip + " > " + packed).exit_code, 0);
  std::filesystem::resize_file(packed, std::filesystem::file_size(packed) - 9);
  finished = convert(packed, folder_.path("packed.lcm"), "--json");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(finished.output, nullptr, false)["frames"], 3);
  EXPECT_NE(finished.talk.find("the xz file is cut short; copy it again"), std::string::npos)
      << finished.talk;
}

TEST_F(Convert, UsesTheGivenUnitAndAxis) {
  const auto height_m = [&](const std::string& more) {
    const std::string to = folder_.path("height.lcm");
    std::filesystem::remove(to);
    const Finished finished = convert(kClip, to, "--guest alice " + more);
    EXPECT_EQ(finished.exit_code, 0) << finished.talk;
    return standing_height_m(log_at(to).find(kAlice)->skeleton());
  };
  const float as_it_is_m = height_m("");
  EXPECT_NEAR(as_it_is_m, 1.72f, 0.2f);
  EXPECT_NEAR(height_m("--unit dm"), 0.1f * as_it_is_m, 0.02f);
  EXPECT_NEAR(height_m("--unit m --up y"), as_it_is_m, 0.01f);
}

TEST_F(Convert, TheViewerShowsAClipAsItIs) {
  if (!std::filesystem::exists(bin("dance-view"))) GTEST_SKIP() << "the viewer is not built";
  const Finished viewed =
      run("ASAN_OPTIONS=detect_leaks=0 " + bin("dance-view") + " " + kClip +
          " --headless --quality low --size 160x90 --at 0 --out " + folder_.path("clip"));
  if (viewed.talk.find("EGL") != std::string::npos) GTEST_SKIP() << viewed.talk;
  EXPECT_EQ(viewed.exit_code, 0) << viewed.talk;
  EXPECT_TRUE(std::filesystem::exists(folder_.path("clip/stage-0001.png"))) << viewed.talk;
}

TEST_F(Convert, WritesALogThatTheViewerShows) {
  if (!std::filesystem::exists(bin("dance-view"))) GTEST_SKIP() << "the viewer is not built";
  for (const char* end : {".csv", ".glb"}) there_and_back(end);
  for (const char* log : {"back.csv.lcm", "back.glb.lcm"}) {
    const std::string out = folder_.path(std::string(log) + "-pictures");
    const Finished viewed = run(bin("dance-view") + " --headless --log " + folder_.path(log) +
                                " --every 4 --out " + out);
    if (viewed.talk.find("EGL") != std::string::npos) GTEST_SKIP() << viewed.talk;
    EXPECT_EQ(viewed.exit_code, 0) << viewed.talk;
    std::size_t pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out))
      pictures += entry.path().extension() == ".png" && entry.file_size() > 10'000;
    EXPECT_GE(pictures, 2u) << viewed.talk;
  }
}

TEST(FileKind, MakesGuestIdsOfFileNames) {
  EXPECT_EQ(guest_name_of("/a/Dance 7.bvh.xz"), "dance-7");
  EXPECT_EQ(guest_name_of("María_José--solo.BVH"), "mar-a-jos-solo");
  EXPECT_EQ(guest_name_of("...bvh"), "dancer");
  EXPECT_EQ(guest_name_of(std::string(60, 'x') + ".glb"), std::string(24, 'x'));
}

}  // namespace
}  // namespace dance
