#include "transformers/touch/stage_touch.h"

#include <algorithm>
#include <cmath>

#include "core/motion/palm_pull.h"
#include "core/pose/heading.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// An estimate: soft tissue of 500 N/m, and damping; a held hand is pulled as it is moved.
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
  GuestId guest_a, guest_b;
  MonoTime looked;
  std::array<Contact, kBodyParts * kBodyParts> contacts;
};

struct StageTouch::Dancer : StagePlace {
  Skeleton skeleton = average_skeleton();
  BodyFrames frames;
  BodyCapsules body;
  float radius_m = 0.0f;  // of all of the body, about the hips
  std::array<Vector3f, kBoneCount> speed_m_s;
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

StageTouch::Dancer* StageTouch::place_of(const GuestId& guest, const Pose& pose, MonoTime now,
                                         DancerOf of) {
  for (Dancer& dancer : state_->dancers)
    if (dancer.guest == guest) return &dancer;
  Dancer* place = find_place(state_->dancers, of, pose.p_WH_m, now, kGone);
  if (!place) {
    ++refused_;
    return nullptr;
  }
  *place = Dancer();
  place->speed_m_s.fill(Vector3f::Zero());
  place->guest = guest;
  return place;
}

void StageTouch::set_body(const GuestId& guest, const Skeleton& skeleton) {
  for (Dancer& dancer : state_->dancers)
    if (dancer.guest == guest) dancer.skeleton = skeleton;
}

void StageTouch::show(const GuestId& guest, const Pose& pose, MonoTime now, DancerOf of) {
  Dancer* dancer = place_of(guest, pose, now, of);
  if (!dancer) return;
  dancer->of = of;
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
  dancer->p_WH_m = frames.p_WB_m[0];
  dancer->body = BodyCapsules::of(dancer->skeleton, frames);
  dancer->radius_m = 0.0f;
  for (const Capsule& bone : dancer->body.of_bone)
    for (const Vector3f& end : {bone.from, bone.to})
      dancer->radius_m = std::max(dancer->radius_m, (end - dancer->p_WH_m).norm() + bone.radius_m);
  dancer->shown = now;
}

StageTouch::Pair* StageTouch::pair_of(std::size_t a, std::size_t b, bool wants_one) {
  const GuestId &first = state_->dancers[a].guest, &second = state_->dancers[b].guest;
  Pair* free = nullptr;
  for (Pair& pair : state_->pairs) {
    const bool is_it = pair.is_used && pair.a == a && pair.b == b;
    if (is_it && pair.guest_a == first && pair.guest_b == second) return &pair;
    if (!pair.is_used && !free) free = &pair;
  }
  if (!wants_one) return nullptr;
  if (!free) {
    ++refused_;
    return nullptr;
  }
  *free = Pair();
  free->is_used = true;
  free->a = a;
  free->b = b;
  free->guest_a = first;
  free->guest_b = second;
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
      // What two others do to each other is felt elsewhere.
      const bool is_felt = first.of == DancerOf::kThisHouse || second.of == DancerOf::kThisHouse;
      if (!is_felt || !is_here(first)) continue;
      if (!((first.p_WH_m - second.p_WH_m).squaredNorm() < kNear_m * kNear_m)) continue;
      Slots found;
      Pair* pair = pair_of(a, b, look(first, second, holds, found));
      if (!pair) continue;
      pair->looked = now;
      for (std::size_t slot = 0; slot < found.size(); ++slot)
        follow(*pair, slot, found[slot], now, clock_id, sink);
    }
  }
  // Who has left, went away, or gave the place to another touches nobody; nor is a place kept for
  // two who have parted.
  for (Pair& pair : state_->pairs) {
    if (!pair.is_used) continue;
    const bool touches = std::any_of(pair.contacts.begin(), pair.contacts.end(),
                                     [](const Contact& contact) { return contact.seen.is_set(); });
    if (pair.looked != now || !touches) end(pair, now, clock_id, sink);
  }
}

bool StageTouch::look(const Dancer& a, const Dancer& b, const StageHolds& holds, Slots& found) {
  bool is_any = false;
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const Capsule& one = a.body.of_bone[i];
    const Vector3f middle = 0.5f * (one.from + one.to);
    const float reach = 0.5f * (one.to - one.from).norm() + one.radius_m + kParts_m;
    const float most = reach + b.radius_m;
    if (!((middle - b.p_WH_m).squaredNorm() < most * most)) continue;
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
      is_any = true;
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
      is_any = true;
    }
  return is_any;
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
  const GuestId* guests[2] = {&pair.guest_a, &pair.guest_b};
  const std::size_t bones[2] = {contact.bone_a, contact.bone_b};
  for (std::size_t d = 0; d < 2; ++d) {
    const Dancer &own = *both[d], &other = *both[1 - d];
    // Only dancers of this house are told; none of these gives a place to another while shown.
    if (own.of != DancerOf::kThisHouse || own.guest != *guests[d]) continue;
    Touch touch;
    touch.time = now;
    touch.clock_id = clock_id;
    touch.contact = contact.number;
    touch.phase = phase;
    touch.is_hold = contact.is_hold;
    touch.bone = static_cast<Bone>(bones[d]);
    touch.other_bone = static_cast<Bone>(bones[1 - d]);
    touch.other = *guests[1 - d];
    const float depth = contact.is_hold ? contact.distance_m : -contact.distance_m;
    touch.depth_m = std::clamp(depth, 0.0f, Touch::kMostDepth_m);
    touch.approach_m_s =
        std::clamp(contact.approach_m_s, -Touch::kMostSpeed_m_s, Touch::kMostSpeed_m_s);
    Vector3f moves = other.speed_m_s[bones[1 - d]] - own.speed_m_s[0];
    if (other.guest != *guests[1 - d]) moves.setZero();  // has given the place to another
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
