#include "core/bus/channel.h"

#include "core/base/assert.h"

namespace dance {
namespace {

#define DANCE_SIGNAL_WORD(Type, kName, word) word,
constexpr auto kSignals = std::to_array<std::string_view>({DANCE_MESSAGE_TABLE(DANCE_SIGNAL_WORD)});
#undef DANCE_SIGNAL_WORD
// In the order of Where.
constexpr std::array<std::string_view, 5> kWheres{"capture", "guest", "stage", "view", "room"};
static_assert(static_cast<std::size_t>(Where::kRoom) + 1 == kWheres.size());
constexpr std::string_view kLocalWord = "local";

template <class Value, std::size_t kCount>
std::string_view text_of(const std::array<std::string_view, kCount>& words, Value value) {
  const auto place = static_cast<std::size_t>(value);
  return place < kCount ? words[place] : std::string_view();
}

template <class Value, std::size_t kCount>
std::optional<Value> value_of(const std::array<std::string_view, kCount>& words,
                              std::string_view text) {
  for (std::size_t place = 0; place < kCount; ++place)
    if (words[place] == text) return static_cast<Value>(place);
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

std::string_view signal_name(Signal signal) { return text_of(kSignals, signal); }
std::string_view where_name(Where where) { return text_of(kWheres, where); }
std::optional<Where> find_where(std::string_view name) { return value_of<Where>(kWheres, name); }

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
  const auto signal = value_of<Signal>(kSignals, name.substr(0, first));
  if (!signal) return std::nullopt;
  const std::string_view rest = name.substr(first + 1);
  const std::size_t second = rest.find('/');
  if (second == std::string_view::npos) {
    if (rest == kLocalWord && is_in_table(*signal, Where::kLocal)) return of_house(*signal);
    if (!GuestId::parse(rest) || !is_in_table(*signal, Where::kProgram)) return std::nullopt;
    return of_program(*signal, rest);
  }
  const auto where = find_where(rest.substr(0, second));
  const auto guest = GuestId::parse(rest.substr(second + 1));
  if (!where || !guest || !is_in_table(*signal, *where)) return std::nullopt;
  return of(*signal, *where, *guest);
}

}  // namespace dance
