// A model of beats as a stranger would hand it over: what is let through tells valid beats.
#include <algorithm>

#include "core/base/assert.h"
#include "producers/music/beat_tracker.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The input stands in for the beginning of a whole file: of 28 kB no mutation would be whole.
  static const std::vector<std::uint8_t> kWhole =
      dance::write_beat_model(*dance::built_in_beat_model());
  const auto alone = dance::read_beat_model({data, size});
  DANCE_ASSERT(alone || !alone.error().what.empty());
  std::vector<std::uint8_t> file = kWhole;
  std::copy_n(data, std::min(size, file.size()), file.begin());
  const auto model = dance::read_beat_model(file);
  if (!model) return 0;
  dance::StrokeMeaning meaning{};
  std::array<float, dance::StrokeFeatures::kCount> features;
  for (std::size_t i = 0; i < features.size(); ++i) features[i] = static_cast<float>(i % 7) - 3.0f;
  meaning = (*model)->net.judge(features);
  DANCE_ASSERT(std::abs(meaning.beat) <= 5.0f && std::abs(meaning.half) <= 5.0f);
  return 0;
}
