// FileDeck: the music files that a MusicProgram plays: opens them, has their beats found while they
// are heard, and handles the commands of a dancer who has them alone: stop, play, next, speed.
//
// Ownership:    refers to the program and the poller, which must outlive it.
// Threads:      the poller's thread; beats are found in a thread of its own.
// Failure:      open() names the file that cannot be played; without beats the first song ends the
//               program with result(), a later one is skipped with a warning.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/net/poller.h"
#include "producers/music/control/music_control.h"
#include "producers/music/decode/audio_file.h"
#include "producers/music/file/song_loader.h"
#include "producers/music/music_program.h"

namespace dance {

class FileDeck {
 public:
  struct Options {
    MusicFile file;
    TempoHint hint;
    bool is_alone = false;  // in no room: the song may be stopped, slowed and changed
    // The sound of a file, from now on.
    std::function<std::unique_ptr<MusicPlayer>(AudioFile audio)> make_player;
    // When a song begins whose beats have just been found.
    std::function<Result<MonoTime>(MonoTime now)> begin;
  };

  FileDeck(Options options, Poller& poller) : options_(std::move(options)), poller_(poller) {}

  // Puts the beats into `program` if a list has them; else run() starts their search.
  Result<std::unique_ptr<MusicPlayer>> open(MusicProgramOptions& program);
  // After open(), before the poller runs.
  void run(MusicProgram& program);
  void apply(const MusicCommand& command);
  const Result<void>& result() const { return result_; }

 private:
  void find_beats();
  void play_next(MonoTime now);
  MonoTime work(MonoTime now);
  void take_found(MonoTime now);
  MusicTitle title_of(const AudioFile& audio) const;

  Options options_;
  Poller& poller_;
  MusicProgram* program_ = nullptr;
  std::unique_ptr<SongLoader> loader_;
  Result<void> result_;
  double volume_ = -1.0;  // as commanded; below 0: not yet
  double speed_ = 1.0;
  bool is_first_ = true;
  int without_beats_ = 0;  // songs in a row
};

}  // namespace dance
