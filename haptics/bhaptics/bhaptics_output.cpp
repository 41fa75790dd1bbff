#include "haptics/bhaptics/bhaptics_output.h"

#include <libwebsockets.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/base/spsc_ring.h"
#include "core/net/address.h"
#include "core/net/mono_clock.h"
#include "haptics/bhaptics/bhaptics_frame.h"
#include "haptics/haptic_player.h"

namespace dance {
namespace {

constexpr std::uint16_t kUsualPort = 15881;
constexpr lws_usec_t kAgain_us = 1'000'000;
constexpr std::size_t kMostText = 1024;

BhapticsOutput::LookUp look_up_of(const std::string& address) {
  return [address] { return Address::resolve_all(address, kUsualPort); };
}

}  // namespace

struct BhapticsOutput::Impl {
  struct Order {
    Haptic haptic;
    MonoTime given;
    bool is_stop = false;
  };
  // lws finds it by the address of its first member.
  lws_sorted_usec_list_t again{};
  std::string address;  // as it was given
  LookUp look_up;
  lws_context* context = nullptr;
  lws* connection = nullptr;
  // Of the thread: where a player may be, those that were tried, and whether one is tried now.
  std::vector<Address> places;
  std::size_t tried = 0;
  bool is_trying = false;
  SpscRing<Order, 64> orders;
  std::optional<Order> next;
  std::atomic<bool> is_connected{false}, ends{false};
  std::atomic<std::uint64_t> written{0}, connections{0}, failures{0}, late{0};
  std::thread thread;

  static int on_event(lws* wsi, lws_callback_reasons reason, void* user, void* data,
                      std::size_t size);
  static void on_again(lws_sorted_usec_list_t* again);
  void connect();
  void try_next();
  void not_here();
  void lost();
  int write_one(lws* wsi);
  void run();
};

// In its own thread, as looking a name up may take seconds.
void BhapticsOutput::Impl::connect() {
  auto found = look_up();
  if (!found || found->empty()) return lost();
  places = std::move(*found);
  tried = 0;
  try_next();
}

// Also of one machine a player may be at one address only: "localhost" is ::1 and 127.0.0.1.
void BhapticsOutput::Impl::try_next() {
  const Address to = places[tried++];
  const std::string text = to.to_string();
  std::string host = text.substr(0, text.rfind(':'));
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  lws_client_connect_info info{};
  info.context = context;
  info.address = host.c_str();
  info.port = to.port();
  info.path = kPath;
  info.host = host.c_str();
  info.origin = host.c_str();
  info.local_protocol_name = "dance-haptics";
  info.pwsi = &connection;
  is_trying = true;
  // So long one that does not answer keeps the next one waiting.
  if (tried < places.size())
    lws_sul_schedule(context, 0, &again, on_again,
                     kAnswers.count_us() / static_cast<std::int64_t>(places.size()));
  // The library may have told of the failure already.
  if (lws_client_connect_via_info(&info) == nullptr) not_here();
}

void BhapticsOutput::Impl::not_here() {
  if (!is_trying) return;
  is_trying = false;
  connection = nullptr;
  if (tried == places.size()) return lost();
  if (!ends) lws_sul_schedule(context, 0, &again, on_again, 1);
}

void BhapticsOutput::Impl::lost() {
  connection = nullptr;
  is_connected = is_trying = false;
  places.clear();
  tried = 0;
  ++failures;
  if (!ends) lws_sul_schedule(context, 0, &again, on_again, kAgain_us);
}

void BhapticsOutput::Impl::on_again(lws_sorted_usec_list_t* again) {
  auto* const self = reinterpret_cast<Impl*>(again);
  // One that does not answer: its end is told.
  if (self->is_trying && self->connection)
    lws_set_timeout(self->connection, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_ASYNC);
  else if (self->tried < self->places.size())
    self->try_next();
  else
    self->connect();
}

int BhapticsOutput::Impl::write_one(lws* wsi) {
  if (!next) next = orders.pop();
  // What waited while the connection stalled would be felt as something else; a stop never is late.
  while (next && !next->is_stop && mono_now() - next->given > HapticPlayer::kTooLate) {
    ++late;
    next = orders.pop();
  }
  if (!next) return 0;
  const std::string text = next->is_stop ? bhaptics_stop() : bhaptics_frame(next->haptic);
  next.reset();
  std::array<unsigned char, LWS_PRE + kMostText> buffer{};
  if (text.size() > kMostText) return 0;
  std::memcpy(buffer.data() + LWS_PRE, text.data(), text.size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, text.size(), LWS_WRITE_TEXT) < 0) return -1;
  ++written;
  next = orders.pop();
  if (next) lws_callback_on_writable(wsi);
  return 0;
}

int BhapticsOutput::Impl::on_event(lws* wsi, lws_callback_reasons reason, void*, void*,
                                   std::size_t) {
  auto* const self = static_cast<Impl*>(lws_context_user(lws_get_context(wsi)));
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      ++self->connections;
      // What waited meanwhile is of the past.
      self->next.reset();
      while (self->orders.pop()) {
      }
      self->is_trying = false;
      lws_sul_cancel(&self->again);
      self->is_connected = true;
      break;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
    case LWS_CALLBACK_WSI_DESTROY:  // all that is told of one that does not answer
      self->not_here();
      break;
    case LWS_CALLBACK_CLIENT_CLOSED:
      self->lost();
      break;
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      return self->write_one(wsi);
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      if (self->connection && self->is_connected) lws_callback_on_writable(self->connection);
      break;
    default:  // what the player says back is not needed
      break;
  }
  return 0;
}

void BhapticsOutput::Impl::run() {
  pthread_setname_np(pthread_self(), "haptics-ws");
  connect();
  while (!ends && lws_service(context, 0) >= 0) {
  }
}

Result<std::unique_ptr<HapticOutput>> BhapticsOutput::open(const std::string& address) {
  const std::string wanted = address.empty() ? kUsualAddress : address;
  return open(wanted, look_up_of(wanted));
}

Result<std::unique_ptr<HapticOutput>> BhapticsOutput::open(const std::string& address,
                                                           const LookUp& look_up) {
  DANCE_TRY(const auto places, look_up());
  auto output = start(address, look_up);
  if (!output) return fail("libwebsockets cannot be started: no memory, or too many files");
  const Impl& impl = *output->impl_;
  const MonoTime begin = mono_now();
  while (!impl.is_connected && impl.failures == 0 && mono_now() - begin < kAnswers)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!impl.is_connected)
    return fail("no bHaptics Player at " +
                (places.size() == 1 ? places.front().to_string() : address) +
                ": start it, or say where it is with an address, as 192.168.1.7:15881");
  return std::unique_ptr<HapticOutput>(std::move(output));
}

std::unique_ptr<HapticOutput> BhapticsOutput::later(const std::string& address) {
  const std::string wanted = address.empty() ? kUsualAddress : address;
  return start(wanted, look_up_of(wanted));
}

std::unique_ptr<BhapticsOutput> BhapticsOutput::start(const std::string& address, LookUp look_up) {
  auto impl = std::make_unique<Impl>();
  impl->address = address;
  impl->look_up = std::move(look_up);
  lws_set_log_level(0, nullptr);
  static const std::array<lws_protocols, 2> kProtocols{
      {{"dance-haptics", Impl::on_event, 0, 512, 0, nullptr, 0},
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = kProtocols.data();
  info.user = impl.get();
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  impl->context = lws_create_context(&info);
  if (!impl->context) return nullptr;
  Impl* const raw = impl.get();
  impl->thread = std::thread([raw] { raw->run(); });
  return std::unique_ptr<BhapticsOutput>(new BhapticsOutput(std::move(impl)));
}

BhapticsOutput::BhapticsOutput(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

BhapticsOutput::~BhapticsOutput() {
  impl_->ends = true;
  lws_cancel_service(impl_->context);
  impl_->thread.join();
  lws_context_destroy(impl_->context);
}

bool BhapticsOutput::play(const Haptic& haptic, MonoTime now) {
  if (!impl_->is_connected) return false;
  impl_->orders.push({haptic, now, false});
  lws_cancel_service(impl_->context);
  return true;
}

void BhapticsOutput::stop() {
  if (!impl_->is_connected) return;
  impl_->orders.push({Haptic(), MonoTime(), true});
  lws_cancel_service(impl_->context);
}

bool BhapticsOutput::is_there() const { return impl_->is_connected; }

std::string BhapticsOutput::name() const { return "bHaptics Player at " + impl_->address; }

std::string BhapticsOutput::summary() const {
  std::string line = name();
  if (impl_->connections == 0) return line + ", which was not found";
  if (!impl_->is_connected) line += ", lost";
  line += ", " + std::to_string(impl_->written) + " messages";
  if (impl_->late > 0) line += ", " + std::to_string(impl_->late) + " left out after a stall";
  return line;
}

}  // namespace dance
