// One frame of a guest's voice: 10 ms of sound, mono at 48 kHz, as one Opus packet. The same fields
// as lcmtypes/voice_t.lcm, which says what each means. Nothing here looks into the packet: what a
// stranger sent stays bytes until the Opus decoder of voice/ reads it.
//
// Units/frames: MonoTime of the clock that clock_id names; levels in dBFS; sequence in frames.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what the .lcm file does not allow; is_valid() says nothing
//               about whether the packet is Opus.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

constexpr Duration kVoiceFrame = Duration::ms(10);
constexpr int kVoiceRate_hz = 48'000;
constexpr std::size_t kMaxVoiceBytes = 160;  // 128 kbit/s; Opus speech takes a quarter of it
constexpr int kSilence_dbfs = -127;

struct Voice {
  MonoTime capture_time;
  std::uint64_t clock_id = 0;
  std::uint32_t sequence = 0;
  int level_dbfs = kSilence_dbfs;
  int size_bytes = 0;
  std::array<std::uint8_t, kMaxVoiceBytes> data{};

  std::span<const std::uint8_t> packet() const {
    return std::span(data).first(static_cast<std::size_t>(size_bytes));
  }
  // False, and nothing is changed, for a packet that is empty or too long.
  [[nodiscard]] bool set_packet(std::span<const std::uint8_t> packet) {
    if (packet.empty() || packet.size() > data.size()) return false;
    std::fill(std::copy(packet.begin(), packet.end(), data.begin()), data.end(), std::uint8_t{0});
    size_bytes = static_cast<int>(packet.size());
    return true;
  }
};

inline bool is_valid(const Voice& voice) {
  return voice.level_dbfs >= kSilence_dbfs && voice.level_dbfs <= 0 && voice.size_bytes >= 1 &&
         voice.size_bytes <= static_cast<int>(kMaxVoiceBytes) &&
         std::all_of(voice.data.begin() + voice.size_bytes, voice.data.end(),
                     [](std::uint8_t byte) { return byte == 0; });
}

// Whose voices a guest of this house wants, as the program that plays them says it.
struct HearingWish {
  MonoTime time;
  std::uint64_t clock_id = 0;
  GuestId listener;                  // who wants it
  bool hears_others = true;          // everybody but these, or nobody but these
  std::array<GuestId, 16> guests{};  // those that are set

  bool hears(const GuestId& guest) const {
    const bool is_named = std::find(guests.begin(), guests.end(), guest) != guests.end();
    return is_named != hears_others;
  }
};
inline bool is_valid(const HearingWish& wish) { return wish.listener.is_set(); }

// How a guest of this house speaks and hears at present, for what shows it.
struct VoiceState {
  MonoTime time;
  std::uint64_t clock_id = 0;
  bool is_muted = false;
  bool is_deafened = false;
  bool is_push_to_talk = false;
  bool is_heard = true;  // what is said now goes to the others
  bool has_microphone = true;
  bool has_loudspeaker = true;
};
inline bool is_valid(const VoiceState&) { return true; }

}  // namespace dance
