// HeadsetPrograms: programs of a house with a headset, which is the scripted one of testing/xr, and
// what is heard of its dancer on the bus. A test fails where the headset's runtime saw misuse.
//
// Units/frames: none.
// Ownership:    the fixture's programs and files end with the test.
// Threads:      one.
// Failure:      what does not come to pass within the time that no machine should need is false.
#pragma once

#include <cstdlib>
#include <map>

#include "core/pose/heading.h"
#include "tests/apps/bus_programs.h"

namespace dance {

class HeadsetPrograms : public BusPrograms {
 protected:
  struct Heard {
    int poses = 0, skeletons = 0;
    Pose pose;
    std::vector<MonoTime> captured;
  };

  void SetUp() override {
    set("XR_RUNTIME_JSON", DANCE_BINARY_DIR "/lib/dance_test_xr.json");
    set("DANCE_XR_RECORD", folder_.path("record"));
    set("XDG_RUNTIME_DIR", folder_.path());
    set("LC_ALL", "C");
    ::unsetenv("DANCE_XR_PICTURES");  // NOLINT(concurrency-mt-unsafe)
    auto bus = Bus::open(kBus);
    ASSERT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->subscribe<Pose>(Where::kCapture,
                          [this](const Channel& channel, const Pose& pose, MonoTime) {
                            note(captured_[std::string(channel.guest().view())], pose);
                          });
    bus_->subscribe<Pose>(Where::kStage,
                          [this](const Channel& channel, const Pose& pose, MonoTime) {
                            note(staged_[std::string(channel.guest().view())], pose);
                          });
    bus_->subscribe<TimedSkeleton>(Where::kCapture,
                                   [this](const Channel& channel, const TimedSkeleton&, MonoTime) {
                                     ++captured_[std::string(channel.guest().view())].skeletons;
                                   });
  }
  void TearDown() override {
    end_all();
    EXPECT_EQ(record().find("misuse"), std::string::npos) << record();
    EXPECT_EQ(record().find("cannot be read"), std::string::npos) << record();
  }

  static void set(const char* name, const std::string& value) {
    ::setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  void write_script(const std::string& script) {
    std::ofstream(folder_.path("script")) << script;
    set("DANCE_XR_SCRIPT", folder_.path("script"));
  }
  ChildProcess& put_on(const std::string& script, std::vector<std::string> more = {}) {
    write_script(script);
    std::vector<std::string> words{"--guest", "alice", "--bus", kBus};
    words.insert(words.end(), more.begin(), more.end());
    return start("dance-headset", std::move(words));
  }

  template <class Condition>
  bool until(const Condition& condition) {
    return wait_for(
        [&] {
          bus_->drain(mono_now());
          return condition();
        },
        std::chrono::seconds(120));
  }
  // So many more from now on.
  bool hears_more(int poses) {
    const int wanted = captured_["alice"].poses + poses;
    return until([&] { return captured_["alice"].poses >= wanted; });
  }
  std::string talk() const { return text_of(folder_.path("talk")); }
  std::string record() const { return text_of(folder_.path("record")); }
  static int count_of(const std::string& text, const std::string& words) {
    int count = 0;
    for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at) ++count;
    return count;
  }
  int said(const std::string& words) const { return count_of(talk(), words); }
  bool has_recorded(const std::string& words) const {
    return record().find(words) != std::string::npos;
  }
  const Pose& newest(const std::string& guest) { return captured_[guest].pose; }

  std::unique_ptr<Bus> bus_;
  std::map<std::string, Heard> captured_, staged_;

 private:
  static void note(Heard& heard, const Pose& pose) {
    ++heard.poses;
    heard.pose = pose;
    heard.captured.push_back(pose.capture_time);
  }
};

}  // namespace dance
