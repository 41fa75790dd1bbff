#include "viewer/figure/face/living_face.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "viewer/figure/face/blink.h"
#include "viewer/figure/face/gaze.h"
#include "viewer/figure/face/guest_noise.h"
#include "viewer/figure/face/smile.h"

namespace dance {
namespace {

using Eigen::Vector2f;

constexpr float kGazeTakes_s = 0.06f;
constexpr float kSmileTakes_s = 0.8f;
constexpr float kMouthOpens_s = 0.035f, kMouthCloses_s = 0.09f;
// ARKit's weights are 1 at about this turn of an eye.
constexpr float kFullLook_rad = 0.6f;
// Upper lids go down with eyes that look down by more than a saccade.
constexpr float kLidFollows = 0.45f;
constexpr float kLidBegins_rad = 0.06f;
// Lips change their shape about as fast as syllables.
constexpr std::int64_t kSyllable_ns = 190'000'000;
constexpr std::uint64_t kOpenStream = 5, kRoundStream = 6;

// The share of the way to a target that is covered after that time.
float share_after(float passed_s, float takes_s) { return 1.0f - std::exp(-passed_s / takes_s); }

template <class Value>
void approach(Value& value, const Value& target, float takes_s, const FacePast& past) {
  value += (past.is_known ? share_after(past.passed_s, takes_s) : 1.0f) * (target - value);
}

void look(const SceneGuest& guest, std::span<const DancerView> views, std::size_t self,
          MonoTime time, FacePast& past) {
  if (!past.is_known) past.partner = GuestId();
  const std::size_t partner = find_gaze_partner(views, self, past.partner);
  Vector2f target = Vector2f::Zero();
  past.partner = GuestId();
  if (partner < views.size()) {
    target = limit_gaze(aim_gaze(views[self], views[partner].eyes_W_m));
    past.partner = views[partner].id;
  }
  approach(past.gaze_rad, Vector2f(target + saccade_at(guest.id, time)), kGazeTakes_s, past);
}

void speak(const GuestId& guest, MonoTime time, float loudness, Face& face) {
  using E = Expression;
  const float open = GuestNoise(guest, kOpenStream).drift(time, kSyllable_ns);
  const float round = 2.0f * GuestNoise(guest, kRoundStream).drift(time, kSyllable_ns) - 1.0f;
  face[E::kJawOpen] = loudness * (0.35f + 0.5f * open);
  face[E::kMouthFunnel] = loudness * 0.6f * std::max(0.0f, round);
  face[E::kMouthStretchLeft] = face[E::kMouthStretchRight] =
      loudness * 0.5f * std::max(0.0f, -round);
}

// A headset publishes the gaze only as eyeLook… expressions.
std::optional<Vector2f> captured_gaze(const std::optional<Face>& face) {
  using E = Expression;
  if (!face) return std::nullopt;
  if ((face->presence & kGazeSeen) != 0) return Vector2f(face->gaze_rad[0], face->gaze_rad[1]);
  if ((face->presence & kFaceSeen) == 0) return std::nullopt;
  const auto both = [&](E left, E right) { return 0.5f * ((*face)[left] + (*face)[right]); };
  const Vector2f gaze(
      both(E::kEyeLookOutLeft, E::kEyeLookInRight) - both(E::kEyeLookInLeft, E::kEyeLookOutRight),
      both(E::kEyeLookUpLeft, E::kEyeLookUpRight) -
          both(E::kEyeLookDownLeft, E::kEyeLookDownRight));
  if (gaze.isZero()) return std::nullopt;
  return kFullLook_rad * gaze;
}

}  // namespace

void set_look(const Vector2f& gaze_rad, Face& face) {
  using E = Expression;
  const auto set = [&](E left_eye, E right_eye, float angle) {
    face[left_eye] = face[right_eye] = std::clamp(angle / kFullLook_rad, 0.0f, 1.0f);
  };
  set(E::kEyeLookOutLeft, E::kEyeLookInRight, gaze_rad.x());
  set(E::kEyeLookInLeft, E::kEyeLookOutRight, -gaze_rad.x());
  set(E::kEyeLookUpLeft, E::kEyeLookUpRight, gaze_rad.y());
  set(E::kEyeLookDownLeft, E::kEyeLookDownRight, -gaze_rad.y());
}

Face face_of(const SceneGuest& guest, std::span<const DancerView> views, std::size_t self,
             MonoTime time, FacePast& past) {
  using E = Expression;
  const bool is_captured = guest.face && (guest.face->presence & kFaceSeen) != 0;
  Face face;
  if (is_captured) face = *guest.face;
  if (const auto gaze_rad = captured_gaze(guest.face)) {
    past.gaze_rad = *gaze_rad;
    // A captured gaze without a captured face has no expressions for eyes that look by morphs.
    if (!is_captured) set_look(past.gaze_rad, face);
  } else {
    look(guest, views, self, time, past);
    set_look(past.gaze_rad, face);
  }
  face.gaze_rad = {past.gaze_rad.x(), past.gaze_rad.y()};
  approach(past.smile, smile_towards(views, self, time), kSmileTakes_s, past);
  const bool is_louder = guest.voice > past.loudness;
  approach(past.loudness, guest.voice, is_louder ? kMouthOpens_s : kMouthCloses_s, past);
  if (is_captured) return face;

  speak(guest.id, time, past.loudness, face);
  face[E::kMouthSmileLeft] = face[E::kMouthSmileRight] = past.smile;
  face[E::kCheekSquintLeft] = face[E::kCheekSquintRight] = 0.4f * past.smile;
  const float lowered = kLidFollows * std::clamp((-past.gaze_rad.y() - kLidBegins_rad) /
                                                     (kMostGazeDown_rad - kLidBegins_rad),
                                                 0.0f, 1.0f);
  // A single picture, without one before it, shows open eyes.
  const float blink = past.is_known ? blink_at(guest.id, time) : 0.0f;
  face[E::kEyeBlinkLeft] = face[E::kEyeBlinkRight] = std::max(lowered, blink);
  return face;
}

}  // namespace dance
