// BandSource: the sound of a BandSet.
//
// Units/frames: frames of the set.
// Ownership:    shares the set with the publisher of its beats.
#pragma once

#include <array>
#include <memory>

#include "producers/music/band/band_audio.h"
#include "producers/music/music_source.h"
#include "producers/music/room/band_set.h"

namespace dance {

class BandSource : public MusicSource {
 public:
  static Result<std::unique_ptr<BandSource>> make(std::shared_ptr<BandSet> set,
                                                  const BandSound& sound);

  double rate_hz() const override { return kBandRate_hz; }
  Result<void> read(std::int64_t frame, std::span<float> interleaved) override;
  void prepare(std::int64_t frame) override;
  // "FluidSynth, TimGM6mb.sf2"
  std::string sound() const { return audio_[0]->sound(); }

 private:
  BandSource(std::shared_ptr<BandSet> set, std::array<std::unique_ptr<BandAudio>, 2> audio)
      : set_(std::move(set)), audio_(std::move(audio)) {}
  BandAudio& audio_of(const BandSet::Part& part);

  std::shared_ptr<BandSet> set_;
  // For songs with even and with odd numbers: the next song is rendered while one ends.
  std::array<std::unique_ptr<BandAudio>, 2> audio_;
};

}  // namespace dance
