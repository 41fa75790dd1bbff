#include "producers/rokoko/rokoko_receiver.h"

#include "producers/rokoko/rokoko_body.h"

namespace dance {
namespace {

constexpr std::uint16_t kUsualPort = 14043;
// Whoever is followed and does not come for so long has gone.
constexpr Duration kGone = Duration::s(2);

}  // namespace

Result<std::unique_ptr<RokokoReceiver>> RokokoReceiver::open(const Options& options,
                                                             CaptureSink& sink, Poller& poller) {
  DANCE_TRY(const Address local,
            Address::resolve(options.listen.empty() ? kUsualAddress : options.listen, kUsualPort));
  DANCE_TRY(auto socket, UdpSocket::bind(local, kLongDatagrams));
  return std::unique_ptr<RokokoReceiver>(
      new RokokoReceiver(options, std::move(socket), sink, poller));
}

RokokoReceiver::RokokoReceiver(const Options& options, UdpSocket socket, CaptureSink& sink,
                               Poller& poller)
    : socket_(std::move(socket)),
      poller_(poller),
      wanted_(options.actor),
      dancer_(options.guest, sink) {
  poller_.watch(socket_.fd(), [this](MonoTime now) {
    for (auto batch = socket_.receive(); !batch.empty(); batch = socket_.receive())
      for (const auto& datagram : batch) take(datagram.bytes, datagram.received, now);
  });
}

RokokoReceiver::~RokokoReceiver() { poller_.unwatch(socket_.fd()); }

void RokokoReceiver::take(std::span<const std::uint8_t> datagram, MonoTime received, MonoTime now) {
  ++datagrams_;
  const RokokoFault fault = reader_.read(datagram);
  ++faults_[static_cast<std::size_t>(fault)];
  if (fault != RokokoFault::kNone) return;
  const RokokoFrame& frame = reader_.frame();
  const MonoTime captured =
      clock_.to_ours(static_cast<std::int64_t>(frame.timestamp_s * 1e6), received);
  const RokokoActor* actor = find_actor(frame, now);
  if (!actor) {
    ++without_actor_;
    return;
  }
  dance(*actor, captured, now);
}

const RokokoActor* RokokoReceiver::find_actor(const RokokoFrame& frame, MonoTime now) {
  const RokokoActor* first = nullptr;
  for (const RokokoActor& actor : frame.actors) {
    if (!actor.has_body) continue;
    if (!wanted_.empty()) {
      if (actor.name == std::string_view(wanted_)) return &actor;
      continue;
    }
    if (actor.name == followed_) {
      followed_at_ = now;
      return &actor;
    }
    if (!first) first = &actor;
  }
  if (!first || (!followed_.empty() && now - followed_at_ < kGone)) return nullptr;
  followed_ = first->name;
  followed_at_ = now;
  figure_ = JointFigure();
  return first;
}

void RokokoReceiver::dance(const RokokoActor& actor, MonoTime captured, MonoTime now) {
  figure_.set_heights(actor.total_height_m, actor.hip_height_m);
  const FigureFrame figure = figure_of(actor);
  Pose pose;
  if (!figure_.fit(figure, pose)) {
    ++incomplete_;
    return;
  }
  dancer_.set_skeleton(figure_.skeleton());
  if (!dancer_.capture(pose, captured, now)) return;
  Hands hands;
  if (hands_of(actor, figure, hands)) dancer_.capture(hands);
}

std::string RokokoReceiver::summary() const {
  const auto& counters = dancer_.counters();
  std::string line = std::to_string(counters.poses) + " poses of " + std::to_string(datagrams_) +
                     " datagrams from Rokoko Studio";
  const auto tell = [&line](std::uint64_t count, const char* what) {
    if (count > 0) line += ", " + std::to_string(count) + " " + what;
  };
  for (std::size_t fault = 1; fault < faults_.size(); ++fault)
    tell(faults_[fault], text_of(static_cast<RokokoFault>(fault)));
  tell(without_actor_,
       wanted_.empty() ? "without an actor with a body" : "without the actor that was asked for");
  tell(incomplete_, "with joints missing");
  tell(counters.invalid, "not valid");
  tell(counters.not_newer, "not newer");
  tell(socket_.counters().truncated, "too long");
  tell(clock_.steps(), "jumps of the sender's clock");
  return line;
}

}  // namespace dance
