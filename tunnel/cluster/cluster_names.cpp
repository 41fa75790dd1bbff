#include "tunnel/cluster/cluster_names.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/assert.h"

namespace dance::cluster {
namespace {

constexpr std::string_view kPrefix = "dance.1.";
constexpr std::string_view kPosePrefix = "dance.1.pose.";
constexpr std::string_view kVoicePrefix = "dance.1.voice.";

// Bounded texts of known parts, which always fit.
class TextMaker {
 public:
  TextMaker& operator<<(std::string_view part) {
    DANCE_ASSERT(size_ + part.size() <= chars_.size(), size_);
    for (const char c : part) chars_[size_++] = c;
    return *this;
  }
  TextMaker& operator<<(ServerId server) {
    std::array<char, 16> digits;
    digits.fill('0');
    std::array<char, 16> some;
    const auto end = std::to_chars(some.data(), some.data() + some.size(), server, 16).ptr;
    const auto count = static_cast<std::size_t>(end - some.data());
    std::copy(some.data(), end, digits.end() - static_cast<std::ptrdiff_t>(count));
    return *this << std::string_view(digits.data(), digits.size());
  }
  Text text() const {
    Text made;
    const bool fits = made.assign({chars_.data(), size_});
    DANCE_ASSERT(fits, size_);
    return made;
  }

 private:
  std::array<char, 96> chars_{};
  std::size_t size_ = 0;
};

// The part up to the next '.', which is taken off; all of it where there is none.
std::string_view take_part(std::string_view& text) {
  const std::size_t end = text.find('.');
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

std::optional<PoseSubject> subject_of_guest(std::string_view prefix, std::string_view subject) {
  // An empty last part would go unnoticed.
  if (!subject.starts_with(prefix) || subject.ends_with('.')) return std::nullopt;
  subject.remove_prefix(prefix.size());
  const auto room = GuestId::parse(take_part(subject));
  const auto guest = GuestId::parse(take_part(subject));
  if (!room || !guest || !subject.empty()) return std::nullopt;
  return PoseSubject{*room, *guest};
}

template <class Number>
std::optional<Number> number_in(std::string_view text, int base) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

Text beat_subject() { return (TextMaker() << kPrefix << "beat").text(); }
Text server_subject(ServerId server) { return (TextMaker() << kPrefix << "to." << server).text(); }
Text pose_subject(const wire::RoomName& room, const GuestId& guest) {
  return (TextMaker() << kPosePrefix << room.view() << "." << guest.view()).text();
}

Text voice_subject(const wire::RoomName& room, const GuestId& guest) {
  return (TextMaker() << kVoicePrefix << room.view() << "." << guest.view()).text();
}

std::array<Text, 2> subjects_of(const wire::RoomName& room, const GuestId& guest) {
  return {pose_subject(room, guest), voice_subject(room, guest)};
}

std::optional<PoseSubject> parse_pose_subject(std::string_view subject) {
  return subject_of_guest(kPosePrefix, subject);
}
std::optional<PoseSubject> parse_voice_subject(std::string_view subject) {
  return subject_of_guest(kVoicePrefix, subject);
}

Text keys_of(const wire::RoomName& room) { return (TextMaker() << room.view() << ".>").text(); }

Text text_of(const Key& key) {
  TextMaker text;
  text << key.room.view();
  std::array<char, 4> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), key.place).ptr;
  const std::string_view place(digits.data(), static_cast<std::size_t>(end - digits.data()));
  switch (key.kind) {
    case KeyKind::kPresence:
      return (text << ".at." << key.server).text();
    case KeyKind::kGuest:
      return (text << ".guest." << key.guest.view()).text();
    case KeyKind::kGuestState:
      return (text << ".state." << key.guest.view() << "." << place).text();
    case KeyKind::kRoomState:
      return (text << ".room." << place).text();
  }
  return text.text();
}

std::optional<Key> parse_key(std::string_view text) {
  Key key;
  if (text.ends_with('.')) return std::nullopt;
  const auto room = GuestId::parse(take_part(text));
  const std::string_view kind = take_part(text);
  const std::string_view of = take_part(text);
  if (!room) return std::nullopt;
  key.room = *room;
  if (kind == "at") {
    const auto server = number_in<ServerId>(of, 16);
    if (!server || *server == 0 || of.size() != 16 || !text.empty()) return std::nullopt;
    key.server = *server;
    return key;
  }
  if (kind == "room") {
    const auto place = number_in<std::size_t>(of, 10);
    if (!place || *place >= wire::kRoomStates || !text.empty()) return std::nullopt;
    key.kind = KeyKind::kRoomState;
    key.place = *place;
    return key;
  }
  const auto guest = GuestId::parse(of);
  if (!guest) return std::nullopt;
  key.guest = *guest;
  key.kind = KeyKind::kGuest;
  if (kind == "guest" && text.empty()) return key;
  const auto place = number_in<std::size_t>(take_part(text), 10);
  if (kind != "state" || !place || *place >= wire::kGuestStates || !text.empty())
    return std::nullopt;
  key.kind = KeyKind::kGuestState;
  key.place = *place;
  return key;
}

}  // namespace dance::cluster
