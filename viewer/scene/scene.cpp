#include "viewer/scene/scene.h"

#include "viewer/scene/figure_stature.h"

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kTagAboveHead_m = 0.14f;
constexpr float kRoomForTag_m = 0.10f;
}  // namespace

VoiceMark mark_of(const SceneVoice& voice) {
  if (voice.is_deafened) return VoiceMark::kDeafened;
  if (voice.is_muted) return VoiceMark::kMuted;
  if (!voice.has_microphone) return VoiceMark::kNoMicrophone;
  if (!voice.is_push_to_talk) return VoiceMark::kNone;
  return voice.is_heard ? VoiceMark::kTalking : VoiceMark::kWaiting;
}

void append_outline(const SceneGuest& guest, std::vector<Vector3f>& points_W_m) {
  BodyFrames frames;
  figure_frames(guest, frames);
  points_W_m.insert(points_W_m.end(), frames.p_WB_m.begin(), frames.p_WB_m.end());
  points_W_m.insert(points_W_m.end(), frames.p_WT_m.begin(), frames.p_WT_m.end());
  points_W_m.push_back(frames.tip(Tip::kHead) +
                       Vector3f(0.0f, kTagAboveHead_m + kRoomForTag_m, 0.0f));
}

Vector3f tag_anchor_W_m(const SceneGuest& guest) {
  BodyFrames frames;
  figure_frames(guest, frames);
  return tag_anchor_W_m(frames);
}

Vector3f tag_anchor_W_m(const BodyFrames& figure) {
  return figure.tip(Tip::kHead) + Vector3f(0.0f, kTagAboveHead_m, 0.0f);
}

Vector3f face_W_m(const SceneGuest& guest) {
  BodyFrames frames;
  figure_frames(guest, frames);
  return 0.5f * (frames.position(Bone::kHead) + frames.tip(Tip::kHead));
}

Vector3f facing_W(const SceneGuest& guest) {
  Vector3f facing = guest.pose.R_PB[index_of(Bone::kHips)] * Vector3f::UnitZ();
  facing.y() = 0.0f;
  return facing.squaredNorm() > 1e-6f ? Vector3f(facing.normalized()) : Vector3f::UnitZ();
}

}  // namespace dance
