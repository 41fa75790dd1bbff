#include "producers/rokoko/rokoko_receiver.h"

#include "core/base/printable.h"
#include "producers/receive/input_report.h"
#include "producers/rokoko/rokoko_body.h"

namespace dance {
namespace {

constexpr std::uint16_t kUsualPort = 14043;
// An actor that is followed has left when nothing came for so long.
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
    // One batch a turn: what is left wakes the poller again, and others have their turn before.
    for (const auto& datagram : socket_.receive())
      take(datagram.from, datagram.bytes, datagram.received, now);
  });
}

RokokoReceiver::~RokokoReceiver() { poller_.unwatch(socket_.fd()); }

void RokokoReceiver::take(const Address& from, std::span<const std::uint8_t> datagram,
                          MonoTime received, MonoTime now) {
  ++datagrams_;
  newest_from_ = from;
  const OneSender::Verdict verdict = sender_.admit(from, received);
  if (verdict == OneSender::Verdict::kOther) return;
  if (verdict == OneSender::Verdict::kReadAnew) {
    followed_ = {};
    figure_ = JointFigure();
  }
  const RokokoFault fault = reader_.read(datagram);
  ++faults_[static_cast<std::size_t>(fault)];
  if (fault != RokokoFault::kNone) return;
  const RokokoActor* actor = find_actor(reader_.frame(), now);
  if (!actor) {
    ++without_actor_;
    return;
  }
  if (dance(*actor, received, now)) sender_.keep(from, received);
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

bool RokokoReceiver::dance(const RokokoActor& actor, MonoTime received, MonoTime now) {
  figure_.set_heights(actor.total_height_m, actor.hip_height_m);
  const FigureFrame figure = figure_of(actor);
  Pose pose;
  if (!figure_.fit(figure, pose)) {
    ++incomplete_;
    return false;
  }
  // Only the stamps of the sender that is kept tell its clock.
  if (!sender_.is_kept()) clock_.begin_anew();
  const MonoTime captured =
      clock_.to_ours(static_cast<std::int64_t>(reader_.frame().timestamp_s * 1e6), received);
  dancer_.set_skeleton(figure_.skeleton());
  if (!dancer_.capture(pose, captured, now)) return false;
  Hands hands;
  if (hands_of(actor, figure, hands)) dancer_.capture(hands);
  return true;
}

InputState RokokoReceiver::state() const {
  return {.arrived = datagrams_,
          .poses = dancer_.counters().poses,
          .at = socket_.local_address(),
          .from = newest_from_,
          .is_clock_unusable = clock_.is_unusable()};
}

std::string RokokoReceiver::diagnosis() const {
  if (datagrams_ == 0) return nothing_arrives_text(socket_.local_address());
  if (refused(RokokoFault::kOtherVersion) > 0)
    return "they are an older version of Rokoko's JSON; choose JSON v3 as the data format of the "
           "custom live stream in Rokoko Studio";
  const std::uint64_t unreadable = refused(RokokoFault::kNotLz4) + refused(RokokoFault::kNotJson) +
                                   refused(RokokoFault::kNoScene);
  if (unreadable > 0 && refused(RokokoFault::kNone) == 0)
    return "they are no live stream of Rokoko Studio; choose JSON v3 as the data format of its "
           "custom live stream";
  if (without_actor_ > 0 && !wanted_.empty())
    return "no actor of the stream is called '" + printable(wanted_) +
           "'; give --actor the name that Rokoko Studio shows, or leave it out";
  if (without_actor_ > 0) return "the stream has no actor with a body; add one in Rokoko Studio";
  return summary();
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
  tell(counters.skeletons_left_out, "skeletons that changed again within a second");
  tell(sender_.others(), "of a second sender, who has to use another port");
  tell(socket_.counters().truncated, "too long");
  tell(clock_.steps(), "jumps of the sender's clock");
  return line;
}

}  // namespace dance
