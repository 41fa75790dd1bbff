#include "apps/crowd/crowd_dances.h"

#include <cmath>

#include "core/base/random.h"
#include "formats/clip/dancers_file.h"
#include "producers/replay/clip_dancer.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {
namespace {

constexpr double kSpacing_m = 2.0;
constexpr double kLongestPhase_s = 120.0;

}  // namespace

Result<CrowdDances> CrowdDances::load(const std::vector<std::string>& takes) {
  CrowdDances dances;
  for (const std::string& take : takes) {
    DANCE_TRY(std::vector<NamedClip> loaded, load_dancers(take));
    for (NamedClip& each : loaded)
      dances.clips_.push_back(std::make_shared<const MotionClip>(std::move(each.clip)));
  }
  return dances;
}

CrowdDances::Place CrowdDances::place_of(std::size_t place, std::size_t guests) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(guests))));
  const double middle = 0.5 * static_cast<double>(columns - 1);
  Random random(place + 1);
  return {(static_cast<double>(place % columns) - middle) * kSpacing_m,
          (static_cast<double>(place / columns) - middle) * kSpacing_m,
          random.uniform(-180.0, 180.0)};
}

Duration CrowdDances::phase_of(std::size_t guest) {
  return Duration::seconds(Random(guest + 1).uniform(0.0, kLongestPhase_s));
}

std::unique_ptr<Dancer> CrowdDances::make(std::size_t guest) const {
  if (clips_.empty()) {
    SalsaStyle style;
    style.role = guest % 2 == 0 ? SalsaRole::kLead : SalsaRole::kFollow;
    style.seed = 1 + guest / 2;
    style.tempo_bpm = Random(style.seed).uniform(160.0, 210.0);
    return std::make_unique<SalsaDancer>(style);
  }
  return std::make_unique<ClipDancer>(clips_[guest % clips_.size()]);
}

}  // namespace dance
