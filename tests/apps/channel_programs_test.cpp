// Further channels and the room's music between two houses' programs, as another project's programs
// would use them: messages that LCM's own generated code writes and reads.
#include <testlcm/arm_t.hpp>

#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kCarolsBus = "udpm://239.255.76.67:7744?ttl=0";
constexpr const char* kArmRule =
    "class=newest size=300 rate=100 "
    "layout=utime:i64,joints:i32,f64[joints],rows:i8,columns:i16,f32[rows][columns],string,"
    "string[joints],bool,bytes[3]";

std::vector<std::uint8_t> bytes_of(const testlcm::arm_t& arm) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(arm.getEncodedSize()));
  EXPECT_GT(arm.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

testlcm::arm_t arm_at(std::int64_t utime) {
  testlcm::arm_t arm{};
  arm.utime = utime;
  arm.joints = 2;
  arm.angle = {0.25, -1.5};
  arm.rows = 1;
  arm.columns = 3;
  arm.grid = {{1.0f, 2.0f, 3.0f}};
  arm.name = "left";
  arm.joint_name = {"shoulder", "elbow"};
  arm.moving = 1;
  return arm;
}

// Everything that is heard on a bus, by channel: the last message.
class Ear {
 public:
  explicit Ear(const char* url) {
    auto bus = Bus::open(url);
    EXPECT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->on_anything([this](std::string_view name, const void* data, std::size_t size, MonoTime) {
      const auto* bytes = static_cast<const std::uint8_t*>(data);
      last_[std::string(name)].assign(bytes, bytes + size);
    });
    bus_->subscribe<Music>(Where::kRoom,
                           [this](const Channel& channel, const Music& music, MonoTime) {
                             music_ = {std::string(channel.guest().view()), music};
                           });
  }
  Bus& bus() { return *bus_; }
  bool hears(const std::string& channel) {
    bus_->drain(mono_now());
    return last_.contains(channel);
  }
  const std::vector<std::uint8_t>& last(const std::string& channel) { return last_[channel]; }
  const std::pair<std::string, Music>& music() const { return music_; }
  int count_with(const std::string& part) const {
    int count = 0;
    for (const auto& [name, bytes] : last_)
      if (name.find(part) != std::string::npos) ++count;
    return count;
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::map<std::string, std::vector<std::uint8_t>> last_;
  std::pair<std::string, Music> music_;
};

class ChannelPrograms : public BusPrograms {
 protected:
  void start_link(const char* bus, const std::string& guest, const std::string& report) {
    const auto rule = [](const char* name, std::string_view words) {
      return std::string(name) + " " + std::string(words);
    };
    auto child = ChildProcess::start(
        {bin("dance-link"),
         {"--server", "127.0.0.1:7455", "--guest", guest, "--bus", bus, "--bus-captures", guest,
          "--json", "--channel", rule("ROBOT/*", kArmRule), "--channel",
          "LIGHT/desk class=state rate=10 layout=n:i32,f32[n]"},
         report,
         folder_.path("talk")});
    ASSERT_TRUE(child) << child.error().what;
    children_.push_back(std::move(*child));
  }
};

TEST_F(ChannelPrograms, CarryAnArmALightAndTheMusicToTheOtherHouse) {
  start("dance-server", {"--port", "7455"});
  start_link(kBus, "alice", folder_.path("alice.json"));
  start_link(kOtherBus, "bob", folder_.path("bob.json"));
  Ear a(kBus), b(kOtherBus);
  Music music;
  music.tempo_bpm = 176.0;
  music.playing = true;
  music.clock_id = this_clock_id();
  music.start_time = mono_now() - Duration::s(30);
  ASSERT_TRUE(music.title.assign("Quimbara"));
  // The fingerprint of nobody, two lamps.
  const std::vector<std::uint8_t> light{0, 0, 0,  0, 0, 0, 0,  0, 0, 0,
                                        0, 2, 63, 0, 0, 0, 62, 0, 0, 0};
  std::int64_t utime = 0;
  const bool has_come = wait_for([&] {
    const auto arm = bytes_of(arm_at(++utime));
    a.bus().publish_raw("ROBOT/arm", arm.data(), arm.size());
    // A count that no message has room for: the house keeps it in.
    std::vector<std::uint8_t> hostile = arm;
    hostile[16] = 0x7f;
    a.bus().publish_raw("ROBOT/hostile", hostile.data(), hostile.size());
    a.bus().publish_raw("LIGHT/desk", light.data(), light.size());
    a.bus().publish_raw("LIGHT/other", light.data(), light.size());
    music.time = mono_now();
    a.bus().publish(Channel::of(Signal::kMusic, Where::kCapture, *GuestId::parse("alice")), music);
    a.bus().drain(mono_now());
    return b.hears("ROBOT/arm/guest/alice") && b.hears("LIGHT/desk/guest/alice") &&
           b.hears("MUSIC/room/alice") && a.hears("MUSIC/room/alice");
  });
  ASSERT_TRUE(has_come) << text_of(folder_.path("talk"));
  testlcm::arm_t arm;
  const auto& bytes = b.last("ROBOT/arm/guest/alice");
  ASSERT_EQ(arm.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  EXPECT_GT(arm.utime, 0);
  EXPECT_EQ(arm.joint_name, (std::vector<std::string>{"shoulder", "elbow"}));
  EXPECT_EQ(b.last("LIGHT/desk/guest/alice"), light);
  EXPECT_EQ(b.music().second.title.view(), "Quimbara");
  // One machine, one clock, and a line of next to no length: the beat is the same.
  const MonoTime now = mono_now();
  EXPECT_NEAR(b.music().second.beats_at(now), music.beats_at(now), 0.5);

  // Nothing is published any more; a house that comes now gets it all the same.
  Ear c(kCarolsBus);
  start_link(kCarolsBus, "carol", folder_.path("carol.json"));
  EXPECT_TRUE(wait_for([&] {
    return c.hears("LIGHT/desk/guest/alice") && c.hears("MUSIC/room/alice");
  })) << text_of(folder_.path("talk"));
  EXPECT_EQ(c.last("LIGHT/desk/guest/alice"), light);
  EXPECT_EQ(c.music().second.title.view(), "Quimbara");
  end_all();
  b.hears("");
  a.hears("");
  EXPECT_EQ(b.count_with("hostile"), 0);
  EXPECT_EQ(b.count_with("LIGHT/other"), 0);
  EXPECT_EQ(a.count_with("/guest/alice"), 0) << "what went out came back";
  EXPECT_EQ(b.count_with("/guest/bob"), 0);
  const std::string report = text_of(folder_.path("alice.json"));
  EXPECT_TRUE(has_all(report, {"\"channels_sent\":", "\"channels_invalid\":"})) << report;
  EXPECT_EQ(report.find("\"channels_invalid\":0,"), std::string::npos) << report;
}

TEST_F(ChannelPrograms, AWrongRuleIsOneLineThatNamesTheWord) {
  const Finished refused =
      run(bin("dance-link") + " --guest alice --channel 'LIGHT/desk class=state layout=i9'");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
  EXPECT_TRUE(has_all(refused.talk, {"LIGHT/desk", "i9", "f64"})) << refused.talk;
}

}  // namespace
}  // namespace dance
