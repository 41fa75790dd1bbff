// What an Opus packet says of itself, without a decoder.
//
// Units/frames: bytes, as RFC 6716 has them.
// Ownership:    looks at the caller's bytes, keeps nothing.
// Threads:      none inside; plain functions.
// Failure:      none: bytes that are no packet have no error correction and are no silence.
// Source:       RFC 6716, sections 3.1 and 4.2.3.
#pragma once

#include <cstdint>
#include <span>

namespace dance {

// In silence Opus makes packets of one or two bytes.
inline bool is_silence(std::span<const std::uint8_t> packet) { return packet.size() <= 2; }

// Whether it has a copy of the frame before it: the flag behind the one for speech, in the modes
// that have it.
inline bool has_error_correction(std::span<const std::uint8_t> packet) {
  if (packet.size() < 3) return false;
  const unsigned configuration = packet[0] >> 3;
  const bool is_mono = (packet[0] & 0x04) == 0;
  const bool is_one_frame = (packet[0] & 0x03) == 0;
  return configuration < 16 && is_mono && is_one_frame && (packet[1] & 0x40) != 0;
}

}  // namespace dance
