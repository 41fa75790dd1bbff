#include "apps/doctor/doctor_checks.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "apps/doctor/doctor_camera.h"
#include "apps/doctor/doctor_drawing.h"
#include "apps/doctor/doctor_headset.h"
#include "apps/doctor/doctor_limits.h"
#include "apps/doctor/doctor_network.h"
#include "apps/doctor/doctor_sound.h"
#include "core/base/histogram.h"
#include "core/bus/bus.h"
#include "core/bus/route/multicast_route.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/confinement.h"
#include "core/program/program.h"
#include "formats/media/media_module.h"

namespace dance {

using Grade = Finding::Grade;

namespace {

// Checks whether readers of avatars, songs and videos can be confined here.
Finding check_confinement() {
  bool is_on = false;
  std::thread([&] { is_on = confine_thread(); }).join();
  if (is_on) return {"strangers' files", Finding::Grade::kOk, "read on confined threads", ""};
  return {"strangers' files", Finding::Grade::kNote,
          "avatars, songs and videos are read unconfined, as this build or kernel has no seccomp",
          ""};
}

// Listens on the bus for a second, for programs, dancers and a message of its own that must return.
std::vector<Finding> check_bus(const std::string& url) {
  Finding finding{"bus", Grade::kOk, "", ""};
  auto poller = Poller::create();
  auto bus = Bus::open(url);
  if (!bus || !poller) {
    finding.grade = Grade::kProblem;
    finding.what = bus ? poller.error().what : bus.error().what;
    return {finding};
  }
  // A channel that no program of ours listens to.
  bool is_heard = false;
  std::set<std::string> programs, guests;
  constexpr std::size_t kMost = 64;
  (*bus)->on_anything([&](std::string_view name, const void*, std::size_t, MonoTime) {
    is_heard = is_heard || name == "DOCTOR";
    const auto channel = Channel::parse(name);
    if (!channel) return;
    if (channel->signal() == Signal::kStats && programs.size() < kMost)
      programs.emplace(channel->program());
    if (channel->signal() == Signal::kPose && guests.size() < kMost)
      guests.emplace(channel->guest().view());
  });
  (*poller)->watch((*bus)->fd(), [&](MonoTime now) { (*bus)->drain(now); });
  (*bus)->publish_raw("DOCTOR", "hello", 5);
  // Programs tell their figures once a second.
  const MonoTime end = mono_now() + Duration::ms(1200);
  while (mono_now() < end) (*poller)->run_once(Duration::ms(50));
  finding.what = is_heard ? url + " hears itself" : url + " does not hear what is sent on it";
  if (!is_heard) {
    finding.grade = Grade::kProblem;
    finding.cure = "nft list ruleset   (and allow multicast on lo)";
    return {finding};
  }
  const auto listed = [](const std::set<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? std::string("nobody") : text;
  };
  return {finding,
          {"on the bus", Grade::kOk,
           "programs: " + listed(programs) + "; dancers: " + listed(guests), ""}};
}

Finding check_display() {
  const std::string name = display_name();
  if (!name.empty()) return {"display", Grade::kOk, "windows on " + name, ""};
  return {"display", Grade::kNote, "none: the viewer writes pictures (--headless)", ""};
}

Finding measure_wake_ups() {
  constexpr int kTimes = 200;
  Histogram lateness;
  for (int i = 0; i < kTimes; ++i) {
    const MonoTime due = mono_now() + Duration::ms(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    lateness.add(mono_now() - due);
  }
  return check_wake_ups(lateness.percentile(0.99));
}

Finding check_java() {
  Finding finding{"lcm-spy", Grade::kOk, "Java, LCM's jars and our types are there", ""};
  for (const std::string& file :
       {std::string("/usr/share/java/lcm.jar"), std::string("/usr/share/java/jchart2d.jar"),
        std::string("/usr/bin/java"), data_folder() + "/dance_types.jar"})
    if (!std::filesystem::exists(file)) {
      finding.grade = Grade::kNote;
      finding.what = file + " is missing; only `dance spy` needs it";
      finding.cure = "./dance spy   (installs and builds what it needs)";
    }
  return finding;
}

Finding check_media() {
  if (const auto module = media_module(); !module)
    return {"media", Grade::kNote,
            "no videos, and music as WAV, FLAC, Ogg and MP3 only: " + module.error().what, ""};
  return {"media", Grade::kOk, "FFmpeg's libraries read and write videos here", ""};
}

}  // namespace

Finding check_multicast_device(const std::string& device) {
  Finding finding{"LCM's programs", Grade::kOk, "multicast over lo: they meet the house there", ""};
  if (device == "lo") return finding;
  finding.grade = Grade::kNote;
  finding.cure = kMulticastCure;
  finding.what =
      device.empty()
          ? "no multicast route: lcm-spy and lcm-logger cannot open a bus (dance needs no route)"
          : "multicast over " + device +
                ": lcm-spy receives nothing of the house there, and what lcm-logplayer sends may "
                "leave through a VPN (dance stays on lo)";
  return finding;
}

Finding check_bus_exposure(const BusAddress& address) {
  if (address.ttl > 0)
    return {"bus and network", Grade::kNote,
            "ttl=" + std::to_string(address.ttl) +
                ": any host of the network can see the bus and dance as this house's guests",
            "--bus 'udpm://" + address.group + ":" + std::to_string(address.port) + "?ttl=0'"};
  // The rule matches the source address, as the kernel loops our own datagrams back from a card.
  return {"bus and network", Grade::kNote,
          "dance ignores other hosts; lcm-spy and lcm-logger do not, and a datagram from there can "
          "crash them. As root, this closes the port to other hosts:",
          "nft 'add table inet dance_bus; add chain inet dance_bus input { type filter hook input "
          "priority 0; }; add rule inet dance_bus input udp dport " +
              std::to_string(address.port) + " fib saddr type != local drop'"};
}

Finding check_receive_buffer(long long rmem_max_bytes) {
  Finding finding{"socket buffers", Grade::kOk, std::to_string(rmem_max_bytes) + " bytes", ""};
  if (rmem_max_bytes >= 2 << 20) return finding;
  finding.grade = Grade::kNote;
  finding.what += ": enough for a pair; a burst of a crowd may be lost";
  finding.cure = "sysctl -w net.core.rmem_max=4194304";
  return finding;
}

Finding check_wake_ups(Duration lateness_p99) {
  Finding finding{"wake-ups", Grade::kOk,
                  "at most " + std::to_string(lateness_p99.count_us()) + " µs late, 99 of 100", ""};
  if (lateness_p99 < Duration::ms(2)) return finding;
  finding.grade = Grade::kNote;
  finding.what += ": poses will be late by as much; is this machine busy?";
  finding.cure = "top   (and end what eats the processor)";
  return finding;
}

std::vector<Finding> examine_machine(const std::string& bus_url) {
  std::vector<Finding> findings;
  const auto address = parse_udpm_url(bus_url);
  if (!address) return {{"bus", Grade::kProblem, address.error().what, ""}};
  for (Finding& finding : examine_network()) findings.push_back(std::move(finding));
  for (Finding& finding : check_bus(bus_url)) findings.push_back(std::move(finding));
  findings.push_back(check_bus_exposure(*address));
  findings.push_back(check_multicast_device(multicast_device(address->group)));
  long long rmem_max_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> rmem_max_bytes;
  findings.push_back(check_receive_buffer(rmem_max_bytes));
  for (Finding& finding : examine_limits()) findings.push_back(std::move(finding));
  findings.push_back(check_confinement());
  findings.push_back(measure_wake_ups());
  findings.push_back(check_display());
  findings.push_back(check_drawing());
  findings.push_back(check_camera());
  findings.push_back(check_pose_network());
  findings.push_back(check_headset());
  findings.push_back(check_sound());
  findings.push_back(check_microphone());
  findings.push_back(check_media());
  findings.push_back(check_java());
  return findings;
}

}  // namespace dance
