#include "testing/flood/newcomer_flood.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "core/net/secure_random.h"
#include "tunnel/seal/seal_client.h"

namespace dance {
namespace {

constexpr std::size_t kCookieBytes = 16;
// Within a record: handshake header, version and random stand before the session id.
constexpr std::size_t kHandshakeHeader = 12, kVersionAndRandom = 2 + 32;
constexpr std::uint8_t kHelloVerifyRequest = 3;

std::string refused(const char* what) {
  std::array<char, 128> text{};
  return std::string(what) + ": " + strerror_r(errno, text.data(), text.size());
}

void add_to_u16(std::uint8_t* at, std::size_t more) {
  const std::size_t value = (std::size_t{at[0]} << 8 | at[1]) + more;
  at[0] = static_cast<std::uint8_t>(value >> 8);
  at[1] = static_cast<std::uint8_t>(value);
}

class OneDatagram final : public DatagramSink {
 public:
  void send(const Address&, std::span<const std::uint8_t> of) override {
    bytes.assign(of.begin(), of.end());
  }
  std::vector<std::uint8_t> bytes;
};

// The second hello of a handshake: the first with the server's cookie in it.
std::vector<std::uint8_t> with_cookie(std::vector<std::uint8_t> hello, std::uint64_t id,
                                      seal::Bytes cookie) {
  seal::write_opening(id, seal::Form::kRecords, hello);
  std::uint8_t* record = hello.data() + seal::kIdBytes;
  std::uint8_t* handshake = record + seal::kRecordHeader;
  record[10] = 1;    // sequence of the record
  handshake[5] = 1;  // sequence of the message
  add_to_u16(record + 11, cookie.size());
  add_to_u16(handshake + 2, cookie.size());
  add_to_u16(handshake + 10, cookie.size());
  const std::size_t session_id =
      seal::kIdBytes + seal::kRecordHeader + kHandshakeHeader + kVersionAndRandom;
  const std::size_t length = session_id + 1 + hello[session_id];
  hello[length] = static_cast<std::uint8_t>(cookie.size());
  hello.insert(hello.begin() + static_cast<std::ptrdiff_t>(length) + 1, cookie.begin(),
               cookie.end());
  return hello;
}

// The cookie in a HelloVerifyRequest; empty where the datagram is something else.
seal::Bytes cookie_in(seal::Bytes records) {
  const auto record = seal::take_record(records);
  if (!record || record->type != seal::kHandshake) return {};
  const seal::Bytes body = record->body();
  constexpr std::size_t kBefore = kHandshakeHeader + 2 + 1;
  if (body.size() != kBefore + kCookieBytes || body[0] != kHelloVerifyRequest) return {};
  return body.subspan(kBefore);
}

}  // namespace

Result<std::unique_ptr<NewcomerFlood>> NewcomerFlood::make(const Options& options) {
  const int fd = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return fail(refused("no IPv6 socket for the flood"));
  auto flood = std::unique_ptr<NewcomerFlood>(new NewcomerFlood(options, fd));
  const int on = 1, room = 1 << 20;
  sockaddr_in6 any{};
  any.sin6_family = AF_INET6;
  if (setsockopt(fd, IPPROTO_IPV6, IPV6_FREEBIND, &on, sizeof on) != 0 ||
      setsockopt(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, &on, sizeof on) != 0 ||
      setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &room, sizeof room) != 0 ||
      bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0)
    return fail(refused("no socket that sends from many IPv6 addresses"));
  if (auto made = flood->make_hello(); !made) return tl::make_unexpected(made.error());
  return flood;
}

NewcomerFlood::~NewcomerFlood() {
  is_stopped_ = true;
  if (thread_.joinable()) thread_.join();
  close(fd_);
}

void NewcomerFlood::start() {
  thread_ = std::thread([this] { run(); });
}

Result<void> NewcomerFlood::make_hello() {
  OneDatagram sink;
  DANCE_TRY(auto context,
            SealContext::for_link(identity_text("nobody", PrivateKey::make().public_key()),
                                  PresharedKey::make(), PublicKey()));
  SealClient client(std::move(context), secure_random_u64, {}, sink);
  client.tick(mono_now());
  hello_ = sink.bytes;
  const auto opening = seal::parse(hello_);
  const auto cookie = opening ? seal::cookie_of(opening->body) : std::nullopt;
  if (!cookie || !cookie->empty()) return fail("the flood's first datagram is no ClientHello");
  return {};
}

void NewcomerFlood::send(const std::array<std::uint8_t, 16>& from,
                         const std::vector<std::uint8_t>& bytes) {
  sockaddr_storage to{};
  const socklen_t to_size = options_.server.to_sockaddr(Address::Family::kIpv6, to);
  iovec data{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in6_pktinfo))> control{};
  msghdr message{};
  message.msg_name = &to;
  message.msg_namelen = to_size;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = IPPROTO_IPV6;
  header->cmsg_type = IPV6_PKTINFO;
  header->cmsg_len = CMSG_LEN(sizeof(in6_pktinfo));
  in6_pktinfo info{};
  std::memcpy(&info.ipi6_addr, from.data(), from.size());
  std::memcpy(CMSG_DATA(header), &info, sizeof info);
  (void)sendmsg(fd_, &message, 0);  // what is not sent is not counted as answered
}

void NewcomerFlood::send_hello() {
  const auto network =
      static_cast<std::uint32_t>(random_.next_u64() & ((1u << options_.network_bits) - 1));
  std::array<std::uint8_t, 16> from{0x20, 0x01, 0x0d, 0xb8};
  from[6] = static_cast<std::uint8_t>(network >> 8);
  from[7] = static_cast<std::uint8_t>(network);
  from[15] = 1;
  const std::uint64_t id = seal::id_of(random_.next_u64() | 4);
  if (id == 0) return;
  std::vector<std::uint8_t> hello = hello_;
  seal::write_opening(id, seal::Form::kRecords, hello);
  send(from, hello);
  ++hellos_;
}

// False where nothing waits.
bool NewcomerFlood::receive() {
  std::array<std::uint8_t, 2048> bytes;
  iovec data{bytes.data(), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in6_pktinfo))> control{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(fd_, &message, 0);
  if (size < 0) return false;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  const auto opening = seal::parse({bytes.data(), static_cast<std::size_t>(size)});
  if (header == nullptr || !opening || opening->form != seal::Form::kRecords) return true;
  in6_pktinfo info{};
  std::memcpy(&info, CMSG_DATA(header), sizeof info);
  std::array<std::uint8_t, 16> to;
  std::memcpy(to.data(), &info.ipi6_addr, to.size());
  const seal::Bytes cookie = cookie_in(opening->body);
  if (cookie.empty()) {
    ++handshakes_;
    return true;
  }
  ++cookies_;
  send(to, with_cookie(hello_, opening->id, cookie));
  ++begun_;
  return true;
}

void NewcomerFlood::run() {
  const MonoTime begin = mono_now();
  std::uint64_t tried = 0;
  while (!is_stopped_) {
    const auto due =
        static_cast<std::uint64_t>((mono_now() - begin).as_seconds() * options_.per_second);
    for (int i = 0; i < 64 && tried < due; ++i, ++tried) send_hello();
    for (int i = 0; i < 256 && receive(); ++i) {
    }
    if (tried >= due) {
      timespec pause{0, 500'000};
      nanosleep(&pause, nullptr);
    }
  }
}

}  // namespace dance
