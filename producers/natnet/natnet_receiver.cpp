#include "producers/natnet/natnet_receiver.h"

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kAskAgain = Duration::s(1);
// A server that is silent for so long may be another next time.
constexpr Duration kGone = Duration::s(3);
constexpr std::uint32_t kReordered = 100;  // frames

}  // namespace

Result<std::unique_ptr<NatNetReceiver>> NatNetReceiver::open(const Options& options,
                                                             CaptureSink& sink, Poller& poller) {
  DANCE_TRY(const NatNetPlace place, parse_natnet_place(options.listen));
  std::optional<UdpSocket> commands;
  if (!place.listen.is_multicast()) {
    DANCE_TRY(auto data, UdpSocket::bind(place.listen, kLongDatagrams));
    return std::unique_ptr<NatNetReceiver>(
        new NatNetReceiver(options, place, std::move(data), std::move(commands), sink, poller));
  }
  DANCE_TRY(auto data, UdpSocket::join(place.listen, place.interface, kLongDatagrams));
  // Answers come to where the question came from, not to the group.
  const Address own =
      place.interface.is_set() ? place.interface.with_port(0) : Address::any_ipv4(0);
  DANCE_TRY(commands, UdpSocket::bind(own, kLongDatagrams));
  return std::unique_ptr<NatNetReceiver>(
      new NatNetReceiver(options, place, std::move(data), std::move(commands), sink, poller));
}

NatNetReceiver::NatNetReceiver(const Options& options, const NatNetPlace& place, UdpSocket data,
                               std::optional<UdpSocket> commands, CaptureSink& sink, Poller& poller)
    : place_(place),
      data_(std::move(data)),
      commands_(std::move(commands)),
      poller_(poller),
      wanted_(options.actor),
      dancer_(options.guest, sink),
      server_(place.server),
      version_(place.version),
      models_(std::make_unique<NatNetModels>()),
      frame_(std::make_unique<NatNetFrame>()),
      body_(std::make_unique<NatNetBody>()) {
  poller_.watch(data_.fd(), [this](MonoTime now) { drain(data_, now); });
  if (commands_) poller_.watch(commands_->fd(), [this](MonoTime now) { drain(*commands_, now); });
  timer_ = poller_.add_timer(mono_now(), [this](MonoTime now) {
    ask(now);
    return now + kAskAgain;
  });
}

NatNetReceiver::~NatNetReceiver() {
  poller_.set_deadline(timer_, MonoTime());
  poller_.unwatch(data_.fd());
  if (commands_) poller_.unwatch(commands_->fd());
}

void NatNetReceiver::drain(UdpSocket& socket, MonoTime now) {
  // One batch a turn: what is left wakes the poller again, and others have their turn before.
  for (const auto& datagram : socket.receive())
    take(datagram.from, datagram.bytes, datagram.received, now);
}

void NatNetReceiver::forget_server() {
  sender_.release();
  server_ = place_.server;
  server_heard_ = server_since_ = MonoTime();
  others_stream_ = is_in_doubt_ = false;
  version_ = place_.version;
  ticks_per_second_ = 0;
  models_->skeletons.clear();
  has_models_ = false;
  skeleton_id_.reset();
  figure_ = JointFigure();
  clock_.begin_anew();
  newest_frame_ = 0;
}

// Commands go to the server that was named, else to where the stream comes from.
void NatNetReceiver::ask(MonoTime now) {
  const bool is_silent = server_heard_.is_set() && now - server_heard_ > kGone;
  // One that answers, but makes no pose, is not to keep out another that does.
  const bool is_useless = !place_.server.is_set() && !sender_.is_kept() && others_stream_ &&
                          now - server_since_ > kGone;
  if (is_silent || is_useless) forget_server();
  if (!server_.is_set()) return;
  if (!version_ || ticks_per_second_ == 0 || is_in_doubt_) request(NatNetMessage::kConnect, "Ping");
  if (!has_models_ || is_in_doubt_) request(NatNetMessage::kRequestModels, "");
  is_in_doubt_ = false;
  // Without it a unicast stream ends.
  if (!commands_) request(NatNetMessage::kKeepAlive, "");
}

void NatNetReceiver::request(const Address& to, NatNetMessage message, std::string_view text) {
  const auto bytes = natnet_request(message, text);
  (commands_ ? *commands_ : data_).send_now(to, std::span(bytes.begin(), bytes.size()));
}

bool NatNetReceiver::is_server(const Address& from, std::span<const std::uint8_t> packet,
                               MonoTime now) {
  if (!server_.is_set()) {
    look_for_server(from, packet, now);
    if (!server_.is_set()) return false;
  }
  if (server_.ip() != from.ip()) {
    ++counters_.of_others;
    others_stream_ = true;
    return false;
  }
  server_heard_ = now;
  return true;
}

// Who says so, or streams what can be read. A frame of unknown version only makes its machine one
// to be asked.
void NatNetReceiver::look_for_server(const Address& from, std::span<const std::uint8_t> packet,
                                     MonoTime now) {
  const auto reads = [&](NatNetVersion version) {
    return read_natnet_frame(packet, version, *frame_);
  };
  const Address server = from.with_port(kNatNetCommandPort);
  NatNetServer told;
  NatNetFault fault = NatNetFault::kOtherMessage;
  bool is_found = false;
  if (message_of(packet) == NatNetMessage::kServerInfo) {
    fault = read_natnet_server(packet, told);
    is_found = fault == NatNetFault::kNone;
  } else if (message_of(packet) == NatNetMessage::kFrame) {
    fault = reads(version_.value_or(kNewestNatNet));
    is_found = version_ && fault == NatNetFault::kNone;
    for (const NatNetVersion version : {NatNetVersion{4, 0}, kOldestNatNet})
      if (!version_ && fault != NatNetFault::kNone) fault = reads(version);
    if (!version_ && fault == NatNetFault::kNone) {
      ++counters_.before_version;
      if (now >= next_question_) request(server, NatNetMessage::kConnect, "Ping");
      if (now >= next_question_) next_question_ = now + kAskAgain;
      return;
    }
  }
  if (!is_found) {
    note(fault);
    return;
  }
  server_ = server;
  server_since_ = server_heard_ = now;
  ask(now);
}

NatNetFault NatNetReceiver::note(NatNetFault fault) {
  ++counters_.faults[static_cast<std::size_t>(fault)];
  return fault;
}

void NatNetReceiver::take(const Address& from, std::span<const std::uint8_t> packet,
                          MonoTime received, MonoTime now) {
  ++counters_.packets;
  newest_from_ = from;
  const auto message = message_of(packet);
  if (!message) {
    note(NatNetFault::kTooShort);
    return;
  }
  const Address machine = from.with_port(0);
  const OneSender::Verdict verdict = sender_.admit(machine, received);
  if (verdict == OneSender::Verdict::kOther) {
    ++counters_.of_others;
    return;
  }
  if (verdict == OneSender::Verdict::kReadAnew) forget_server();
  if (!is_server(from, packet, now)) return;
  switch (*message) {
    case NatNetMessage::kServerInfo:
      return take_server(packet);
    case NatNetMessage::kModels:
      return take_models(packet);
    case NatNetMessage::kFrame:
      if (take_frame(packet, received, now)) sender_.keep(machine, received);
      return;
    default:
      note(NatNetFault::kOtherMessage);
  }
}

void NatNetReceiver::take_server(std::span<const std::uint8_t> packet) {
  NatNetServer server;
  if (note(read_natnet_server(packet, server)) != NatNetFault::kNone) return;
  const bool was_told = ticks_per_second_ != 0;
  const bool is_other = version_ != server.version;
  if (was_told && (is_other || ticks_per_second_ != server.ticks_per_second)) {
    const Address same = server_;
    const MonoTime heard = server_heard_;
    forget_server();
    server_ = same;
    server_heard_ = server_since_ = heard;
  }
  version_ = server.version;
  ticks_per_second_ = server.ticks_per_second;
  if (is_other && !has_models_) request(NatNetMessage::kRequestModels, "");
}

void NatNetReceiver::take_models(std::span<const std::uint8_t> packet) {
  if (!version_) return;  // asked for again once it is known
  if (note(read_natnet_models(packet, *version_, *models_)) != NatNetFault::kNone) {
    has_models_ = false;
    return;
  }
  has_models_ = true;
  skeleton_id_.reset();
  choose_model();
}

bool NatNetReceiver::choose_model() {
  for (const NatNetModel& model : models_->skeletons) {
    if (!wanted_.empty() && !(model.name == std::string_view(wanted_))) continue;
    skeleton_id_ = model.id;
    body_->set_rig(find_natnet_rig(model));
    figure_ = JointFigure();
    return true;
  }
  return false;
}

// The middle of the cameras' exposure where the server counts in ticks that it has told.
MonoTime NatNetReceiver::capture_time(MonoTime received) {
  constexpr std::uint64_t kMostTicks = std::uint64_t{1} << 62;
  if (ticks_per_second_ > 0 && frame_->exposed_ticks > 0 && frame_->exposed_ticks < kMostTicks)
    return clock_.to_ours(static_cast<std::int64_t>(static_cast<double>(frame_->exposed_ticks) *
                                                    1e6 / static_cast<double>(ticks_per_second_)),
                          received);
  return clock_.to_ours(static_cast<std::int64_t>(frame_->timestamp_s * 1e6), received);
}

bool NatNetReceiver::take_frame(std::span<const std::uint8_t> packet, MonoTime received,
                                MonoTime now) {
  if (!version_) {
    ++counters_.before_version;
    return false;
  }
  if (note(read_natnet_frame(packet, *version_, *frame_)) != NatNetFault::kNone) {
    is_in_doubt_ = true;
    return false;
  }
  // Motive was started again, or plays a take again.
  if (frame_->number < newest_frame_ && newest_frame_ - frame_->number > kReordered)
    is_in_doubt_ = true;
  newest_frame_ = frame_->number;
  if (frame_->models_changed && has_models_) {
    has_models_ = false;
    request(NatNetMessage::kRequestModels, "");
  }
  if (frame_->skeletons.empty()) {
    if (frame_->rigid_bodies > 0) ++counters_.rigid_bodies_only;
    return false;
  }
  if (!skeleton_id_) {
    ++(has_models_ ? counters_.without_actor : counters_.before_models);
    return false;
  }
  for (const NatNetSkeleton& skeleton : frame_->skeletons)
    if (skeleton.id == *skeleton_id_) return dance(skeleton, received, now);
  ++counters_.without_actor;
  return false;
}

bool NatNetReceiver::dance(const NatNetSkeleton& skeleton, MonoTime received, MonoTime now) {
  body_->take(skeleton, place_.z_is_up);
  Pose pose;
  if (!figure_.fit(body_->figure(), pose)) {
    ++counters_.incomplete;
    return false;
  }
  dancer_.set_skeleton(figure_.skeleton());
  if (!dancer_.capture(pose, capture_time(received), now)) return false;
  Hands hands;
  if (body_->hands(hands)) dancer_.capture(hands);
  return true;
}

InputState NatNetReceiver::state() const {
  return {.arrived = counters_.packets,
          .poses = dancer_.counters().poses,
          .at = place_.listen,
          .from = newest_from_,
          .is_clock_unusable = clock_.is_unusable()};
}

std::string NatNetReceiver::diagnosis() const {
  if (counters_.packets > 0) return summary();
  if (commands_)
    return "switch on Broadcast Frame Data in Motive with the transmission type Multicast; on a "
           "machine with several networks name its address there: --listen '" +
           place_.listen.to_string() + "?interface=192.168.1.20'";
  if (!place_.server.is_set())
    return "Motive sends a unicast stream only when it is asked: name its machine: --listen '" +
           place_.listen.to_string() + "?server=192.168.1.5'";
  return "Motive does not answer at " + place_.server.to_string() +
         ": check that address, the transmission type Unicast in Motive, and the firewalls";
}

std::string NatNetReceiver::summary() const {
  const auto& poses = dancer_.counters();
  std::string line = std::to_string(poses.poses) + " poses of " +
                     std::to_string(counters_.packets) + " packets from Motive";
  const auto tell = [&line](std::uint64_t count, const char* what) {
    if (count > 0) line += ", " + std::to_string(count) + " " + what;
  };
  for (std::size_t fault = 1; fault < counters_.faults.size(); ++fault)
    tell(counters_.faults[fault], text_of(static_cast<NatNetFault>(fault)));
  tell(counters_.rigid_bodies_only,
       "frames with rigid bodies but no skeleton: switch Skeletons on in Motive's streaming pane");
  tell(counters_.before_version,
       "frames of unknown version, as the server's port 1510 does not answer: give version=4.1");
  tell(counters_.before_models,
       "frames before the skeletons' names, which the server's port 1510 tells");
  tell(counters_.without_actor, wanted_.empty() ? "frames without a skeleton that is described"
                                                : "frames without the actor that was asked for");
  tell(counters_.incomplete, "frames with bones missing");
  tell(counters_.of_others, "packets of other machines");
  tell(poses.invalid, "not valid");
  tell(poses.not_newer, "not newer");
  tell(poses.skeletons_left_out, "skeletons that changed again within a second");
  tell(data_.counters().truncated, "too long");
  tell(clock_.steps(), "jumps of the sender's clock");
  return line;
}

}  // namespace dance
