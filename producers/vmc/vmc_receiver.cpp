#include "producers/vmc/vmc_receiver.h"

#include <cmath>

#include "producers/receive/input_report.h"

namespace dance {
namespace {

// A float of more seconds than these counts in steps of over 2 ms: no use as a capture time.
constexpr float kCoarseTime_s = 16'384.0f;

void add_count(std::string& line, std::uint64_t count, const char* what) {
  if (count > 0) line += "; " + std::to_string(count) + what;
}

}  // namespace

void VmcIntake::take(std::span<const std::uint8_t> packet, MonoTime received, MonoTime now) {
  now_ = now;
  assembler_.begin_packet(received);
  reader_.read(packet, *this);
  assembler_.end_packet();
}

void VmcIntake::begin_anew() {
  assembler_.forget();
  body_ = VmcBody();
  clock_.begin_anew();
}

void VmcIntake::on_message(const OscMessage& message) {
  const VmcMessage parsed = parse_vmc(message);
  if (parsed.kind == VmcMessage::Kind::kMalformed) {
    ++malformed_;
    if (parsed.has_doubles) ++with_doubles_;
    return;
  }
  if (parsed.kind == VmcMessage::Kind::kBone) ++bones_;
  assembler_.take(parsed);
}

void VmcIntake::on_frame(const ReceivedVmcFrame& frame) {
  body_.take(frame);
  dancer_.set_skeleton(body_.skeleton());
  const bool has_time = frame.time_s && *frame.time_s >= 0.0f && *frame.time_s < kCoarseTime_s;
  const MonoTime captured =
      has_time
          ? clock_.to_ours(std::llround(static_cast<double>(*frame.time_s) * 1e6), frame.received)
          : frame.received;
  Pose pose = body_.pose();
  if (!dancer_.capture(pose, captured, now_) || body_.hands().presence == 0) return;
  Hands hands = body_.hands();
  dancer_.capture(hands);
}

std::string VmcIntake::summary() const {
  std::string line = "vmc: " + std::to_string(dancer_.counters().poses) + " poses of " +
                     std::string(dancer_.guest().view());
  if (dancer_.counters().poses > 0)
    line += body_.has_own_proportions() ? ", of the sender's proportions"
                                        : ", of average proportions, as the sender has none";
  add_count(line, reader_.counters().damaged, " packets that are no Open Sound Control");
  add_count(line, malformed_, " malformed messages");
  add_count(line, assembler_.unknown_bones(), " bones of unknown names");
  add_count(line, dancer_.counters().invalid, " poses that cannot be");
  add_count(line, dancer_.counters().not_newer, " poses not newer than the last");
  add_count(line, dancer_.counters().skeletons_left_out,
            " skeletons that changed again within a second");
  return line;
}

std::string VmcIntake::diagnosis() const {
  const OscReader::Counters& packets = reader_.counters();
  if (packets.messages == 0)
    return "they are no Open Sound Control; let the program send VMC protocol (OSC over UDP)";
  if (with_doubles_ > 0)
    return "their numbers are doubles (OSC type d), and VMC protocol has floats (f); let the "
           "program send floats";
  if (malformed_ > 0)
    return "the values of " + std::to_string(malformed_) +
           " messages are not those of VMC protocol: a name, three coordinates and a unit "
           "quaternion of floats for each bone";
  if (bones_ == 0)
    return "they are Open Sound Control without bones (/VMC/Ext/Bone/Pos); switch on sending of "
           "motion by VMC protocol in the program, as a Performer";
  if (assembler_.unknown_bones() == bones_)
    return "none of their bones has a name of Unity's humanoid skeleton, such as Hips or Spine";
  return summary();
}

Result<std::unique_ptr<PoseReceiver>> VmcReceiver::open(const ReceiverOptions& options,
                                                        CaptureSink& sink, Poller& poller) {
  DANCE_TRY(const Address at,
            Address::resolve(options.listen.empty() ? kUsualAddress : options.listen));
  DANCE_TRY(UdpSocket socket, UdpSocket::bind(at, kLongDatagrams));
  return std::unique_ptr<PoseReceiver>(
      new VmcReceiver(options.guest, sink, poller, std::move(socket)));
}

VmcReceiver::VmcReceiver(const GuestId& guest, CaptureSink& sink, Poller& poller, UdpSocket socket)
    : poller_(poller), socket_(std::move(socket)), intake_(guest, sink) {
  poller_.watch(socket_.fd(), [this](MonoTime now) { drain(now); });
}

VmcReceiver::~VmcReceiver() { poller_.unwatch(socket_.fd()); }

void VmcReceiver::drain(MonoTime now) {
  // One batch a turn: what is left wakes the poller again, and others have their turn before.
  for (const UdpSocket::Datagram& datagram : socket_.receive()) {
    newest_from_ = datagram.from;
    const OneSender::Verdict verdict = sender_.admit(datagram.from, datagram.received);
    if (verdict == OneSender::Verdict::kOther) continue;
    if (verdict == OneSender::Verdict::kReadAnew) intake_.begin_anew();
    const std::uint64_t poses = intake_.dancer().counters().poses;
    intake_.take(datagram.bytes, datagram.received, now);
    if (intake_.dancer().counters().poses > poses) sender_.keep(datagram.from, datagram.received);
  }
}

InputState VmcReceiver::state() const {
  return {.arrived = socket_.counters().received,
          .poses = intake_.dancer().counters().poses,
          .at = socket_.local_address(),
          .from = newest_from_,
          .is_clock_unusable = intake_.is_clock_unusable()};
}

std::string VmcReceiver::diagnosis() const {
  if (socket_.counters().received == 0) return nothing_arrives_text(socket_.local_address());
  return intake_.diagnosis();
}

std::string VmcReceiver::summary() const {
  std::string line = intake_.summary();
  add_count(line, sender_.others(), " packets of a second sender, who has to use another port");
  add_count(line, socket_.counters().truncated, " packets that were cut");
  return line;
}

}  // namespace dance
