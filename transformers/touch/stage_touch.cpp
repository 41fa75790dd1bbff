#include "transformers/touch/stage_touch.h"

#include <algorithm>
#include <cmath>

#include "core/motion/palm_pull.h"
#include "core/pose/heading.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// A guess: soft tissue of 500 N/m, and damping; a held hand is pulled as it is moved.
constexpr float kStiffness_n_m = 500.0f, kDamping_ns_m = 15.0f;
constexpr float kHold_n = 5.0f, kHoldDamping_ns_m = 10.0f;
// Speeds are smoothed over a few pictures.
constexpr float kTouchSpeedPart = 0.35f;
constexpr Duration kTouchGap = Duration::ms(100);

Vector3f bounded_speed(const Vector3f& v, float most) {
  if (!v.allFinite()) return Vector3f::Zero();
  const float size = v.norm();
  return size > most ? Vector3f(v * (most / size)) : v;
}

}  // namespace

struct StageTouch::Contact {
  bool is_touching = false, is_hold = false;
  std::uint32_t number = 0;
  std::size_t bone_a = 0, bone_b = 0;
  float distance_m = 0.0f, approach_m_s = 0.0f;
  Vector3f place = Vector3f::Zero();
  MonoTime told, seen;
};

struct StageTouch::Pair {
  bool is_used = false;
  std::size_t a = 0, b = 0;  // a < b
  MonoTime looked;
  std::array<Contact, kBodyParts * kBodyParts> contacts;
};

struct StageTouch::Dancer {
  GuestId guest;
  Skeleton skeleton = average_skeleton();
  BodyFrames frames;
  BodyCapsules body;
  std::array<Vector3f, kBoneCount> speed_m_s;
  MonoTime shown;
};

struct StageTouch::Found {
  bool is_near = false, is_hold = false;
  std::size_t bone_a = 0, bone_b = 0;
  float distance_m = 0.0f;
  Vector3f place = Vector3f::Zero();
};

struct StageTouch::State {
  std::array<Dancer, kMostDancers> dancers;
  std::array<Pair, kMostPairs> pairs;
};

StageTouch::StageTouch() : state_(std::make_unique<State>()) {
  for (Dancer& dancer : state_->dancers) dancer.speed_m_s.fill(Vector3f::Zero());
}
StageTouch::~StageTouch() = default;

StageTouch::Dancer* StageTouch::place_of(const GuestId& guest, MonoTime now) {
  Dancer* free = nullptr;
  for (Dancer& dancer : state_->dancers) {
    if (dancer.guest == guest) return &dancer;
    if (!dancer.guest.is_set() || now - dancer.shown > kGone * 4)
      if (!free || free->guest.is_set()) free = &dancer;
  }
  if (!free) {
    ++refused_;
    return nullptr;
  }
  *free = Dancer();
  free->speed_m_s.fill(Vector3f::Zero());
  free->guest = guest;
  return free;
}

void StageTouch::set_body(const GuestId& guest, const Skeleton& skeleton) {
  for (Dancer& dancer : state_->dancers)
    if (dancer.guest == guest) dancer.skeleton = skeleton;
}

void StageTouch::show(const GuestId& guest, const Pose& pose, MonoTime now) {
  Dancer* dancer = place_of(guest, now);
  if (!dancer) return;
  BodyFrames frames;
  forward_kinematics(dancer->skeleton, pose, frames);
  const Duration step = now - dancer->shown;
  if (dancer->shown.is_set() && step < kTouchGap) {
    const auto step_s = static_cast<float>(std::max(step, Duration::ms(4)).as_seconds());
    for (std::size_t b = 0; b < kBoneCount; ++b)
      dancer->speed_m_s[b] +=
          kTouchSpeedPart *
          ((frames.p_WB_m[b] - dancer->frames.p_WB_m[b]) / step_s - dancer->speed_m_s[b]);
  } else {
    dancer->speed_m_s.fill(Vector3f::Zero());
  }
  dancer->frames = frames;
  dancer->body = BodyCapsules::of(dancer->skeleton, frames);
  dancer->shown = now;
}

StageTouch::Pair* StageTouch::pair_of(std::size_t a, std::size_t b, MonoTime now) {
  Pair* free = nullptr;
  for (Pair& pair : state_->pairs) {
    if (pair.is_used && pair.a == a && pair.b == b) return &pair;
    if (!pair.is_used && !free) free = &pair;
  }
  if (!free) {
    ++refused_;
    return nullptr;
  }
  *free = Pair();
  free->is_used = true;
  free->a = a;
  free->b = b;
  free->looked = now;
  return free;
}

void StageTouch::update(MonoTime now, std::uint64_t clock_id, const StageHolds& holds,
                        TouchSink& sink) {
  const auto is_here = [&](const Dancer& dancer) {
    return dancer.guest.is_set() && now - dancer.shown <= kGone;
  };
  for (std::size_t b = 1; b < kMostDancers; ++b) {
    const Dancer& second = state_->dancers[b];
    if (!is_here(second)) continue;
    for (std::size_t a = 0; a < b; ++a) {
      const Dancer& first = state_->dancers[a];
      if (!is_here(first)) continue;
      const Vector3f apart = first.frames.p_WB_m[0] - second.frames.p_WB_m[0];
      if (!(apart.squaredNorm() < kNear_m * kNear_m)) continue;
      if (Pair* pair = pair_of(a, b, now)) look(*pair, now, clock_id, holds, sink);
    }
  }
  // Who has left, or went away, touches nobody.
  for (Pair& pair : state_->pairs)
    if (pair.is_used && pair.looked != now) end(pair, now, clock_id, sink);
}

void StageTouch::look(Pair& pair, MonoTime now, std::uint64_t clock_id, const StageHolds& holds,
                      TouchSink& sink) {
  const Dancer &a = state_->dancers[pair.a], &b = state_->dancers[pair.b];
  pair.looked = now;
  // Of each two parts the bones that are deepest in each other.
  std::array<Found, kBodyParts * kBodyParts> found;
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const Capsule& one = a.body.of_bone[i];
    const Vector3f middle = 0.5f * (one.from + one.to);
    const float reach = 0.5f * (one.to - one.from).norm() + one.radius_m + kParts_m;
    for (std::size_t k = 0; k < kBoneCount; ++k) {
      const Capsule& two = b.body.of_bone[k];
      const float far = reach + 0.5f * (two.to - two.from).norm() + two.radius_m;
      if (!((middle - 0.5f * (two.from + two.to)).squaredNorm() < far * far)) continue;
      const Nearness near = nearness_of(one, two);
      Found& slot = found[kBodyParts * static_cast<std::size_t>(part_of(static_cast<Bone>(i))) +
                          static_cast<std::size_t>(part_of(static_cast<Bone>(k)))];
      if (!(near.distance_m < kParts_m) || (slot.is_near && slot.distance_m <= near.distance_m))
        continue;
      slot = {true, false, i, k, near.distance_m, near.place};
    }
  }
  constexpr std::array<BodyPart, 2> kHands{BodyPart::kHandL, BodyPart::kHandR};
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t other = 0; other < 2; ++other) {
      if (!holds.are_held(a.guest, side, b.guest, other)) continue;
      const Vector3f p = palm_of(a.skeleton, a.frames, side),
                     q = palm_of(b.skeleton, b.frames, other);
      found[kBodyParts * static_cast<std::size_t>(kHands[side]) +
            static_cast<std::size_t>(kHands[other])] = {
          true,           true,          index_of(kHandBones[side]), index_of(kHandBones[other]),
          (p - q).norm(), 0.5f * (p + q)};
    }
  for (std::size_t slot = 0; slot < found.size(); ++slot)
    follow(pair, slot, found[slot], now, clock_id, sink);
}

void StageTouch::follow(Pair& pair, std::size_t slot, const Found& found, MonoTime now,
                        std::uint64_t clock_id, TouchSink& sink) {
  Contact& contact = pair.contacts[slot];
  if (!found.is_near) {
    if (contact.is_touching) tell(pair, contact, TouchPhase::kEnded, now, clock_id, sink);
    contact = Contact();
    return;
  }
  const bool begins = !contact.is_touching && (found.is_hold || found.distance_m < 0.0f);
  const bool was_seen =
      contact.seen.is_set() && now - contact.seen < kTouchGap && contact.is_hold == found.is_hold;
  if (was_seen && now > contact.seen) {
    const auto step_s = static_cast<float>((now - contact.seen).as_seconds());
    contact.approach_m_s +=
        kTouchSpeedPart * ((contact.distance_m - found.distance_m) / step_s - contact.approach_m_s);
  } else {
    contact.approach_m_s = 0.0f;
  }
  contact.seen = now;
  contact.distance_m = found.distance_m;
  contact.place = found.place;
  contact.bone_a = found.bone_a;
  contact.bone_b = found.bone_b;
  const bool changes = contact.is_touching && contact.is_hold != found.is_hold;
  contact.is_hold = found.is_hold;
  if (begins) {
    contact.is_touching = true;
    contact.number = ++contacts_;
    contact.told = now;
    tell(pair, contact, TouchPhase::kBegins, now, clock_id, sink);
  } else if (contact.is_touching && (changes || now - contact.told >= kTold)) {
    contact.told = now;
    tell(pair, contact, TouchPhase::kLasts, now, clock_id, sink);
  }
}

void StageTouch::tell(const Pair& pair, const Contact& contact, TouchPhase phase, MonoTime now,
                      std::uint64_t clock_id, TouchSink& sink) const {
  const Dancer* both[2] = {&state_->dancers[pair.a], &state_->dancers[pair.b]};
  const std::size_t bones[2] = {contact.bone_a, contact.bone_b};
  for (std::size_t d = 0; d < 2; ++d) {
    const Dancer &own = *both[d], &other = *both[1 - d];
    Touch touch;
    touch.time = now;
    touch.clock_id = clock_id;
    touch.contact = contact.number;
    touch.phase = phase;
    touch.is_hold = contact.is_hold;
    touch.bone = static_cast<Bone>(bones[d]);
    touch.other_bone = static_cast<Bone>(bones[1 - d]);
    touch.other = other.guest;
    const float depth = contact.is_hold ? contact.distance_m : -contact.distance_m;
    touch.depth_m = std::clamp(depth, 0.0f, Touch::kMostDepth_m);
    touch.approach_m_s =
        std::clamp(contact.approach_m_s, -Touch::kMostSpeed_m_s, Touch::kMostSpeed_m_s);
    const Vector3f moves = other.speed_m_s[bones[1 - d]] - own.speed_m_s[0];
    touch.motion_m_s = bounded_speed(about_up(heading_rad(own.frames.R_WB[0])).conjugate() * moves,
                                     Touch::kMostSpeed_m_s);
    touch.place_m = contact.place;
    const float force = contact.is_hold ? kHold_n + kHoldDamping_ns_m * touch.motion_m_s.norm()
                                        : kStiffness_n_m * touch.depth_m +
                                              kDamping_ns_m * std::max(0.0f, touch.approach_m_s);
    touch.force_n = std::clamp(force, 0.0f, Touch::kMostForce_n);
    sink.on_touch(own.guest, touch);
  }
}

void StageTouch::end(Pair& pair, MonoTime now, std::uint64_t clock_id, TouchSink& sink) {
  for (Contact& contact : pair.contacts)
    if (contact.is_touching) tell(pair, contact, TouchPhase::kEnded, now, clock_id, sink);
  pair.is_used = false;
}

}  // namespace dance
