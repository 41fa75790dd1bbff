#include "producers/camera/v4l2/camera_list.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/base/text/plain_text.h"
#include "producers/camera/v4l2/v4l2_device.h"

namespace dance {
namespace {

constexpr int kMaxDevices = 256;  // as many as the kernel numbers
constexpr const char* kNone =
    "no camera is there: plug one in, look at ls /dev/video*, and in a virtual machine hand it "
    "through; "
    "a video file or a folder of pictures does as well";

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() <= 3 &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

// A notebook's second camera sees heat or grey, to know a face by; a device that plays back may
// have nothing to give.
int rank_of(const CameraEntry& camera) {
  const auto mode = choose_mode(camera.modes, {});
  if (!mode) return 2;
  return mode->fourcc == V4L2_PIX_FMT_GREY ? 1 : 0;
}

std::string rates_of(const std::set<double>& rates) {
  std::string text;
  for (const double hz : rates) {
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", hz);
    text += (text.empty() ? "" : " ") + (hz > 0.0 ? std::string(number) : std::string("?"));
  }
  return text + " Hz";
}

}  // namespace

std::vector<CameraEntry> list_cameras() {
  std::vector<CameraEntry> all;
  for (int number = 0; number < kMaxDevices; ++number) {
    const std::string path = "/dev/video" + std::to_string(number);
    const auto device = V4l2Device::open(path);
    if (device) {
      all.push_back({path, device->card(), device->bus_info(), device->modes({}), ""});
      continue;
    }
    const DeviceTrouble& trouble = device.error();
    if (trouble.number == ENOENT || trouble.number == ENODEV || trouble.number == ENXIO) continue;
    if (!trouble.is_no_capture) all.push_back({path, "", "", {}, trouble.what});
  }
  return all;
}

std::string camera_table(std::span<const CameraEntry> cameras) {
  if (cameras.empty()) return std::string(kNone) + "\n";
  std::string table;
  for (const CameraEntry& camera : cameras) {
    if (!camera.trouble.empty()) {
      table += plain_text(camera.trouble) + "\n";
      continue;
    }
    table += plain_text(camera.path + "  " + camera.name + "  (" + camera.bus_info + ")") + "\n";
    // One line a size, in the order in which the camera lists its encodings.
    std::vector<std::string> order;
    std::map<std::string, std::set<double>> rates;
    std::vector<std::string> unread;
    for (const VideoMode& mode : camera.modes) {
      const std::string encoding = text_of_fourcc(mode.fourcc);
      if (!is_readable(mode.fourcc)) {
        if (std::find(unread.begin(), unread.end(), encoding) == unread.end())
          unread.push_back(encoding);
        continue;
      }
      const std::string what =
          encoding + " " + std::to_string(mode.width_px) + "x" + std::to_string(mode.height_px);
      if (rates[what].empty()) order.push_back(what);
      rates[what].insert(mode.hz());
    }
    for (const std::string& what : order) {
      char line[64];
      std::snprintf(line, sizeof line, "  %-16s ", what.c_str());
      table += line + rates_of(rates[what]) + "\n";
    }
    if (!unread.empty()) {
      table += "  not read:";
      for (const std::string& encoding : unread) table += " " + encoding;
      table += "\n";
    }
    const auto chosen = choose_mode(camera.modes, {});
    table += "  taken unless asked otherwise: " +
             (chosen ? text_of(*chosen) : "nothing, " + chosen.error().what) + "\n";
  }
  return table;
}

std::string camera_json(std::span<const CameraEntry> cameras) {
  auto list = nlohmann::ordered_json::array();
  for (const CameraEntry& camera : cameras) {
    const auto chosen = choose_mode(camera.modes, {});
    std::string trouble = camera.trouble;
    if (trouble.empty() && !chosen) trouble = camera.name + ": " + chosen.error().what;
    list.push_back({{"device", camera.path},
                    {"name", plain_text(camera.name)},
                    {"socket", camera.bus_info},
                    {"mode", chosen ? text_of(*chosen) : ""},
                    {"trouble", trouble}});
  }
  // A name that is no UTF-8 is a driver's.
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string cameras_in_a_line(std::span<const CameraEntry> cameras) {
  std::string line;
  for (const CameraEntry& camera : cameras) {
    if (!line.empty()) line += ", ";
    line += camera.path + (camera.trouble.empty() ? " (" + camera.name + ")" : " (not usable)");
  }
  return line.empty() ? kNone : "these are there: " + line;
}

Result<std::string> camera_path(const std::string& called, std::span<const CameraEntry> cameras) {
  if (is_number(called)) return "/dev/video" + called;
  if (called.find('/') != std::string::npos) return called;
  const bool is_any = called.empty() || called == "auto";
  const std::string wanted = in_lower_case(called);
  const CameraEntry* best = nullptr;
  std::pair<bool, int> best_key;
  for (const CameraEntry& camera : cameras) {
    if (!camera.trouble.empty()) continue;
    const std::string name = in_lower_case(camera.name);
    if (!is_any && name.find(wanted) == std::string::npos) continue;
    const std::pair<bool, int> key{!is_any && name != wanted, rank_of(camera)};
    if (best == nullptr || key < best_key) {
      best = &camera;
      best_key = key;
    }
  }
  if (best != nullptr) return best->path;
  if (is_any) {
    // The first that is there and cannot be used says why.
    if (!cameras.empty()) return fail(cameras.front().trouble);
    return fail(kNone);
  }
  return fail("no camera is called '" + called + "'; " + cameras_in_a_line(cameras));
}

const CameraEntry* found_again(const CameraEntry& lost,
                               std::span<const std::string> taken_bus_infos,
                               std::span<const CameraEntry> cameras) {
  const CameraEntry* elsewhere = nullptr;
  for (const CameraEntry& camera : cameras) {
    if (!camera.trouble.empty() || camera.name != lost.name) continue;
    if (camera.bus_info == lost.bus_info) return &camera;
    const bool is_another = std::find(taken_bus_infos.begin(), taken_bus_infos.end(),
                                      camera.bus_info) != taken_bus_infos.end();
    if (!is_another && elsewhere == nullptr) elsewhere = &camera;
  }
  return elsewhere;
}

}  // namespace dance
