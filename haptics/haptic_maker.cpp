#include "haptics/haptic_maker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dance {
namespace {

// A touch of this force is felt as strongly as can be.
constexpr float kFullTouch_n = 60.0f;
constexpr float kLeastTouch = 0.25f;  // of a touch at all
constexpr float kFastestSignal_m_s = 2.5f;
// Another place of the music than the one that was ordered for.
constexpr double kJump_beats = 0.5;
// A contact, or a dancer, of which nothing came for so long gives its place to another.
constexpr Duration kForgotten = Duration::s(1);

float strength_of(float force_n) {
  return std::clamp(kLeastTouch + force_n / kFullTouch_n, 0.0f, 1.0f);
}

}  // namespace

HapticMaker::Contact* HapticMaker::place_of(const Touch& touch, MonoTime now) {
  Contact *free = nullptr, *own_touch = nullptr, *any_touch = nullptr;
  std::size_t of_this_one = 0;
  for (Contact& contact : contacts_) {
    if (contact.other == touch.other && contact.number == touch.contact) return &contact;
    const bool is_free = !contact.other.is_set() || now - contact.heard > kForgotten;
    if (is_free && !free) free = &contact;
    if (is_free) continue;
    if (contact.other == touch.other) ++of_this_one;
    if (contact.is_hold) continue;
    any_touch = &contact;
    if (contact.other == touch.other) own_touch = &contact;
  }
  const bool has_its_share = of_this_one >= kMostOfOne;
  if (has_its_share) free = nullptr;
  if (!free && touch.is_hold) free = own_touch || has_its_share ? own_touch : any_touch;
  if (free) {
    *free = Contact();
    free->other = touch.other;
    free->number = touch.contact;
    free->begun = now;
  }
  return free;
}

// After kForgotten its buckets are as full as a new one's: a place is given on only then.
HapticMaker::Other* HapticMaker::other_of(const GuestId& guest, MonoTime now) {
  Other* free = nullptr;
  for (Other& other : others_) {
    if (other.guest == guest) {
      other.heard = now;
      return &other;
    }
    if (!other.guest.is_set() || now - other.heard > kForgotten) free = &other;
  }
  if (!free) return nullptr;
  *free = Other();
  free->guest = guest;
  free->heard = now;
  return free;
}

bool HapticMaker::is_felt(const GuestId& other) const {
  const auto& from = options_.from;
  return from.empty() || std::find(from.begin(), from.end(), other) != from.end();
}

bool HapticMaker::admit(HapticSource source, const Touch& touch, MonoTime now) {
  const auto may = [&] {
    Other* const other = other_of(touch.other, now);
    if (!other) return false;
    const bool is_touch = source == HapticSource::kTouch;
    MonoTime& last = (is_touch                        ? touched_at_
                      : source == HapticSource::kHold ? other->hold_at
                                                      : other->lead_at)[index_of(touch.bone)];
    // A clock that went back is another one: felt.
    if (last.is_set() && now >= last && now - last < kBetweenAtPlace) return false;
    TokenBucket& bucket = is_touch ? other->touches : other->holds;
    if (!bucket.take(1.0, now) || (is_touch && !all_touches_.take(1.0, now))) return false;
    last = now;
    return true;
  };
  if (may()) return true;
  ++left_out_;
  return false;
}

void HapticMaker::order(HapticSource source, Bone bone, const Shape& shape, MonoTime play,
                        MonoTime now, HapticSink& sink) {
  Haptic haptic;
  haptic.time = now;
  haptic.clock_id = clock_id_;
  haptic.maker = maker_;
  haptic.number = made_++;
  haptic.play_time = play;
  haptic.duration = shape.duration;
  haptic.attack = shape.attack;
  haptic.release = shape.release;
  haptic.source = source;
  haptic.bone = bone;
  haptic.amplitude = std::clamp(shape.amplitude, 0.0f, 1.0f);
  haptic.frequency_hz = shape.frequency_hz;
  sink.on_haptic(haptic);
}

// What the other's hand does, seen by who is led: away from the body, to it, up, to a side.
void HapticMaker::read_signal(const Touch& touch, Contact& contact, MonoTime now,
                              HapticSink& sink) {
  if (contact.said.is_set() && now - contact.said < kBetween) return;
  const Eigen::Vector3f& v = touch.motion_m_s;
  Eigen::Index axis = 0;
  const float speed = v.cwiseAbs().maxCoeff(&axis);
  if (!(speed > kSignal_m_s)) return;
  // One that is not felt now may be with the next message.
  if (!admit(HapticSource::kLead, touch, now)) return;
  contact.said = now;
  const float amplitude = 0.3f + 0.7f * std::min(1.0f, speed / kFastestSignal_m_s);
  const auto say = [&](Duration after, Shape shape) {
    order(HapticSource::kLead, touch.bone, shape, now + after, now, sink);
  };
  if (axis == 1 && v.y() > 0.0f) {  // raised: twice, the second one higher
    say({}, {Duration::ms(60), {}, Duration::ms(20), amplitude, 120.0f});
    say(Duration::ms(110), {Duration::ms(60), {}, Duration::ms(20), amplitude, 220.0f});
  } else if (axis == 2 && v.z() < 0.0f) {  // pushed: short and hard
    say({}, {Duration::ms(70), {}, Duration::ms(20), amplitude, 90.0f});
  } else if (axis == 2) {  // pulled: swells
    say({}, {Duration::ms(200), Duration::ms(150), Duration::ms(30), amplitude, 140.0f});
  } else {  // to a side, or down
    say({}, {Duration::ms(110), Duration::ms(30), Duration::ms(30), 0.7f * amplitude, 170.0f});
  }
}

void HapticMaker::take(const Touch& touch, MonoTime now, HapticSink& sink) {
  if (!is_felt(touch.other)) return;
  Contact* contact = place_of(touch, now);
  const bool is_new = touch.phase == TouchPhase::kBegins;
  const HapticSource source = touch.is_hold ? HapticSource::kHold : HapticSource::kTouch;
  if (contact) contact->heard = now;
  const bool becomes_hold = contact && touch.is_hold && !contact->is_hold && !is_new;
  if (contact) contact->is_hold = touch.is_hold;
  if (touch.phase == TouchPhase::kEnded) {
    // A hand that lets go.
    if (options_.touch && touch.is_hold && admit(source, touch, now))
      order(source, touch.bone, {Duration::ms(50), {}, Duration::ms(40), 0.3f, 250.0f}, now, now,
            sink);
    if (contact) *contact = Contact();
    return;
  }
  if (options_.touch && (is_new || becomes_hold)) {
    if (!admit(source, touch, now)) return;
    if (contact) contact->felt = now;
    const Duration length = touch.is_hold ? Duration::ms(120) : Duration::ms(80);
    order(source, touch.bone,
          {length, {}, Duration::ms(30), touch.is_hold ? 0.5f : strength_of(touch.force_n), 170.0f},
          now, now, sink);
    return;
  }
  if (!contact) return;
  if (touch.is_hold) {
    if (options_.lead) read_signal(touch, *contact, now, sink);
    return;
  }
  if (!options_.touch || now - contact->felt < kAgain) return;
  const double left = std::exp(-(now - contact->begun).as_seconds() / kFades.as_seconds());
  const float amplitude = 0.6f * strength_of(touch.force_n) * static_cast<float>(left);
  // Skin gets used to what stays.
  if (amplitude < 0.05f || !admit(source, touch, now)) return;
  contact->felt = now;
  order(source, touch.bone, {kAgain, Duration::ms(20), Duration::ms(40), amplitude, 130.0f}, now,
        now, sink);
}

void HapticMaker::look_ahead(MonoTime now, HapticSink& sink) {
  if (options_.beats == FeltBeats::kNone || !music_.is_known(now)) {
    has_beat_ = false;
    return;
  }
  const double here = music_.position(now);
  const double until = music_.position(now + kAhead);
  if (!has_beat_ || next_beat_ < here - kJump_beats || next_beat_ > until + 1.0 + kJump_beats)
    next_beat_ = std::ceil(here);
  has_beat_ = true;
  for (int i = 0; i < 8 && next_beat_ <= until; ++i, next_beat_ += 1.0) {
    const int bar = music_.beats_per_bar();
    const bool is_one = bar > 0 && std::fmod(std::fmod(next_beat_, bar) + bar, bar) < 0.5;
    if (!is_one && options_.beats == FeltBeats::kOne) continue;
    order(HapticSource::kBeat, Bone::kChest,
          {is_one ? Duration::ms(90) : Duration::ms(50),
           {},
           Duration::ms(30),
           is_one ? 0.7f : 0.35f,
           60.0f},
          music_.time_of(next_beat_), now, sink);
  }
}

}  // namespace dance
