#include "consumers/rokoko/rokoko_consumer.h"

#include <algorithm>

#include "core/program/talk.h"
#include "formats/rokoko/rokoko_actor.h"

namespace dance {
namespace {

constexpr std::uint16_t kUsualPort = 14043;
// Poses that come within this are of one moment of a stage.
constexpr Duration kTogether = Duration::ms(2);
constexpr Duration kGone = Duration::s(2);
// Frames may come so much closer than the rate, as their times jitter.
constexpr double kBurst = 2.0;
// A stage of the same rate by another clock loses none.
constexpr double kSlack = 1.02;

// Of the actors, in turn.
constexpr std::array<std::array<std::uint8_t, 3>, 8> kColors{{{230, 90, 60},
                                                              {60, 140, 230},
                                                              {90, 190, 90},
                                                              {230, 180, 50},
                                                              {170, 90, 210},
                                                              {60, 190, 190},
                                                              {220, 100, 160},
                                                              {150, 150, 150}}};

}  // namespace

Result<std::unique_ptr<RokokoConsumer>> RokokoConsumer::open(const Options& options) {
  DANCE_TRY(
      const Address to,
      Address::resolve(options.address.empty() ? kUsualAddress : options.address, kUsualPort));
  DANCE_TRY(auto socket, UdpSocket::connect(to, UdpRoom{1, 64}));
  return std::unique_ptr<RokokoConsumer>(new RokokoConsumer(options, std::move(socket), to));
}

RokokoConsumer::RokokoConsumer(const Options& options, UdpSocket socket, Address to)
    : options_(options),
      socket_(std::move(socket)),
      to_(to),
      rate_(kSlack * (options.hz > 0.0 ? options.hz : kUsual_hz), kBurst),
      scene_(std::make_unique<RokokoFrame>()),
      packer_(RokokoWriter::kMostTextBytes) {
  dancers_.reserve(RokokoFrame::kMostActors);
  scene_->fps = options.hz > 0.0 ? options.hz : kUsual_hz;
}

RokokoConsumer::Dancer* RokokoConsumer::find(const GuestId& guest) {
  const auto found = std::find_if(dancers_.begin(), dancers_.end(),
                                  [&](const Dancer& dancer) { return dancer.guest == guest; });
  if (found != dancers_.end()) return &*found;
  if (dancers_.size() == RokokoFrame::kMostActors) {
    ++counters_.guests_too_many;
    return nullptr;
  }
  dancers_.emplace_back().guest = guest;
  return &dancers_.back();
}

void RokokoConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  Dancer* dancer = find(guest);
  if (!dancer) return;
  dancer->skeleton = skeleton;
  if (!dancer->has_pose) dancer->arrived = now;
}

void RokokoConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  Dancer* dancer = find(guest);
  if (!dancer || hands.presence == 0) return;
  dancer->hands = hands;
  dancer->has_hands = true;
  dancer->hands_at = now;
  if (!dancer->has_pose) dancer->arrived = now;
}

void RokokoConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  ++counters_.heard;
  Dancer* dancer = find(guest);
  if (!dancer) return;
  // What still waited for a pose that did not come.
  const bool someone_waits = std::any_of(dancers_.begin(), dancers_.end(), [&](const Dancer& each) {
    return each.is_new && now - each.arrived > kTogether;
  });
  if (someone_waits || dancer->is_new) send(now);

  if (!dancer->has_pose) {
    dancer->has_pose = true;
    arrange_scene();
  }
  RokokoActor& actor = scene_->actors[dancer->actor];
  make_rokoko_actor(dancer->skeleton, pose, dancer->has_hands ? &dancer->hands : nullptr, actor);
  dancer->arrived_before = dancer->arrived;
  dancer->arrived = now;
  dancer->is_new = true;
  const MonoTime captured = pose.clock_id == options_.own_clock_id ? pose.capture_time : now;
  if (!first_.is_set()) first_ = captured;
  newest_ = std::max(newest_, captured);
  if (!waits_for_others(*dancer, now)) send(now);
}

// For those whose last pose came together with this guest's last, and whose next has not come yet.
bool RokokoConsumer::waits_for_others(const Dancer& dancer, MonoTime now) const {
  return std::any_of(dancers_.begin(), dancers_.end(), [&](const Dancer& other) {
    if (&other == &dancer || !other.has_pose || other.is_new) return false;
    const Duration apart = other.arrived - dancer.arrived_before;
    return now - other.arrived > kTogether && apart < kTogether && -apart < kTogether;
  });
}

void RokokoConsumer::send(MonoTime now) {
  if (!std::any_of(dancers_.begin(), dancers_.end(), [](const Dancer& d) { return d.is_new; }))
    return;
  // What is left out is in the next frame, unless there is newer.
  for (Dancer& dancer : dancers_) dancer.is_new = false;
  if (!rate_.take(1.0, now)) {
    ++counters_.throttled;
    return;
  }
  scene_->timestamp_s = (newest_ - first_).as_seconds();
  const bool packs = options_.dialect == Dialect::kLz4;
  for (std::size_t actors = scene_->actors.size(); actors > 0; --actors) {
    const auto written =
        writer_.write(*scene_, actors, packs ? RokokoWriter::kMostTextBytes : kMostJsonBytes);
    std::span<const std::uint8_t> datagram(
        reinterpret_cast<const std::uint8_t*>(written.text.data()), written.text.size());
    if (packs) {
      const auto packed = packer_.pack(written.text, kMostLz4Bytes);
      if (!packed) continue;
      datagram = *packed;
    }
    counters_.left_out += scene_->actors.size() - written.actors;
    socket_.send_now(to_, datagram);
    ++counters_.frames;
    return;
  }
}

void RokokoConsumer::on_second(MonoTime now) {
  if (const auto line = report_.tick(socket_.counters(), to_)) talk::warn("{}", *line);
  for (Dancer& dancer : dancers_)
    if (dancer.has_hands && now - dancer.hands_at > kGone) dancer.has_hands = false;
  const auto is_gone = [&](const Dancer& dancer) { return now - dancer.arrived > kGone; };
  if (std::none_of(dancers_.begin(), dancers_.end(), is_gone)) return;
  std::erase_if(dancers_, is_gone);
  arrange_scene();
}

// The actors in the order of the guests, each with what it was.
void RokokoConsumer::arrange_scene() {
  auto& actors = scene_->actors;
  for (std::size_t i = 0; i < actors.size();) {
    const bool is_here = std::any_of(dancers_.begin(), dancers_.end(), [&](const Dancer& dancer) {
      return dancer.has_pose && actors[i].name == dancer.guest.view();
    });
    if (is_here)
      ++i;
    else
      actors.erase_at(i);
  }
  for (Dancer& dancer : dancers_) {
    if (!dancer.has_pose) continue;
    std::size_t place = 0;
    while (place < actors.size() && !(actors[place].name == dancer.guest.view())) ++place;
    dancer.actor = place;
    if (place < actors.size()) continue;
    RokokoActor actor;
    if (!actor.name.assign(dancer.guest.view())) continue;
    actor.color = kColors[place % kColors.size()];
    if (!actors.try_push(actor)) ++counters_.guests_too_many;
  }
}

std::string RokokoConsumer::summary() const {
  std::string line = std::to_string(counters_.frames) + " frames of " +
                     std::to_string(counters_.heard) + " poses to " + to_.to_string();
  const auto tell = [&line](std::uint64_t count, const char* what) {
    if (count > 0) line += ", " + std::to_string(count) + " " + what;
  };
  tell(counters_.throttled, "frames left out to keep the rate");
  tell(counters_.left_out, "actors left out, as a datagram has no room for them");
  tell(counters_.guests_too_many, "messages of guests beyond 16");
  tell(socket_.counters().refused, "found nobody listening");
  tell(socket_.counters().send_failed, "refused by the network");
  return line;
}

}  // namespace dance
