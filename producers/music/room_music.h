// Converts between the position of a song that is played here and the room's music_t: houses that
// have the same song hear the same part of it at the same time.
//
// Units/frames: `begin` is when song second 0 was or will be heard; all times in this house's
//               clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>
#include <string_view>

#include "core/base/beat.h"
#include "core/bus/state_messages.h"
#include "producers/music/song.h"

namespace dance {

// The song's title for the room: the file's name without folders and extension, cut to the bound.
MusicTitle music_title(const std::string& path);
// Without hidden characters, cut to the bound.
MusicTitle shortened_title(std::string_view text);

// A position and one tempo that describe where a song stands, renewed only where the song departs
// from them: steady music repeats one message, and music of varying tempo is right in every bar.
class RoomMusic {
 public:
  RoomMusic(const MusicTitle& title, std::uint64_t clock_id) : title_(title), clock_id_(clock_id) {}

  const Music& update(const Song& song, MonoTime begin, MonoTime now);
  const Music& update_stopped(double beats, MonoTime now);
  const Music& last() const { return music_; }

 private:
  MusicTitle title_;
  std::uint64_t clock_id_;
  Music music_;
};

// When song second 0 was heard, by what the room says. The music plays.
MonoTime begin_of_room_music(const Music& music, const Song& song);

// The beat of a room whose song is not here.
Beat beat_of_room_music(const Music& music, MonoTime now);

}  // namespace dance
