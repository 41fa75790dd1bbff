#include "bench/line/line_lane.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "core/program/figures.h"
#include "producers/salsa/salsa_style.h"

namespace dance {
namespace {

// The stage's moments fall between the poses as they will: all phases in a minute.
constexpr Duration kStageSlip = Duration::us(7);
// Room in the meters for what a stage that slips shows more.
constexpr std::size_t kMorePoses = 64;
constexpr float kGrowth = 1.01f;

std::size_t poses_in(Duration span, Duration frame) {
  return static_cast<std::size_t>(span.count_ns() / frame.count_ns()) + kMorePoses;
}

}  // namespace

LineLane::LineLane(const std::string& name, const LineDance& dance, Duration span, Poller& poller)
    : name_(name),
      dance_(dance),
      poller_(poller),
      begin_(mono_now()),
      middle_(begin_ + span / 2),
      end_(begin_ + span),
      up_(begin_, poses_in(span, dance.frame)),
      down_(begin_, poses_in(span, dance.frame)) {
  lead_.guest = follow_.other = *GuestId::parse("lead");
  follow_.guest = lead_.other = *GuestId::parse("follow");
  lead_.poses = &dance.lead;
  follow_.poses = &dance.follow;
  lead_.skeleton = salsa_skeleton(SalsaRole::kLead, SalsaStyle().seed);
  follow_.skeleton = salsa_skeleton(SalsaRole::kFollow, SalsaStyle().seed);
  lead_.hears = follow_.dances = &up_;
  follow_.hears = lead_.dances = &down_;
}

Result<std::unique_ptr<LineLane>> LineLane::open(const std::string& name, const LossyLine& line,
                                                 const LineDance& dance, Duration span,
                                                 Poller& poller) {
  std::unique_ptr<LineLane> lane(new LineLane(name, dance, span, poller));
  if (auto opened = lane->open_ends(line); !opened) return tl::make_unexpected(opened.error());
  return lane;
}

// The only place that knows how server and links are made.
Result<void> LineLane::open_ends(const LossyLine& line) {
  ways_ = line;
  KeyEntry key;
  key.name = *GuestId::parse("line");
  key.kind = KeyKind::kRoom;
  const PrivateKey grant = PrivateKey::make();
  key.key = grant.public_key();
  KeyRing ring;
  const bool is_new = ring.add(key);
  DANCE_ASSERT(is_new);
  ServerOptions options;
  HouseKey of_house;
  of_house.name = key.name;
  of_house.server_key = options.identity.public_key();
  of_house.grant = grant;
  DANCE_TRY(key_, LinkKey::of(of_house, PrivateKey::make()));
  options.keys = std::make_shared<const KeyRing>(std::move(ring));
  DANCE_TRY(server_, Server::open(Address::loopback(0), options, poller_));
  DANCE_TRY(line_, LossyProxy::open(Address::loopback(0), server_->local_address(), line, poller_));
  DANCE_TRY(lead_.link, open_link(lead_, server_->local_address()));
  DANCE_TRY(follow_.link, open_link(follow_, line_->local_address()));
  const MonoTime now = mono_now();
  for (House* house : {&lead_, &follow_}) send_skeleton(*house, now);
  lead_.next_pose = now;
  follow_.next_pose = now + dance_.frame / 2;
  lead_.next_show = follow_.next_show = now + dance_.frame / 4;
  timer_ = poller_.add_timer(now, [this](MonoTime due) { return turn(due); });
  return {};
}

Result<std::unique_ptr<Link>> LineLane::open_link(House& house, const Address& server) {
  LinkOptions options;
  options.room = *wire::RoomName::parse("line");
  const bool fits = options.guests.try_push(house.guest);
  DANCE_ASSERT(fits);
  return Link::open({server}, key_, options, handlers_of(house), poller_);
}

LineLane::~LineLane() { poller_.set_deadline(timer_, MonoTime()); }

LinkHandlers LineLane::handlers_of(House& house) {
  LinkHandlers handlers;
  handlers.on_pose = [&house](const GuestId& who, const Pose& pose, MonoTime) {
    if (who == house.other) house.hears->delivered(pose, house.dances->last_took(), mono_now());
  };
  handlers.on_skeleton = [this, &house](const GuestId& who, const Skeleton& skeleton,
                                        MonoTime now) {
    if (who == house.other) house.others_skeleton = skeleton.version;
    note_state(now);
  };
  handlers.on_guest_joined = [this, &house](const GuestId& who, MonoTime now) {
    if (who == house.other) house.other_is_here = true;
    note_state(now);
  };
  handlers.on_guest_left = [&house](const GuestId& who, MonoTime) {
    if (who == house.other) house.other_is_here = false;
  };
  return handlers;
}

// Each time another one, as if the dancer had been measured again.
void LineLane::send_skeleton(House& house, MonoTime now) {
  ++house.skeleton.version;
  for (Eigen::Vector3f& offset : house.skeleton.offset_m) offset *= kGrowth;
  house.link->send(house.guest, house.skeleton, now);
  changed_ = now;
  converged_ = MonoTime();
}

bool LineLane::has_converged() const {
  return lead_.other_is_here && follow_.other_is_here &&
         lead_.others_skeleton == follow_.skeleton.version &&
         follow_.others_skeleton == lead_.skeleton.version && lead_.link->is_connected() &&
         follow_.link->is_connected();
}

void LineLane::note_state(MonoTime now) {
  if (!converged_.is_set() && has_converged()) converged_ = now;
}

// At most one for each turn: what a machine that was late missed is not made up for.
bool LineLane::is_due(MonoTime& next, Duration period, MonoTime now) {
  if (now < next) return false;
  for (next += period; next <= now; next += period) ++missed_frames_;
  return true;
}

void LineLane::dance_due(House& house, MonoTime now) {
  if (!is_due(house.next_pose, dance_.frame, now)) return;
  Pose pose = (*house.poses)[++house.sequence % house.poses->size()];
  pose.sequence = house.sequence;
  pose.clock_id = this_clock_id();
  pose.capture_time = mono_now();
  house.dances->sent(pose.sequence, pose.capture_time);
  house.link->send(house.guest, pose, pose.capture_time);
}

void LineLane::show_due(House& house, MonoTime now) {
  if (is_due(house.next_show, dance_.frame + kStageSlip, now)) house.hears->show(now);
}

MonoTime LineLane::turn(MonoTime now) {
  if (now >= end_) {
    if (!is_over_) {
      up_.end_dance(now);
      down_.end_dance(now);
    }
    is_over_ = true;
    return {};
  }
  if (now >= middle_ && !is_changed_) {
    for (House* house : {&lead_, &follow_}) send_skeleton(*house, now);
    is_changed_ = true;
  }
  const Duration since_begin = line_->begin().is_set() ? now - line_->begin() : Duration();
  up_.look(time_on(ways_.up, since_begin), now);
  down_.look(time_on(ways_.down, since_begin), now);
  MonoTime next = end_;
  for (House* house : {&lead_, &follow_}) {
    dance_due(*house, now);
    show_due(*house, now);
    next = std::min({next, house->next_pose, house->next_show});
  }
  return is_changed_ ? next : std::min(next, middle_);
}

LineWayResult LineLane::way(const LineMeter& meter, LossyProxy::Direction direction,
                            const House& dancer, const House& hearer) const {
  LineWayResult way;
  way.figures = meter.figures();
  way.line = line_->totals(direction);
  for (const RemoteGuestStats& remote : hearer.link->remote_stats()) {
    way.undecoded += remote.reference_missing;
    way.intra_frames += remote.intra_frames_asked;
  }
  for (const LocalGuestStats& local : dancer.link->local_stats()) way.references = local.references;
  return way;
}

LineResult LineLane::result() const {
  LineResult result;
  result.name = name_;
  result.up = way(up_, LossyProxy::Direction::kUp, follow_, lead_);
  result.down = way(down_, LossyProxy::Direction::kDown, lead_, follow_);
  const auto& up = result.up.figures.ages;
  const auto& down = result.down.figures.ages;
  if (!up.empty() && !down.empty())
    result.round_trip = percentile<Duration>(up, 0.5) + percentile<Duration>(down, 0.5);
  result.lapses = follow_.link->counters().lapses;
  result.reconnects = follow_.link->counters().reconnects;
  result.missed_frames = missed_frames_;
  result.has_converged = has_converged();
  if (converged_.is_set()) result.converged_after = converged_ - changed_;
  return result;
}

}  // namespace dance
