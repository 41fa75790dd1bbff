// VoiceSigns: how the guests of this house speak, for other houses: muted, deafened, without a
// microphone, talking. One byte a guest, sent when it changes, so that a house that plays no voices
// shows it too.
//
// Units/frames: MonoTime of this house's clock.
// Ownership:    plain values; at most kMost guests.
// Failure:      parse() refuses bytes with unknown bits.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/fixed_list.h"
#include "core/bus/voice.h"

namespace dance {

class VoiceSigns {
 public:
  static constexpr std::size_t kMost = 16;
  static constexpr int kSpeech_dbfs = -50;                 // RMS of a frame of speech
  static constexpr Duration kPause = Duration::ms(1500);   // between words of one speech
  static constexpr Duration kStateHolds = Duration::s(3);  // it is published once a second

  // Each returns the guest's byte where it is to be sent.
  std::optional<std::uint8_t> on_state(const GuestId& guest, const VoiceState& state,
                                       MonoTime now) {
    Own* own = own_of(guest);
    if (own == nullptr) return std::nullopt;
    own->flags = static_cast<std::uint8_t>((state.is_muted ? kMuted : 0) |
                                           (state.is_deafened ? kDeafened : 0) |
                                           (state.has_microphone ? 0 : kNoMicrophone));
    own->stated = now;
    return changed(*own, now);
  }
  std::optional<std::uint8_t> on_voice(const GuestId& guest, const Voice& voice, MonoTime now) {
    if (voice.level_dbfs < kSpeech_dbfs) return std::nullopt;
    Own* own = own_of(guest);
    if (own == nullptr) return std::nullopt;
    own->talked = now;
    return changed(*own, now);
  }
  // Once a second: calls send(guest, byte) for those who have stopped talking, or whose dance voice
  // has ended. A guest without a sign leaves room for others.
  template <class Send>
  void expire(MonoTime now, Send send) {
    for (std::size_t i = own_.size(); i-- > 0;) {
      Own& own = own_[i];
      if (own.stated.is_set() && now - own.stated > kStateHolds) own.flags = 0;
      if (const auto byte = changed(own, now)) send(own.guest, *byte);
      if (own.sent == 0) own_.erase_at(i);
    }
  }

  // How a guest of another house speaks, by the byte that it sent.
  static std::optional<VoiceState> parse(std::uint8_t byte) {
    if (byte >= kEnd) return std::nullopt;
    VoiceState state;
    state.is_muted = (byte & kMuted) != 0;
    state.is_deafened = (byte & kDeafened) != 0;
    state.has_microphone = (byte & kNoMicrophone) == 0;
    state.is_heard = (byte & kTalks) != 0;
    return state;
  }

 private:
  enum Bits : std::uint8_t { kMuted = 1, kDeafened = 2, kNoMicrophone = 4, kTalks = 8, kEnd = 16 };
  struct Own {
    GuestId guest;
    std::uint8_t flags = 0;
    std::uint8_t sent = 0;  // receivers assume 0 until the first byte arrives
    MonoTime stated;        // by the dance voice, last
    MonoTime talked;        // last
  };

  Own* own_of(const GuestId& guest) {
    for (Own& own : own_)
      if (own.guest == guest) return &own;
    Own own;
    own.guest = guest;
    return own_.try_push(own) ? &own_[own_.size() - 1] : nullptr;
  }
  static std::optional<std::uint8_t> changed(Own& own, MonoTime now) {
    const bool talks = own.talked.is_set() && now - own.talked < kPause;
    const auto byte = static_cast<std::uint8_t>(own.flags | (talks ? kTalks : 0));
    if (byte == own.sent) return std::nullopt;
    own.sent = byte;
    return byte;
  }

  FixedList<Own, kMost> own_;
};

}  // namespace dance
