// BandRoom: the song of the house band in this house: the room's song, or one that this house
// begins if the room has none; and the changes that a dancer requests for the whole room.
//
// A change is a request: it takes effect once the room has accepted it, at the same time in all
// houses. If no room answers (a house alone, a link that is down), it takes effect at once. The
// band is silent while other music plays in the room or in this house.
//
// Units/frames: times of this house's clock.
// Failure:      songs that no band plays, of another clock, or that began too long ago are ignored.
#pragma once

#include <optional>

#include "core/base/guest_id.h"
#include "core/bus/state_messages.h"
#include "producers/music/room/band_set.h"

namespace dance {

class BandRoom {
 public:
  // A link publishes the room's song once a second.
  static constexpr Duration kRoomTimeout = Duration::ms(3500);
  // A request reaches the other houses within this time.
  static constexpr Duration kNotice = Duration::s(2);
  // A set that began earlier or begins later is ignored: no house that plays now has set it, as the
  // setter renews its set.
  static constexpr Duration kLongestSet = Duration::s(24 * 3600);
  static constexpr Duration kFurthestStart = Duration::s(60);
  static constexpr int kRenewedAfter_songs = 100;
  static constexpr double kTempoStep = 0.05;  // of the style's usual tempo
  static constexpr double kSlowest = 0.5, kFastest = 1.1;

  struct Options {
    GuestId guest;         // requests songs
    bool follows = false;  // waits for the room's song first
    BandStyle style = BandStyle::kSalsa;
    std::uint32_t seed = 0;
    int tempo_bpm = 0;  // 0 = the style's usual one
    std::uint64_t clock_id = 0;
  };

  BandRoom(const Options& options, MonoTime now);

  void on_room_song(const GuestId& setter, const RoomSong& song, MonoTime now);
  void on_room_music(const Music& music, MonoTime now);
  // Another program of this house publishes beats.
  void set_has_other_music(bool has_other) { has_other_ = has_other; }
  // Begins a song if the room has none.
  void work(MonoTime now);

  void play_next(MonoTime now);
  void play_style(BandStyle style, MonoTime now);
  // Changes the tempo by `steps` of kTempoStep, from the first bar after kNotice on. False if it
  // cannot change any further in this song.
  bool change_tempo(int steps, MonoTime now);
  void set_playing(bool plays, MonoTime now);
  void set_locked(bool is_locked, MonoTime now);

  // The song in force; nullopt before the first.
  const std::optional<RoomSong>& song() const { return song_; }
  // Its songs, one after the other, counted from song()->start_time.
  const std::shared_ptr<BandSet>& set() const { return set_; }
  bool plays(MonoTime now) const { return song_ && song_->playing && !has_other_music(now); }
  bool has_other_music(MonoTime now) const {
    return has_other_ || (room_music_until_.is_set() && now < room_music_until_);
  }
  // This house's request to the room; the caller publishes it on change and once a second.
  const std::optional<RoomSong>& request() const { return request_; }

 private:
  double song_s(MonoTime now) const { return (now - song_->start_time).as_seconds(); }
  void renew(MonoTime now);
  RoomSong song_at(MonoTime start, BandStyle style, std::uint32_t seed, std::int32_t centi_bpm);
  const BandSet::Part& part_now(MonoTime now);
  void make_request(const RoomSong& song, MonoTime now);
  bool adopt(const RoomSong& song);

  Options options_;
  std::shared_ptr<BandSet> set_ = std::make_shared<BandSet>();
  std::optional<RoomSong> song_, request_;
  MonoTime begun_, room_received_, requested_, room_music_until_;
  bool has_other_ = false;
};

}  // namespace dance
