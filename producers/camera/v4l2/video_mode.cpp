#include "producers/camera/v4l2/video_mode.h"

#include <linux/videodev2.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace dance {
namespace {

constexpr int kUsualWidth_px = 1280;
constexpr int kUsualHeight_px = 720;
constexpr double kUsualHz = 60.0;
constexpr double kTooSlowHz = 23.5;  // 24 Hz are often 23.976

struct Readable {
  std::uint32_t fourcc;
  int rank;  // lower is better: without loss, then with, then without colour
};
constexpr std::array<Readable, 5> kReadable{{{V4L2_PIX_FMT_YUYV, 0},
                                             {V4L2_PIX_FMT_NV12, 1},
                                             {V4L2_PIX_FMT_MJPEG, 2},
                                             {V4L2_PIX_FMT_JPEG, 3},
                                             {V4L2_PIX_FMT_GREY, 4}}};

int rank_of(std::uint32_t fourcc) {
  for (const Readable& r : kReadable) {
    if (r.fourcc == fourcc) return r.rank;
  }
  return -1;
}

// Half a picture's colour lies between two pixels.
bool has_a_readable_size(const VideoMode& mode) {
  if (mode.width_px <= 0 || mode.height_px <= 0) return false;
  if (mode.fourcc == V4L2_PIX_FMT_YUYV) return mode.width_px % 2 == 0;
  if (mode.fourcc == V4L2_PIX_FMT_NV12) return mode.width_px % 2 == 0 && mode.height_px % 2 == 0;
  return true;
}

double ratio_distance(double a, double b) { return std::abs(std::log(a / b)); }

double size_distance(const VideoMode& mode, const CameraWish& wish) {
  const bool is_usual = !wish.width_px && !wish.height_px;
  double distance = 0.0;
  if (wish.width_px || is_usual) {
    distance += ratio_distance(mode.width_px, wish.width_px.value_or(kUsualWidth_px));
  }
  if (wish.height_px || is_usual) {
    distance += ratio_distance(mode.height_px, wish.height_px.value_or(kUsualHeight_px));
  }
  // Of one height, or one width, the most usual shape.
  if (wish.width_px.has_value() != wish.height_px.has_value()) {
    distance += 1e-3 * ratio_distance(static_cast<double>(mode.width_px) / mode.height_px,
                                      static_cast<double>(kUsualWidth_px) / kUsualHeight_px);
  }
  return std::round(distance * 1e6);
}

// In hundredths of a hertz: 29.97 and 30 are two rates, rounding is none.
double rate_distance(double hz, const CameraWish& wish) {
  if (hz <= 0.0) return 1e12;
  if (wish.hz) return std::round(1e4 * ratio_distance(hz, *wish.hz));
  // Above the usual rate only where there is nothing below.
  return hz <= kUsualHz + 0.5 ? std::round(100.0 * (kUsualHz + 0.5 - hz)) : 1e9 + hz;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// As people write it: "mjpeg".
std::string encoding_of(const CameraWish& wish) {
  std::string name;
  for (const char c : wish.encoding) {
    name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  if (name == "MJPEG") return "MJPG";
  return name == "YUY2" ? "YUYV" : name;
}

std::string encodings_of(std::span<const VideoMode> modes) {
  std::string all;
  for (const VideoMode& mode : modes) {
    const std::string name = text_of_fourcc(mode.fourcc);
    if ((", " + all + ", ").find(", " + name + ", ") != std::string::npos) continue;
    all += (all.empty() ? "" : ", ") + name;
  }
  return all.empty() ? "none" : all;
}

}  // namespace

std::string text_of_fourcc(std::uint32_t fourcc) {
  std::string text;
  for (int byte = 0; byte < 4; ++byte) {
    const char c = static_cast<char>((fourcc >> (8 * byte)) & 0x7f);
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  // The highest bit means the other order of bytes.
  return (fourcc >> 31) != 0 ? text + "-BE" : text;
}

bool is_readable(std::uint32_t fourcc) { return rank_of(fourcc) >= 0; }

Result<VideoMode> choose_mode(std::span<const VideoMode> modes, const CameraWish& wish) {
  const std::string encoding = encoding_of(wish);
  const bool is_size_open = !wish.width_px && !wish.height_px;
  using Key = std::tuple<bool, double, double, int>;
  const VideoMode* best = nullptr;
  Key best_key;
  for (const VideoMode& mode : modes) {
    const int rank = rank_of(mode.fourcc);
    if (rank < 0 || !has_a_readable_size(mode)) continue;
    if (!encoding.empty() && text_of_fourcc(mode.fourcc) != encoding) continue;
    const double hz = mode.hz();
    const bool is_slow = is_size_open && !wish.hz && hz > 0.0 && hz < kTooSlowHz;
    const Key key{is_slow, size_distance(mode, wish), rate_distance(hz, wish), rank};
    if (best == nullptr || key < best_key) {
      best = &mode;
      best_key = key;
    }
  }
  if (best != nullptr) return *best;
  if (!encoding.empty()) {
    return fail("no pictures in " + encoding + "; it offers " + encodings_of(modes) +
                ", of which YUYV, NV12, MJPG, JPEG and GREY can be read");
  }
  return fail("no format that can be read; it offers " + encodings_of(modes) +
              ", and YUYV, NV12, MJPG, JPEG and GREY can be read");
}

std::string text_of(const VideoMode& mode) {
  const std::string rate =
      mode.hz() > 0.0 ? " at " + number(mode.hz()) + " Hz" : " at a rate it does not say";
  return std::to_string(mode.width_px) + "x" + std::to_string(mode.height_px) + " " +
         text_of_fourcc(mode.fourcc) + rate;
}

std::string text_of(const CameraWish& wish) {
  std::string text;
  if (wish.width_px && wish.height_px) {
    text = std::to_string(*wish.width_px) + "x" + std::to_string(*wish.height_px);
  } else if (wish.width_px) {
    text = "width " + std::to_string(*wish.width_px);
  } else if (wish.height_px) {
    text = "height " + std::to_string(*wish.height_px);
  } else {
    text = std::to_string(kUsualWidth_px) + "x" + std::to_string(kUsualHeight_px);
  }
  if (!wish.encoding.empty()) text += " " + encoding_of(wish);
  return text + (wish.hz ? " at " + number(*wish.hz) : " at up to " + number(kUsualHz)) + " Hz";
}

}  // namespace dance
