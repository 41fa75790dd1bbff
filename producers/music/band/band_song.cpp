#include "producers/music/band/band_song.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"

namespace dance {
namespace {

struct StyleFacts {
  std::string_view name;
  int tempo_bpm;
  int beats_per_bar;
};

constexpr std::array<StyleFacts, kBandStyles> kStyles{{{"salsa", 180, 4},
                                                       {"bachata", 128, 4},
                                                       {"cha-cha", 120, 4},
                                                       {"merengue", 136, 4},
                                                       {"cumbia", 96, 4},
                                                       {"swing", 150, 4},
                                                       {"tango", 124, 4},
                                                       {"waltz", 90, 3}}};

const StyleFacts& facts_of(BandStyle style) {
  const auto index = static_cast<std::size_t>(style);
  DANCE_ASSERT(index < kStyles.size(), index);
  return kStyles[index];
}

}  // namespace

std::string_view name_of(BandStyle style) { return facts_of(style).name; }

std::optional<BandStyle> band_style_of(std::string_view name) {
  for (std::size_t i = 0; i < kStyles.size(); ++i)
    if (kStyles[i].name == name) return static_cast<BandStyle>(i);
  return std::nullopt;
}

std::string band_style_names() {
  std::string names;
  for (int i = 0; i < kBandStyles; ++i)
    names += (i == 0 ? "" : ", ") + std::string(name_of(static_cast<BandStyle>(i)));
  return names;
}

int usual_tempo_bpm(BandStyle style) { return facts_of(style).tempo_bpm; }

int beats_per_bar(BandStyle style) { return facts_of(style).beats_per_bar; }

bool operator==(const BandSong& a, const BandSong& b) {
  return a.style == b.style && a.seed == b.seed &&
         std::equal(a.tempi.begin(), a.tempi.end(), b.tempi.begin(), b.tempi.end());
}

BandSong band_song(BandStyle style, std::uint32_t seed, int tempo_bpm) {
  BandSong song{style, seed, {}};
  DANCE_ASSERT(song.tempi.try_push({0, 100 * tempo_bpm}));
  return song;
}

bool is_valid(const BandSong& song) {
  if (static_cast<int>(song.style) >= kBandStyles || song.tempi.empty()) return false;
  const int usual = usual_tempo_bpm(song.style);
  std::int32_t least_bar = 0;
  for (const BandTempo& tempo : song.tempi) {
    if (tempo.bar < least_bar || tempo.bar >= kMostBandBars) return false;
    if (tempo.centi_bpm < 30 * usual || tempo.centi_bpm > 160 * usual) return false;
    least_bar = tempo.bar + 1;
  }
  return song.tempi[0].bar == 0;
}

}  // namespace dance
