#include "formats/mcap/dance_mcap_reader.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "formats/mcap/dance_json.h"
#include "formats/mcap/dance_schemas.h"
#include "formats/mcap/mcap_by_time.h"
#include "formats/recording/recorded_time.h"

namespace dance {
namespace {

// Of poses whose own were left out of the file.
constexpr std::uint64_t kFileClockId = 1;

// Ranks our messages: transforms come before the rest of their pose.
std::optional<std::uint8_t> rank_of(const McapMessage& message) {
  if (message.encoding != "json" || message.topic == kStageTopic) return std::nullopt;
  const std::array schemas{kFrameTransformsSchema.name, kPoseSchema.name, kHandsSchema.name,
                           kBeatSchema.name};
  const auto* const found = std::find(schemas.begin(), schemas.end(), message.schema);
  if (found == schemas.end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - schemas.begin());
}

}  // namespace

Result<DanceMcapReader> DanceMcapReader::open(const std::string& path) {
  DANCE_TRY(McapReader reader, McapReader::open(path));
  return DanceMcapReader(std::move(reader), path);
}

Result<DanceMcapReader> DanceMcapReader::over(std::span<const std::uint8_t> bytes) {
  DANCE_TRY(McapReader reader, McapReader::over(bytes));
  return DanceMcapReader(std::move(reader), "the file");
}

Result<void> DanceMcapReader::read_into(RecordingSink& sink) {
  const auto read =
      read_by_time(reader_, rank_of, [&](const McapMessage& message) { take(message, sink); });
  if (!read) return fail(name_ + ": " + read.error().what);
  was_sorted_ = *read;
  for (Guest& guest : guests_) tell_pending(guest, sink);
  if (auto ended = reader_.ended(); !ended) return ended;
  if (counters_.poses == 0)
    return fail(name_ + ": nobody dances in it; dance convert reads MCAP files that dance wrote");
  return {};
}

// The guest of "/guest/<id><end>"; nullptr for other topics.
DanceMcapReader::Guest* DanceMcapReader::guest_of(std::string_view topic, std::string_view end) {
  if (!topic.starts_with(kGuestTopic) || !topic.ends_with(end) ||
      topic.size() <= kGuestTopic.size() + end.size())
    return nullptr;
  topic.remove_prefix(kGuestTopic.size());
  topic.remove_suffix(end.size());
  const auto id = GuestId::parse(topic);
  if (!id) return nullptr;
  const auto found = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const Guest& each) { return each.id == *id; });
  if (found != guests_.end()) return &*found;
  if (guests_.size() >= kMostGuests) {
    ++counters_.beyond_guests;
    return nullptr;
  }
  guests_.emplace_back();
  guests_.back().id = *id;
  guests_.back().skeleton = guests_.back().told = average_skeleton();
  return &guests_.back();
}

void DanceMcapReader::take(const McapMessage& message, RecordingSink& sink) {
  const auto time_us = static_cast<std::int64_t>(message.log_ns / 1000u);
  if (message.data.size() > kMostMessage_bytes || !is_recorded_time(time_us)) {
    ++counters_.unreadable;
    return;
  }
  const auto json = nlohmann::json::parse(message.data, nullptr, false);
  if (json.is_discarded()) {
    ++counters_.unreadable;
    return;
  }
  if (message.schema == kBeatSchema.name) {
    Beat beat;
    if (!read_beat_json(json, beat))
      ++counters_.unreadable;
    else if (!is_valid(beat))
      ++counters_.invalid;
    else
      sink.on_beat(beat, time_us);
  } else if (message.schema == kFrameTransformsSchema.name) {
    if (Guest* guest = guest_of(message.topic, kTransformsTopic))
      take_transforms(*guest, json, time_us, sink);
  } else if (message.schema == kPoseSchema.name) {
    if (Guest* guest = guest_of(message.topic, kPoseTopic)) take_pose(*guest, json, time_us, sink);
  } else if (const Guest* guest = guest_of(message.topic, kHandsTopic)) {
    Hands hands;
    if (!read_hands_json(json, hands)) {
      ++counters_.unreadable;
    } else if (!is_valid(hands)) {
      ++counters_.invalid;
    } else {
      normalize(hands);
      sink.on_hands(guest->id, hands, time_us);
    }
  }
}

void DanceMcapReader::take_transforms(Guest& guest, const nlohmann::json& json,
                                      std::int64_t time_us, RecordingSink& sink) {
  tell_pending(guest, sink);
  Skeleton skeleton = guest.skeleton;
  if (!read_transforms_json(json, guest.id.view(), guest.pose, skeleton)) {
    ++counters_.unreadable;
    return;
  }
  if (!is_valid(skeleton)) {
    ++counters_.invalid;
    return;
  }
  guest.skeleton = skeleton;
  guest.time_us = time_us;
  guest.pose.sequence = guest.next_sequence;
  guest.pose.clock_id = kFileClockId;
  guest.pose.capture_time = MonoTime::from_us(time_us);
  guest.pose.presence = kAllBones;
  guest.pose.confidence = 1.0f;
  guest.pose.music_beats = kNoMusic;
  guest.is_pending = true;
}

void DanceMcapReader::take_pose(Guest& guest, const nlohmann::json& json, std::int64_t time_us,
                                RecordingSink& sink) {
  if (!guest.is_pending || guest.time_us != time_us) {
    ++counters_.without_transforms;
    return;
  }
  Pose pose = guest.pose;
  Skeleton skeleton = guest.skeleton;
  float hips_height_m = 0.0f;
  if (!read_pose_json(json, pose, hips_height_m)) {
    ++counters_.unreadable;
    return;
  }
  skeleton.offset_m[0] = {0.0f, hips_height_m, 0.0f};
  if (!is_valid(skeleton)) {
    guest.is_pending = false;
    ++counters_.invalid;
    return;
  }
  guest.pose = pose;
  guest.skeleton = skeleton;
  tell(guest, sink);
}

void DanceMcapReader::tell_pending(Guest& guest, RecordingSink& sink) {
  if (!guest.is_pending) return;
  ++counters_.bare;
  tell(guest, sink);
}

void DanceMcapReader::tell(Guest& guest, RecordingSink& sink) {
  guest.is_pending = false;
  if (!is_valid(guest.pose)) {
    ++counters_.invalid;
    return;
  }
  normalize(guest.pose);
  guest.next_sequence = guest.pose.sequence + 1;
  if (!guest.has_skeleton || !(guest.told == guest.skeleton)) {
    guest.has_skeleton = true;
    guest.told = guest.skeleton;
    sink.on_skeleton(guest.id, guest.skeleton, guest.time_us);
  }
  sink.on_pose(guest.id, guest.pose, guest.time_us);
  ++counters_.poses;
}

}  // namespace dance
