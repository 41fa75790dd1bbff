#include "producers/camera/stereo/zed_ini.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace dance {
namespace {

struct ZedSize {
  std::string_view suffix;
  int width_px;
  int height_px;
};
constexpr std::array<ZedSize, 6> kZedSizes{{{"2K", 2208, 1242},
                                            {"FHD", 1920, 1080},
                                            {"FHD1200", 1920, 1200},
                                            {"HD", 1280, 720},
                                            {"SVGA", 960, 600},
                                            {"VGA", 672, 376}}};

constexpr const char* kFetchAgain = "fetch the file again by the camera's serial number";

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return trimmed(line);
}

// "" where the line is none.
std::string_view section_of(std::string_view line) {
  if (line.size() < 2 || line.front() != '[' || line.back() != ']') return {};
  return trimmed(line.substr(1, line.size() - 2));
}

class Ini {
 public:
  Ini(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool has_section(std::string_view section) const {
    std::string_view rest = text_;
    while (!rest.empty())
      if (section_of(take_line(rest)) == section) return true;
    return false;
  }

  // The first that is so called; no text where there is none.
  std::optional<std::string_view> text_of(std::string_view section, std::string_view key) const {
    std::string_view rest = text_;
    bool is_inside = false;
    while (!rest.empty()) {
      const std::string_view line = take_line(rest);
      if (line.starts_with('[')) {
        is_inside = section_of(line) == section;
        continue;
      }
      const std::size_t equals = line.find('=');
      if (!is_inside || equals == std::string_view::npos) continue;
      if (trimmed(line.substr(0, equals)) != key) continue;
      // What stands behind the number is a remark.
      std::string_view value = line.substr(equals + 1);
      return trimmed(value.substr(0, value.find_first_of(";#")));
    }
    return std::nullopt;
  }

  Result<double> number(std::string_view section, std::string_view key) const {
    const auto text = text_of(section, key);
    if (!text) return fail(fmt::format("{}: [{}] has no {}; {}", name_, section, key, kFetchAgain));
    return number_in(*text, section, key);
  }

  // Of a key that stands with or without the size's suffix.
  Result<double> number(std::string_view section, std::string_view key,
                        std::string_view suffix) const {
    const std::string longer = fmt::format("{}_{}", key, suffix);
    if (const auto text = text_of(section, longer)) return number_in(*text, section, longer);
    if (const auto text = text_of(section, key)) return number_in(*text, section, key);
    return fail(fmt::format("{}: [{}] has neither {} nor {}; {}", name_, section, longer, key,
                            kFetchAgain));
  }

 private:
  Result<double> number_in(std::string_view text, std::string_view section,
                           std::string_view key) const {
    // from_chars, as the numbers have points wherever the machine stands.
    double value = 0.0;
    const char* begin = text.data();
    const char* end = begin + text.size();
    if (begin != end && *begin == '+') ++begin;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value))
      return fail(fmt::format("{}: [{}] {}={} is no number; {}", name_, section, key,
                              std::string(text.substr(0, 40)), kFetchAgain));
    return value;
  }

  std::string_view text_;
  const std::string& name_;
};

// The size whose section fits: the very one, else that of the same shape that is next larger, else
// the largest.
const ZedSize* size_for(const Ini& ini, int width_px, int height_px) {
  const ZedSize* best = nullptr;
  for (const ZedSize& size : kZedSizes) {
    if (!ini.has_section(fmt::format("LEFT_CAM_{}", size.suffix))) continue;
    if (size.width_px == width_px && size.height_px == height_px) return &size;
    const double rows = static_cast<double>(size.height_px) * width_px / size.width_px;
    if (std::abs(rows - height_px) > 1.0) continue;
    if (!best ||
        (size.width_px > width_px ? best->width_px < width_px || size.width_px < best->width_px
                                  : best->width_px < size.width_px))
      best = &size;
  }
  return best;
}

Result<Pinhole> read_camera(const Ini& ini, const std::string& section, const ZedSize& size) {
  Pinhole camera;
  camera.width_px = size.width_px;
  camera.height_px = size.height_px;
  camera.is_measured = true;
  DANCE_TRY(camera.fx_px, ini.number(section, "fx"));
  DANCE_TRY(camera.fy_px, ini.number(section, "fy"));
  DANCE_TRY(camera.cx_px, ini.number(section, "cx"));
  DANCE_TRY(camera.cy_px, ini.number(section, "cy"));
  constexpr std::array<std::string_view, 5> kNames{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    // Old files end with k2: their lenses were measured without the others.
    if (i >= 2 && !ini.text_of(section, kNames[i])) continue;
    DANCE_TRY(camera.distortion[i], ini.number(section, kNames[i]));
  }
  return camera;
}

}  // namespace

bool looks_like_zed_ini(std::string_view text) {
  std::string_view rest = text.substr(0, kMostZedIni_bytes);
  while (!rest.empty()) {
    const std::string_view section = section_of(take_line(rest));
    if (section == "STEREO" || section.starts_with("LEFT_CAM_")) return true;
  }
  return false;
}

Result<StereoRig> parse_zed_ini(std::string_view text, const std::string& name, int width_px,
                                int height_px) {
  if (text.size() > kMostZedIni_bytes)
    return fail(fmt::format("{}: {} bytes, and a ZED's file has a few thousand; {}", name,
                            text.size(), kFetchAgain));
  const Ini ini(text, name);
  const ZedSize* size = size_for(ini, width_px, height_px);
  if (!size)
    return fail(
        fmt::format("{}: no section LEFT_CAM_… for pictures of {} x {} a camera; choose "
                    "--size so that a camera has 2208x1242, 1920x1080, 1280x720 or 672x376",
                    name, width_px, height_px));
  StereoRig rig;
  DANCE_TRY(rig.left, read_camera(ini, fmt::format("LEFT_CAM_{}", size->suffix), *size));
  DANCE_TRY(rig.right, read_camera(ini, fmt::format("RIGHT_CAM_{}", size->suffix), *size));
  DANCE_TRY(const double baseline_mm, ini.number("STEREO", "Baseline"));
  DANCE_TRY(const double ty_mm, ini.number("STEREO", "TY", size->suffix));
  DANCE_TRY(const double tz_mm, ini.number("STEREO", "TZ", size->suffix));
  DANCE_TRY(const double rx_rad, ini.number("STEREO", "RX", size->suffix));
  DANCE_TRY(const double ry_rad, ini.number("STEREO", "CV", size->suffix));
  DANCE_TRY(const double rz_rad, ini.number("STEREO", "RZ", size->suffix));
  if (baseline_mm < 10.0 || baseline_mm > 2000.0)
    return fail(
        fmt::format("{}: [STEREO] Baseline={} mm; a ZED's cameras are 63 to 120 mm apart; {}", name,
                    baseline_mm, kFetchAgain));
  const Eigen::Vector3d turn_rad(rx_rad, ry_rad, rz_rad);
  if (turn_rad.norm() > 0.5)
    return fail(fmt::format("{}: [STEREO] RX, CV, RZ turn the cameras by {} rad; {}", name,
                            turn_rad.norm(), kFetchAgain));
  if (turn_rad.norm() > 0.0)
    rig.R_RL = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
  rig.p_RL_m = -1e-3 * Eigen::Vector3d(baseline_mm, ty_mm, tz_mm);
  DANCE_TRY(rig.left, fitted(rig.left, width_px, height_px, name));
  DANCE_TRY(rig.right, fitted(rig.right, width_px, height_px, name));
  return checked(rig, name);
}

}  // namespace dance
