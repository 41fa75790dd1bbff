// A model of tracked bodies as a stranger would hand it over: what is let through is within bounds
// and says numbers.
#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "producers/trackers/net/tracker_model.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(tracker_model) {
  // Of 470 kB no mutation would be whole: the input stands for the first weights and the last.
  static const std::vector<std::uint8_t> kWhole =
      dance::write_tracker_model(*dance::built_in_tracker_model());
  const auto alone = dance::read_tracker_model({data, size});
  DANCE_ASSERT(alone || !alone.error().what.empty());
  std::vector<std::uint8_t> file = kWhole;
  constexpr std::size_t kHead = 14;  // magic, version, sizes: damaged above
  const std::size_t half = std::min(size / 2, (file.size() - kHead) / 2);
  std::copy_n(data, half, file.begin() + kHead);
  std::copy_n(data + size - half, half, file.end() - static_cast<std::ptrdiff_t>(half));
  const auto model = dance::read_tracker_model(file);
  if (!model) return 0;
  dance::TrackerRow::Inputs inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = static_cast<float>(i % 7) - 3.0f;
  dance::TrackerNet::State state;
  for (int step = 0; step < 3; ++step) (*model)->net.step(inputs, state);
  for (const float x : state.outputs) DANCE_ASSERT(std::isfinite(x));
  return 0;
}
