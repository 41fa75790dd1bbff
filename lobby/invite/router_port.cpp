#include "lobby/invite/router_port.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/net/machine_addresses.h"

namespace dance {
namespace {

constexpr std::uint8_t kVersion = 0, kAskAddress = 0, kMapUdp = 1, kAnswer = 128;
constexpr std::size_t kAddressAnswer_bytes = 12, kMapAnswer_bytes = 16;
constexpr std::uint32_t kLifetime_s = 3600;
constexpr Duration kFirstWait = Duration::ms(250);  // doubled with each try
constexpr int kMostTries = 5;                       // 8 s in all
constexpr std::uint32_t kShortestLifetime_s = 120;
// A flood of datagrams must not keep the drawing thread: the rest waits for the next turn.
constexpr int kMostBatches = 8;

std::uint16_t u16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}
std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{u16_at(bytes, at)} << 16 | u16_at(bytes, at + 2);
}

std::string without_port(const Address& address) {
  const std::string text = address.with_port(1).to_string();
  return text.substr(0, text.rfind(':'));
}

}  // namespace

Result<RouterPort> RouterPort::start(const Address& router, std::uint16_t port, MonoTime now) {
  DANCE_TRY(UdpSocket socket, UdpSocket::connect(router, {4, 64}));
  RouterPort asked(std::move(socket), port);
  asked.next_ = now;
  asked.work(now);
  return asked;
}

void RouterPort::ask(std::uint32_t lifetime_s) {
  const std::array<std::uint8_t, 2> address{kVersion, kAskAddress};
  const auto high = static_cast<std::uint8_t>(port_ >> 8), low = static_cast<std::uint8_t>(port_);
  // A lifetime of 0 releases the port; the requested outer port must then be 0 too.
  const bool is_wanted = lifetime_s > 0;
  const std::array<std::uint8_t, 12> map{kVersion,
                                         kMapUdp,
                                         0,
                                         0,
                                         high,
                                         low,
                                         is_wanted ? high : std::uint8_t{0},
                                         is_wanted ? low : std::uint8_t{0},
                                         static_cast<std::uint8_t>(lifetime_s >> 24),
                                         static_cast<std::uint8_t>(lifetime_s >> 16),
                                         static_cast<std::uint8_t>(lifetime_s >> 8),
                                         static_cast<std::uint8_t>(lifetime_s)};
  if (is_wanted) socket_.send_now({}, address);
  socket_.send_now({}, map);
}

bool RouterPort::work(MonoTime now) {
  const State before = state_;
  for (int batch = 0; batch < kMostBatches; ++batch) {
    const auto got = socket_.receive();
    if (got.empty()) break;
    for (const UdpSocket::Datagram& it : got) take(it.bytes, now);
  }
  const bool asks = state_ == State::kAsking || state_ == State::kOpen;
  if (asks && now >= next_) {
    if (tries_ == kMostTries) {
      state_ = State::kSilent;
    } else {
      ask(kLifetime_s);
      next_ = now + kFirstWait * (1 << tries_);
      ++tries_;
    }
  }
  return state_ != before;
}

void RouterPort::take(std::span<const std::uint8_t> bytes, MonoTime now) {
  constexpr std::uint16_t kSuccess = 0;
  if (bytes.size() < 8 || bytes[0] != kVersion) return;
  const bool is_address = bytes[1] == kAnswer + kAskAddress;
  const bool is_map = bytes[1] == kAnswer + kMapUdp;
  if (!is_address && !is_map) return;
  if (u16_at(bytes, 2) != kSuccess) {
    // Without the port a later answer about the address alone does not open it again.
    outer_port_ = 0;
    state_ = State::kRefused;
    return;
  }
  if (is_address && bytes.size() == kAddressAnswer_bytes) {
    const Address told = Address::of(bytes.subspan(8, 4), 0);
    host_ = told.scope() == Address::Scope::kNone ? "" : without_port(told);
  }
  if (is_map && bytes.size() == kMapAnswer_bytes && u16_at(bytes, 8) == port_) {
    const std::uint32_t lifetime_s = std::max(u32_at(bytes, 12), kShortestLifetime_s);
    outer_port_ = u16_at(bytes, 10);
    tries_ = 0;
    next_ = now + Duration::s(std::min(lifetime_s, kLifetime_s) / 2);
  }
  if (!host_.empty() && outer_port_ != 0) state_ = State::kOpen;
}

void RouterPort::close() {
  if (state_ == State::kOpen || state_ == State::kAsking) ask(0);
  state_ = State::kSilent;
}

std::string RouterPort::address() const {
  if (state_ != State::kOpen) return "";
  return outer_port_ == port_ ? host_ : host_ + ":" + std::to_string(outer_port_);
}

bool RouterPort::is_behind_another() const {
  return state_ == State::kOpen && is_private_address(host_);
}

}  // namespace dance
