#include "viewer/dance_panel/dance_records.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr float kPredicted_ms = 10.0f;
// A newcomer's first seconds tell nothing.
constexpr Duration kSettles = Duration::s(3);
constexpr std::size_t kMostLevels = 16;

// Over the last seconds: one that loses a burst does not blink.
std::optional<float> mean_loss(const GuestRecord& record) {
  const std::size_t seconds = std::min<std::size_t>(
      record.size(), static_cast<std::size_t>(DanceRecords::kLossOver.count_ms() / 1000));
  float sum = 0.0f;
  std::size_t known = 0;
  for (std::size_t i = record.size() - seconds; i < record.size(); ++i) {
    if (!std::isfinite(record.at(i).loss_percent)) continue;
    sum += record.at(i).loss_percent;
    ++known;
  }
  if (known == 0) return std::nullopt;
  return sum / static_cast<float>(known);
}

std::optional<float> where_known(float value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// The delay from this guest's link to ours, including the server. The guest's camera and this
// machine's drawing do not count.
std::optional<float> network_delay(const GuestStats& stats) {
  const float to_server = stats.gap_p50_ms[static_cast<std::size_t>(Hop::kServer)];
  const float to_link = stats.gap_p50_ms[static_cast<std::size_t>(Hop::kLinkReceived)];
  if (!std::isfinite(to_link)) return std::nullopt;
  return to_link + (std::isfinite(to_server) ? to_server : 0.0f);
}

}  // namespace

const DanceGuest* DanceRecords::find(const GuestId& guest) const {
  const auto at = std::lower_bound(guests_.begin(), guests_.end(), guest,
                                   [](const DanceGuest& a, const GuestId& b) { return a.id < b; });
  return at != guests_.end() && at->id == guest ? &*at : nullptr;
}

DanceGuest* DanceRecords::guest_of(const GuestId& guest, MonoTime now) {
  const auto at = std::lower_bound(guests_.begin(), guests_.end(), guest,
                                   [](const DanceGuest& a, const GuestId& b) { return a.id < b; });
  if (at != guests_.end() && at->id == guest) return &*at;
  if (guests_.size() == kMost) return nullptr;
  DanceGuest fresh;
  fresh.id = guest;
  fresh.came = fresh.present = fresh.named = fresh.moved = now;
  return &*guests_.insert(at, fresh);
}

void DanceRecords::take(DanceBoard& board, MonoTime now) {
  while (const auto heard = board.take_status()) {
    DanceGuest* guest = guest_of(heard->guest, heard->at);
    if (guest == nullptr) continue;
    guest->is_remote = heard->what.remote;
    if (heard->what.received != guest->received) guest->moved = heard->at;
    guest->received = heard->what.received;
    if (heard->what.alive) guest->present = guest->named = heard->at;
  }
  while (const auto heard = board.take_present())
    if (DanceGuest* guest = guest_of(heard->guest, heard->at))
      guest->present = guest->named = heard->at;
  while (const auto heard = board.take_level())
    if (levels_.contains(heard->guest) || levels_.size() < kMostLevels)
      levels_[heard->guest] = {heard->what, heard->at};
  if (const Music* music = board.take_music()) music_ = *music;
  if (const RoomSong* song = board.take_song()) song_ = *song;
  if (const auto* link = board.take_link()) link_ = *link;
  forget_gone(now);
}

void DanceRecords::forget_gone(MonoTime now) {
  std::erase_if(guests_, [&](const DanceGuest& guest) {
    return now - guest.present > (guest.is_remote ? kGone : kOwnGone);
  });
  // Of those who are gone and were left as they were.
  if (choices_.size() > kMost)
    std::erase_if(choices_, [&](const auto& choice) {
      return choice.second == GuestChoice() && find(choice.first) == nullptr;
    });
}

void DanceRecords::judge(const InstrumentRecords& figures, const SceneState& scene, MonoTime now) {
  for (DanceGuest& guest : guests_) {
    const auto shown = std::find_if(scene.guests.begin(), scene.guests.end(),
                                    [&](const SceneGuest& it) { return it.id == guest.id; });
    guest.voice = shown != scene.guests.end() ? shown->voice : 0.0f;
    guest.voice_mark = shown != scene.guests.end() ? shown->voice_mark : VoiceMark::kNone;
    // A stage may dance on for one who is gone: that figure has its line, too.
    if (shown != scene.guests.end()) guest.present = now;
    QualityFigures measured;
    const auto choice = choices_.find(guest.id);
    if (guest.is_remote && choice != choices_.end() && choice->second.is_hidden) {
      // No poses are wanted: there is nothing to judge, nor just after they are wanted again. Those
      // of this house's own dancers come all the same.
      guest.moved = guest.came = now;
      guest.quality.update(measured, now);
      continue;
    }
    measured.silent_s = static_cast<float>((now - guest.moved).as_seconds());
    // It is said once a second: one that is not late is no silence.
    if (*measured.silent_s < 2.0f) measured.silent_s = 0.0f;
    const GuestRecord* record = figures.find(guest.id);
    if (record != nullptr && record->size() > 0 && now - guest.came > kSettles) {
      const GuestStats& newest = record->newest();
      const bool is_fresh = now - newest.time < Duration::s(3);
      if (is_fresh) measured.arrival_hz = where_known(newest.arrival_hz);
      // The network has no part in an own dancer's delay.
      if (guest.is_remote) measured.loss_percent = mean_loss(*record);
      if (guest.is_remote && is_fresh) measured.late_ms = network_delay(newest);
      if (guest.is_remote && is_fresh) measured.jitter_ms = where_known(newest.jitter_ms);
      measured.is_predicted =
          std::isfinite(newest.horizon_p50_ms) && newest.horizon_p50_ms > kPredicted_ms;
    }
    guest.quality.update(measured, now);
  }
}

std::optional<VoiceLevel> DanceRecords::level_of(const GuestId& guest, MonoTime now) const {
  const auto known = levels_.find(guest);
  if (known == levels_.end() || now - known->second.at > kLevelHolds) return std::nullopt;
  return known->second.level;
}

}  // namespace dance
