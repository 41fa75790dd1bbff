#include "viewer/feed/stage_roster.h"

#include <algorithm>

namespace dance {
namespace {
constexpr Duration kSilenceBeforeFading = Duration::s(3);
constexpr Duration kFade = Duration::ms(800);
constexpr Duration kHandsHold = Duration::s(1);

float opacity_after(Duration silence) {
  if (silence <= kSilenceBeforeFading) return 1.0f;
  const double gone = (silence - kSilenceBeforeFading).as_seconds() / kFade.as_seconds();
  return gone >= 1.0 ? 0.0f : 1.0f - static_cast<float>(gone);
}
}  // namespace

StageRoster::StageRoster(GuestBoard& board) : board_(board), guests_(GuestBoard::kMaxGuests) {
  fresh_.reserve(GuestBoard::kMaxGuests);
}

void StageRoster::update(MonoTime now, SceneState& scene) {
  fresh_.clear();
  scene.time = now;
  scene.guests.clear();
  for (std::size_t i = 0; i < guests_.size(); ++i) {
    GuestNews& known = guests_[i];
    if (const GuestNews* news = board_.take(i)) {
      known = *news;
      fresh_.push_back({news->id, news->pose, news->heard});
    }
    const float opacity = known.heard.is_set() ? opacity_after(now - known.heard) : 0.0f;
    if (opacity <= 0.0f) continue;
    SceneGuest guest;
    guest.id = known.id;
    guest.skeleton = known.skeleton;
    guest.pose = known.pose;
    if (known.hands_heard.is_set() && known.heard - known.hands_heard < kHandsHold)
      guest.hands = known.hands;
    guest.opacity = opacity;
    guest.figures = known.figures;
    scene.guests.push_back(guest);
  }
  if (const BeatClock* music = board_.take_music()) music_ = *music;
  scene.music.reset();
  if (music_.is_known(now))
    scene.music =
        SceneMusic{music_.position(now), music_.beats_per_second(), music_.beats_per_bar()};
  std::sort(scene.guests.begin(), scene.guests.end(),
            [](const SceneGuest& a, const SceneGuest& b) { return a.id < b.id; });
}

}  // namespace dance
