#include "bench/tunnel/flood_attack.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"
#include "tunnel/seal/seal_client.h"

namespace dance {
namespace {

constexpr std::size_t kKept = 256;
constexpr std::size_t kDatagramsAtOnce = 32;
constexpr Duration kWrongKeyEach = Duration::ms(250);

// Addresses of 127/8 are all this machine's: 127.1.0.1, 127.1.0.2 …
Result<UdpSocket> socket_at(std::size_t number) {
  const std::string ip =
      "127.1." + std::to_string(number / 250) + "." + std::to_string(number % 250 + 1);
  DANCE_TRY(const Address local, Address::resolve(ip + ":1"));
  return UdpSocket::bind(local.with_port(0));
}

class OneDatagram final : public DatagramSink {
 public:
  void send(const Address&, std::span<const std::uint8_t> of) override {
    bytes.assign(of.begin(), of.end());
  }
  std::vector<std::uint8_t> bytes;
};

}  // namespace

Result<std::unique_ptr<FloodAttack>> FloodAttack::make(const Options& options) {
  auto attack = std::unique_ptr<FloodAttack>(new FloodAttack(options));
  for (std::size_t i = 0; i < std::max<std::size_t>(options.sources, 1); ++i) {
    DANCE_TRY(UdpSocket socket, socket_at(i));
    attack->sockets_.push_back(std::move(socket));
  }
  attack->make_hello();
  return attack;
}

FloodAttack::~FloodAttack() {
  is_stopped_ = true;
  if (thread_.joinable()) thread_.join();
}

void FloodAttack::make_hello() {
  OneDatagram sink;
  auto context = SealContext::for_link(identity_text("nobody", PrivateKey::make().public_key()),
                                       PresharedKey::make(), PublicKey());
  if (!context) return;
  SealClient client(std::move(*context), secure_random_u64, {}, sink);
  client.tick(mono_now());
  hello_ = sink.bytes;
}

void FloodAttack::record(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  if (first_.size() < kKept) first_.emplace_back(bytes.begin(), bytes.end());
  if (newest_.size() < kKept) newest_.emplace_back();
  newest_[next_newest_].assign(bytes.begin(), bytes.end());
  next_newest_ = (next_newest_ + 1) % kKept;
}

void FloodAttack::start() {
  thread_ = std::thread([this] { run(); });
}

FloodAttack::Totals FloodAttack::totals() const {
  const std::lock_guard lock(mutex_);
  return totals_;
}

FloodAttack::Datagram FloodAttack::recorded(bool is_of_begin) {
  const std::lock_guard lock(mutex_);
  const auto& from = is_of_begin ? first_ : newest_;
  return from.empty() ? Datagram{} : from[random_.next_u64() % from.size()];
}

FloodAttack::Datagram FloodAttack::make(Attack attack) {
  switch (attack) {
    case Attack::kNoise: {
      Datagram bytes(random_.next_u64() % 1400);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random_.next_u64());
      return bytes;
    }
    case Attack::kHello: {
      Datagram bytes = hello_;
      const std::uint64_t id = seal::id_of(random_.next_u64() | 4);
      if (bytes.size() > seal::kIdBytes && id != 0)
        seal::write_opening(id, seal::Form::kRecords, bytes);
      return bytes;
    }
    case Attack::kChanged: {
      Datagram bytes = recorded(false);
      for (int i = 0; i < 3 && bytes.size() > seal::kIdBytes; ++i)
        bytes[seal::kIdBytes + random_.next_u64() % (bytes.size() - seal::kIdBytes)] ^=
            static_cast<std::uint8_t>(1 + random_.next_u64() % 255);
      return bytes;
    }
    case Attack::kReplayed:
      return recorded(false);
    case Attack::kOldSession:
      return recorded(true);
    case Attack::kWrongKey:
    case Attack::kCount:
      break;
  }
  return {};
}

void FloodAttack::take_answers() {
  std::uint64_t bytes = 0;
  for (UdpSocket& socket : sockets_)
    for (const auto& datagram : socket.receive()) bytes += datagram.bytes.size();
  const std::lock_guard lock(mutex_);
  totals_.bytes_answered += bytes;
}

// A whole handshake, whose answers are waited for: what is wrong is the key alone.
void FloodAttack::try_wrong_key(MonoTime now) {
  auto socket = UdpSocket::connect(options_.server);
  auto context = SealContext::for_link("local", PresharedKey::make(), PublicKey());
  if (!socket || !context) return;
  Totals more;
  struct Sink final : DatagramSink {
    UdpSocket* socket = nullptr;
    Totals* totals = nullptr;
    void send(const Address& to, std::span<const std::uint8_t> bytes) override {
      ++totals->sent[static_cast<std::size_t>(Attack::kWrongKey)];
      totals->bytes_sent += bytes.size();
      socket->send_now(to, bytes);
    }
  };
  Sink sink;
  sink.socket = &*socket;
  sink.totals = &more;
  SealClient client(std::move(*context), secure_random_u64, {}, sink);
  client.tick(now);
  bool is_over = false;
  for (int i = 0; i < 50 && !is_over; ++i) {
    for (const auto& datagram : socket->receive()) {
      client.receive(datagram.bytes, datagram.received, mono_now());
      // A refusal ends it; the next try would be later.
      is_over = client.counters().tries > 0 && client.next_deadline() > now + Duration::s(1);
    }
    timespec pause{0, 200'000};
    nanosleep(&pause, nullptr);
  }
  more.let_in = client.is_sealed() ? 1 : 0;
  const std::lock_guard lock(mutex_);
  totals_.sent[static_cast<std::size_t>(Attack::kWrongKey)] +=
      more.sent[static_cast<std::size_t>(Attack::kWrongKey)];
  totals_.let_in += more.let_in;
}

void FloodAttack::run() {
  const MonoTime begin = mono_now();
  MonoTime next_wrong_key = begin;
  std::uint64_t sent = 0;
  while (sent < options_.datagrams && !is_stopped_) {
    const MonoTime now = mono_now();
    if (now >= next_wrong_key) {
      try_wrong_key(now);
      next_wrong_key = mono_now() + kWrongKeyEach;
    }
    const auto due = static_cast<std::uint64_t>((now - begin).as_seconds() * options_.per_second);
    if (sent >= std::min(due, options_.datagrams)) {
      timespec pause{0, 200'000};
      nanosleep(&pause, nullptr);
      continue;
    }
    // Half of it from one address, the rest from all.
    UdpSocket& socket =
        sockets_[random_.next_u64() % 2 == 0 ? 0 : random_.next_u64() % sockets_.size()];
    Totals more;
    for (std::size_t i = 0; i < kDatagramsAtOnce; ++i) {
      const auto attack = static_cast<Attack>(random_.next_u64() % (kAttacks - 1));
      const Datagram bytes = make(attack);
      socket.send(options_.server, bytes);
      ++more.sent[static_cast<std::size_t>(attack)];
      more.bytes_sent += bytes.size();
    }
    socket.flush();
    sent += kDatagramsAtOnce;
    {
      const std::lock_guard lock(mutex_);
      for (std::size_t i = 0; i < kAttacks; ++i) totals_.sent[i] += more.sent[i];
      totals_.bytes_sent += more.bytes_sent;
    }
    if (sent % (kDatagramsAtOnce * 16) == 0) take_answers();
  }
  timespec pause{0, 200'000'000};
  nanosleep(&pause, nullptr);
  take_answers();
  is_over_ = true;
}

}  // namespace dance
