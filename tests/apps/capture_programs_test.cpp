// dance capture as a user runs it: a person in a video and before a preloaded camera, unplugging,
// recording, a house that starts it.
#include <signal.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "core/pose/skeleton.h"
#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"
#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

const std::string kVideo = DANCE_SOURCE_DIR "/../shared/data/video/taiji.mp4";

// All of one guest's captures.
class CaptureEar {
 public:
  explicit CaptureEar(Where where = Where::kCapture) {
    auto bus = Bus::open(kBus);
    EXPECT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime now) {
      guests.emplace(channel.guest().view());
      if (skeletons == 0) ++before_skeleton;
      poses.push_back(pose);
      last = now;
    });
    bus_->subscribe<TimedSkeleton>(where,
                                   [this](const Channel&, const TimedSkeleton& said, MonoTime) {
                                     ++skeletons;
                                     skeleton = said.skeleton;
                                   });
  }
  void work() { bus_->drain(mono_now()); }
  bool has_more_than(std::size_t n) {
    work();
    return poses.size() > n;
  }

  std::set<std::string> guests;
  std::vector<Pose> poses;
  int skeletons = 0;
  int before_skeleton = 0;
  Skeleton skeleton;
  MonoTime last;

 private:
  std::unique_ptr<Bus> bus_;
};

class CapturePrograms : public BusPrograms {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(DANCE_SOURCE_DIR "/models/pose/pose_landmark_lite.tflite"))
      GTEST_SKIP() << "the pose network is not here; ./dance setup fetches it";
    SKIP_WITHOUT_MEDIA();
    if (!std::filesystem::exists(kVideo)) GTEST_SKIP() << "there is no " << kVideo;
  }
  std::string talk() { return text_of(folder_.path("talk")); }
  // A raw film of some pictures of the video, small enough for a slow machine. With `is_twice` the
  // person stands there a second time on the right, turned round and in other colours.
  std::string raw_film(int pictures, bool is_twice = false) {
    VideoPictures video(kVideo);
    std::ofstream file(folder_.path("film.yuyv"), std::ios::binary);
    cv::Mat picture;
    cv::Mat small;
    for (int i = 0; i < pictures && video.next(picture); ++i) {
      cv::resize(picture, small, {640, 360}, 0, 0, cv::INTER_AREA);
      if (is_twice) {
        const cv::Mat left = small(cv::Rect(160, 0, 320, 360)).clone();
        cv::Mat right;
        cv::flip(left, right, 1);
        cv::cvtColor(right, right, cv::COLOR_BGR2RGB);
        left.copyTo(small(cv::Rect(0, 0, 320, 360)));
        right.copyTo(small(cv::Rect(320, 0, 320, 360)));
      }
      cv::Mat yuv;
      cv::cvtColor(small, yuv, cv::COLOR_BGR2YUV);
      std::vector<char> row(1280);
      for (int y = 0; y < 360; ++y) {
        const cv::Vec3b* in = yuv.ptr<cv::Vec3b>(y);
        for (int x = 0; x < 640; x += 2) {
          row[2 * x] = static_cast<char>(in[x][0]);
          row[2 * x + 1] = static_cast<char>(in[x][1]);
          row[2 * x + 2] = static_cast<char>(in[x + 1][0]);
          row[2 * x + 3] = static_cast<char>(in[x][2]);
        }
        file.write(row.data(), static_cast<std::streamsize>(row.size()));
      }
    }
    return folder_.path("film.yuyv");
  }
  ChildProcess& start_before_shim(const std::string& words, std::vector<std::string> arguments) {
    std::vector<std::string> line{"LD_PRELOAD=" DANCE_BINARY_DIR "/tests/libdance_video_shim.so",
                                  "DANCE_VIDEO_SHIM=" + words, bin("dance-capture")};
    line.insert(line.end(), arguments.begin(), arguments.end());
    return start("/usr/bin/env", line);
  }
};

void expect_good_dance(const CaptureEar& ear) {
  for (std::size_t i = 0; i < ear.poses.size(); ++i) {
    EXPECT_TRUE(is_valid(ear.poses[i])) << i;
    if (i == 0) continue;
    EXPECT_LT(ear.poses[i - 1].capture_time, ear.poses[i].capture_time) << i;
  }
  EXPECT_EQ(ear.before_skeleton, 0) << "proportions come before the first pose";
  EXPECT_TRUE(is_valid(ear.skeleton));
}

TEST_F(CapturePrograms, TurnAVideoIntoADanceOnTheBus) {
  CaptureEar ear;
  const std::string json = folder_.path("output");
  ChildProcess& capture =
      start("dance-capture", {kVideo, "--loop", "--model", "lite", "--guest", "mei", "--height",
                              "1.75", "--bus", kBus, "--json"});
  ASSERT_TRUE(wait_for([&] { return ear.has_more_than(40); })) << talk();
  capture.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return capture.has_ended(); }));
  EXPECT_TRUE(capture.ended_well()) << capture.exit_text() << talk();
  EXPECT_EQ(ear.guests, std::set<std::string>{"mei"});
  expect_good_dance(ear);
  EXPECT_NEAR(standing_height_m(ear.skeleton), 1.75, 0.08);
  const auto counted = nlohmann::json::parse(text_of(json), nullptr, false);
  ASSERT_FALSE(counted.is_discarded()) << text_of(json);
  EXPECT_GE(counted["poses"].get<int>(), 40);
  EXPECT_GE(counted["pictures"].get<int>(), counted["poses"].get<int>());
  EXPECT_NE(talk().find("seen from head to feet"), std::string::npos) << talk();
}

TEST_F(CapturePrograms, WaitForACameraThatWasUnplugged) {
  CaptureEar ear;
  start_before_shim("modes=YUYV:640x360@30 hz=30 unplug=20 replug_ms=300 file=" + raw_film(60),
                    {"42", "--model", "lite", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] {
    return talk().find("is gone; plug it in again") != std::string::npos;
  })) << talk();
  ear.work();
  const std::size_t before = ear.poses.size();
  ASSERT_TRUE(wait_for([&] { return talk().find("is back") != std::string::npos; })) << talk();
  EXPECT_TRUE(wait_for([&] { return ear.has_more_than(before + 10); })) << talk();
  expect_good_dance(ear);
}

TEST_F(CapturePrograms, SeeTwoDancersBeforeOneCamera) {
  CaptureEar ear;
  const std::string json = folder_.path("output");
  ChildProcess& capture =
      start_before_shim("modes=YUYV:640x360@30 hz=30 file=" + raw_film(60, true),
                        {"42", "--guest", "ann,ben", "--height", "1.6,1.8", "--model", "lite",
                         "--hands", "off", "--bus", kBus, "--json"});
  ASSERT_TRUE(wait_for([&] { return ear.has_more_than(0) && ear.guests.size() == 2; })) << talk();
  const std::size_t before = ear.poses.size();
  ASSERT_TRUE(wait_for([&] { return ear.has_more_than(before + 50); })) << talk();
  capture.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return capture.has_ended(); }));
  EXPECT_TRUE(capture.ended_well()) << capture.exit_text() << talk();
  EXPECT_EQ(ear.guests, (std::set<std::string>{"ann", "ben"}));
  EXPECT_EQ(ear.before_skeleton, 0);
  for (const Pose& pose : ear.poses) EXPECT_TRUE(is_valid(pose));
  const auto counted = nlohmann::json::parse(text_of(json), nullptr, false);
  ASSERT_FALSE(counted.is_discarded()) << text_of(json);
  ASSERT_EQ(counted["dancers"].size(), 2u);
  for (const auto& dancer : counted["dancers"]) {
    EXPECT_GE(dancer["poses"].get<int>(), 10) << text_of(json);
    EXPECT_NEAR(dancer["standing_height_m"].get<double>(), dancer["guest"] == "ann" ? 1.6 : 1.8,
                0.08);
  }
}

TEST_F(CapturePrograms, SayWhatDoesNotFitSeveralDancers) {
  for (const auto& [words, cure] : {std::pair{"--guest ann,ann", "names ann twice"},
                                    {"--guest a,b,c,d,e", "1 to 4 dancers"},
                                    {"--guest ann,ben --height 1.7", "one for each dancer"},
                                    {"--guest ann,ben --follow largest", "--follow chooses one"},
                                    {"--guest ann,ben --also 3", "seen by one camera"}}) {
    const Finished refused = run(bin("dance-capture") + " " + kVideo + " " + words +
                                 " --model lite --bus " + quoted(kBus));
    EXPECT_EQ(refused.exit_code, 1) << words;
    EXPECT_NE(refused.talk.find(cure), std::string::npos) << words << ": " << refused.talk;
  }
}

// Both see the same film from one place: there is nothing to place, and all else runs.
TEST_F(CapturePrograms, LookThroughASecondCameraBesideTheFirst) {
  CaptureEar ear;
  const std::string json = folder_.path("output");
  ChildProcess& capture = start_before_shim(
      "modes=YUYV:640x360@30 hz=30 file=" + raw_film(60),
      {"42", "--also", kVideo, "--loop", "--model", "lite", "--bus", kBus, "--json"});
  ASSERT_TRUE(wait_for([&] {
    return talk().find("taiji.mp4 is being placed: move about") != std::string::npos;
  })) << talk();
  ASSERT_TRUE(wait_for([&] { return ear.has_more_than(20); })) << talk();
  capture.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return capture.has_ended(); }));
  EXPECT_TRUE(capture.ended_well()) << capture.exit_text() << talk();
  expect_good_dance(ear);
  const auto counted = nlohmann::json::parse(text_of(json), nullptr, false);
  ASSERT_FALSE(counted.is_discarded()) << text_of(json);
  ASSERT_EQ(counted["also"].size(), 1u);
  EXPECT_EQ(counted["also"][0]["source"], "taiji.mp4");
  EXPECT_GE(counted["also"][0]["seen"].get<int>(), 5);
  EXPECT_FALSE(counted["also"][0]["placed"].get<bool>());
}

TEST_F(CapturePrograms, TakeThreeCamerasBesideTheFirstAtMost) {
  ChildProcess& capture =
      start("dance-capture", {kVideo, "--also", kVideo, "--also", kVideo, "--also", kVideo,
                              "--also", kVideo, "--model", "lite", "--bus", kBus});
  ASSERT_TRUE(wait_for([&] { return capture.has_ended(); }));
  EXPECT_FALSE(capture.ended_well());
  EXPECT_NE(talk().find("--also: 3 cameras beside the first are the most"), std::string::npos)
      << talk();
}

TEST_F(CapturePrograms, KeepVideoBesidePoses) {
  const std::string folder = folder_.path("take");
  {
    CaptureEar ear;
    ChildProcess& capture = start(
        "dance-capture", {kVideo, "--loop", "--model", "lite", "--bus", kBus, "--record", folder});
    ASSERT_TRUE(wait_for([&] { return ear.has_more_than(15); })) << talk();
    capture.ask_to_stop();
    ASSERT_TRUE(wait_for([&] { return capture.has_ended(); }));
  }
  for (const char* part : {"", "/video.mkv", "/poses.lcm"})
    EXPECT_TRUE(is_private(folder + part)) << part;
  VideoPictures video(folder + "/video.mkv");
  ASSERT_TRUE(video.is_open());
  int pictures = 0;
  for (cv::Mat picture; video.next(picture);) ++pictures;
  EXPECT_GT(pictures, 5) << talk();
  CaptureEar again;
  start("dance-replay", {folder + "/poses.lcm", "--bus", kBus});
  EXPECT_TRUE(wait_for([&] { return again.has_more_than(10); })) << talk();
  const Finished twice =
      run(bin("dance-capture") + " " + kVideo + " --bus " + quoted(kBus) + " --record " + folder);
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.talk.find("name another folder"), std::string::npos) << twice.talk;
}

// The capture that a house has started, found as its child.
pid_t child_of(pid_t parent, const std::string& name) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string pid = entry.path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string stat = text_of(entry.path() / "stat");
    if (stat.find("(" + name) == std::string::npos) continue;
    const std::size_t after = stat.rfind(')');
    if (after == std::string::npos || stat.size() < after + 5) continue;
    if (std::atoi(stat.c_str() + after + 4) == parent) return std::atoi(pid.c_str());
  }
  return 0;
}

TEST_F(CapturePrograms, AreStartedByTheHouseAndAgainWhenTheyDie) {
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguest = \"mei\"\n"
      << "[[produce]]\nkind = \"camera\"\nguest = \"mei\"\nmodel = \"lite\"\ndevice = \"" << kVideo
      << "\"\n"
      << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
  CaptureEar stage(Where::kStage);
  ChildProcess& house = start("dance-join", {folder_.path("house.toml"), "--no-view"});
  ASSERT_TRUE(wait_for([&] { return stage.has_more_than(5); })) << talk();
  const pid_t capture = child_of(house.pid(), "dance-capture");
  ASSERT_TRUE(send_signal(capture, SIGKILL));
  ASSERT_TRUE(wait_for([&] { return talk().find("it is started again") != std::string::npos; }))
      << talk();
  stage.work();
  const std::size_t before = stage.poses.size();
  EXPECT_TRUE(wait_for([&] { return stage.has_more_than(before + 5); })) << talk();
}

TEST(CaptureWords, SayWhatIsWrongAndTheCure) {
  const auto refused = [&](const std::string& arguments) {
    const Finished it = run(bin("dance-capture") + " " + arguments + " --bus " + quoted(kBus));
    EXPECT_EQ(it.exit_code, 1) << arguments << it.talk;
    return it.talk;
  };
  const TestFolder folder("capture-words");
  std::ofstream(folder.path("text.mp4")) << "this is no video\n";
  EXPECT_NE(refused("/dev/video77").find("/dev/video77"), std::string::npos);
  EXPECT_NE(refused("/dev/null").find("/dev/null"), std::string::npos);
  EXPECT_NE(refused("nowhere.mp4").find("nowhere.mp4"), std::string::npos);
  EXPECT_NE(refused(folder.path("text.mp4")).find("text.mp4"), std::string::npos);
  EXPECT_NE(refused("/dev/null --size huge").find("--size 'huge'"), std::string::npos);
  const Finished listed = run(bin("dance-capture") + " --list");
  EXPECT_EQ(listed.exit_code, 0);
  EXPECT_FALSE(listed.output.empty()) << "cameras, or what to do where there is none";
}

TEST_F(CapturePrograms, SayWhatIsMissing) {
  const Finished no_models = run(bin("dance-capture") + " " + kVideo + " --models " +
                                 folder_.path("empty") + " --bus " + quoted(kBus));
  EXPECT_EQ(no_models.exit_code, 1);
  EXPECT_NE(no_models.talk.find("dance fetch-models"), std::string::npos) << no_models.talk;
  std::ofstream(folder_.path("lens.yml")) << "%YAML:1.0\n---\nimage_width: nine\n";
  const Finished no_lens = run(bin("dance-capture") + " " + kVideo + " --calibration " +
                               folder_.path("lens.yml") + " --bus " + quoted(kBus));
  EXPECT_EQ(no_lens.exit_code, 1);
  EXPECT_NE(no_lens.talk.find("lens.yml"), std::string::npos) << no_lens.talk;
}

}  // namespace
}  // namespace dance
