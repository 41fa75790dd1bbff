#include "apps/doctor/doctor_checks.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "apps/doctor/doctor_camera.h"
#include "apps/doctor/doctor_drawing.h"
#include "apps/doctor/doctor_headset.h"
#include "apps/doctor/doctor_sound.h"
#include "core/base/histogram.h"
#include "core/bus/bus.h"
#include "core/bus/multicast_route.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/program.h"
#include "formats/media/media_module.h"
#include "testing/private_network.h"

namespace dance {

using Grade = Finding::Grade;

namespace {

// In a child, as the network of this process must stay what it is.
bool can_make_private_network() {
  const pid_t child = fork();
  if (child == 0) _exit(enter_private_network() ? 0 : 1);
  int status = 1;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

// The bus itself, and who is on it: a second of listening, and a word of our own that must come
// back.
std::vector<Finding> check_bus(const std::string& url, bool has_route) {
  Finding finding{"bus", Grade::kOk, "", ""};
  if (!has_route) {
    finding.grade = Grade::kNote;
    finding.what = "not tried: without a route for multicast there is none";
    return {finding};
  }
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
    finding.cure = kMulticastCure;
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

Finding check_multicast_device(const std::string& device, bool private_network_possible) {
  Finding finding{"multicast", Grade::kOk, "over lo: stays on this machine", ""};
  if (device == "lo") return finding;
  finding.cure = kMulticastCure;
  finding.grade = Grade::kNote;
  if (!device.empty()) {
    finding.what =
        "over " + device + ": local programs stop hearing each other when that link goes down";
  } else if (private_network_possible) {
    finding.what =
        "no route: `dance demo` makes a network of its own; other programs need the route";
  } else {
    finding.grade = Grade::kProblem;
    finding.what = "no route, and no network of our own can be made: LCM cannot be opened";
  }
  return finding;
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
  const std::string device = multicast_device(address->group);
  findings.push_back(check_multicast_device(device, can_make_private_network()));
  for (Finding& finding : check_bus(bus_url, !device.empty()))
    findings.push_back(std::move(finding));
  long long rmem_max_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> rmem_max_bytes;
  findings.push_back(check_receive_buffer(rmem_max_bytes));
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
