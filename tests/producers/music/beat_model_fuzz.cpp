// A model of beats as a stranger would hand it over: what is let through is within bounds, and is
// written as it was read.
#include <algorithm>

#include "core/base/assert.h"
#include "producers/music/tracker/beat_tracker.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(beat_model) {
  // Of 230 kB no mutation would be whole: half of the input stands for the first weights, half for
  // the last patterns.
  static const std::vector<std::uint8_t> kWhole =
      dance::write_beat_model(*dance::built_in_beat_model());
  const auto alone = dance::read_beat_model({data, size});
  DANCE_ASSERT(alone || !alone.error().what.empty());
  std::vector<std::uint8_t> file = kWhole;
  constexpr std::size_t kHead = 8;  // magic, version, how many patterns: damaged above
  const std::size_t half = std::min(size / 2, (file.size() - kHead) / 2);
  std::copy_n(data, half, file.begin() + kHead);
  std::copy_n(data + size - half, half, file.end() - static_cast<std::ptrdiff_t>(half));
  const auto model = dance::read_beat_model(file);
  if (!model) return 0;
  DANCE_ASSERT(dance::write_beat_model(**model) == file);
  for (const dance::MeterPattern& pattern : (*model)->patterns)
    DANCE_ASSERT(pattern.least_tempo_bpm >= 40 && pattern.most_tempo_bpm <= 400 &&
                 pattern.least_tempo_bpm < pattern.most_tempo_bpm);
  std::array<float, dance::RhythmFeatures::kCount> features;
  for (std::size_t i = 0; i < features.size(); ++i) features[i] = static_cast<float>(i % 7) - 3.0f;
  dance::RhythmState state;
  dance::StrokeMeaning meaning{};
  for (int step = 0; step < 3; ++step) meaning = (*model)->net.step(features, state);
  DANCE_ASSERT(std::abs(meaning.beat) <= 5.0f && std::abs(meaning.half) <= 5.0f);
  return 0;
}
