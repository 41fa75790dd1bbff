#include "tunnel/link/failover/server_probe.h"

#include <algorithm>
#include <array>

#include "core/net/secure_random.h"
#include "tunnel/seal/seal_format.h"

namespace dance {
namespace {

constexpr Duration kLongestWait = Duration::ms(600);

}  // namespace

ServerProbe::~ServerProbe() { clear(); }

void ServerProbe::clear() {
  for (const Question& question : questions_) poller_.unwatch(question.socket.fd());
  questions_.clear();
}

void ServerProbe::begin(std::span<const Address> servers, MonoTime now) {
  clear();
  questions_.reserve(servers.size());
  for (const Address& server : servers) {
    auto socket = UdpSocket::connect(server, {.datagrams = 8, .bytes = 64});
    if (!socket) continue;
    const std::size_t which = questions_.size();
    questions_.push_back({server, std::move(*socket), 0, MonoTime(), std::nullopt});
    poller_.watch(questions_.back().socket.fd(), [this, which](MonoTime) { on_readable(which); });
  }
  for (Question& question : questions_) ask(question, now);
  next_ = questions_.empty() ? MonoTime() : now + kLongestWait;
}

void ServerProbe::tick(MonoTime now) {
  if (next_.is_set() && now >= next_) next_ = MonoTime();
}

void ServerProbe::ask(Question& question, MonoTime now) {
  do {
    question.id = seal::id_of(secure_random_u64());
  } while (question.id == 0);
  std::array<std::uint8_t, seal::kOverhead + 1> bytes{};
  seal::write_opening(question.id, seal::Form::kCompact, bytes);
  question.asked = now;
  question.socket.send_now(question.to, bytes);
}

void ServerProbe::on_readable(std::size_t which) {
  Question& question = questions_[which];
  for (const UdpSocket::Datagram& datagram : question.socket.receive()) {
    const auto opening = seal::parse(datagram.bytes);
    if (!opening || opening->form != seal::Form::kNotice || opening->id != question.id) continue;
    question.round_trip = std::max(Duration(), datagram.received - question.asked);
    on_answer_(question.to);
  }
}

std::optional<Duration> ServerProbe::round_trip(const Address& server) const {
  for (const Question& question : questions_)
    if (question.to == server) return question.round_trip;
  return std::nullopt;
}

}  // namespace dance
