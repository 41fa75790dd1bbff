#include "producers/receive/receiver_table.h"

#include <algorithm>
#include <array>

#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/talk.h"
#include "producers/engine/engine_receiver.h"
#include "producers/natnet/natnet_receiver.h"
#include "producers/receive/input_report.h"
#include "producers/rokoko/rokoko_receiver.h"
#include "producers/vmc/vmc_receiver.h"

namespace dance {
namespace {

using Opened = Result<std::unique_ptr<PoseReceiver>>;

struct Row {
  ReceiverKind kind;
  Opened (*open)(const ReceiverOptions&, CaptureSink&, Poller&);
};

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows{
      {{"vmc", InputKind::kAddress, VmcReceiver::kUsualAddress, false}, VmcReceiver::open},
      {{"engine", InputKind::kMemory, EngineReceiver::kUsualName, false},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return EngineReceiver::open(options.name, options.guest, sink, poller);
       }},
      {{"natnet", InputKind::kAddress, kUsualNatNetPlace, true},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return NatNetReceiver::open({options.guest, options.listen, options.actor}, sink, poller);
       }},
      {{"rokoko", InputKind::kAddress, RokokoReceiver::kUsualAddress, true},
       [](const ReceiverOptions& options, CaptureSink& sink, Poller& poller) -> Opened {
         return RokokoReceiver::open({options.guest, options.listen, options.actor}, sink, poller);
       }},
  };
  return kRows;
}

// A receiver that tells the user when nothing usable arrives.
class WatchedReceiver final : public PoseReceiver {
 public:
  WatchedReceiver(const std::string& name, std::unique_ptr<PoseReceiver> receiver, Poller& poller)
      : receiver_(std::move(receiver)), poller_(poller), report_(name) {
    timer_ = poller_.add_timer(mono_now() + kSecond, [this](MonoTime now) {
      check_input(now);
      return now + kSecond;
    });
  }
  ~WatchedReceiver() override { poller_.remove_timer(timer_); }
  std::string summary() const override { return receiver_->summary(); }
  InputState state() const override { return receiver_->state(); }
  std::string diagnosis() const override { return receiver_->diagnosis(); }

 private:
  static constexpr Duration kSecond = Duration::s(1);

  void check_input(MonoTime now) {
    if (probe_) {
      const std::uint64_t before = probe_->counters().received;
      probe_->receive();  // cut datagrams count too
      arrived_elsewhere_ += probe_->counters().received - before;
    }
    for (const std::string& line : report_.tick(*receiver_, elsewhere_, arrived_elsewhere_, now))
      talk::warn("{}", line);
    if (report_.is_waiting_for_datagrams())
      open_probe();
    else
      probe_.reset();
  }
  // A program that sends to `localhost` may send to the loopback address of the other family.
  void open_probe() {
    const Address at = receiver_->state().at;
    if (probe_ || !at.is_set() || at.is_multicast()) return;
    const bool is_ipv4 = at.family() == Address::Family::kIpv4;
    elsewhere_ = is_ipv4 ? loopback_ipv6(at.port()) : Address::loopback(at.port());
    auto opened = UdpSocket::bind(elsewhere_, UdpRoom{8, 64});
    if (opened) probe_ = std::make_unique<UdpSocket>(std::move(*opened));
  }
  static Address loopback_ipv6(std::uint16_t port) {
    std::array<std::uint8_t, 16> ip{};
    ip[15] = 1;
    return Address::of(ip, port);
  }

  std::unique_ptr<PoseReceiver> receiver_;
  Poller& poller_;
  Poller::TimerId timer_;
  InputReport report_;
  std::unique_ptr<UdpSocket> probe_;
  Address elsewhere_;
  std::uint64_t arrived_elsewhere_ = 0;
};

const Row* find_row(const std::string& name) {
  const auto row = std::find_if(rows().begin(), rows().end(),
                                [&](const Row& each) { return each.kind.name == name; });
  return row == rows().end() ? nullptr : &*row;
}

}  // namespace

std::vector<std::string> receiver_names() {
  std::vector<std::string> names;
  for (const Row& row : rows()) names.push_back(row.kind.name);
  return names;
}

const ReceiverKind* find_receiver_kind(const std::string& name) {
  const Row* row = find_row(name);
  return row ? &row->kind : nullptr;
}

Result<void> check_receiver_options(const ReceiverKind& kind, const ReceiverOptions& options) {
  if (!options.listen.empty() && kind.input != InputKind::kAddress)
    return fail("'" + kind.name + "' has a name, not an address to listen at");
  if (!options.name.empty() && kind.input != InputKind::kMemory)
    return fail("'" + kind.name + "' listens at an address, as 0.0.0.0:39539; it has no name");
  if (!options.actor.empty() && !kind.has_actors)
    return fail("'" + kind.name + "' carries one dancer; leave the actor out");
  return {};
}

Result<std::unique_ptr<PoseReceiver>> open_receiver(const std::string& from,
                                                    const ReceiverOptions& options,
                                                    CaptureSink& sink, Poller& poller) {
  const Row* row = find_row(from);
  if (!row) {
    std::string known;
    for (const std::string& name : receiver_names()) known += known.empty() ? name : ", " + name;
    return fail("there is no receiver '" + from + "'; known are " + known);
  }
  if (auto checked = check_receiver_options(row->kind, options); !checked)
    return tl::make_unexpected(checked.error());
  DANCE_TRY(auto receiver, row->open(options, sink, poller));
  return std::make_unique<WatchedReceiver>(from, std::move(receiver), poller);
}

}  // namespace dance
