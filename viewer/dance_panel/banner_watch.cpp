#include "viewer/dance_panel/banner_watch.h"

namespace dance {
namespace {

constexpr Duration kClockLook = Duration::s(1);
constexpr Duration kPauseOfSpeech = Duration::ms(700);

}  // namespace

const BannerFacts& BannerWatch::update(const DanceRecords& records, const SceneState& scene,
                                       const Drawing& drawing, Duration wall, MonoTime now) {
  watch_link(records, now);
  facts_.names = scene.names;
  // Host signs expire while the link has no session, so the last host is kept.
  if (facts_.link && facts_.link->state == HouseLinkState::kConnected) facts_.host = scene.host;
  watch_poses(records, now);
  watch_voice(records, scene, now);
  facts_.pictures_hz = drawing.pictures_hz;
  facts_.draws_plainly = drawing.is_plain;
  facts_.slow_for = slow_.update(
      drawing.is_software && drawing.is_at_smallest_scale && drawing.pictures_hz < kSlow_hz, now);
  if (!clock_looked_.is_set() || now - clock_looked_ >= kClockLook) {
    clock_looked_ = now;
    if (const auto jump = clock_.look(now, wall)) {
      facts_.clock_jump = *jump;
      clock_jumped_ = now;
    }
  }
  facts_.since_clock_jump = now - clock_jumped_;
  return facts_;
}

void BannerWatch::watch_link(const DanceRecords& records, MonoTime now) {
  facts_.link.reset();
  if (!records.link()) return;
  facts_.link = records.link()->link;
  facts_.link_silent = now - records.link()->at;
  facts_.link_down = down_.update(facts_.link->state != HouseLinkState::kConnected, now);
}

// The one that has been still the longest.
void BannerWatch::watch_poses(const DanceRecords& records, MonoTime now) {
  facts_.still = GuestId();
  facts_.still_for = Duration();
  for (const DanceGuest& guest : records.guests()) {
    if (guest.is_remote || now - guest.moved <= facts_.still_for) continue;
    facts_.still = guest.id;
    facts_.still_for = now - guest.moved;
  }
}

// Of this house's voices the first: the keys tell it, too.
void BannerWatch::watch_voice(const DanceRecords& records, const SceneState& scene, MonoTime now) {
  const SceneVoice* voice = scene.voices.empty() ? nullptr : &scene.voices.front();
  facts_.lacks_sound = voice != nullptr && voice->has_no_sound();
  facts_.lacks_microphone = voice != nullptr && !voice->has_microphone && voice->has_loudspeaker;
  const auto level =
      voice != nullptr ? records.level_of(voice->guest, now) : std::optional<VoiceLevel>();
  facts_.microphone_silent =
      silent_.update(level && voice->is_heard && level->level_dbfs < kSilentMicrophone_dbfs, now);
  const bool is_muted = level && (voice->is_muted || voice->is_deafened);
  if (!is_muted) spoke_ = MonoTime();
  if (is_muted && level->cleaned_dbfs > kSpeech_dbfs) spoke_ = now;
  facts_.speaks_muted = muted_speech_.update(spoke_.is_set() && now - spoke_ < kPauseOfSpeech, now);
}

}  // namespace dance
