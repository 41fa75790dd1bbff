// BandSynth: turns notes of the house band into sound. FluidSynth is one (in a module), the band's
// own sounds are the other.
//
// Units/frames: frames at kBandRate_hz, rendered in blocks of kBandBlock_frames.
// Ownership:    instruments outlive the synths that they make.
// Threads:      one thread uses the instruments and all their synths.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "producers/music/band/band_note.h"

namespace dance {

struct BandBlock {
  std::array<float, kBandBlock_frames> left{}, right{};
};

class BandSynth {
 public:
  virtual ~BandSynth() = default;
  virtual void begin_note(BandVoice voice, int key, int velocity) = 0;
  virtual void end_note(BandVoice voice, int key) = 0;
  virtual void render(BandBlock& block) = 0;
};

class BandInstruments {
 public:
  virtual ~BandInstruments() = default;
  virtual std::unique_ptr<BandSynth> make_synth() = 0;
  virtual std::string name() const = 0;
};

}  // namespace dance
