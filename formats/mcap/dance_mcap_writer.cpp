#include "formats/mcap/dance_mcap_writer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "formats/mcap/body_shape.h"
#include "formats/mcap/dance_schemas.h"

namespace dance {
namespace {

// The longest text: a body.
constexpr std::size_t kJson_bytes = std::size_t{1} << 16;
constexpr std::size_t kFrames = kBoneCount + kTipCount;

// +Y of the stage is +Z of the world: a quarter turn about x.
constexpr float kHalfRoot = 0.70710678f;

void append_place(JsonText& json, const Eigen::Vector3f& p_m) {
  json.raw(",\"translation\":").xyz(p_m.x(), p_m.y(), p_m.z());
}

void append_frames(JsonText& json, const GuestId& guest, std::string_view parent,
                   std::string_view child) {
  json.raw(",\"parent_frame_id\":\"").raw(guest.view()).raw("/").raw(parent);
  json.raw("\",\"child_frame_id\":\"").raw(guest.view()).raw("/").raw(child).raw("\"");
}

}  // namespace

struct DanceMcapWriter::Guest {
  GuestId id;
  Skeleton skeleton = average_skeleton();
  // Of each transform the part that no pose changes.
  std::array<std::string, kFrames> constant;
  std::uint16_t transforms = 0, body = 0, pose = 0, hands = 0;  // channels
  std::int64_t heard_us = 0;
  bool is_drawn = false;

  void take(const Skeleton& measured) {
    skeleton = measured;
    JsonText json(256);
    for (std::size_t i = 0; i < kFrames; ++i) {
      json.clear();
      if (i == 0) {
        json.raw(",\"parent_frame_id\":").quoted(kStageFrame);
        json.raw(",\"child_frame_id\":\"").raw(id.view()).raw("/hips\"");
      } else if (i < kBoneCount) {
        append_frames(json, id, kBones[static_cast<std::size_t>(kBones[i].parent)].name,
                      kBones[i].name);
        append_place(json, skeleton.offset_m[i]);
      } else {
        const std::size_t tip = i - kBoneCount;
        append_frames(json, id, kBones[index_of(kTipBones[tip])].name, kTipFrames[tip]);
        append_place(json, skeleton.tip_m[tip]);
        json.raw(",\"rotation\":").xyzw(0.0f, 0.0f, 0.0f, 1.0f).raw("}");
      }
      constant[i] = json.view();
    }
  }
};

DanceMcapWriter::DanceMcapWriter(McapWriter::Put put)
    : writer_(std::move(put)), json_(kJson_bytes) {
  const auto add = [this](const DanceSchema& schema) {
    return writer_.add_schema(schema.name, schema.json);
  };
  transforms_schema_ = add(kFrameTransformsSchema);
  scene_schema_ = add(kSceneUpdateSchema);
  pose_schema_ = add(kPoseSchema);
  hands_schema_ = add(kHandsSchema);
  stage_channel_ = writer_.add_channel(transforms_schema_, kStageTopic);
  floor_channel_ = writer_.add_channel(scene_schema_, kFloorTopic);
  beat_channel_ = writer_.add_channel(add(kBeatSchema), kBeatTopic);
  guests_.reserve(kMostGuests);
}

DanceMcapWriter::~DanceMcapWriter() = default;

DanceMcapWriter::Guest* DanceMcapWriter::guest_of(const GuestId& id) {
  for (const auto& guest : guests_)
    if (guest->id == id) return guest.get();
  if (guests_.size() == kMostGuests) {
    ++counters_.beyond_guests;
    return nullptr;
  }
  auto guest = std::make_unique<Guest>();
  guest->id = id;
  const std::string topic = std::string(kGuestTopic) + std::string(id.view());
  const auto add = [&](std::uint16_t schema, std::string_view of) {
    return writer_.add_channel(schema, topic + std::string(of));
  };
  guest->transforms = add(transforms_schema_, kTransformsTopic);
  guest->body = add(scene_schema_, kBodyTopic);
  guest->pose = add(pose_schema_, kPoseTopic);
  guest->hands = add(hands_schema_, kHandsTopic);
  guest->take(guest->skeleton);
  guests_.push_back(std::move(guest));
  return guests_.back().get();
}

bool DanceMcapWriter::is_time(std::int64_t time_us) {
  constexpr std::int64_t kLast_us = std::int64_t{1} << 53;  // the year 2255
  if (time_us >= 0 && time_us < kLast_us) return true;
  ++counters_.before_1970;
  return false;
}

void DanceMcapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns) {
  writer_.write(channel, sequence, time_ns, time_ns, json_.view());
}

void DanceMcapWriter::write_stage(std::uint64_t time_ns) {
  json_.clear();
  json_.raw("{\"transforms\":[{\"timestamp\":").time(time_ns);
  json_.raw(",\"parent_frame_id\":").quoted(kWorldFrame);
  json_.raw(",\"child_frame_id\":").quoted(kStageFrame);
  append_place(json_, Eigen::Vector3f::Zero());
  json_.raw(",\"rotation\":").xyzw(kHalfRoot, 0.0f, 0.0f, kHalfRoot).raw("}]}");
  write(stage_channel_, 0, time_ns);
  json_.clear();
  append_floor(json_, time_ns);
  write(floor_channel_, 0, time_ns);
}

void DanceMcapWriter::write_body(Guest& guest, std::uint64_t time_ns) {
  json_.clear();
  const auto place = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const auto& each) { return each.get() == &guest; });
  append_body(json_, guest.id, guest.skeleton, static_cast<std::size_t>(place - guests_.begin()),
              time_ns);
  write(guest.body, 0, time_ns);
  guest.is_drawn = true;
}

// What does not change with each pose, once a second.
void DanceMcapWriter::write_shapes(std::int64_t time_us) {
  const std::int64_t since_us = time_us - shapes_us_;
  if (has_shapes_ && since_us >= 0 && since_us < kShapesAgain_us) return;
  has_shapes_ = true;
  shapes_us_ = time_us;
  const std::uint64_t time_ns = static_cast<std::uint64_t>(time_us) * 1000u;
  write_stage(time_ns);
  for (const auto& guest : guests_) {
    if (!guest->is_drawn) continue;
    if (time_us - guest->heard_us < kSilence_us) {
      write_body(*guest, time_ns);
    } else {
      json_.clear();
      append_no_body(json_, time_ns);
      write(guest->body, 0, time_ns);
      guest->is_drawn = false;
    }
  }
}

void DanceMcapWriter::on_skeleton(const GuestId& guest, const Skeleton& skeleton,
                                  std::int64_t time_us) {
  Guest* of = guest_of(guest);
  if (!of || of->skeleton == skeleton) return;
  of->take(skeleton);
  if (of->is_drawn && is_time(time_us))
    write_body(*of, static_cast<std::uint64_t>(time_us) * 1000u);
}

void DanceMcapWriter::write_transforms(const Guest& guest, const Pose& pose,
                                       std::uint64_t time_ns) {
  json_.clear();
  json_.raw("{\"transforms\":[");
  JsonText& json = json_;
  for (std::size_t i = 0; i < kFrames; ++i) {
    json.raw(i > 0 ? ",{\"timestamp\":" : "{\"timestamp\":").time(time_ns).raw(guest.constant[i]);
    if (i == 0) append_place(json, pose.p_WH_m);
    if (i >= kBoneCount) continue;
    const Eigen::Quaternionf& R = pose.R_PB[i];
    json.raw(",\"rotation\":").xyzw(R.x(), R.y(), R.z(), R.w()).raw("}");
  }
  json.raw("]}");
  write(guest.transforms, pose.sequence, time_ns);
}

void DanceMcapWriter::write_pose(const Guest& guest, const Pose& pose, std::uint64_t time_ns) {
  json_.clear();
  json_.raw("{\"guest\":").quoted(guest.id.view()).raw(",\"sequence\":").number(pose.sequence);
  json_.raw(",\"clock_id\":\"").number(pose.clock_id).raw("\",\"capture_time_us\":");
  json_.number(pose.capture_time.since_zero_us()).raw(",\"presence\":").number(pose.presence);
  json_.raw(",\"confidence\":").number(pose.confidence).raw(",\"music_beats\":");
  if (std::isfinite(pose.music_beats))
    json_.number(pose.music_beats);
  else
    json_.raw("null");
  json_.raw(",\"hips_height_m\":").number(guest.skeleton.hips_height_m()).raw("}");
  write(guest.pose, pose.sequence, time_ns);
}

void DanceMcapWriter::on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) {
  Guest* of = guest_of(guest);
  if (!of || !is_time(time_us)) return;
  of->heard_us = time_us;
  write_shapes(time_us);
  const std::uint64_t time_ns = static_cast<std::uint64_t>(time_us) * 1000u;
  if (!of->is_drawn) write_body(*of, time_ns);
  write_transforms(*of, pose, time_ns);
  write_pose(*of, pose, time_ns);
  ++counters_.poses;
}

void DanceMcapWriter::on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) {
  const Guest* of = guest_of(guest);
  if (!of || !is_time(time_us)) return;
  json_.clear();
  json_.raw("{\"guest\":").quoted(guest.view()).raw(",\"sequence\":").number(hands.sequence);
  json_.raw(",\"clock_id\":\"").number(hands.clock_id).raw("\",\"capture_time_us\":");
  json_.number(hands.capture_time.since_zero_us()).raw(",\"presence\":").number(hands.presence);
  json_.raw(",\"rotations_xyzw\":[");
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    json_.raw(i > 0 ? ",[" : "[").number(hands.R_PB[i].x()).raw(",").number(hands.R_PB[i].y());
    json_.raw(",").number(hands.R_PB[i].z()).raw(",").number(hands.R_PB[i].w()).raw("]");
  }
  json_.raw("]}");
  write(of->hands, hands.sequence, static_cast<std::uint64_t>(time_us) * 1000u);
  ++counters_.hands;
}

void DanceMcapWriter::on_beat(const Beat& beat, std::int64_t time_us) {
  if (!is_time(time_us)) return;
  json_.clear();
  json_.raw("{\"time_us\":").number(beat.time.since_zero_us()).raw(",\"clock_id\":\"");
  json_.number(beat.clock_id).raw("\",\"beat_time_us\":").number(beat.beat_time.since_zero_us());
  json_.raw(",\"beat\":").number(beat.beat).raw(",\"tempo_bpm\":").number(beat.tempo_bpm);
  json_.raw(",\"beats_per_bar\":").number(beat.beats_per_bar).raw(",\"confidence\":");
  json_.number(beat.confidence).raw(beat.playing ? ",\"playing\":true}" : ",\"playing\":false}");
  write(beat_channel_, 0, static_cast<std::uint64_t>(time_us) * 1000u);
  ++counters_.beats;
}

}  // namespace dance
