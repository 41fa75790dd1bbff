#include "producers/music/file/file_deck.h"

#include "core/base/music/music_speed.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "producers/music/beats_file.h"
#include "producers/music/file/song_folder.h"

namespace dance {
namespace {

constexpr Duration kDeckTurn = Duration::ms(20);
constexpr Duration kUntilNext = Duration::ms(300);
// In a folder of files that cannot be played, a dancer chooses another one.
constexpr int kMostSkipped = 8;

}  // namespace

// Houses of a room know a song by its file's name; its tags may differ.
MusicTitle FileDeck::title_of(const AudioFile& audio) const {
  return options_.is_alone && !audio.title().empty() ? shortened_title(audio.title())
                                                     : music_title(audio.path());
}

Result<std::unique_ptr<MusicPlayer>> FileDeck::open(MusicProgramOptions& program) {
  DANCE_TRY(AudioFile audio, AudioFile::open(options_.file.path));
  program.title = title_of(audio);
  program.is_alone = options_.is_alone;
  if (beats_list_of(options_.file).empty()) {
    program.awaits_song = true;
  } else {
    const std::atomic<bool> is_cancelled{false};
    DANCE_TRY(LoadedSong loaded, load_song(options_.file, options_.hint, is_cancelled));
    program.song.emplace(std::move(loaded.song));
    program.confidence = loaded.confidence;
  }
  return options_.make_player(std::move(audio));
}

void FileDeck::run(MusicProgram& program) {
  program_ = &program;
  if (!program.has_song()) find_beats();
  poller_.add_timer(mono_now() + kDeckTurn, [this](MonoTime now) { return work(now); });
}

void FileDeck::find_beats() {
  if (beats_list_of(options_.file).empty())
    talk::info("there is no {}: finds the beats of {} by listening",
               beats_path_beside(options_.file.path), options_.file.path);
  loader_ = std::make_unique<SongLoader>(options_.file, options_.hint);
}

MonoTime FileDeck::work(MonoTime now) {
  if (loader_ && loader_->is_done()) take_found(now);
  return now + kDeckTurn;
}

void FileDeck::take_found(MonoTime now) {
  auto loaded = loader_->take();
  loader_.reset();
  Result<MonoTime> begin = loaded ? options_.begin(now) : Result<MonoTime>(now);
  if (loaded && begin) {
    if (loaded->is_tracked)
      talk::info("{} beats, about {:.0f} a minute", loaded->song.grid().size(),
                 loaded->song.tempo_bpm(0.5 * loaded->song.length_s()));
    loaded->song.set_speed(speed_);
    program_->set_song(std::move(loaded->song), loaded->confidence, *begin, now);
    is_first_ = false;
    without_beats_ = 0;
    return;
  }
  const Error error = loaded ? begin.error() : loaded.error();
  if (is_first_ || ++without_beats_ >= kMostSkipped) {
    result_ = tl::make_unexpected(error);
    poller_.stop();
    return;
  }
  talk::warn("{}; plays the next song", error.what);
  play_next(now);
}

void FileDeck::play_next(MonoTime now) {
  int skipped = 0;
  for (const std::string& path : songs_after(options_.file.path)) {
    auto audio = AudioFile::open(path);
    if (!audio) {
      talk::warn("{}; skipped", audio.error().what);
      if (++skipped >= kMostSkipped) break;
      continue;
    }
    options_.file = {path, ""};
    const MusicTitle title = title_of(*audio);
    talk::info("plays '{}'", title.view());
    auto player = options_.make_player(std::move(*audio));
    if (volume_ >= 0.0) player->set_volume(volume_);
    player->set_speed(speed_);
    program_->begin_next(std::move(player), title, now + kUntilNext);
    find_beats();
    return;
  }
}

void FileDeck::apply(const MusicCommand& command) {
  const MonoTime now = mono_now();
  using What = MusicCommand::What;
  if (command.what == What::kVolume) {
    volume_ = command.volume;
    program_->set_volume(volume_);
    return;
  }
  if (!options_.is_alone) {
    talk::info("only the volume can be changed while a room may hear the song");
    return;
  }
  switch (command.what) {
    case What::kPlay:
    case What::kPause:
      return program_->set_playing(command.what == What::kPlay, now);
    case What::kSpeed:
      speed_ = command.speed;
      return program_->set_speed(speed_, now);
    case What::kSlower:
    case What::kFaster:
      speed_ = stepped_music_speed(speed_, command.what == What::kSlower ? -1 : 1);
      return program_->set_speed(speed_, now);
    case What::kNext:
      is_first_ = false;
      return play_next(now);
    case What::kVolume:
    case What::kLock:
    case What::kUnlock:
    case What::kStyle:
      return;
  }
}

}  // namespace dance
