#include "tests/producers/camera/v4l2/shim_words.h"

#include <linux/videodev2.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace dance {
namespace {

[[noreturn]] void wrong(const std::string& what) {
  std::fprintf(stderr, "dance_video_shim: %s\n", what.c_str());
  std::abort();
}

int number(const std::string& text) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < 0 || value > 1'000'000) wrong("no number: " + text);
  return static_cast<int>(value);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

std::set<std::uint32_t> numbers(const std::string& text) {
  std::set<std::uint32_t> all;
  for (const std::string& part : split(text, ','))
    all.insert(static_cast<std::uint32_t>(number(part)));
  return all;
}

std::uint32_t fourcc_of(const std::string& name) {
  if (name.size() != 4) wrong("no encoding: " + name);
  return v4l2_fourcc(static_cast<std::uint32_t>(name[0]), static_cast<std::uint32_t>(name[1]),
                     static_cast<std::uint32_t>(name[2]), static_cast<std::uint32_t>(name[3]));
}

ShimMode mode_of(const std::string& text) {
  char name[5] = {};
  ShimMode mode;
  if (std::sscanf(text.c_str(), "%4[A-Z0-9]:%dx%d@%d", name, &mode.width_px, &mode.height_px,
                  &mode.hz) != 4) {
    wrong("no mode: " + text);
  }
  mode.fourcc = fourcc_of(name);
  return mode;
}

ShimFree free_of(const std::string& text) {
  char name[5] = {};
  ShimFree free;
  if (std::sscanf(text.c_str(), "%4[A-Z0-9]:%dx%d-%dx%d/%d@%d", name, &free.least.width_px,
                  &free.least.height_px, &free.most.width_px, &free.most.height_px, &free.step_px,
                  &free.most.hz) != 7) {
    wrong("no range of modes: " + text);
  }
  free.least.fourcc = free.most.fourcc = fourcc_of(name);
  return free;
}

}  // namespace

void ShimWords::read(const std::string& words) {
  for (const std::string& word : split(words, ' ')) {
    if (word.empty()) continue;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) wrong("a word without a value: " + word);
    const std::string key = word.substr(0, equals);
    const std::string value = word.substr(equals + 1);
    if (key == "device")
      device = number(value);
    else if (key == "card") {
      card = value;
      for (char& c : card) c = c == '_' ? ' ' : c;
    } else if (key == "bus")
      bus = value;
    else if (key == "modes") {
      modes.clear();
      for (const std::string& mode : split(value, ',')) modes.push_back(mode_of(mode));
    } else if (key == "free")
      free = free_of(value);
    else if (key == "makes")
      makes = mode_of(value);
    else if (key == "pad")
      pad_bytes = number(value);
    else if (key == "busy")
      is_busy = number(value) != 0;
    else if (key == "denied")
      is_denied = number(value) != 0;
    else if (key == "absent")
      is_absent = number(value) != 0;
    else if (key == "metadata")
      has_metadata = number(value) != 0;
    else if (key == "stamp")
      stamp = value;
    else if (key == "age_ms")
      age_ms = value.starts_with('-') ? -number(value.substr(1)) : number(value);
    else if (key == "priority")
      priority = number(value);
    else if (key == "gap")
      gaps = numbers(value);
    else if (key == "error")
      errors = numbers(value);
    else if (key == "truncate")
      cut = numbers(value);
    else if (key == "file")
      file = value;
    else if (key == "hz")
      hz = number(value);
    else if (key == "slow_start_ms")
      slow_start_ms = number(value);
    else if (key == "unplug")
      unplug_after = number(value);
    else if (key == "replug_ms")
      replug_ms = number(value);
    else if (key == "again")
      again = number(value);
    else
      wrong("no such word: " + word);
  }
  if (stamp != "monotonic" && stamp != "realtime" && stamp != "zero")
    wrong("no such stamp: " + stamp);
}

bool is_jpeg_mode(const ShimMode& mode) { return mode.fourcc == V4L2_PIX_FMT_MJPEG; }

int row_count(const ShimMode& mode) {
  return mode.fourcc == V4L2_PIX_FMT_NV12 ? mode.height_px * 3 / 2 : mode.height_px;
}

int row_bytes(const ShimMode& mode) {
  if (is_jpeg_mode(mode)) return 0;
  return mode.fourcc == V4L2_PIX_FMT_YUYV ? mode.width_px * 2 : mode.width_px;
}

std::size_t picture_bytes(const ShimMode& mode, int pad_bytes) {
  const auto pixels =
      static_cast<std::size_t>(mode.width_px) * static_cast<std::size_t>(mode.height_px);
  if (is_jpeg_mode(mode)) return pixels * 2 + 4096;
  return static_cast<std::size_t>(row_count(mode)) *
         static_cast<std::size_t>(row_bytes(mode) + pad_bytes);
}

std::vector<std::vector<std::uint8_t>> read_pictures(const std::string& path,
                                                     const ShimMode& mode) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> all{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::vector<std::uint8_t>> pictures;
  if (is_jpeg_mode(mode)) {
    // Ours have no pictures inside pictures: one ends where the next begins.
    std::size_t begin = 0;
    for (std::size_t i = 2; i + 2 < all.size(); ++i) {
      if (all[i] != 0xff || all[i + 1] != 0xd8 || all[i + 2] != 0xff) continue;
      pictures.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(begin),
                            all.begin() + static_cast<std::ptrdiff_t>(i));
      begin = i;
    }
    if (begin < all.size())
      pictures.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(begin), all.end());
  } else {
    const std::size_t size = picture_bytes(mode, 0);
    for (std::size_t at = 0; size > 0 && at + size <= all.size(); at += size) {
      pictures.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                            all.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
  }
  if (pictures.empty()) wrong("no pictures in " + path);
  return pictures;
}

}  // namespace dance
