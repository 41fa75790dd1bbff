#include "apps/demo/demo_song.h"

#include <cmath>
#include <memory>

#include "producers/music/band/band_file.h"

namespace dance {
namespace {

// The first bar of a chorus: the whole band plays there, without a break.
int first_chorus_bar(const BandScore& score) {
  for (const BandSection& section : score.sections())
    if (section.part == BandPartKind::kChorus) return section.first_bar;
  return 0;
}

}  // namespace

Result<void> write_demo_song(const std::string& wav, double tempo_bpm) {
  constexpr std::uint32_t kSeed = 7;
  constexpr int kBeatsOfBar = 4;
  BandSong song = band_song(BandStyle::kSalsa, kSeed, usual_tempo_bpm(BandStyle::kSalsa));
  song.tempi[0].centi_bpm = static_cast<std::int32_t>(std::lround(100.0 * tempo_bpm));
  const auto score = std::make_shared<const BandScore>(BandScore::make(song));
  DANCE_TRY(const auto audio, BandAudio::make(score, {}));
  return write_band_file(wav, *audio, {first_chorus_bar(*score), kDemoSong_beats / kBeatsOfBar, 1});
}

}  // namespace dance
