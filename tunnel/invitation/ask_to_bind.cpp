// The house's side of the exchange in a session that an invitation opened.
#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/secure_random.h"
#include "core/net/udp_socket.h"
#include "tunnel/invitation/open_invitation.h"
#include "tunnel/seal/seal_client.h"

namespace dance {
namespace {

constexpr Duration kAskAgain = Duration::ms(250);
constexpr int kRefusalsCount = 2;

// A try at one of the server's addresses after the other, in a loop of its own.
class BindingQuestion {
 public:
  // `key` opens the sessions; `identity` names it.
  BindingQuestion(const Invitation& invitation, std::string identity, const PresharedKey& key,
                  std::vector<Address> addresses, Poller& poller)
      : invitation_(invitation),
        identity_(std::move(identity)),
        key_(key),
        addresses_(std::move(addresses)),
        poller_(poller) {}
  ~BindingQuestion() { end_socket(); }
  BindingQuestion(const BindingQuestion&) = delete;
  BindingQuestion& operator=(const BindingQuestion&) = delete;

  Result<Binding> run(Duration patience) {
    const MonoTime given_up = mono_now() + patience;
    while (!answer_ && !no_trust_ && !is_other_server_) {
      const MonoTime now = mono_now();
      if (now >= given_up) return fail(no_answer_line());
      if (needs_socket_) {
        if (auto begun = begin_at_next_address(); !begun) return tl::make_unexpected(begun.error());
      }
      if (now >= client_->next_deadline()) client_->tick(now);
      if (is_sealed_ && now >= ask_at_) {
        client_->send({}, kRequest);
        ask_at_ = now + kAskAgain;
      }
      socket_->flush();
      poller_.run_once(Duration::ms(20));
    }
    if (answer_) return *answer_;
    if (is_other_server_)
      return fail("the server " + invitation_.server() +
                  " has another key than the invitation says: it is not the server that invited "
                  "you, or its key has changed since; ask its keeper for another invitation");
    return fail("the server " + invitation_.server() +
                " takes no keys, or speaks another version of DanceGraph: ask its keeper which");
  }

 private:
  std::string no_answer_line() const {
    if (was_interrupted_)
      return "the server " + invitation_.server() +
             " answers, and then no more: is there a firewall on the way? Then open the "
             "invitation again";
    return "the server " + invitation_.server() +
           " does not answer: is it running, its UDP port open, and this machine online? Then open "
           "the invitation again";
  }

  void end_socket() {
    client_.reset();  // says so to the server
    if (!socket_) return;
    socket_->flush();
    poller_.unwatch(socket_->fd());
    socket_.reset();
  }

  Result<void> begin_at_next_address() {
    end_socket();
    is_sealed_ = false;
    // One that this machine has no way to (IPv6 without IPv6, say) is left out.
    for (std::size_t i = 0; i < addresses_.size() && !socket_; ++i) {
      auto made = UdpSocket::connect(addresses_[next_]);
      next_ = (next_ + 1) % addresses_.size();
      if (made)
        socket_ = std::make_unique<UdpSocket>(std::move(*made));
      else if (i + 1 == addresses_.size())
        return tl::make_unexpected(made.error());
    }
    DANCE_TRY(auto context, SealContext::for_link(identity_, key_, invitation_.server_key));
    client_ =
        std::make_unique<SealClient>(std::move(context), secure_random_u64, handlers(), *socket_);
    poller_.watch(socket_->fd(), [this](MonoTime now) {
      for (const UdpSocket::Datagram& datagram : socket_->receive())
        client_->receive(datagram.bytes, datagram.received, now);
    });
    needs_socket_ = false;
    return {};
  }

  SealClient::Handlers handlers() {
    SealClient::Handlers handlers;
    handlers.on_sealed = [this](MonoTime now) {
      is_sealed_ = true;
      ask_at_ = now;
    };
    handlers.on_unsealed = [this](MonoTime) { is_sealed_ = false; };
    handlers.on_datagram = [this](seal::Bytes plain, MonoTime, MonoTime) {
      if (plain.size() == seal::kBindingAnswerBytes && plain[0] == seal::kBindingAnswer &&
          plain[1] < static_cast<std::uint8_t>(Binding::kCount))
        answer_ = static_cast<Binding>(plain[1]);
    };
    handlers.on_trouble = [this](SealTrouble trouble, MonoTime) {
      switch (trouble) {
        case SealTrouble::kNoAnswer:
          needs_socket_ = true;
          break;
        case SealTrouble::kInterrupted:
          was_interrupted_ = true;
          break;
        case SealTrouble::kWrongKey:
          // A server reads its keys again each second, and the invitation may be newer than that;
          // the next try comes later.
          if (++refusals_ == kRefusalsCount) answer_ = Binding::kUnknown;
          break;
        case SealTrouble::kNotTrusted:
          no_trust_ = true;
          break;
        case SealTrouble::kServerKeyChanged:
          is_other_server_ = true;
          break;
      }
    };
    return handlers;
  }

  static constexpr std::array<std::uint8_t, seal::kBindingRequestBytes> kRequest{
      seal::kBindingRequest};

  const Invitation& invitation_;
  std::string identity_;
  PresharedKey key_;
  std::vector<Address> addresses_;
  Poller& poller_;
  std::unique_ptr<UdpSocket> socket_;
  std::unique_ptr<SealClient> client_;
  std::size_t next_ = 0;
  MonoTime ask_at_;
  bool needs_socket_ = true;
  bool is_sealed_ = false;
  bool no_trust_ = false;
  bool is_other_server_ = false;
  int refusals_ = 0;
  bool was_interrupted_ = false;
  std::optional<Binding> answer_;
};

}  // namespace

Result<Binding> ask_to_bind(const Invitation& invitation, const PrivateKey& house,
                            Duration patience) {
  const auto key = house_session_key(house, invitation.key, invitation.server_key);
  if (!key) return fail("the invitation names no key that a server could have: ask for another");
  DANCE_TRY(auto addresses, Address::resolve_all(invitation.server()));
  DANCE_TRY(const auto poller, Poller::create());
  const std::string name = std::string(seal::kInvitedPrefix) + std::string(invitation.guest.view());
  BindingQuestion question(invitation, identity_text(name, house.public_key()), *key,
                           std::move(addresses), *poller);
  return question.run(patience);
}

}  // namespace dance
