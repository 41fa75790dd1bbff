#include "core/bus/channel.h"

#include "core/base/assert.h"

namespace dance {
namespace {

struct Word {
  int value;
  std::string_view text;
};
constexpr std::array<Word, 12> kSignals{{
    {static_cast<int>(Signal::kPose), "POSE"},
    {static_cast<int>(Signal::kSkeleton), "SKELETON"},
    {static_cast<int>(Signal::kHands), "HANDS"},
    {static_cast<int>(Signal::kGuest), "GUEST"},
    {static_cast<int>(Signal::kStats), "STATS"},
    {static_cast<int>(Signal::kStageTime), "STAGE_TIME"},
    {static_cast<int>(Signal::kMusic), "MUSIC"},
    {static_cast<int>(Signal::kScene), "SCENE"},
    {static_cast<int>(Signal::kAvatar), "AVATAR"},
    {static_cast<int>(Signal::kStyle), "STYLE"},
    {static_cast<int>(Signal::kPlacement), "PLACEMENT"},
    {static_cast<int>(Signal::kBeat), "BEAT"},
}};
constexpr std::string_view kLocalWord = "local";
constexpr std::array<Word, 5> kWheres{{
    {static_cast<int>(Where::kCapture), "capture"},
    {static_cast<int>(Where::kGuest), "guest"},
    {static_cast<int>(Where::kStage), "stage"},
    {static_cast<int>(Where::kView), "view"},
    {static_cast<int>(Where::kRoom), "room"},
}};

template <std::size_t kCount>
std::string_view text_of(const std::array<Word, kCount>& words, int value) {
  for (const Word& word : words)
    if (word.value == value) return word.text;
  return {};
}

template <std::size_t kCount>
std::optional<int> value_of(const std::array<Word, kCount>& words, std::string_view text) {
  for (const Word& word : words)
    if (word.text == text) return word.value;
  return std::nullopt;
}

// Builds "a/b" or "a/b/c" in a bounded string.
FixedString<kMaxChannelLength> join(std::string_view a, std::string_view b, std::string_view c) {
  std::array<char, kMaxChannelLength> chars{};
  std::size_t size = 0;
  const auto append = [&](std::string_view text) {
    DANCE_ASSERT(size + text.size() <= chars.size(), size, text.size());
    for (const char ch : text) chars[size++] = ch;
  };
  append(a);
  append("/");
  append(b);
  if (!c.empty()) {
    append("/");
    append(c);
  }
  FixedString<kMaxChannelLength> name;
  [[maybe_unused]] const bool fits = name.assign({chars.data(), size});
  return name;
}

bool is_in_table(Signal signal, Where where) {
  for (const ChannelRow& row : kChannelTable)
    if (row.signal == signal && row.where == where) return true;
  return false;
}

}  // namespace

std::string_view signal_name(Signal signal) { return text_of(kSignals, static_cast<int>(signal)); }
std::string_view where_name(Where where) { return text_of(kWheres, static_cast<int>(where)); }
std::optional<Where> find_where(std::string_view name) {
  const auto value = value_of(kWheres, name);
  return value ? std::optional(static_cast<Where>(*value)) : std::nullopt;
}

Channel Channel::of(Signal signal, Where where, const GuestId& guest) {
  DANCE_ASSERT(guest.is_set());
  Channel channel;
  channel.signal_ = signal;
  channel.where_ = where;
  channel.guest_ = guest;
  channel.name_ = join(signal_name(signal), where_name(where), guest.view());
  return channel;
}

Channel Channel::of_house(Signal signal) {
  Channel channel;
  channel.signal_ = signal;
  channel.where_ = Where::kLocal;
  channel.name_ = join(signal_name(signal), kLocalWord, {});
  return channel;
}

Channel Channel::of_program(Signal signal, std::string_view program) {
  DANCE_ASSERT(GuestId::parse(program).has_value());
  Channel channel;
  channel.signal_ = signal;
  channel.where_ = Where::kProgram;
  [[maybe_unused]] const bool fits = channel.program_.assign(program);
  channel.name_ = join(signal_name(signal), program, {});
  return channel;
}

std::optional<Channel> Channel::parse(std::string_view name) {
  const std::size_t first = name.find('/');
  if (first == std::string_view::npos || name.size() > kMaxChannelLength) return std::nullopt;
  const auto signal = value_of(kSignals, name.substr(0, first));
  if (!signal) return std::nullopt;
  const std::string_view rest = name.substr(first + 1);
  if (static_cast<Signal>(*signal) == Signal::kStats) {
    if (!GuestId::parse(rest)) return std::nullopt;
    return of_program(Signal::kStats, rest);
  }
  if (static_cast<Signal>(*signal) == Signal::kBeat)
    return rest == kLocalWord ? std::optional(of_house(Signal::kBeat)) : std::nullopt;
  const std::size_t second = rest.find('/');
  if (second == std::string_view::npos) return std::nullopt;
  const auto where = find_where(rest.substr(0, second));
  const auto guest = GuestId::parse(rest.substr(second + 1));
  if (!where || !guest || !is_in_table(static_cast<Signal>(*signal), *where)) return std::nullopt;
  return of(static_cast<Signal>(*signal), *where, *guest);
}

}  // namespace dance
