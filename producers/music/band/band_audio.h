// BandAudio: the sound of a BandScore. A frame sounds the same whatever was read before it: each
// section is rendered alone by a new synth, with its own reverb, and its tail is added to the next
// one.
//
// Units/frames: frames of the song; stereo samples are interleaved, within -0.9 to 0.9.
// Ownership:    shares the score; keeps the sound of five sections, some 15 MB.
// Threads:      one thread uses it.
// Failure:      make() names the soundfont that cannot be read, and the cure.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "producers/music/band/band_score.h"

namespace dance {

struct BandSound {
  // Read by FluidSynth; without one the band plays its own percussion and bass.
  std::string soundfont;
};

// The soundfont that this machine has, where FluidSynth can play it, or the band's own sounds.
BandSound best_band_sound();

class BandAudio {
 public:
  static Result<std::unique_ptr<BandAudio>> make(std::shared_ptr<const BandScore> score,
                                                 const BandSound& sound);
  ~BandAudio();
  BandAudio(const BandAudio&) = delete;
  BandAudio& operator=(const BandAudio&) = delete;

  // "FluidSynth, TimGM6mb.sf2" or "own percussion".
  std::string sound() const;
  const BandScore& score() const;
  // The sections before the first difference of the two scores keep what is rendered of them.
  void set_score(std::shared_ptr<const BandScore> score);

  // Renders the sections of this frame up to it, about `budget_frames` in each call. True once
  // read_stereo() of this frame has nothing left to render.
  bool prepare(std::int64_t frame, std::int64_t budget_frames);
  // Fills all of `interleaved`, with silence outside the song; renders what is not prepared.
  void read_stereo(std::int64_t frame, std::span<float> interleaved);

 private:
  class Impl;
  explicit BandAudio(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
