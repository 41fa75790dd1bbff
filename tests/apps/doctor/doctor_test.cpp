#include <gtest/gtest.h>

#include <algorithm>

#include "apps/doctor/doctor_camera.h"
#include "apps/doctor/doctor_checks.h"
#include "apps/doctor/doctor_cluster.h"
#include "apps/doctor/doctor_drawing.h"
#include "apps/doctor/doctor_sound.h"

namespace dance {
namespace {

using Grade = Finding::Grade;

TEST(Doctor, AcceptsMulticastOverLoopbackForLcmsPrograms) {
  EXPECT_EQ(check_multicast_device("lo").grade, Grade::kOk);
}

TEST(Doctor, NotesThatLcmsProgramsFollowARouteOverANetworkCard) {
  const Finding finding = check_multicast_device("eth0");
  EXPECT_EQ(finding.grade, Grade::kNote);
  EXPECT_NE(finding.what.find("eth0"), std::string::npos);
  EXPECT_EQ(finding.cure, "ip route add 224.0.0.0/4 dev lo");
}

TEST(Doctor, NotesThatOnlyLcmsProgramsNeedARoute) {
  const Finding finding = check_multicast_device("");
  EXPECT_EQ(finding.grade, Grade::kNote);
  EXPECT_NE(finding.what.find("dance needs no route"), std::string::npos);
  EXPECT_EQ(finding.cure, "ip route add 224.0.0.0/4 dev lo");
}

TEST(Doctor, PrintsTheFirewallRuleForThePortOfTheBus) {
  const Finding finding = check_bus_exposure(*parse_udpm_url("udpm://239.255.76.67:7668?ttl=0"));
  EXPECT_TRUE(finding.cure.starts_with("nft '")) << finding.cure;
  EXPECT_NE(finding.cure.find("udp dport 7668 "), std::string::npos) << finding.cure;
}

TEST(Doctor, AdvisesTtlZeroForABusThatIsOpenToTheNetwork) {
  const Finding finding = check_bus_exposure(*parse_udpm_url("udpm://239.255.76.67:7667?ttl=1"));
  EXPECT_EQ(finding.grade, Grade::kNote);
  EXPECT_NE(finding.cure.find("?ttl=0"), std::string::npos) << finding.cure;
}

TEST(Doctor, NotesSmallSocketBuffers) {
  EXPECT_EQ(check_receive_buffer(212'992).grade, Grade::kNote);
  EXPECT_EQ(check_receive_buffer(4 << 20).grade, Grade::kOk);
}

TEST(Doctor, NotesAMachineThatWakesLate) {
  EXPECT_EQ(check_wake_ups(Duration::us(80)).grade, Grade::kOk);
  const Finding late = check_wake_ups(Duration::ms(7));
  EXPECT_EQ(late.grade, Grade::kNote);
  EXPECT_NE(late.what.find("7000"), std::string::npos);
}

TEST(Doctor, TriesToDraw) {
  const Finding drawing = check_drawing();
  EXPECT_FALSE(drawing.what.empty());
  EXPECT_EQ(drawing.cure.empty(), drawing.grade == Grade::kOk);
}

TEST(Doctor, NamesTheCureOfEveryFaultOfACamera) {
  const Finding camera = check_camera();
  EXPECT_FALSE(camera.what.empty());
  EXPECT_NE(camera.grade, Grade::kProblem) << "a house needs no camera";
  const Finding network = check_pose_network();
  EXPECT_FALSE(network.what.empty());
  EXPECT_EQ(network.cure.empty(), network.grade == Grade::kOk);
}

TEST(Doctor, PrintsNothingRawThatASoundServerCallsItsDevices) {
  const std::string raw = "Card\x1b[2J\nok: all is well\r";
  for (const bool is_muted : {false, true}) {
    const Finding sound = check_loudspeaker(Loudspeaker{raw, raw, is_muted, false, Duration()});
    const Finding microphone = check_microphone(Microphone{raw, raw, is_muted, false});
    for (const Finding& finding : {sound, microphone}) {
      EXPECT_NE(finding.what.find("Card?[2J?ok"), std::string::npos) << finding.what;
      for (const std::string& text : {finding.what, finding.cure})
        EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](char c) { return c < ' '; }));
    }
  }
  EXPECT_EQ(check_microphone(fail("none\x1b[2J")).what.find('\x1b'), std::string::npos);
}

TEST(Doctor, TellsWhereSoundGoesAndHowToMendIt) {
  Loudspeaker loudspeaker{"hdmi", "A loudspeaker", false, false, Duration::ms(40)};
  const Finding good = check_loudspeaker(loudspeaker);
  EXPECT_EQ(good.grade, Grade::kOk);
  EXPECT_NE(good.what.find("40 ms"), std::string::npos) << good.what;
  EXPECT_TRUE(good.cure.empty());
  const auto expect_note = [](const Loudspeaker& of, const std::string& cure) {
    const Finding finding = check_loudspeaker(of);
    EXPECT_EQ(finding.grade, Grade::kNote) << finding.what;
    EXPECT_NE(finding.cure.find(cure), std::string::npos) << finding.cure;
  };
  loudspeaker.latency = Duration::ms(700);
  expect_note(loudspeaker, "--trim");
  loudspeaker.is_muted = true;
  expect_note(loudspeaker, "pactl set-sink-mute hdmi 0");
  loudspeaker.leads_nowhere = true;
  expect_note(loudspeaker, "set-default-sink");
}

TEST(Doctor, TellsWhyThereIsNoSoundAndTheCureOfEach) {
  SoundFailure failure;
  failure.socket = "/run/user/1000/pulse/native";
  const auto expect = [&](SoundTrouble trouble, const std::string& what, const std::string& cure) {
    failure.trouble = trouble;
    const Finding finding = check_loudspeaker(tl::make_unexpected(failure));
    EXPECT_EQ(finding.grade, Grade::kNote) << "nobody needs sound to dance";
    EXPECT_NE(finding.what.find(what), std::string::npos) << finding.what;
    EXPECT_NE(finding.cure.find(cure), std::string::npos) << finding.cure;
  };
  expect(SoundTrouble::kNoServer, "nobody is at /run/user/1000", "apt-get install pulseaudio");
  failure.installed_server = "pipewire-pulse";
  expect(SoundTrouble::kNoServer, "nobody is at", "systemctl --user start pipewire-pulse");
  failure.installed_server = "pulseaudio";
  expect(SoundTrouble::kNoServer, "nobody is at", "pulseaudio --start");
  failure.is_named = true;
  expect(SoundTrouble::kNoServer, "nobody is at", "unset PULSE_SERVER");
  expect(SoundTrouble::kNotYours, "another user's", "stat -c %U /run/user/1000/pulse/native");
  expect(SoundTrouble::kHangs, "hangs: it accepts the connection and does not answer",
         "pulseaudio --kill");
  failure.installed_server = "pipewire-pulse";
  expect(SoundTrouble::kHangs, "hangs", "systemctl --user restart pipewire pipewire-pulse");
  expect(SoundTrouble::kRefused, "does not let us in", "PULSE_COOKIE");
  failure.reason = "No such entity";
  expect(SoundTrouble::kNoLoudspeaker, "no loudspeaker (No such entity)", "module-udev-detect");
  expect(SoundTrouble::kFarServer, "PULSE_SERVER", "unset PULSE_SERVER");
  expect(SoundTrouble::kNotBuilt, "built without", "libpulse-dev");
}

TEST(Doctor, AsksTheSoundServerOfThisMachine) {
  const Finding sound = check_sound();
  EXPECT_EQ(sound.name, "sound");
  EXPECT_FALSE(sound.what.empty());
  EXPECT_NE(sound.grade, Grade::kProblem) << "nobody needs sound to dance";
  EXPECT_EQ(sound.cure.empty(), sound.grade == Grade::kOk);
}

NatsProbe healthy_nats() {
  NatsProbe found;
  found.server = "nats://127.0.0.1:4222";
  found.round_trip = Duration::us(300);
  for (const char* name : {kClusterBucket, kKeysBucket}) {
    NatsProbe::Bucket bucket;
    bucket.name = name;
    bucket.is_there = true;
    bucket.replicas = bucket.current_replicas = 3;
    found.buckets.push_back(bucket);
  }
  return found;
}

// The worst of them, and it has a cure.
Grade worst(const std::vector<Finding>& findings) {
  Grade grade = Grade::kOk;
  for (const Finding& finding : findings) {
    EXPECT_FALSE(finding.grade == Grade::kProblem && finding.cure.empty()) << finding.what;
    grade = std::max(grade, finding.grade);
  }
  return grade;
}

TEST(Doctor, TellsWhatNatsLacks) {
  NatsOptions three;
  three.urls = {"nats://a", "nats://b", "nats://c"};
  EXPECT_EQ(worst(check_nats(healthy_nats(), three)), Grade::kOk);
  NatsProbe found = healthy_nats();
  found.no_connection = Error{"no NATS server answers"};
  EXPECT_EQ(check_nats(found, three).size(), 1u) << "the rest cannot be known";
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kProblem);
  found = healthy_nats();
  found.no_jetstream = Error{"not enabled"};
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kProblem);
  found = healthy_nats();
  found.round_trip = Duration::ms(20);
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kNote);
  found = healthy_nats();
  found.buckets[0].cannot_write = Error{"permissions violation"};
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kProblem);
  found = healthy_nats();
  found.buckets[1].cannot_write = Error{"permissions violation"};
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kOk) << "a server writes no keys";
  found = healthy_nats();
  found.buckets[0].current_replicas = 2;
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kNote);
  found = healthy_nats();
  found.buckets[0].is_there = false;
  EXPECT_EQ(worst(check_nats(found, three)), Grade::kNote);
}

TEST(Doctor, TellsServersWhoseClocksAreApart) {
  EXPECT_EQ(worst(check_servers({})), Grade::kNote) << "none beats";
  std::map<ServerId, ClusterProbe::Seen> seen;
  for (const ServerId id : {1, 2, 3}) {
    seen[id].answers = 20;
    seen[id].round_trip = Duration::us(200);
    seen[id].offset = Duration::us(static_cast<std::int64_t>(id) * 300);
  }
  EXPECT_EQ(worst(check_servers(seen)), Grade::kOk) << "0.6 ms apart";
  seen[3].offset = Duration::us(1700);
  const auto apart = check_servers(seen);
  EXPECT_EQ(worst(apart), Grade::kNote);
  EXPECT_NE(apart.back().what.find("1.40 ms"), std::string::npos) << apart.back().what;
  seen[3].answers = 0;
  EXPECT_EQ(worst(check_servers(seen)), Grade::kProblem) << "it beats but tells no time";
}

TEST(Doctor, TellsABusUrlThatIsNone) {
  const auto findings = examine_machine("http://nowhere");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].grade, Grade::kProblem);
}

}  // namespace
}  // namespace dance
