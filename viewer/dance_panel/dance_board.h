// DanceBoard: passes messages between the bus thread and the drawing thread. The dance panel gets
// the state that it shows beside the dance. The bus thread gets the panel's requests, such as
// removals, hidden guests and lines of chat.
//
// Units/frames: times of the house's clock.
// Ownership:    bounded rings and mailboxes; never allocates after construction.
// Threads:      on_*(), take_asked(), take_written() and take_renamed() on the bus thread; the rest
//               on the drawing thread.
// Failure:      a display that draws nothing for long misses the oldest.
#pragma once

#include <atomic>

#include "core/base/latest.h"
#include "core/base/spsc_ring.h"
#include "core/bus/chat.h"
#include "core/bus/house_messages.h"
#include "core/bus/state_messages.h"
#include "viewer/instruments/instrument_board.h"

namespace dance {

class DanceBoard {
 public:
  using HiddenGuests = decltype(InterestWish::hidden);
  template <class T>
  struct Heard {
    GuestId guest;
    T what;
    MonoTime at;
  };
  struct HeardLink {
    HouseLink link;
    MonoTime at;
  };

  void on_status(const GuestId& guest, const GuestStatus& status, MonoTime now) {
    statuses_.push({guest, status, now});
  }
  // It is in the room, whether it dances or not.
  void on_traffic(const GuestId& guest, MonoTime now) { present_.push({guest, true, now}); }
  void on_level(const GuestId& guest, const VoiceLevel& level, MonoTime now) {
    levels_.push({guest, level, now});
  }
  void on_music(const Music& music) { music_.put(music); }
  void on_song(const RoomSong& song) { song_.put(song); }
  void on_link(const HouseLink& link, MonoTime now) { link_.put({link, now}); }
  std::optional<OfGuest<std::int32_t>> take_asked() { return asked_.pop(); }
  // A line or sign that a guest of this house sends; the caller sets its time.
  std::optional<OfGuest<Chat>> take_written() { return written_.pop(); }
  // A name for a guest of this house; "" = the id.
  std::optional<OfGuest<ShownName>> take_renamed() { return renamed_.pop(); }
  bool is_recording() const { return is_recording_.load(std::memory_order_relaxed); }
  // Where they have changed.
  const HiddenGuests* take_hidden() { return hidden_.take(); }

  std::optional<Heard<GuestStatus>> take_status() { return statuses_.pop(); }
  std::optional<Heard<bool>> take_present() { return present_.pop(); }
  std::optional<Heard<VoiceLevel>> take_level() { return levels_.pop(); }
  const Music* take_music() { return music_.take(); }
  const RoomSong* take_song() { return song_.take(); }
  const HeardLink* take_link() { return link_.take(); }
  // The guest is to be removed from the room; the number tells this wish from others.
  void ask(const GuestId& guest, std::int32_t number) { asked_.push({guest, number}); }
  void write(const GuestId& guest, const Chat& chat) { written_.push({guest, chat}); }
  void rename(const GuestId& guest, const ShownName& name) { renamed_.push({guest, name}); }
  // This window records.
  void set_recording(bool is) { is_recording_.store(is, std::memory_order_relaxed); }
  // Those who are not drawn in this window: no poses of them are wanted.
  void hide(const HiddenGuests& guests) { hidden_.put(guests); }

 private:
  SpscRing<Heard<GuestStatus>, 256> statuses_;
  SpscRing<Heard<bool>, 256> present_;
  SpscRing<Heard<VoiceLevel>, 256> levels_;
  SpscRing<OfGuest<std::int32_t>, 64> asked_;
  SpscRing<OfGuest<Chat>, 8> written_;
  SpscRing<OfGuest<ShownName>, 8> renamed_;
  Latest<Music> music_;
  Latest<RoomSong> song_;
  Latest<HiddenGuests> hidden_;
  Latest<HeardLink> link_;
  std::atomic<bool> is_recording_{false};
};

}  // namespace dance
