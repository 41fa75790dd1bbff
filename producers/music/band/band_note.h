// A note of the house band: its player, pitch, loudness and time.
//
// Units/frames: keys are MIDI's (60 is the middle C, 69 is 440 Hz); of percussion they are General
//               MIDI's sounds. Velocities are 1 to 127.
#pragma once

#include <cstdint>

namespace dance {

constexpr int kBandRate_hz = 48000;
// FluidSynth begins notes on blocks of this size; the score has all its notes and beats there.
constexpr int kBandBlock_frames = 64;

// The players, each of whom has a place in the stereo picture and a loudness.
enum class BandVoice : std::uint8_t {
  kClave,
  kBell,
  kCongas,
  kBongos,
  kTimbales,
  kShaker,
  kGuiro,
  kDrums,
  kBass,
  kUprightBass,
  kPiano,
  kGuitar,
  kLeadGuitar,
  kTrumpet,
  kTrombone,
  kSax,
  kFlute,
  kClarinet,
  kAccordion,
  kBandoneon,
  kViolin,
  kStrings,
  kVibraphone,
  kTambora
};
constexpr int kBandVoices = 24;

constexpr bool is_percussion(BandVoice voice) {
  return voice <= BandVoice::kDrums || voice == BandVoice::kTambora;
}

struct BandNote {
  std::int64_t begin_frame = 0;  // of the song
  std::int64_t end_frame = 0;
  BandVoice voice = BandVoice::kClave;
  std::uint8_t key = 0;
  std::uint8_t velocity = 0;

  bool operator==(const BandNote&) const = default;
};

}  // namespace dance
