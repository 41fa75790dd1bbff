#include "transformers/tempo/room_steps.h"

#include <algorithm>

namespace dance {

RoomSteps::RoomSteps() : dancers_(kMostDancers) {}

RoomSteps::Dancer* RoomSteps::dancer_of(Whose whose, const GuestId& guest, MonoTime now) {
  Dancer* place = nullptr;
  for (Dancer& dancer : dancers_) {
    if (dancer.guest.is_set() && dancer.guest == guest && dancer.whose == whose) return &dancer;
    const bool is_free = !dancer.guest.is_set() || now - dancer.heard > kSilence;
    const bool is_less = whose == Whose::kOwn && dancer.whose == Whose::kRemote;
    if (is_free ? !place || place->guest.is_set() : is_less && !place) place = &dancer;
  }
  if (!place) return nullptr;
  place->level.forget();
  place->guest = guest;
  place->whose = whose;
  place->heard = now;
  place->told_at = MonoTime();
  return place;
}

void RoomSteps::observe(Whose whose, const GuestId& guest, const Pose& pose, MonoTime now) {
  Dancer* dancer = dancer_of(whose, guest, now);
  if (!dancer) return;
  dancer->heard = now;
  seen_ = pose;
  seen_.music_beats = kNoMusic;
  dancer->level.observe(seen_, now);
}

void RoomSteps::set_body(Whose whose, const GuestId& guest, const Skeleton& skeleton) {
  for (Dancer& dancer : dancers_)
    if (dancer.guest.is_set() && dancer.guest == guest && dancer.whose == whose)
      dancer.level.set_body(skeleton);
}

void RoomSteps::tell(const GuestId& guest, const Steps& steps, MonoTime now) {
  Dancer* dancer = dancer_of(Whose::kOwn, guest, now);
  if (!dancer) return;
  dancer->heard = dancer->told_at = now;
  dancer->told = steps;
}

void RoomSteps::see(const Dancer& dancer, Group& group, MonoTime now) {
  if (!dancer.guest.is_set() || now - dancer.heard > kSilence) return;
  ++group.present;
  const bool is_told = dancer.told_at.is_set() && now - dancer.told_at <= kSilence;
  const double tempo_bpm = is_told ? dancer.told.tempo_bpm : dancer.level.tempo_bpm();
  const float sure = is_told ? dancer.told.weight : dancer.level.sure();
  if (!group.tempo.see(tempo_bpm, sure)) return;
  ++group.dancers;
  group.stepped = now;
}

bool RoomSteps::is_stepping(const Group& group, MonoTime now) {
  return group.present > 0 && group.stepped.is_set() && now - group.stepped <= kHeld;
}

std::optional<Steps> RoomSteps::steps_of(const Group& group, MonoTime now) {
  if (!is_stepping(group, now) || group.tempo.weight() < kLeastWeight) return std::nullopt;
  Steps steps;
  steps.tempo_bpm = group.tempo.tempo_bpm();
  steps.weight = static_cast<float>(group.tempo.weight());
  steps.dancers = group.dancers;
  return steps;
}

std::optional<Steps> RoomSteps::pass(MonoTime now) {
  for (Group* group : {&own_, &remote_}) group->present = group->dancers = 0;
  const double music_bpm = music_.is_known(now) ? 60.0 * music_.beats_per_second() : 0.0;
  for (Dancer& dancer : dancers_) {
    dancer.level.judge(music_bpm);
    see(dancer, dancer.whose == Whose::kOwn ? own_ : remote_, now);
  }
  const Duration since = passed_.is_set() ? now - passed_ : Duration();
  passed_ = now;
  own_.tempo.pass(since);
  remote_.tempo.pass(since);
  if (is_stepping(own_, now)) return steps_of(own_, now);
  std::optional<Steps> steps = steps_of(remote_, now);
  if (steps) steps->is_remote = true;
  return steps;
}

}  // namespace dance
