#include "core/control/house_socket.h"

#include <algorithm>
#include <filesystem>

#include "core/net/mono_clock.h"
#include "core/net/program_control.h"
#include "core/net/secure_random.h"

namespace dance {
namespace {

// One URL is another bus in each network namespace.
std::string house_path(std::string_view bus_url) {
  std::string bus(bus_url.substr(0, bus_url.find('?')));
  std::error_code error;  // without /proc there is one namespace for all
  bus += std::filesystem::read_symlink("/proc/self/ns/net", error).string();
  return control_path("house", bus);
}

std::string_view chars_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool is_request(Signal signal, Where where) {
  return where == Where::kLocal && (signal == Signal::kHearing || signal == Signal::kRemoval ||
                                    signal == Signal::kInterest || signal == Signal::kRecording);
}

bool goes_to_house(Signal signal, Where where) {
  if (where != Where::kCapture) return is_request(signal, where);
  switch (signal) {
    case Signal::kPose:
    case Signal::kSkeleton:
    case Signal::kHands:
    case Signal::kFace:
    case Signal::kVoice:
    case Signal::kVoiceState:
    case Signal::kMusic:
    case Signal::kSong:
    case Signal::kScene:
    case Signal::kAvatar:
    case Signal::kAvatarFile:
    case Signal::kStyle:
    case Signal::kPlacement:
    case Signal::kChat:
    case Signal::kProfile:
    case Signal::kFlow:
      return true;
    default:
      return false;
  }
}

Result<std::unique_ptr<HouseSocket>> HouseSocket::open(std::string_view bus_url,
                                                       OnMessage on_message, Poller& poller) {
  std::unique_ptr<HouseSocket> socket(new HouseSocket(std::move(on_message)));
  const std::string path = numbered_control_path(house_path(bus_url), secure_random_u64());
  DANCE_TRY(socket->server_,
            LocalMessageServer::open(
                path,
                [self = socket.get()](std::span<const std::uint8_t> message, MonoTime now) {
                  self->receive(message, now);
                },
                poller));
  return socket;
}

void HouseSocket::receive(std::span<const std::uint8_t> message, MonoTime now) {
  const std::string_view text =
      chars_of(message.first(std::min<std::size_t>(message.size(), kMaxChannelLength + 1)));
  const std::size_t end = text.find('\0');
  const auto channel =
      end == std::string_view::npos ? std::nullopt : Channel::parse(text.substr(0, end));
  if (!channel || !goes_to_house(channel->signal(), channel->where())) {
    ++unknown_;
    return;
  }
  const auto body = message.subspan(end + 1);
  on_message_(*channel, {channel->view(), body.data(), body.size(), now});
}

HouseSender::HouseSender(std::string_view bus_url, Poller& poller)
    : poller_(poller), path_(house_path(bus_url)) {
  houses_.reserve(kMostHouses);
  connect_to_houses();
  timer_ = poller_.add_timer(mono_now() + kSearchPeriod, [this](MonoTime now) {
    connect_to_houses();
    return now + kSearchPeriod;
  });
}

HouseSender::~HouseSender() { poller_.remove_timer(timer_); }

void HouseSender::connect_to_houses() {
  std::erase_if(houses_, [](const House& house) { return house.is_gone; });
  for (const std::string& path : numbered_control_files(path_)) {
    if (houses_.size() == kMostHouses) return;
    const auto is_there = [&](const House& house) { return house.path == path; };
    if (path == left_out_ || std::any_of(houses_.begin(), houses_.end(), is_there)) continue;
    if (auto sender = LocalMessageSender::connect(path))
      houses_.push_back({path, std::move(*sender)});
  }
}

void HouseSender::send(const Channel& channel, const AnyMessage& message) {
  if (houses_.empty()) return;
  MessageBuffer buffer;
  const std::size_t size = message.encode(buffer);
  // The name includes its final zero.
  const std::span<const std::uint8_t> name(reinterpret_cast<const std::uint8_t*>(channel.c_str()),
                                           channel.view().size() + 1);
  for (House& house : houses_) {
    if (house.is_gone) continue;
    const auto sent = house.sender.send(name, {buffer.data(), size});
    if (sent == LocalMessageSender::Sent::kFull) ++lost_;
    if (sent == LocalMessageSender::Sent::kGone) house.is_gone = true;
  }
}

}  // namespace dance
