#include "viewer/replay/sound/sound_track.h"

#include <algorithm>

namespace dance {
namespace {

constexpr Duration kBlock = Duration::ms(10);
static_assert(RecordedBand::kBlock_frames * 100 == SoundTrack::kSoundRate_hz);
static_assert(kBandRate_hz == SoundTrack::kSoundRate_hz);
static_assert(kVoiceRate_hz == SoundTrack::kSoundRate_hz);

constexpr int kSearchedAtOnce = 50'000;  // messages: some milliseconds
// Songs are published once a second. A song that is first received within this time after the start
// of a recording was already in force at the start.
constexpr Duration kSongPeriod = Duration::ms(1500);
// Play-out starts this early, so that a voice that is already speaking is complete when the range
// begins.
constexpr int kPreroll_blocks = 100;
// While a guest speaks the music has this share of its volume. It is reached in 12 blocks, and left
// in 60.
constexpr float kDucked = 0.5f;
constexpr float kDown_per_block = (1.0f - kDucked) / 12.0f;
constexpr float kUp_per_block = (1.0f - kDucked) / 60.0f;

template <class Names>
std::string list_of(const Names& names) {
  std::string text;
  std::size_t i = 0;
  for (const auto& name : names) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += name;
    ++i;
  }
  return text;
}

}  // namespace

Result<std::unique_ptr<SoundTrack>> SoundTrack::open(const std::string& log,
                                                     const ReplayIndex& index, const Range& range,
                                                     BandSound band) {
  DANCE_TRY(SoundLog scout, SoundLog::open(log, index, range.from));
  DANCE_TRY(SoundLog reader, SoundLog::open(log, index, range.from));
  return std::unique_ptr<SoundTrack>(
      new SoundTrack(std::move(scout), std::move(reader), index, range, std::move(band)));
}

SoundTrack::SoundTrack(SoundLog scout, SoundLog log, const ReplayIndex& index, const Range& range,
                       BandSound band)
    : scout_(std::move(scout)),
      log_(std::move(log)),
      range_(range),
      band_(index.clock_id, std::move(band)),
      at_(range.from) {}

SoundTrack::Search SoundTrack::search() {
  for (int i = 0; i < kSearchedAtOnce; ++i) {
    std::optional<SoundEvent> event;
    const SoundLog::Step step = scout_.step(range_.to, event);
    if (step == SoundLog::Step::kEnd) return has_sound_ ? Search::kSound : Search::kNone;
    if (!event) continue;
    const bool is_after_begin = event->time > range_.from + kSongPeriod;
    if (const auto* song = std::get_if<RoomSong>(&event->message)) {
      const bool is_better = !first_song_ || (first_song_->channel.where() == Where::kCapture &&
                                              event->channel.where() == Where::kRoom);
      if (!is_after_begin && is_better && song->start_time <= event->time) first_song_ = event;
      if (song->playing) has_sound_ = true;
    } else if (std::holds_alternative<Voice>(event->message)) {
      if (event->time >= range_.from) has_sound_ = true;
    }
    if (has_sound_ && is_after_begin) return Search::kSound;
  }
  return Search::kGoesOn;
}

void SoundTrack::handle(const SoundEvent& event) {
  if (const auto* song = std::get_if<RoomSong>(&event.message))
    band_.on_song(event.channel.where(), *song, event.time);
  else if (const auto* music = std::get_if<Music>(&event.message))
    band_.on_music(*music, event.time);
  else if (const auto* beat = std::get_if<Beat>(&event.message))
    band_.on_beat(*beat, event.time);
  else if (const auto* voice = std::get_if<Voice>(&event.message)) {
    has_voice_packets_ = has_voice_packets_ || event.time >= range_.from;
    if (voices_ != nullptr) voices_->put(event.channel.guest(), *voice, event.time);
  }
}

void SoundTrack::handle_until(MonoTime moment) {
  std::optional<SoundEvent> event;
  for (auto step = log_.step(moment, event); step != SoundLog::Step::kEnd;
       step = log_.step(moment, event))
    if (event) handle(*event);
}

void SoundTrack::begin() {
  has_begun_ = true;
  if (auto voices = RecordedVoices::create())
    voices_ = std::move(*voices);
  else
    no_voices_ = voices.error().what;
  if (first_song_)
    band_.on_song(first_song_->channel.where(), std::get<RoomSong>(first_song_->message),
                  first_song_->time);
  for (int i = kPreroll_blocks; i > 0; --i) {
    const MonoTime moment = range_.from - kBlock * i;
    handle_until(moment);
    std::array<float, 2 * kBlock_frames> unheard{};
    if (voices_ != nullptr) voices_->add_to(moment, unheard);
  }
}

void SoundTrack::duck(std::span<float> stereo) {
  const bool is_speech = voices_ != nullptr && voices_->is_speech(at_);
  const float target = is_speech ? std::max(kDucked, music_gain_ - kDown_per_block)
                                 : std::min(1.0f, music_gain_ + kUp_per_block);
  if (music_gain_ == 1.0f && target == 1.0f) return;
  const float step = (target - music_gain_) / static_cast<float>(kBlock_frames);
  for (std::size_t i = 0; i < stereo.size(); ++i)
    stereo[i] *= music_gain_ + step * static_cast<float>(i / 2);
  music_gain_ = target;
}

Result<void> SoundTrack::make_block() {
  if (!has_begun_) begin();
  handle_until(at_);
  if (auto music = band_.read(at_, block_); !music) return music;
  duck(block_);
  if (voices_ != nullptr) voices_->add_to(at_, block_);
  limiter_.limit(block_);
  at_ += kBlock;
  used_ = 0;
  return {};
}

Result<void> SoundTrack::read(std::span<float> stereo) {
  while (!stereo.empty()) {
    if (used_ == block_.size())
      if (auto made = make_block(); !made) return made;
    const std::size_t part = std::min(stereo.size(), block_.size() - used_);
    std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>(used_), part, stereo.begin());
    used_ += part;
    stereo = stereo.subspan(part);
  }
  return {};
}

std::string SoundTrack::description() const {
  std::string text;
  std::set<std::string_view> styles;
  for (const BandStyle style : band_.heard()) styles.insert(name_of(style));
  if (!styles.empty()) text = "house band (" + list_of(styles) + ")";
  if (voices_ == nullptr || voices_->heard().empty()) return text;
  const auto& guests = voices_->heard();
  if (!text.empty()) text += ", ";
  return text + (guests.size() == 1 ? "voice of " : "voices of ") + list_of(guests);
}

std::string SoundTrack::missing() const {
  std::string text;
  if (!band_.missing().empty()) {
    std::set<std::string> titles;
    for (const std::string& title : band_.missing()) titles.insert("'" + title + "'");
    text = "the music " + list_of(titles) + " is not recorded";
  } else if (band_.is_untitled_missing()) {
    text = "the music is not recorded, only its beats are";
  }
  if (has_voice_packets_ && voices_ == nullptr)
    text += (text.empty() ? "" : "; ") + std::string("voices are missing: ") + no_voices_;
  return text;
}

}  // namespace dance
