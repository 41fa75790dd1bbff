#include "voice/control/voice_control.h"

#include <array>
#include <cstdio>

#include "core/base/fnv1a.h"
#include "core/bus/bus.h"
#include "core/net/local_address.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kMostCommandsPerTurn = 16;

}  // namespace

// A bus's URL is no file name: a number of it is.
std::string voice_control_path(const std::string& bus, const GuestId& guest) {
  const std::uint32_t number = folded(fnv1a(bus_url_or_default(bus)));
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08x", number);
  return local_socket_folder() + "/voice-" + std::string(guest.view()) + "-" + text.data();
}

Result<std::unique_ptr<VoiceControl>> VoiceControl::open(const std::string& bus,
                                                         const GuestId& guest, OnCommand on_command,
                                                         Poller& poller) {
  auto socket = LocalDatagramSocket::bind(voice_control_path(bus, guest));
  const std::string name(guest.view());
  if (!socket && is_socket(voice_control_path(bus, guest)))
    return fail(name + " has a dance voice on this bus already, perhaps of its house's [voice]: " +
                "end that one first, or tell it things with: dance voice set --guest " + name);
  if (!socket)
    return fail("the voice of " + name + " cannot be told anything: " + socket.error().what);
  return std::unique_ptr<VoiceControl>(
      new VoiceControl(std::move(*socket), std::move(on_command), poller));
}

VoiceControl::VoiceControl(std::unique_ptr<LocalDatagramSocket> socket, OnCommand on_command,
                           Poller& poller)
    : socket_(std::move(socket)), on_command_(std::move(on_command)), poller_(poller) {
  poller_.watch(socket_->fd(), [this](MonoTime now) {
    std::array<std::uint8_t, kMostBytes> bytes{};
    for (int i = 0; i < kMostCommandsPerTurn; ++i) {
      const std::ptrdiff_t size = socket_->receive(bytes);
      if (size < 0) return;
      if (size > static_cast<std::ptrdiff_t>(bytes.size())) continue;
      on_command_({reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(size)},
                  now);
    }
  });
}

VoiceControl::~VoiceControl() { poller_.unwatch(socket_->fd()); }

Result<void> tell_voice(const std::string& bus, const GuestId& guest, std::string_view command) {
  if (command.size() > VoiceControl::kMostBytes) return fail("the command is too long");
  DANCE_TRY(auto sender, LocalDatagramSender::open(voice_control_path(bus, guest)));
  const auto sent = sender->send(
      {reinterpret_cast<const std::uint8_t*>(command.data()), command.size()}, mono_now());
  if (sent == LocalDatagramSender::Sent::kNobody)
    return fail("no dance voice runs for " + std::string(guest.view()) +
                " on this bus; start it with: dance voice --guest " + std::string(guest.view()));
  if (sent == LocalDatagramSender::Sent::kFull)
    return fail("the dance voice of " + std::string(guest.view()) + " does not listen");
  return {};
}

}  // namespace dance
