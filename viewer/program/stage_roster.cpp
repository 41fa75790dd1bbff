#include "viewer/program/stage_roster.h"

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

StageRoster::StageRoster(GuestBoard& board) : board_(board), entries_(GuestBoard::kMaxGuests) {
  fresh_.reserve(GuestBoard::kMaxGuests);
}

void StageRoster::update(MonoTime now, SceneState& scene) {
  fresh_.clear();
  scene.guests.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (const GuestNews* news = board_.take(i)) {
      entry.news = *news;
      fresh_.push_back({news->id, news->pose, news->heard});
    }
    const float opacity = entry.news.heard.is_set() ? opacity_after(now - entry.news.heard) : 0.0f;
    if (entry.is_shown != (opacity > 0.0f)) {
      entry.is_shown = !entry.is_shown;
      ++arrivals_;
    }
    if (!entry.is_shown) continue;
    SceneGuest guest;
    guest.id = entry.news.id;
    guest.skeleton = entry.news.skeleton;
    guest.pose = entry.news.pose;
    if (entry.news.hands_heard.is_set() && entry.news.heard - entry.news.hands_heard < kHandsHold)
      guest.hands = entry.news.hands;
    guest.opacity = opacity;
    guest.figures = entry.news.figures;
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
