#include "producers/engine/engine_receiver.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "core/net/local_address.h"

namespace dance {
namespace {

// So that one who floods the socket does not keep the house from its other work.
constexpr int kMostATurn = 64;

}  // namespace

Result<std::unique_ptr<EngineReceiver>> EngineReceiver::open(const std::string& name,
                                                             const GuestId& guest,
                                                             CaptureSink& sink, Poller& poller) {
  const auto id = GuestId::parse(name.empty() ? kUsualName : name);
  if (!id)
    return fail("the name '" + name + "' for an engine: 1 to 24 characters of a-z, 0-9 and '-'");
  DANCE_TRY(auto socket,
            LocalDatagramSocket::bind(local_socket_folder() + "/" + engine::kSocketPrefix +
                                      std::string(id->view())));
  return std::unique_ptr<EngineReceiver>(
      new EngineReceiver(std::move(socket), guest, sink, poller));
}

EngineReceiver::EngineReceiver(std::unique_ptr<LocalDatagramSocket> socket, const GuestId& guest,
                               CaptureSink& sink, Poller& poller)
    : socket_(std::move(socket)), poller_(poller), dancer_(guest, sink) {
  poller_.watch(socket_->fd(), [this](MonoTime now) { drain(now); });
}

EngineReceiver::~EngineReceiver() { poller_.unwatch(socket_->fd()); }

void EngineReceiver::drain(MonoTime now) {
  // One byte more than the longest, so that a longer one has not the size of a valid one.
  std::array<std::uint8_t, engine::kMostDatagram_bytes + 1> buffer;
  for (int i = 0; i < kMostATurn; ++i) {
    const std::ptrdiff_t size = socket_->receive(buffer);
    if (size < 0) return;
    ++datagrams_;
    const std::size_t kept = std::min(static_cast<std::size_t>(size), buffer.size());
    engine::Received received = engine::decode({buffer.data(), kept});
    take(received, now);
  }
}

void EngineReceiver::take(engine::Received& received, MonoTime now) {
  if (const auto* fault = std::get_if<engine::Fault>(&received.what)) return count(*fault);
  auto* pose = std::get_if<Pose>(&received.what);
  // Before it is asked whose it is: an engine with a wrong clock does not keep a good one out.
  if (pose && (pose->capture_time - now > kMostAhead || now - pose->capture_time > kMostBehind)) {
    ++counters_.time;
    return;
  }
  if (received.session != session_) {
    if (heard_.is_set() && now - heard_ < kOtherMayFollow) {
      ++counters_.other_engine;
      return;
    }
    session_ = received.session;
  }
  if (pose) {
    // Only poses: proportions come before the first, and alone keep no other engine out.
    heard_ = now;
    dancer_.capture(*pose, pose->capture_time, now);
  } else if (auto* hands = std::get_if<Hands>(&received.what)) {
    if (dancer_.counters().poses > 0) dancer_.capture(*hands);
  } else if (const auto* skeleton = std::get_if<Skeleton>(&received.what)) {
    dancer_.set_skeleton(*skeleton);
  }
}

void EngineReceiver::count(engine::Fault fault) {
  switch (fault) {
    case engine::Fault::kForeign:
      ++counters_.foreign;
      break;
    case engine::Fault::kOtherVersion:
      ++counters_.version;
      break;
    case engine::Fault::kWrongSize:
      ++counters_.size;
      break;
    case engine::Fault::kInvalid:
      ++counters_.invalid;
      break;
  }
}

InputState EngineReceiver::state() const {
  InputState state;
  state.arrived = datagrams_;
  state.poses = dancer_.counters().poses;
  return state;
}

std::string EngineReceiver::diagnosis() const {
  if (datagrams_ > 0) return summary();
  return "start the engine with DanceGraph's adapter on this machine, as the same user and with "
         "the same name";
}

std::string EngineReceiver::summary() const {
  const ReceivedDancer::Counters& poses = dancer_.counters();
  std::string text =
      std::to_string(poses.poses) + " poses of " + std::string(dancer_.guest().view());
  const auto left_out = [&](std::uint64_t count, const char* why) {
    if (count > 0) text += "; left out: " + std::to_string(count) + " " + why;
  };
  left_out(poses.not_newer, "not newer than the last");
  left_out(poses.invalid + counters_.invalid, "not valid");
  left_out(counters_.time, "captured too far from now");
  left_out(counters_.other_engine, "of another engine");
  left_out(counters_.version, "of another version of libdance_adapter");
  left_out(counters_.size, "of a wrong size");
  left_out(counters_.foreign, "of another program");
  return text;
}

}  // namespace dance
