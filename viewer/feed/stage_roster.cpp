#include "viewer/feed/stage_roster.h"

#include <algorithm>

namespace dance {
namespace {
constexpr Duration kSilenceBeforeFading = Duration::s(3);
constexpr Duration kFade = Duration::ms(800);
constexpr Duration kHandsHold = Duration::s(1);
constexpr Duration kFaceHolds = Duration::s(1);
constexpr Duration kSignHolds = Duration::seconds(kSignHolds_s);

float opacity_after(Duration silence) {
  if (silence <= kSilenceBeforeFading) return 1.0f;
  const double gone = (silence - kSilenceBeforeFading).as_seconds() / kFade.as_seconds();
  return gone >= 1.0 ? 0.0f : 1.0f - static_cast<float>(gone);
}
// A word's pauses are shorter.
constexpr Duration kVoiceHolds = Duration::ms(250);

// 0 for what is hardly heard, 1 for as loud as speech is.
float loudness_of(int level_dbfs) {
  return std::clamp((static_cast<float>(level_dbfs) + 55.0f) / 40.0f, 0.0f, 1.0f);
}

VoiceMark mark_of_remote(const VoiceState& state) {
  if (state.is_deafened) return VoiceMark::kDeafened;
  if (state.is_muted) return VoiceMark::kMuted;
  if (!state.has_microphone) return VoiceMark::kNoMicrophone;
  return state.is_heard ? VoiceMark::kTalking : VoiceMark::kNone;
}

void compare_in(const GuestNews& known, MonoTime now, SceneGuest& guest) {
  const auto holds = [&](MonoTime heard) {
    return heard.is_set() && now - heard < kSilenceBeforeFading;
  };
  if (holds(known.arriving_heard)) {
    guest.arriving = known.arriving;
    guest.arriving_beat = known.arriving_beat;
  }
  if (holds(known.staged_heard)) guest.staged = known.staged;
}

void sign_in(const GuestNews& known, MonoTime now, SceneGuest& guest) {
  const Duration age = now - known.sign_shown;
  if (!known.sign_shown.is_set() || age < Duration() || age >= kSignHolds) return;
  guest.sign = known.sign == ChatKind::kApplause ? DanceSign::kApplause : DanceSign::kHeart;
  guest.sign_age_s = static_cast<float>(age.as_seconds());
}

bool have_same_names(const ProfileBoard::Profiles& a, const ProfileBoard::Profiles& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SeenProfile& one, const SeenProfile& other) {
                      return one.guest == other.guest && one.name == other.name;
                    });
}

}  // namespace

StageRoster::StageRoster(GuestBoard& board) : board_(board), guests_(GuestBoard::kMaxGuests) {
  fresh_.reserve(GuestBoard::kMaxGuests);
}

void StageRoster::update(MonoTime now, SceneState& scene) {
  fresh_.clear();
  if (epoch_ != board_.epoch()) {
    epoch_ = board_.epoch();
    std::fill(guests_.begin(), guests_.end(), GuestNews());
    music_ = BeatClock();
    voices_.clear();
  }
  scene.time = now;
  scene.guests.clear();
  for (std::size_t i = 0; i < guests_.size(); ++i) {
    GuestNews& known = guests_[i];
    if (const GuestNews* news = board_.take(i)) {
      const bool is_fresh =
          news->heard.is_set() && (news->id != known.id || news->heard != known.heard ||
                                   news->pose.sequence != known.pose.sequence);
      known = *news;
      if (is_fresh) fresh_.push_back({news->id, news->pose, news->heard, news->moment});
    }
    const float opacity = known.heard.is_set() ? opacity_after(now - known.heard) : 0.0f;
    if (opacity <= 0.0f) continue;
    SceneGuest guest;
    guest.id = known.id;
    guest.skeleton = known.skeleton;
    guest.pose = known.pose;
    if (known.hands_heard.is_set() && known.heard - known.hands_heard < kHandsHold)
      guest.hands = known.hands;
    if (known.face_heard.is_set() && known.face.presence != 0 && now >= known.face_heard &&
        now - known.face_heard < kFaceHolds)
      guest.face = known.face;
    guest.wish = known.wish;
    guest.opacity = opacity;
    guest.figures = known.figures;
    if (known.voice_heard.is_set() && now - known.voice_heard < kVoiceHolds)
      guest.voice = loudness_of(known.voice_dbfs);
    if (known.voice_state_heard.is_set() && now - known.voice_state_heard < VoiceBoard::kHolds)
      guest.voice_mark = mark_of_remote(known.voice_state);
    sign_in(known, now, guest);
    compare_in(known, now, guest);
    scene.guests.push_back(guest);
  }
  if (const BeatClock* music = board_.take_music()) music_ = *music;
  scene.music.reset();
  if (music_.is_known(now))
    scene.music =
        SceneMusic{music_.position(now), music_.beats_per_second(), music_.beats_per_bar()};
  std::sort(scene.guests.begin(), scene.guests.end(),
            [](const SceneGuest& a, const SceneGuest& b) { return a.id < b.id; });
  update_voices(now, scene);
  update_lines(scene);
  update_profiles(now, scene);
}

// Comparing all names is quadratic, and profiles are repeated once a second. The names are made
// again only after a name or the set of guests has changed.
void StageRoster::update_profiles(MonoTime now, SceneState& scene) {
  std::vector<GuestId> ids;
  for (const SceneGuest& guest : scene.guests) ids.push_back(guest.id);
  const ProfileBoard::Profiles* news = board_.take_profiles();
  const bool has_new_name = news != nullptr && !have_same_names(profiles_, *news);
  if (news != nullptr) profiles_ = *news;
  if (has_new_name || ids != named_beside_) {
    std::vector<ShownNames::Named> named;
    for (const SeenProfile& seen : profiles_)
      if (!seen.name.empty()) named.push_back({seen.guest, seen.name});
    names_ = ShownNames(named, ids);
    named_beside_ = std::move(ids);
  }
  scene.names = names_;
  scene.recorders.clear();
  scene.host = GuestId();
  int hosts = 0;
  for (const SeenProfile& seen : profiles_) {
    if (!seen.is_remote || now - seen.received > ProfileBoard::kSignsHold) continue;
    if (seen.is_host) scene.host = ++hosts == 1 ? seen.guest : GuestId();
    if (!seen.is_recording) continue;
    scene.recorders.push_back(seen.guest);
    for (SceneGuest& guest : scene.guests)
      if (guest.id == seen.guest) guest.is_recording = true;
  }
}

void StageRoster::update_lines(SceneState& scene) {
  if (const ChatBoard::Lines* lines = board_.take_lines()) {
    lines_.clear();
    for (const ChatLine& line : *lines)
      lines_.push_back({line.guest, std::string(line.text.view()), line.written});
  }
  scene.lines = lines_;
}

void StageRoster::update_voices(MonoTime now, SceneState& scene) {
  if (const VoiceBoard::Voices* voices = board_.take_voices()) voices_ = *voices;
  scene.voices.clear();
  for (const SaidVoice& said : voices_) {
    if (now - said.heard > VoiceBoard::kHolds) continue;
    const VoiceState& state = said.state;
    scene.voices.push_back({said.guest, state.is_muted, state.is_deafened, state.is_push_to_talk,
                            state.is_heard, state.has_microphone, state.has_loudspeaker});
    for (SceneGuest& guest : scene.guests)
      if (guest.id == said.guest) guest.voice_mark = mark_of(scene.voices.back());
  }
  std::sort(scene.voices.begin(), scene.voices.end(),
            [](const SceneVoice& a, const SceneVoice& b) { return a.guest < b.guest; });
}

}  // namespace dance
