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
    routes_.push_back(std::make_unique<RouteState>(
        RouteState{route, static_cast<std::int32_t>(routes_.size()), route.rate_hz, {}, {}}));
    routes_from_[static_cast<std::size_t>(route.from.where)].push_back(routes_.back().get());
    // A flow is megabytes: one is made only of routes of guests, until one has a partner.
    if (has_partner_routes_ || route.from.where != Where::kGuest) continue;
    const auto flow = Flow::make(route.through);
    has_partner_routes_ = flow && flow->partner();
  }
}

Router::Instance* Router::instance_of(RouteState& state, const GuestId& guest, MonoTime now) {
  for (auto& instance : state.instances)
    if (instance->guest == guest) return instance.get();
  if (state.instances.size() == kMaxGuests) {
    // Full: the guest who is silent for longest gives the place to the newcomer.
    const auto longest = longest_silent(state);
    if (now - (*longest)->last_heard <= Roster::kSilence) return nullptr;
    erase(state, longest);
  }
  auto flow = Flow::make(state.route.through);
  DANCE_ASSERT(flow.has_value());
  state.instances.push_back(std::make_unique<Instance>(Instance{
      guest,
      shown_as(state, guest),
      std::move(*flow),
      now,
      0,
      {},
      state.route.from.where == Where::kCapture ? DancerOf::kThisHouse : DancerOf::kAnother}));
  prepare(state, *state.instances.back());
  return state.instances.back().get();
}

bool Router::is_shown(const Instance& instance, MonoTime now) {
  // A guest who is silent is not held on the stage for ever; a flow that goes on with the dance
  // says for how long.
  return now - instance.last_heard <= std::max(Roster::kSilence, instance.flow.longest_silence());
}

Router::Instances::iterator Router::longest_silent(RouteState& state) {
  return std::min_element(
      state.instances.begin(), state.instances.end(),
      [](const auto& a, const auto& b) { return a->last_heard < b->last_heard; });
}

void Router::erase(RouteState& state, Instances::iterator instance) {
  stats_.dropped_late += static_cast<std::int64_t>((*instance)->flow.counters().refused);
  state.instances.erase(instance);
}

void Router::evict_gone(MonoTime now) {
  for (auto& state : routes_) {
    Instances& instances = state->instances;
    if (instances.empty()) continue;
    const auto longest = longest_silent(*state);
    const auto is_heard = [&](const auto& i) { return is_shown(*i, now); };
    if (std::none_of(instances.begin(), instances.end(), is_heard)) state->silent = now;
    const bool is_network_there = !state->silent || now - *state->silent > kHasLeft;
    const auto left = std::count_if(instances.begin(), instances.end(),
                                    [&](const auto& i) { return now - i->last_heard > kHasLeft; });
    const bool too_many = is_network_there && left > static_cast<std::ptrdiff_t>(kMostAway);
    if (now - (*longest)->last_heard > kComesBack || too_many) erase(*state, longest);
  }
}

void Router::prepare(const RouteState& state, Instance& instance) {
  for (const Known& known : known_) {
    if (known.where != state.route.from.where || known.guest != instance.guest) continue;
    if (known.body) instance.flow.set_body(*known.body);
    if (known.style) instance.flow.set_style(*known.style);
  }
  instance.flow.place(state.place, state.route.from.where == Where::kCapture);
  for (const auto& [guest, setting] : settings_)
    if (guest == instance.shown_as) instance.flow.set(setting);
  if (state.route.from.where == Where::kGuest) instance.flow.set_dancers(&partners_);
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

const Skeleton* Router::known_body(Where where, const GuestId& guest) const {
  for (const Known& known : known_)
    if (known.where == where && known.guest == guest && known.body) return &*known.body;
  return nullptr;
}

void Router::take(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
  if (where == Where::kCapture && has_partner_routes_) {
    partners_.take(guest, pose, known_body(where, guest));
    // Who is not on the stage only dances beside it.
    if (routes_from_[static_cast<std::size_t>(where)].empty()) return;
  }
  ++stats_.received;
  RosterEntry* entry = roster_.heard(guest, where == Where::kGuest, pose, now);
  if (!entry) {
    ++stats_.dropped_overflow;
    return;
  }
  bool wanted = false;
  for (RouteState* state : routes_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*state, guest)) continue;
    Instance* instance = instance_of(*state, guest, now);
    if (!instance) continue;
    wanted = true;
    instance->last_heard = now;
    if (!instance->flow.is_pass_through()) {
      instance->flow.observe(pose, now);
      continue;
    }
    Pose staged = pose;
    staged.stamp(Hop::kStageTaken, now);
    show(*instance, staged, now);
    Roster::staged(*entry, staged, now, our_clock_id_);
  }
  ++(wanted ? stats_.forwarded : stats_.dropped_unrouted);
}

void Router::show(Instance& instance, Pose& pose, MonoTime now) {
  spacing_.apply(instance.shown_as, pose, now, instance.of, holds_);
  holds_.show(instance.shown_as, pose, now, instance.flow.holds_hands(), instance.of);
  sink_.stage(instance.shown_as, pose, now);
}

void Router::take(Where where, const GuestId& guest, const Hands& hands) {
  for (RouteState* state : routes_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*state, guest)) continue;
    // Fingers come after their body's first pose, which makes the instance.
    for (auto& instance : state->instances) {
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
  if (where == Where::kCapture) partners_.set_body(guest, skeleton.skeleton);
  for (RouteState* state : routes_from_[static_cast<std::size_t>(where)]) {
    if (!is_for(*state, guest)) continue;
    holds_.set_body(shown_as(*state, guest), skeleton.skeleton);
    sink_.stage(shown_as(*state, guest), skeleton);
    for (auto& instance : state->instances)
      if (instance->guest == guest) instance->flow.set_body(skeleton.skeleton);
  }
}

void Router::take(Where where, const GuestId& guest, const Style& style) {
  known_of(where, guest).style = style;
  for (RouteState* state : routes_from_[static_cast<std::size_t>(where)])
    for (auto& instance : state->instances)
      if (instance->guest == guest) instance->flow.set_style(style);
}

void Router::set(const GuestId& shown_as, const FlowSetting& setting) {
  if (!is_valid(setting)) return;
  std::erase_if(settings_, [&](const auto& known) { return known.first == shown_as; });
  if (settings_.size() == kMostKnown) settings_.erase(settings_.begin());  // who came first
  settings_.emplace_back(shown_as, setting);
  for (auto& state : routes_)
    for (auto& instance : state->instances)
      if (instance->shown_as == shown_as) instance->flow.set(setting);
}

void Router::hear(const Beat& beat) {
  beat_ = beat;
  for (auto& state : routes_)
    for (auto& instance : state->instances) instance->flow.hear(beat);
}

void Router::tick(std::size_t route, MonoTime now) {
  RouteState& state = *routes_[route];
  for (auto& instance : state.instances) {
    if (!is_shown(*instance, now)) continue;
    Pose pose;
    if (!instance->flow.sample(now, pose)) continue;
    pose.sequence = instance->staged++;  // the stage's own count: it makes these poses
    pose.stamp(Hop::kStageTaken, now);
    show(*instance, pose, now);
    if (const Hands* hands = instance->hands.take_due(pose.capture_time, pose.clock_id))
      sink_.stage(instance->shown_as, *hands);
    if (RosterEntry* entry = roster_.find(instance->guest))
      Roster::staged(*entry, pose, now, our_clock_id_);
  }
}

Stats Router::stats() const {
  Stats stats = stats_;
  for (const auto& state : routes_)
    for (const auto& instance : state->instances)
      stats.dropped_late += static_cast<std::int64_t>(instance->flow.counters().refused);
  stats.guests = roster_.alive_count();
  return stats;
}

}  // namespace dance
