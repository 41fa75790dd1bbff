#include "tools/doctor_checks.h"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/bus/bus.h"
#include "core/bus/multicast_route.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/private_network.h"

namespace dance {
namespace {

using Grade = Finding::Grade;

// In a child, as the network of this process must stay what it is.
bool can_make_private_network() {
  const pid_t child = fork();
  if (child == 0) _exit(enter_private_network() ? 0 : 1);
  int status = 1;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

Finding check_bus(const std::string& url, bool has_route) {
  Finding finding{"bus", Grade::kOk, "", ""};
  if (!has_route) {
    finding.grade = Grade::kNote;
    finding.what = "not tried: without a route for multicast there is none";
    return finding;
  }
  auto poller = Poller::create();
  auto bus = Bus::open(url);
  if (!bus || !poller) {
    finding.grade = Grade::kProblem;
    finding.what = bus ? poller.error().what : bus.error().what;
    return finding;
  }
  // Heard back within a second, on a channel that no program of ours listens to.
  bool heard = false;
  (*bus)->on_anything([&](std::string_view name, const void*, std::size_t, MonoTime) {
    heard = heard || name == "DOCTOR";
  });
  (*poller)->watch((*bus)->fd(), [&](MonoTime now) { (*bus)->drain(now); });
  (*bus)->publish_raw("DOCTOR", "hello", 5);
  const MonoTime give_up = mono_now() + Duration::s(1);
  while (!heard && mono_now() < give_up) (*poller)->run_once(Duration::ms(50));
  finding.what = heard ? url + " hears itself" : url + " does not hear what is sent on it";
  if (!heard) {
    finding.grade = Grade::kProblem;
    finding.cure = kMulticastCure;
  }
  return finding;
}

Finding check_display() {
  Finding finding{"display", Grade::kOk, "", ""};
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    if (value && *value) {
      finding.what = std::string("windows on ") + value;
      return finding;
    }
  }
  void* egl = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  finding.grade = egl ? Grade::kNote : Grade::kProblem;
  finding.what = egl ? "none: the viewer writes pictures (--headless)"
                     : "none, and no libEGL to draw pictures with";
  if (egl)
    dlclose(egl);
  else
    finding.cure = "apt-get install libegl1 libgl1-mesa-dri";
  return finding;
}

Finding check_java() {
  Finding finding{"lcm-spy", Grade::kOk, "Java and LCM's jars are there", ""};
  for (const char* file :
       {"/usr/share/java/lcm.jar", "/usr/share/java/jchart2d.jar", "/usr/bin/java"})
    if (!std::filesystem::exists(file)) {
      finding.grade = Grade::kNote;
      finding.what = std::string(file) + " is missing; only `dance spy` needs it";
      finding.cure =
          "apt-get install liblcm-java libjchart2d-java default-jre default-jdk-headless";
    }
  return finding;
}

Finding check_camera() {
  Finding finding{"camera", Grade::kNote, "none; replay and salsa dance without one", ""};
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const std::string path = entry.path().string();
    if (path.rfind("/dev/video", 0) != 0) continue;
    if (access(path.c_str(), R_OK | W_OK) == 0) return {"camera", Grade::kOk, path, ""};
    finding.what = path + " is not yours to open";
    finding.cure = "usermod -aG video $USER   (and log in again)";
  }
  return finding;
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

std::vector<Finding> examine_machine(const std::string& bus_url) {
  std::vector<Finding> findings;
  const auto address = parse_udpm_url(bus_url);
  if (!address) return {{"bus", Grade::kProblem, address.error().what, ""}};
  const std::string device = multicast_device(address->group);
  findings.push_back(check_multicast_device(device, can_make_private_network()));
  findings.push_back(check_bus(bus_url, !device.empty()));
  long long rmem_max_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> rmem_max_bytes;
  findings.push_back(check_receive_buffer(rmem_max_bytes));
  findings.push_back(check_display());
  findings.push_back(check_camera());
  findings.push_back(check_java());
  return findings;
}

}  // namespace dance
