#include "manager/router.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

// A house's own and its remote guests.
constexpr std::size_t kMostKnown = 2 * kMaxGuests;

}  // namespace

Router::Router(const std::vector<Route>& routes, std::uint64_t our_clock_id, StageSink& sink)
    : our_clock_id_(our_clock_id), sink_(sink) {
  for (const Route& route : routes) {
    lines_.push_back(std::make_unique<Line>(Line{route, route.rate_hz, {}, {}}));
    lines_from_[static_cast<std::size_t>(route.from.where)].push_back(lines_.back().get());
  }
}

Router::Instance* Router::instance_of(Line& line, const GuestId& guest, MonoTime now) {
  for (auto& instance : line.instances)
    if (instance->guest == guest) return instance.get();
  if (line.instances.size() == kMaxGuests) {
    // Full: the guest who is silent for longest gives the place to the newcomer.
    const auto longest = longest_silent(line);
    if (now - (*longest)->last_heard <= Roster::kSilence) return nullptr;
    erase(line, longest);
  }
  auto flow = Flow::make(line.route.through);
  DANCE_ASSERT(flow.has_value());
  line.instances.push_back(std::make_unique<Instance>(
      Instance{guest, shown_as(line, guest), std::move(*flow), now, 0, {}}));
  prepare(line, *line.instances.back());
  return line.instances.back().get();
}

bool Router::is_shown(const Instance& instance, MonoTime now) {
  // A guest who is silent is not held on the stage for ever; a flow that goes on with the dance
  // has its own patience.
  return now - instance.last_heard <= std::max(Roster::kSilence, instance.flow.patience());
}

Router::Instances::iterator Router::longest_silent(Line& line) {
  return std::min_element(
      line.instances.begin(), line.instances.end(),
      [](const auto& a, const auto& b) { return a->last_heard < b->last_heard; });
}

void Router::erase(Line& line, Instances::iterator instance) {
  stats_.dropped_late += static_cast<std::int64_t>((*instance)->flow.counters().refused);
  line.instances.erase(instance);
}

void Router::evict_gone(MonoTime now) {
  for (auto& line : lines_) {
    Instances& instances = line->instances;
    if (instances.empty()) continue;
    const auto longest = longest_silent(*line);
    const auto is_heard = [&](const auto& i) { return is_shown(*i, now); };
    if (std::none_of(instances.begin(), instances.end(), is_heard)) line->silent = now;
    const bool is_line_there = !line->silent || now - *line->silent > kHasLeft;
    const auto left = std::count_if(instances.begin(), instances.end(),
                                    [&](const auto& i) { return now - i->last_heard > kHasLeft; });
    const bool too_many = is_line_there && left > static_cast<std::ptrdiff_t>(kMostAway);
    if (now - (*longest)->last_heard > kComesBack || too_many) erase(*line, longest);
  }
}

void Router::prepare(const Line& line, Instance& instance) {
  for (const Known& known : known_) {
    if (known.where != line.route.from.where || known.guest != instance.guest) continue;
    if (known.body) instance.flow.set_body(*known.body);
    if (known.style) instance.flow.set_style(*known.style);
  }
  if (beat_) instance.flow.hear(*beat_);
  if (auto learner = instance.flow.learner(); learner && on_learner_)
    on_learner_(std::move(learner));
}

Router::Known& Router::known_of(Where where, const GuestId& guest) {
  for (Known& known : known_)
    if (known.where == where && known.guest == guest) return known;
  if (known_.size() == kMostKnown) known_.erase(known_.begin());  // who came first
  known_.push_back({where, guest, std::nullopt, std::nullopt});
  return known_.back();
}

void Router::take(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
  ++stats_.received;
  RosterEntry* entry = roster_.heard(guest, where == Where::kGuest, pose, now);
  if (!entry) {
    ++stats_.dropped_overflow;
    return;
  }
  bool wanted = false;
  for (Line* line : lines_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*line, guest)) continue;
    Instance* instance = instance_of(*line, guest, now);
    if (!instance) continue;
    wanted = true;
    instance->last_heard = now;
    if (!instance->flow.is_pass_through()) {
      instance->flow.observe(pose, now);
      continue;
    }
    Pose staged = pose;
    staged.stamp(Hop::kStageTaken, now);
    sink_.stage(instance->shown_as, staged, now);
    Roster::staged(*entry, staged, now, our_clock_id_);
  }
  ++(wanted ? stats_.forwarded : stats_.dropped_unrouted);
}

void Router::take(Where where, const GuestId& guest, const Hands& hands) {
  for (Line* line : lines_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*line, guest)) continue;
    // Fingers come after their body's first pose, which makes the instance.
    for (auto& instance : line->instances) {
      if (instance->guest != guest) continue;
      if (instance->flow.is_pass_through())
        sink_.stage(instance->shown_as, hands);
      else
        instance->hands.push(hands);
    }
  }
}

void Router::take(Where where, const GuestId& guest, const TimedSkeleton& skeleton) {
  known_of(where, guest).body = skeleton.skeleton;
  for (Line* line : lines_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*line, guest)) continue;
    sink_.stage(shown_as(*line, guest), skeleton);
    for (auto& instance : line->instances)
      if (instance->guest == guest) instance->flow.set_body(skeleton.skeleton);
  }
}

void Router::take(Where where, const GuestId& guest, const Style& style) {
  known_of(where, guest).style = style;
  for (Line* line : lines_from_[static_cast<std::size_t>(where)])
    for (auto& instance : line->instances)
      if (instance->guest == guest) instance->flow.set_style(style);
}

void Router::hear(const Beat& beat, MonoTime /*now*/) {
  beat_ = beat;
  for (auto& line : lines_)
    for (auto& instance : line->instances) instance->flow.hear(beat);
}

void Router::tick(std::size_t route, MonoTime now) {
  Line& line = *lines_[route];
  for (auto& instance : line.instances) {
    if (!is_shown(*instance, now)) continue;
    Pose pose;
    if (!instance->flow.sample(now, pose)) continue;
    pose.sequence = instance->staged++;  // the stage's own count: it makes these poses
    pose.stamp(Hop::kStageTaken, now);
    sink_.stage(instance->shown_as, pose, now);
    if (const Hands* hands = instance->hands.take_due(pose.capture_time, pose.clock_id))
      sink_.stage(instance->shown_as, *hands);
    if (RosterEntry* entry = roster_.find(instance->guest))
      Roster::staged(*entry, pose, now, our_clock_id_);
  }
}

Stats Router::stats() const {
  Stats stats = stats_;
  for (const auto& line : lines_)
    for (const auto& instance : line->instances)
      stats.dropped_late += static_cast<std::int64_t>(instance->flow.counters().refused);
  stats.guests = roster_.alive_count();
  return stats;
}

}  // namespace dance
