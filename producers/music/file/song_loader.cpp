#include "producers/music/file/song_loader.h"

#include <sys/stat.h>

#include "producers/music/beats_file.h"
#include "producers/music/decode/audio_file.h"
#include "producers/music/tracked_song.h"

namespace dance {

std::string beats_list_of(const MusicFile& file) {
  if (!file.beats.empty()) return file.beats;
  std::string beside = beats_path_beside(file.path);
  struct stat status {};
  return ::stat(beside.c_str(), &status) == 0 ? beside : std::string();
}

Result<LoadedSong> load_song(const MusicFile& file, const TempoHint& hint,
                             const std::atomic<bool>& is_cancelled) {
  DANCE_TRY(AudioFile audio, AudioFile::open(file.path));
  const std::string list = beats_list_of(file);
  if (list.empty()) {
    auto tracked = track_song(audio, hint, &is_cancelled);
    if (!tracked)
      return fail(tracked.error().what + "; or put a list of its beats beside it as " +
                  beats_path_beside(file.path));
    return LoadedSong{Song(std::move(tracked->grid), audio.length_s(), false), tracked->confidence,
                      true};
  }
  DANCE_TRY(BeatGrid grid, read_beats_file(list));
  if (grid.time_of(grid.first_beat()) > audio.length_s())
    return fail(list + ": its first beat is behind the end of " + file.path);
  return LoadedSong{Song(std::move(grid), audio.length_s(), false)};
}

SongLoader::SongLoader(const MusicFile& file, const TempoHint& hint)
    : thread_([this, file, hint] {
        loaded_ = std::make_unique<Result<LoadedSong>>(load_song(file, hint, is_cancelled_));
        is_done_.store(true, std::memory_order_release);
      }) {}

SongLoader::~SongLoader() {
  is_cancelled_ = true;
  thread_.join();
}

}  // namespace dance
