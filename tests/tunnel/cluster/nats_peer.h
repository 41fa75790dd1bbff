// Peers on loopback that behave as no NATS server would, and one that ends at a chosen byte.
//
// Ownership: each owns its socket and its thread.
// Threads:   one each, which ends with it.
// Failure:   what the system refuses aborts the test.
#pragma once

#include <arpa/inet.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace dance {

class NatsPeer {
 public:
  NatsPeer() {
    fd_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (::bind(fd_, reinterpret_cast<const sockaddr*>(&at), size) != 0 || ::listen(fd_, 8) != 0)
      std::abort();
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &size);
    url = "nats://127.0.0.1:" + std::to_string(ntohs(at.sin_port));
  }
  virtual ~NatsPeer() { ::close(fd_); }

  std::string url;

 protected:
  // In the constructor and the destructor of what derives.
  void start() {
    thread_ = std::thread([this] {
      pollfd waited{fd_, POLLIN, 0};
      while (!ends_) {
        if (::poll(&waited, 1, 20) <= 0) continue;
        const int peer = ::accept(fd_, nullptr, nullptr);
        speak(peer);
        ::close(peer);
      }
    });
  }
  void stop() {
    ends_ = true;
    thread_.join();
  }
  virtual void speak(int peer) = 0;
  static bool send_all(int peer, const std::string& text) {
    return ::send(peer, text.data(), text.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(text.size());
  }

  std::atomic<bool> ends_{false};

 private:
  int fd_ = -1;
  std::thread thread_;
};

// Says that all is well, without end.
class Chatterer final : public NatsPeer {
 public:
  explicit Chatterer(std::size_t lines_at_once) : lines_at_once_(lines_at_once) { start(); }
  ~Chatterer() override { stop(); }

  std::atomic<int> lines{0};

 private:
  void speak(int peer) override {
    std::string said = "INFO {}\r\n";
    while (!ends_ && send_all(peer, said)) {
      said.clear();
      for (std::size_t i = 0; i < lines_at_once_; ++i) said += "+OK\r\n";
      ++lines;
      if (lines_at_once_ == 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  std::size_t lines_at_once_;
};

// In TLS: greets, waits for one subscription, sends messages of it, and then never anything.
class SilentAfterBurst final : public NatsPeer {
 public:
  SilentAfterBurst(const std::string& chain, const std::string& key, std::size_t messages)
      : context_(SSL_CTX_new(TLS_server_method()), SSL_CTX_free), messages_(messages) {
    if (SSL_CTX_use_certificate_chain_file(context_.get(), chain.c_str()) != 1 ||
        SSL_CTX_use_PrivateKey_file(context_.get(), key.c_str(), SSL_FILETYPE_PEM) != 1)
      std::abort();
    start();
  }
  ~SilentAfterBurst() override { stop(); }

  std::atomic<bool> has_sent{false};

 private:
  void speak(int peer) override {
    const int room = 1 << 20;
    const timeval timeout{20, 0};
    ::setsockopt(peer, SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
    ::setsockopt(peer, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    if (!send_all(peer, "INFO {\"tls_required\":true}\r\n")) return;
    const std::unique_ptr<SSL, void (*)(SSL*)> tls(SSL_new(context_.get()), SSL_free);
    SSL_set_fd(tls.get(), peer);
    if (SSL_accept(tls.get()) != 1 || !read_until(tls.get(), "PING\r\n")) return;
    SSL_write(tls.get(), "PONG\r\n", 6);
    const auto subscription = read_until(tls.get(), "\r\n");
    if (!subscription) return;
    const std::string number = subscription->substr(subscription->rfind(' ') + 1);
    const std::string one = "MSG dance.1.test " + number.substr(0, number.find('\r')) +
                            " 1000\r\n" + std::string(1000, 'x') + "\r\n";
    std::string all;
    for (std::size_t i = 0; i < messages_; ++i) all += one;
    // Records have 16 kB: the last begins before the 131,072 bytes of a turn end, and holds all
    // that is left.
    constexpr int kFirst = 10'000;
    SSL_write(tls.get(), all.data(), kFirst);
    SSL_write(tls.get(), all.data() + kFirst, static_cast<int>(all.size()) - kFirst);
    has_sent = true;
    while (!ends_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  static std::optional<std::string> read_until(SSL* tls, std::string_view end) {
    std::string said;
    for (char next = 0; !said.ends_with(end); said += next)
      if (SSL_read(tls, &next, 1) != 1) return std::nullopt;
    return said;
  }

  std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context_;
  std::size_t messages_;
};

}  // namespace dance
