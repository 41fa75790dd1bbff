#include "apps/latency/latency_journey.h"

namespace dance {
namespace {

constexpr std::size_t index_of(Step step) { return static_cast<std::size_t>(step); }

struct StepText {
  std::string_view name;
  std::string_view meaning;
};
constexpr std::array<StepText, kStepCount> kSteps{{
    {"captured", "the sensor saw it"},
    {"published", "frame to pose to the house's bus"},
    {"link sent", "bus hop, packed into a datagram"},
    {"server", "the way up"},
    {"link received", "through the server, the way down"},
    {"stage taken", "to the manager"},
    {"staged", "hold, transformers, the stage's rate"},
    {"heard", "bus hop to the display"},
    {"shown", "drawn, buffers swapped"},
}};

template <class Hops>
std::array<MonoTime, kStepCount> stamps_of(MonoTime captured, const Hops& hops) {
  std::array<MonoTime, kStepCount> stamps{};
  stamps[index_of(Step::kCaptured)] = captured;
  for (std::size_t i = 0; i < kHopCount; ++i) stamps[i + 1] = hops[i];
  return stamps;
}

}  // namespace

static_assert(index_of(Step::kPublished) == static_cast<std::size_t>(Hop::kPublished) + 1);
static_assert(index_of(Step::kStaged) == static_cast<std::size_t>(Hop::kStaged) + 1);

std::string_view step_name(Step step) { return kSteps[index_of(step)].name; }
std::string_view step_meaning(Step step) { return kSteps[index_of(step)].meaning; }

void GuestJourney::heard(const Pose& pose, MonoTime now, std::uint64_t our_clock_id) {
  ++poses_;
  if (pose.clock_id == 0) {
    ++without_clock_;
    return;
  }
  Stamps stamps = stamps_of(pose.capture_time, pose.hops);
  if (pose.clock_id == our_clock_id)
    stamps[index_of(Step::kHeard)] = now;
  else
    ++of_another_clock_;
  add(heard_, stamps);
}

void GuestJourney::shown(const StageTime& stage_time) {
  ++frames_;
  if (stage_time.clock_id == 0) {
    ++without_clock_;
    return;
  }
  Stamps stamps = stamps_of(stage_time.capture_time, stage_time.hops);
  stamps[index_of(Step::kHeard)] = stage_time.heard_time;
  stamps[index_of(Step::kShown)] = stage_time.swap_time;
  add(shown_, stamps);
}

void GuestJourney::add(Way& way, const Stamps& stamps) {
  const MonoTime captured = stamps[index_of(Step::kCaptured)];
  std::size_t from = kStepCount;  // the last step that was passed
  for (std::size_t to = 0; to < kStepCount; ++to) {
    if (!stamps[to].is_set()) continue;
    // Only some poses carry the stamps of their way through the tunnel: without them the arrival
    // ends no step.
    if (to == index_of(Step::kLinkReceived) && !stamps[index_of(Step::kServer)].is_set())
      from = kStepCount;
    if (from < kStepCount) add_one(way.took[from][to], stamps[to] - stamps[from]);
    if (to > 0 && captured.is_set()) add_one(way.since_capture[to], stamps[to] - captured);
    from = to;
  }
}

void GuestJourney::add_one(std::unique_ptr<Histogram>& histogram, Duration took) {
  // Stamps are whole microseconds, so a step of no time may seem to take -1.
  if (took < Duration::us(-1)) {
    ++backwards_;
    return;
  }
  if (!histogram) histogram = std::make_unique<Histogram>();
  histogram->add(took);
}

const GuestJourney::Way& GuestJourney::way_to(std::size_t step) const {
  if (poses_ == 0) return shown_;
  return step >= index_of(Step::kHeard) && frames_ > 0 ? shown_ : heard_;
}

std::vector<GuestJourney::Row> GuestJourney::rows() const {
  std::vector<Row> rows;
  for (std::size_t to = 1; to < kStepCount; ++to)
    for (std::size_t from = 0; from < to; ++from) {
      const Way& way = way_to(to);
      if (way.took[from][to])
        rows.push_back({static_cast<Step>(from), static_cast<Step>(to), way.took[from][to].get(),
                        way.since_capture[to].get()});
    }
  return rows;
}

bool GuestJourney::has_passed(Step step) const {
  const std::size_t to = index_of(step);
  for (std::size_t from = 0; from < to; ++from)
    if (way_to(to).took[from][to]) return true;
  return false;
}

GuestJourney* Journeys::of(const GuestId& guest) {
  for (auto& journey : all_)
    if (journey->guest() == guest) return journey.get();
  if (all_.size() == kMaxJourneyGuests) {
    ++refused_;
    return nullptr;
  }
  all_.push_back(std::make_unique<GuestJourney>(guest));
  return all_.back().get();
}

}  // namespace dance
