// SongLoader: finds the beats of a song beside the program's loop, as that takes some hundredths of
// the song's length.
//
// Ownership:    owns its thread, which ends with it.
// Threads:      one owner; the thread reads the file on its own.
// Failure:      take() names what is wrong with the file or its list of beats.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/base/result.h"
#include "producers/music/song.h"
#include "producers/music/tracker/tempo/tempo_evidence.h"

namespace dance {

struct MusicFile {
  std::string path;
  std::string beats;  // the list; "" = the one beside it, or the tracker finds them
};

struct LoadedSong {
  Song song;
  float confidence = 1.0f;  // of its beats
  bool is_tracked = false;
};

// The list of beats to be read; "" = they are to be tracked.
std::string beats_list_of(const MusicFile& file);
// `is_cancelled` ends tracking early, with an Error.
Result<LoadedSong> load_song(const MusicFile& file, const TempoHint& hint,
                             const std::atomic<bool>& is_cancelled);

class SongLoader {
 public:
  SongLoader(const MusicFile& file, const TempoHint& hint);
  ~SongLoader();
  SongLoader(const SongLoader&) = delete;
  SongLoader& operator=(const SongLoader&) = delete;

  bool is_done() const { return is_done_.load(std::memory_order_acquire); }
  // Once, after is_done().
  Result<LoadedSong> take() { return std::move(*loaded_); }

 private:
  std::atomic<bool> is_cancelled_{false}, is_done_{false};
  std::unique_ptr<Result<LoadedSong>> loaded_;  // not set: not done
  std::thread thread_;
};

}  // namespace dance
