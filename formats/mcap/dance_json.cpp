#include "formats/mcap/dance_json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/mcap/dance_schemas.h"
#include "formats/recording/recorded_time.h"

namespace dance {
namespace {

using Json = nlohmann::json;

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

template <class Number>
bool read(const Json& object, const char* name, Number& value) {
  const Json* found = member(object, name);
  if (!found || !found->is_number()) return false;
  const auto number = found->get<double>();
  value = static_cast<Number>(number);
  return std::isfinite(number) && std::isfinite(value);
}

template <class Number>
requires std::integral<Number>
bool read_integer(const Json& object, const char* name, Number& value) {
  const Json* found = member(object, name);
  if (!found || !found->is_number_integer()) return false;
  if (found->is_number_unsigned()) {
    const auto number = found->get<std::uint64_t>();
    value = static_cast<Number>(number);
    return std::in_range<Number>(number);
  }
  const auto number = found->get<std::int64_t>();
  value = static_cast<Number>(number);
  return std::in_range<Number>(number);
}

bool read_time(const Json& object, const char* name, MonoTime& time) {
  std::int64_t us = 0;
  if (!read_integer(object, name, us) || !is_recorded_time(us)) return false;
  time = MonoTime::from_us(us);
  return true;
}

bool read_text(const Json& object, const char* name, std::string_view& text) {
  const Json* found = member(object, name);
  if (!found || !found->is_string()) return false;
  text = found->get_ref<const std::string&>();
  return true;
}

bool read_clock(const Json& object, std::uint64_t& clock_id) {
  std::string_view text;
  if (!read_text(object, "clock_id", text)) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), clock_id);
  return error == std::errc() && end == text.data() + text.size();
}

bool read_vector(const Json& object, const char* name, Eigen::Vector3f& v) {
  const Json* found = member(object, name);
  return found && read(*found, "x", v.x()) && read(*found, "y", v.y()) && read(*found, "z", v.z());
}

bool read_rotation(const Json& object, const char* name, Eigen::Quaternionf& q) {
  const Json* found = member(object, name);
  return found && read(*found, "x", q.x()) && read(*found, "y", q.y()) &&
         read(*found, "z", q.z()) && read(*found, "w", q.w());
}

// The bone's or tip's number in a frame's name "<guest>/<bone>"; tips follow the bones.
std::optional<std::size_t> frame_of(std::string_view name, std::string_view guest) {
  if (name.size() <= guest.size() + 1 || !name.starts_with(guest) || name[guest.size()] != '/')
    return std::nullopt;
  name.remove_prefix(guest.size() + 1);
  if (const auto bone = find_bone(name)) return index_of(*bone);
  for (std::size_t tip = 0; tip < kTipCount; ++tip)
    if (name == kTipFrames[tip]) return kBoneCount + tip;
  return std::nullopt;
}

bool is_parent(std::string_view name, std::string_view guest, std::size_t frame) {
  if (frame == 0) return name == kStageFrame;
  const std::size_t parent = frame < kBoneCount ? static_cast<std::size_t>(kBones[frame].parent)
                                                : index_of(kTipBones[frame - kBoneCount]);
  return frame_of(name, guest) == parent;
}

}  // namespace

bool read_pose_json(const Json& json, Pose& pose, float& hips_height_m) {
  const Json* beats = member(json, "music_beats");
  pose.music_beats = kNoMusic;
  if (!beats || !(beats->is_null() || read(json, "music_beats", pose.music_beats))) return false;
  if (!read_integer(json, "sequence", pose.sequence) || !read_clock(json, pose.clock_id) ||
      !read_time(json, "capture_time_us", pose.capture_time) ||
      !read_integer(json, "presence", pose.presence) ||
      !read(json, "confidence", pose.confidence) || !read(json, "hips_height_m", hips_height_m))
    return false;
  pose.presence &= kAllBones;
  return true;
}

bool read_hands_json(const Json& json, Hands& hands) {
  if (!read_integer(json, "sequence", hands.sequence) || !read_clock(json, hands.clock_id) ||
      !read_time(json, "capture_time_us", hands.capture_time) ||
      !read_integer(json, "presence", hands.presence))
    return false;
  hands.presence &= (1u << kFingerBoneCount) - 1;
  const Json* rotations = member(json, "rotations_xyzw");
  if (!rotations || !rotations->is_array() || rotations->size() != kFingerBoneCount) return false;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    const Json& xyzw = (*rotations)[i];
    if (!xyzw.is_array() || xyzw.size() != 4) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!xyzw[k].is_number()) return false;
      hands.R_PB[i].coeffs()[static_cast<Eigen::Index>(k)] = xyzw[k].get<float>();
    }
  }
  return true;
}

bool read_beat_json(const Json& json, Beat& beat) {
  const Json* playing = member(json, "playing");
  if (!playing || !playing->is_boolean()) return false;
  beat.playing = playing->get<bool>();
  return read_time(json, "time_us", beat.time) && read_clock(json, beat.clock_id) &&
         read_time(json, "beat_time_us", beat.beat_time) && read(json, "beat", beat.beat) &&
         read(json, "tempo_bpm", beat.tempo_bpm) &&
         read_integer(json, "beats_per_bar", beat.beats_per_bar) &&
         read(json, "confidence", beat.confidence);
}

bool read_transforms_json(const Json& json, std::string_view guest, Pose& pose,
                          Skeleton& skeleton) {
  const Json* list = member(json, "transforms");
  if (!list || !list->is_array()) return false;
  constexpr std::uint32_t kAllFrames = (1u << (kBoneCount + kTipCount)) - 1;
  std::uint32_t seen = 0;
  for (const Json& each : *list) {
    std::string_view parent, child;
    Eigen::Vector3f place_m;
    Eigen::Quaternionf rotation;
    if (!read_text(each, "parent_frame_id", parent) || !read_text(each, "child_frame_id", child) ||
        !read_vector(each, "translation", place_m) || !read_rotation(each, "rotation", rotation))
      return false;
    const auto frame = frame_of(child, guest);
    if (!frame || !is_parent(parent, guest, *frame)) return false;
    seen |= 1u << *frame;
    if (*frame >= kBoneCount) {
      skeleton.tip_m[*frame - kBoneCount] = place_m;
      continue;
    }
    pose.R_PB[*frame] = rotation;
    (*frame == 0 ? pose.p_WH_m : skeleton.offset_m[*frame]) = place_m;
  }
  return seen == kAllFrames;
}

}  // namespace dance
