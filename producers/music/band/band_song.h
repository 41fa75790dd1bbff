// BandSong: what the house band plays, in a few bytes: a style, a seed, and the tempo of each bar.
// The same song makes the same score in every house.
//
// Units/frames: tempi are in hundredths of a beat a minute; bars count from 0.
// Failure:      is_valid() is false for songs that no band plays; check those of other houses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/fixed_list.h"

namespace dance {

enum class BandStyle : std::uint8_t {
  kSalsa,
  kBachata,
  kChaCha,
  kMerengue,
  kCumbia,
  kSwing,
  kTango,
  kWaltz
};
constexpr int kBandStyles = 8;

std::string_view name_of(BandStyle style);  // "salsa"
std::optional<BandStyle> band_style_of(std::string_view name);
std::string band_style_names();  // "salsa, bachata" and so on
int usual_tempo_bpm(BandStyle style);
int beats_per_bar(BandStyle style);

// The tempo from a bar on.
struct BandTempo {
  std::int32_t bar = 0;
  std::int32_t centi_bpm = 0;

  bool operator==(const BandTempo&) const = default;
};

struct BandSong {
  BandStyle style = BandStyle::kSalsa;
  std::uint32_t seed = 0;
  FixedList<BandTempo, 16> tempi;  // the first is of bar 0
};

bool operator==(const BandSong& a, const BandSong& b);

// A song at one tempo.
BandSong band_song(BandStyle style, std::uint32_t seed, int tempo_bpm);

constexpr std::int32_t kMostBandBars = 400;
// At least one tempo, the first of bar 0, bars ascending, and tempi of 30 % to 160 % of the usual.
bool is_valid(const BandSong& song);

}  // namespace dance
