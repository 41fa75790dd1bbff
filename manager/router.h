// Router: which pose reaches the stage through which transformers. Routes are resolved when it is
// made: a pose's way is a walk over pointers, without a lookup by name and without a copy but the
// stage's own.
//
// Units/frames: `now` is this house's clock.
// Ownership:    owns the flows; allocates when a guest comes, not per pose.
// Threads:      none inside; one owner. Pure: the poses it stages go to a sink.
// Failure:      poses that no route wants, or beyond the bound of guests, are counted in the
//               statistics.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/bus/messages.h"
#include "manager/hands_queue.h"
#include "manager/roster.h"
#include "manager/route.h"
#include "transformers/flow.h"
#include "transformers/touch/stage_holds.h"
#include "transformers/touch/stage_spacing.h"

namespace dance {

// Where the router puts what is to be shown.
class StageSink {
 public:
  virtual ~StageSink() = default;
  // May stamp the pose. `guest` is whom it shows.
  virtual void stage(const GuestId& guest, Pose& pose, MonoTime now) = 0;
  virtual void stage(const GuestId& guest, const Hands& hands) = 0;
  virtual void stage(const GuestId& guest, const TimedSkeleton& skeleton) = 0;
};

class Router {
 public:
  // The routes must have passed the session file's checks (a flow that cannot be made is our bug).
  Router(const std::vector<Route>& routes, std::uint64_t our_clock_id, StageSink& sink);

  void take(Where where, const GuestId& guest, const Pose& pose, MonoTime now);
  void take(Where where, const GuestId& guest, const Hands& hands);
  void take(Where where, const GuestId& guest, const TimedSkeleton& skeleton);
  // How a guest's dance is to be shown, and the music that this house hears.
  void take(Where where, const GuestId& guest, const Style& style);
  void hear(const Beat& beat);
  // How the stage is to show a guest, by the name that it has there.
  void set(const GuestId& shown_as, const FlowSetting& setting);
  // say(guest, setting): what is in force for each guest who is on the stage.
  template <class Say>
  void tell_settings(MonoTime now, Say say) const {
    for (const auto& state : routes_)
      for (const auto& instance : state->instances)
        if (is_shown(*instance, now)) say(instance->shown_as, instance->flow.setting());
  }

  // tell(guest, playout): what is shown of each guest whose poses go through transformers.
  template <class Tell>
  void tell_playouts(MonoTime now, Tell tell) const {
    for (const auto& state : routes_)
      for (const auto& instance : state->instances)
        if (!instance->flow.is_pass_through() && is_shown(*instance, now))
          tell(instance->shown_as, instance->flow.playout(now));
  }

  // What learns of the guests beside the pose path: called with each new one.
  using OnLearner = std::function<void(std::shared_ptr<Learner>)>;
  void on_learner(OnLearner on_learner) { on_learner_ = std::move(on_learner); }

  // The routes with a steady rate, and the work of one of their deadlines.
  std::size_t route_count() const { return routes_.size(); }
  double rate_hz(std::size_t route) const { return routes_[route]->rate_hz; }
  void tick(std::size_t route, MonoTime now);

  // A flow is megabytes and holds what it has learned of its dancer: it is kept for a guest who
  // comes back within kComesBack, unless more than kMostAway have left since; then it is freed. A
  // guest silent for kHasLeft has left, unless all of this route are silent: then the network is at
  // fault.
  static constexpr Duration kComesBack = Duration::s(300);
  static constexpr Duration kHasLeft = Duration::s(60);
  static constexpr std::size_t kMostAway = 8;
  // Call once a second: frees one flow of each route at most, so that no turn of the stage waits
  // for many.
  void evict_gone(MonoTime now);

  // Dancers of this house are wanted, too, where others may be predicted beside them.
  bool wants(Where where) const {
    return !routes_from_[static_cast<std::size_t>(where)].empty() ||
           (where == Where::kCapture && has_partner_routes_);
  }
  Roster& roster() { return roster_; }
  // Which hands of the dancers on the stage hold each other.
  const StageHolds& holds() const { return holds_; }
  // Counters of poses; time, uptime and lateness are the caller's.
  Stats stats() const;

 private:
  // One guest on one route.
  struct Instance {
    GuestId guest;
    GuestId shown_as;
    Flow flow;
    MonoTime last_heard;
    std::uint32_t staged = 0;
    HandsQueue hands;  // where the flow shows the body later
    DancerOf of;
  };
  using Instances = std::vector<std::unique_ptr<Instance>>;
  // What is known of a guest before, or beside, the poses: newcomers on a route begin with it.
  struct Known {
    Where where;
    GuestId guest;
    std::optional<Skeleton> body;
    std::optional<Style> style;
  };
  struct RouteState {
    Route route;
    std::int32_t place;
    double rate_hz;
    Instances instances;
    std::optional<MonoTime> silent;  // when nobody of it was heard, last
  };

  Instance* instance_of(RouteState& state, const GuestId& guest, MonoTime now);
  // Still on the stage: heard of lately, or danced on with.
  static bool is_shown(const Instance& instance, MonoTime now);
  static Instances::iterator longest_silent(RouteState& state);
  void erase(RouteState& state, Instances::iterator instance);
  bool is_for(const RouteState& state, const GuestId& guest) const {
    return !state.route.from.guest.is_set() || state.route.from.guest == guest;
  }
  static GuestId shown_as(const RouteState& state, const GuestId& guest) {
    return state.route.to.guest.is_set() ? state.route.to.guest : guest;
  }
  Known& known_of(Where where, const GuestId& guest);
  const Skeleton* known_body(Where where, const GuestId& guest) const;
  void prepare(const RouteState& state, Instance& instance);
  std::uint64_t our_clock_id_;
  StageSink& sink_;
  void show(Instance& instance, Pose& pose, MonoTime now);

  StageHolds holds_;
  StageSpacing spacing_;
  PartnerTracks partners_;  // the dancers of this house; flows refer to it
  std::vector<std::unique_ptr<RouteState>> routes_;
  std::array<std::vector<RouteState*>, 5> routes_from_;    // by Where
  std::vector<Known> known_;                               // at most kMostKnown
  std::vector<std::pair<GuestId, FlowSetting>> settings_;  // at most kMostKnown
  bool has_partner_routes_ = false;  // some guests are predicted beside who dances here
  std::optional<Beat> beat_;
  OnLearner on_learner_;
  Roster roster_;
  Stats stats_;
};

}  // namespace dance
