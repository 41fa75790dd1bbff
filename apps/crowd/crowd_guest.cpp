#include "apps/crowd/crowd_guest.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/assert.h"
#include "core/net/datagram_sink.h"
#include "core/net/mono_clock.h"
#include "testing/undecoded_poses.h"

namespace dance {

CrowdGuest::CrowdGuest(std::size_t number, const Setting& setting, std::unique_ptr<Dancer> dancer,
                       const CrowdDances::Place& place, CrowdTally& tally)
    : number_(number),
      setting_(setting),
      dancer_(std::move(dancer)),
      place_(place),
      tally_(tally),
      name_(setting.plan.guest_name(setting.plan.place_of(number))),
      phase_(CrowdDances::phase_of(number)),
      made_(mono_now()),
      heard_(setting.plan.guests_per_room()) {
  find_near();
}

void CrowdGuest::find_near() {
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t place = 0; place < heard_.size(); ++place) {
    if (place == setting_.plan.place_of(number_)) continue;
    const CrowdDances::Place at = CrowdDances::place_of(place, heard_.size());
    others.emplace_back(std::hypot(at.x_m - place_.x_m, at.z_m - place_.z_m), place);
  }
  std::sort(others.begin(), others.end());
  for (std::size_t i = 0; i < std::min(kNearGuests, others.size()); ++i)
    heard_[others[i].second].is_near = true;
}

LinkOptions CrowdGuest::options() const {
  const CrowdPlan& plan = setting_.plan;
  LinkOptions options;
  options.room = plan.room_name(plan.room_of(number_));
  const bool fits = options.guests.try_push(name_);
  DANCE_ASSERT(fits);
  options.interest = plan.interest;
  options.file_bytes_per_second = 0.0;
  if (plan.place_of(number_) >= plan.decoders)
    options.make_decoder = [](CodecName name) { return std::make_unique<UndecodedPoses>(name); };
  return options;
}

LinkHandlers CrowdGuest::handlers() {
  LinkHandlers handlers;
  handlers.on_pose = [this](const GuestId& from, const Pose& pose, MonoTime) {
    on_pose(from, pose);
  };
  handlers.on_guest_joined = [this](const GuestId& guest, MonoTime) { on_joined(guest); };
  handlers.on_guest_left = [this](const GuestId& guest, MonoTime) {
    std::size_t number = 0;
    if (Heard* heard = heard_of(guest, number)) heard->is_here = false;
  };
  handlers.on_state = [this](LinkState state, MonoTime) {
    if (state == LinkState::kConnected) trouble_.clear();
  };
  handlers.on_refused = [this](const wire::RefusalNotice& refusal, MonoTime) {
    trouble_ = refusal_line(refusal, setting_.plan.room_name(setting_.plan.room_of(number_)));
  };
  handlers.on_no_answer = [this](const Address& address) { trouble_ = no_answer_line(address); };
  handlers.on_no_entry = [this](SealTrouble trouble) {
    trouble_ = no_entry_line(trouble, setting_.door.server);
  };
  return handlers;
}

Result<void> CrowdGuest::join(Poller& poller) {
  DANCE_ASSERT(!link_);
  counted_ = LinkCounters();
  counted_lost_ = 0;
  for (Heard& heard : heard_) heard.is_here = false;
  DANCE_TRY(link_,
            Link::open(setting_.door.addresses, setting_.door.key, options(), handlers(), poller));
  const MonoTime now = mono_now();
  link_->send(name_, dancer_->skeleton(), now);
  Placement stands;
  stands.time = now;
  stands.clock_id = this_clock_id();
  stands.x_m = static_cast<float>(place_.x_m);
  stands.z_m = static_cast<float>(place_.z_m);
  stands.heading_rad = static_cast<float>(place_.heading_deg * std::numbers::pi / 180.0);
  link_->send(name_, stands, now);
  return {};
}

void CrowdGuest::leave() {
  if (!link_) return;
  bring_counts(mono_now());
  link_.reset();
}

void CrowdGuest::dance(MonoTime now) {
  if (!link_) return;
  dancer_->dance_at(phase_ + (now - made_), pose_);
  pose_.sequence = sequence_ + 1;
  pose_.clock_id = this_clock_id();
  pose_.capture_time = mono_now();
  setting_.board.note(number_, pose_.sequence, pose_.capture_time);
  const std::uint64_t before = link_->counters().poses_sent;
  link_->send(name_, pose_, pose_.capture_time);
  if (link_->counters().poses_sent == before) {
    ++tally_.unsent;
    return;
  }
  setting_.board.publish(number_, ++sequence_);
  ++tally_.sent;
}

CrowdGuest::Heard* CrowdGuest::heard_of(const GuestId& guest, std::size_t& number) {
  const auto place = setting_.plan.place_of(guest);
  if (!place || *place >= heard_.size()) return nullptr;
  number = setting_.plan.guest_at(setting_.plan.room_of(number_), *place);
  return number < setting_.board.size() ? &heard_[*place] : nullptr;
}

void CrowdGuest::on_joined(const GuestId& guest) {
  std::size_t number = 0;
  Heard* heard = heard_of(guest, number);
  if (heard == nullptr) return;
  heard->is_here = true;
  heard->last = setting_.board.newest(number);
}

void CrowdGuest::on_pose(const GuestId& from, const Pose& pose) {
  std::size_t number = 0;
  Heard* heard = heard_of(from, number);
  if (heard == nullptr || !heard->is_here) return;
  const std::int32_t ahead = sequence_ahead(heard->last, pose.sequence);
  if (ahead <= 0) return;  // told as missed, or sent before she was here
  const MonoTime sent_at = setting_.board.sent_at(number, pose.sequence);
  if (!sent_at.is_set()) return;
  miss(*heard, ahead - 1);
  heard->last = pose.sequence;
  ++tally_.delivered;
  if (heard->is_near) ++tally_.near_delivered;
  tally_.latency.add(mono_now() - sent_at);
}

void CrowdGuest::miss(const Heard& heard, std::int32_t poses) {
  tally_.missed += static_cast<std::uint64_t>(poses);
  if (heard.is_near) tally_.near_missed += static_cast<std::uint64_t>(poses);
}

void CrowdGuest::settle(const std::vector<std::uint32_t>& before, MonoTime now) {
  if (!link_) return;
  const std::size_t room = setting_.plan.room_of(number_);
  for (std::size_t place = 0; place < heard_.size(); ++place) {
    if (!heard_[place].is_here) continue;
    const std::size_t number = setting_.plan.guest_at(room, place);
    const std::int32_t behind = sequence_ahead(heard_[place].last, before[number]);
    if (behind <= 0) continue;
    miss(heard_[place], behind);
    heard_[place].last = before[number];
  }
  bring_counts(now);
  if (is_present()) ++tally_.present;
}

void CrowdGuest::bring_counts(MonoTime now) {
  const LinkCounters& c = link_->counters();
  const auto ip_udp = [](std::uint64_t datagrams) { return kIpUdp_bytes * datagrams; };
  tally_.datagrams_up += c.datagrams_out - counted_.datagrams_out;
  tally_.datagrams_down += c.datagrams_in - counted_.datagrams_in;
  tally_.bytes_up +=
      c.bytes_out - counted_.bytes_out + ip_udp(c.datagrams_out - counted_.datagrams_out);
  tally_.bytes_down +=
      c.bytes_in - counted_.bytes_in + ip_udp(c.datagrams_in - counted_.datagrams_in);
  tally_.lapses += c.lapses - counted_.lapses;
  tally_.reconnects += c.reconnects - counted_.reconnects;
  const std::uint64_t undecodable = c.reference_missing + c.skeleton_missing + c.invalid;
  tally_.undecodable +=
      undecodable - (counted_.reference_missing + counted_.skeleton_missing + counted_.invalid);
  counted_ = c;
  // What comes late is not lost after all: then there are fewer.
  const std::int64_t lost = link_->stats(now).lost;
  if (lost > counted_lost_) tally_.lost += static_cast<std::uint64_t>(lost - counted_lost_);
  counted_lost_ = std::max(counted_lost_, lost);
}

}  // namespace dance
