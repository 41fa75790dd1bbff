#include "core/bus/encode.h"

#include <dancelcm/all_types.hpp>

#include "core/bus/message_fields.h"

// lcm-gen takes only literal sizes: io() of an array ties each to the code.
namespace dance {
namespace {

template <class Io>
bool map_stamp(Io io, auto& m, auto& v) {
  return io(m.time_us, v.time) && io(m.clock_id, v.clock_id);
}

template <class Io>
bool map_pose(Io io, auto& m, auto& captured, auto& hops, auto& pose) {
  return io(m.capture_time_us, captured) && io(m.hop_time_us, hops) &&
         io(m.clock_id, pose.clock_id) && io(m.sequence, pose.sequence) &&
         io(m.presence, pose.presence) && io(m.rotation_xyzw, pose.R_PB) &&
         io(m.hips_m, pose.p_WH_m) && io(m.confidence, pose.confidence) &&
         io(m.music_beats, pose.music_beats);
}

template <class Io>
bool map_hands(Io io, auto& m, auto& captured, auto& hands) {
  return io(m.capture_time_us, captured) && io(m.clock_id, hands.clock_id) &&
         io(m.sequence, hands.sequence) && io(m.presence, hands.presence) &&
         io(m.rotation_xyzw, hands.R_PB);
}

}  // namespace

template <>
struct MessageFields<Pose> {
  using Generated = dancelcm::pose_t;
  static bool map(auto io, auto& m, auto& v) { return map_pose(io, m, v.capture_time, v.hops, v); }
  static void mask(Pose& pose) { pose.presence &= kAllBones; }
};

template <>
struct MessageFields<Hands> {
  using Generated = dancelcm::hands_t;
  static bool map(auto io, auto& m, auto& v) { return map_hands(io, m, v.capture_time, v); }
  static void mask(Hands& hands) { hands.presence &= (1u << kFingerBoneCount) - 1; }
};

template <>
struct MessageFields<Face> {
  using Generated = dancelcm::face_t;
  static bool map(auto io, auto& m, auto& v) {
    return io(m.capture_time_us, v.capture_time) && io(m.clock_id, v.clock_id) &&
           io(m.sequence, v.sequence) && io(m.presence, v.presence) && io(m.weight, v.weight) &&
           io(m.head_xyzw, v.R_PB) && io(m.gaze_rad, v.gaze_rad);
  }
  static void mask(Face& face) { face.presence &= kFaceSeen | kGazeSeen; }
};

template <>
struct MessageFields<TimedSkeleton> {
  using Generated = dancelcm::skeleton_t;
  static bool map(auto io, auto& m, auto& v) {
    return io(m.capture_time_us, v.capture_time) && io(m.clock_id, v.clock_id) &&
           io(m.version, v.skeleton.version) && io(m.offset_m, v.skeleton.offset_m) &&
           io(m.tip_m, v.skeleton.tip_m);
  }
};

template <>
struct MessageFields<GuestStatus> {
  using Generated = dancelcm::guest_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.alive, v.alive) && io(m.remote, v.remote) &&
           io(m.arrival_hz, v.arrival_hz) && io(m.stage_hz, v.stage_hz) &&
           io(m.age_p50_ms, v.age_p50_ms) && io(m.age_p99_ms, v.age_p99_ms) &&
           io(m.received, v.received) && io(m.lost, v.lost);
  }
};

template <>
struct MessageFields<Stats> {
  using Generated = dancelcm::stats_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.uptime_us, v.uptime) && io(m.received, v.received) &&
           io(m.forwarded, v.forwarded) && io(m.superseded, v.superseded) &&
           io(m.dropped_late, v.dropped_late) && io(m.dropped_invalid, v.dropped_invalid) &&
           io(m.dropped_unrouted, v.dropped_unrouted) &&
           io(m.dropped_overflow, v.dropped_overflow) && io(m.lost, v.lost) &&
           io(m.bytes_in, v.bytes_in) && io(m.bytes_out, v.bytes_out) &&
           io(m.datagrams_in, v.datagrams_in) && io(m.datagrams_out, v.datagrams_out) &&
           io(m.rejected_datagrams, v.rejected_datagrams) && io(m.guests, v.guests) &&
           io(m.sessions, v.sessions) && io(m.reconnects, v.reconnects) &&
           io(m.round_trip_us, v.round_trip) && io(m.clock_offset_us, v.clock_offset) &&
           io(m.lateness_p99_us, v.lateness_p99);
  }
};

template <>
struct MessageFields<StageTime> {
  using Generated = dancelcm::stage_time_t;
  static bool map(auto io, auto& m, auto& v) {
    return io(m.clock_id, v.clock_id) && io(m.sequence, v.sequence) &&
           io(m.capture_time_us, v.capture_time) && io(m.hop_time_us, v.hops) &&
           io(m.heard_time_us, v.heard_time) && io(m.swap_time_us, v.swap_time);
  }
};

template <>
struct MessageFields<Music> {
  using Generated = dancelcm::music_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.start_time_us, v.start_time) &&
           io(m.start_beats, v.start_beats) && io(m.tempo_bpm, v.tempo_bpm) &&
           io(m.beats_per_bar, v.beats_per_bar) && io(m.playing, v.playing) && io(m.title, v.title);
  }
};

template <>
struct MessageFields<RoomSong> {
  using Generated = dancelcm::song_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.start_time_us, v.start_time) &&
           io(m.start_beat, v.start_beat) && io(m.seed, v.seed) && io(m.style, v.style) &&
           io(m.playing, v.playing) && io(m.locked, v.locked) && io(m.tempo_count, v.tempo_count) &&
           io(m.tempo_bar, v.tempo_bar) && io(m.tempo_centi_bpm, v.tempo_centi_bpm);
  }
};

template <>
struct MessageFields<Scene> {
  using Generated = dancelcm::scene_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.name, v.name) && io(m.floor_width_m, v.floor_width_m) &&
           io(m.floor_depth_m, v.floor_depth_m) && io(m.light_rgb, v.light_rgb) &&
           io(m.brightness, v.brightness) && io(m.pulse, v.pulse);
  }
};

template <>
struct MessageFields<Avatar> {
  using Generated = dancelcm::avatar_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.name, v.name) && io(m.colour_rgb, v.colour_rgb) &&
           io(m.height_scale, v.height_scale);
  }
};

template <>
struct MessageFields<AvatarFile> {
  using Generated = dancelcm::avatar_file_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.sha256, v.hash.bytes) && io(m.size_bytes, v.size_bytes) &&
           io(m.name, v.name);
  }
};

template <>
struct MessageFields<Style> {
  using Generated = dancelcm::style_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.gain, v.gain) && io(m.periodic, v.periodic) &&
           io(m.dynamic, v.dynamic);
  }
};

template <>
struct MessageFields<Placement> {
  using Generated = dancelcm::placement_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.x_m, v.x_m) && io(m.z_m, v.z_m) &&
           io(m.heading_rad, v.heading_rad);
  }
};

template <>
struct MessageFields<Beat> {
  using Generated = dancelcm::beat_t;
  static bool map(auto io, auto& m, auto& v) {
    // A clock that is fed with a beat far ahead would count the music as playing until then.
    constexpr Duration kFarthestBeat = Duration::s(60);
    return map_stamp(io, m, v) && io(m.beat_time_us, v.beat_time) && io(m.beat, v.beat) &&
           io(m.tempo_bpm, v.tempo_bpm) && io(m.confidence, v.confidence) &&
           io(m.beats_per_bar, v.beats_per_bar) && io(m.playing, v.playing) &&
           v.beat_time - v.time <= kFarthestBeat && v.time - v.beat_time <= kFarthestBeat;
  }
};

template <>
struct MessageFields<GuestStats> {
  using Generated = dancelcm::guest_stats_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.gap_p50_ms, v.gap_p50_ms) &&
           io(m.gap_p99_ms, v.gap_p99_ms) && io(m.newest_p50_ms, v.newest_p50_ms) &&
           io(m.newest_p99_ms, v.newest_p99_ms) && io(m.age_p50_ms, v.age_p50_ms) &&
           io(m.age_p99_ms, v.age_p99_ms) && io(m.arrival_hz, v.arrival_hz) &&
           io(m.stage_hz, v.stage_hz) && io(m.shown_hz, v.shown_hz) &&
           io(m.jitter_ms, v.jitter_ms) && io(m.loss_percent, v.loss_percent) &&
           io(m.horizon_p50_ms, v.horizon_p50_ms) && io(m.horizon_p99_ms, v.horizon_p99_ms) &&
           io(m.error_mean_mm, v.error_mean_mm) && io(m.error_p95_mm, v.error_p95_mm) &&
           io(m.hips_error_mm, v.hips_error_mm) && io(m.beat_ms, v.beat_ms) &&
           io(m.beat_share, v.beat_share) && io(m.bytes_per_second, v.bytes_per_second) &&
           io(m.bytes_per_pose, v.bytes_per_pose) && io(m.received, v.received) &&
           io(m.lost, v.lost) && io(m.late, v.late) && io(m.superseded, v.superseded);
  }
};

template <>
struct MessageFields<GuestTraffic> {
  using Generated = dancelcm::guest_traffic_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.bytes, v.bytes) && io(m.received, v.received) &&
           io(m.lost, v.lost) && io(m.late, v.late) && io(m.duplicate, v.duplicate) &&
           io(m.invalid, v.invalid) && io(m.reference_missing, v.reference_missing) &&
           io(m.key_frames_asked, v.key_frames_asked);
  }
};

template <>
struct MessageFields<FlowSetting> {
  using Generated = dancelcm::flow_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.has, v.has) && io(m.on, v.on) && io(m.own, v.own) &&
           io(m.route, v.route) && io(m.hold_ms, v.hold_ms) && io(m.lead, v.lead) &&
           io(m.reach_ms, v.reach_ms) && io(m.rhythm_beats, v.rhythm_beats) &&
           io(m.rhythm_count, v.rhythm_count) && io(m.rhythm_strength, v.rhythm_strength) &&
           io(m.rhythm_error_mm, v.rhythm_error_mm) && io(m.gain, v.gain) &&
           io(m.periodic, v.periodic) && io(m.dynamic, v.dynamic) &&
           io(m.guest_gain, v.guest_gain) && io(m.guest_periodic, v.guest_periodic) &&
           io(m.guest_dynamic, v.guest_dynamic);
  }
};

template <>
struct MessageFields<Playout> {
  using Generated = dancelcm::playout_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.reason, v.reason) && io(m.beats, v.beats) &&
           io(m.delay_ms, v.delay_ms) && io(m.ahead_ms, v.ahead_ms) && io(m.error_mm, v.error_mm) &&
           io(m.limit_mm, v.limit_mm) && io(m.partner_share, v.partner_share) &&
           io(m.partner, v.partner);
  }
};

template <>
struct MessageFields<Steps> {
  using Generated = dancelcm::steps_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.tempo_bpm, v.tempo_bpm) && io(m.weight, v.weight) &&
           io(m.dancers, v.dancers) && io(m.is_remote, v.is_remote);
  }
};

template <>
struct MessageFields<Voice> {
  using Generated = dancelcm::voice_t;
  static bool map(auto io, auto& m, auto& v) {
    return io(m.capture_time_us, v.capture_time) && io(m.clock_id, v.clock_id) &&
           io(m.sequence, v.sequence) && io(m.level_dbfs, v.level_dbfs) &&
           io(m.size_bytes, v.size_bytes) && io(m.data, v.data);
  }
};

template <>
struct MessageFields<Touch> {
  using Generated = dancelcm::touch_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.contact, v.contact) && io(m.phase, v.phase) &&
           io(m.is_hold, v.is_hold) && io(m.bone, v.bone) && io(m.other_bone, v.other_bone) &&
           io(m.depth_m, v.depth_m) && io(m.force_n, v.force_n) &&
           io(m.approach_m_s, v.approach_m_s) && io(m.motion_m_s, v.motion_m_s) &&
           io(m.place_m, v.place_m) && io(m.other, v.other);
  }
};

template <>
struct MessageFields<Haptic> {
  using Generated = dancelcm::haptic_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.maker, v.maker) && io(m.play_time_us, v.play_time) &&
           io(m.duration_us, v.duration) && io(m.attack_us, v.attack) &&
           io(m.release_us, v.release) && io(m.number, v.number) && io(m.source, v.source) &&
           io(m.bone, v.bone) && io(m.amplitude, v.amplitude) && io(m.frequency_hz, v.frequency_hz);
  }
};

template <>
struct MessageFields<HearingWish> {
  using Generated = dancelcm::hearing_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.listener, v.listener) &&
           io(m.hears_others, v.hears_others) && io(m.guests, v.guests);
  }
};

template <>
struct MessageFields<VoiceState> {
  using Generated = dancelcm::voice_state_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.is_muted, v.is_muted) && io(m.is_deafened, v.is_deafened) &&
           io(m.is_push_to_talk, v.is_push_to_talk) && io(m.is_heard, v.is_heard) &&
           io(m.has_microphone, v.has_microphone) && io(m.has_loudspeaker, v.has_loudspeaker);
  }
};

template <>
struct MessageFields<HouseLink> {
  using Generated = dancelcm::house_link_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.state, v.state) && io(m.trouble, v.trouble) &&
           io(m.refusal, v.refusal) && io(m.refused, v.refused) &&
           io(m.asks_again_us, v.asks_again) && io(m.may_remove, v.may_remove) &&
           io(m.removal, v.removal) && io(m.verdict, v.verdict);
  }
};

template <>
struct MessageFields<Removal> {
  using Generated = dancelcm::removal_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.number, v.number) && io(m.guest, v.guest);
  }
};

template <>
struct MessageFields<VoiceLevel> {
  using Generated = dancelcm::voice_level_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.level_dbfs, v.level_dbfs) &&
           io(m.cleaned_dbfs, v.cleaned_dbfs);
  }
};

template <>
struct MessageFields<InterestWish> {
  using Generated = dancelcm::interest_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.viewer, v.viewer) && io(m.hidden, v.hidden);
  }
};

template <>
struct MessageFields<Profile> {
  using Generated = dancelcm::profile_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.shown_name, v.shown_name) &&
           io(m.is_recording, v.is_recording) && io(m.is_host, v.is_host);
  }
};

template <>
struct MessageFields<RecordingState> {
  using Generated = dancelcm::recording_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.viewer, v.viewer) && io(m.is_recording, v.is_recording);
  }
};

template <>
struct MessageFields<Chat> {
  using Generated = dancelcm::chat_t;
  static bool map(auto io, auto& m, auto& v) {
    return map_stamp(io, m, v) && io(m.kind, v.kind) && io(m.text, v.text);
  }
};

#define DANCE_INSTANTIATE(Type, kName, word) template struct MessageRow<Type, Signal::kName>;
DANCE_MESSAGE_TABLE(DANCE_INSTANTIATE)
#undef DANCE_INSTANTIATE

std::size_t encode(const RawPose& raw, MessageBuffer& buffer) {
  dancelcm::pose_t m{};
  map_pose(PutFields(), m, raw.capture_time_us, raw.hop_time_us, raw.pose);
  return pack(m, buffer);
}

std::size_t encode(const RawHands& raw, MessageBuffer& buffer) {
  dancelcm::hands_t m{};
  map_hands(PutFields(), m, raw.capture_time_us, raw.hands);
  return pack(m, buffer);
}

bool decode_unchecked(const void* data, std::size_t size, RawPose& raw) {
  dancelcm::pose_t m{};
  return unpack(data, size, m) &&
         map_pose(GetFields(), m, raw.capture_time_us, raw.hop_time_us, raw.pose);
}

bool decode_unchecked(const void* data, std::size_t size, RawHands& raw) {
  dancelcm::hands_t m{};
  return unpack(data, size, m) && map_hands(GetFields(), m, raw.capture_time_us, raw.hands);
}

}  // namespace dance
