#include "tunnel/policy/channel_rule.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace dance {
namespace {

constexpr std::string_view kRuleKeys =
    "class size rate direction layout fingerprint unchecked guest";

// Reads one word after the other into a rule, then what the words mean together.
class RuleReader {
 public:
  explicit RuleReader(std::string_view name) : name_(name) {}

  Result<void> take(const std::string& key, const std::string& value) {
    for (const std::string& seen : seen_)
      if (seen == key) return wrong(key + " is said twice; leave one out");
    seen_.push_back(key);
    if (key == "class") return take_class(value);
    if (key == "size") return take_size(value);
    if (key == "rate") return take_rate(value);
    if (key == "direction") return take_direction(value);
    if (key == "layout") return take_layout(value);
    if (key == "fingerprint") return take_fingerprint(value);
    if (key == "unchecked") return take_unchecked(value);
    if (key == "guest") return take_guest(value);
    return wrong("\"" + key.substr(0, 40) + "\" is no word of a rule; there are " +
                 std::string(kRuleKeys));
  }

  Result<ChannelRule> finish() {
    const auto need = [&](const std::string& what) -> Result<ChannelRule> { return wrong(what); };
    DANCE_TRY(rule_.pattern, ChannelPattern::parse(name_));
    if (!has_class_)
      return need("say class=state (the last one counts) or class=newest (a stream)");
    if (!has_layout_)
      return need("say layout=, the fields of the message, as layout=i64,f64[7], or layout=any");
    const bool is_state = rule_.kind == ChannelClass::kState;
    const std::size_t most = is_state ? kMaxChannelStateBytes : kMaxChannelNewestBytes;
    rule_.max_bytes = size_.value_or(most);
    if (rule_.max_bytes > most)
      return need("size=" + std::to_string(*size_) + " is too much; class=" +
                  (is_state ? "state" : "newest") + " takes up to " + std::to_string(most));
    rule_.rate_hz = rate_.value_or(is_state ? 5.0 : 60.0);
    if (is_state && rule_.rate_hz > kMaxChannelStateRate_hz)
      return need("class=state takes up to rate=20; what changes faster is class=newest");
    if (rule_.layout.is_any() && rule_.is_in && !is_unchecked_)
      return need(
          "layout=any lets whatever another house sends onto this bus; say the layout, or "
          "direction=out, or unchecked=yes if every hearer can bear it");
    if (fingerprint_) rule_.layout.require_fingerprint(*fingerprint_);
    return rule_;
  }

 private:
  tl::unexpected<Error> wrong(const std::string& why) const {
    return fail("channel rule " + std::string(name_.substr(0, 80)) + ": " + why);
  }
  Result<void> take_class(const std::string& value) {
    has_class_ = true;
    if (value != "state" && value != "newest")
      return wrong("class=" + value + ": it is state (the last one counts) or newest (a stream)");
    rule_.kind = value == "state" ? ChannelClass::kState : ChannelClass::kNewest;
    return {};
  }
  Result<void> take_size(const std::string& value) {
    std::size_t size = 0;
    const char* const end = value.data() + value.size();
    const auto read = std::from_chars(value.data(), end, size);
    if (read.ec != std::errc() || read.ptr != end || size == 0)
      return wrong("size=" + value + ": a number of bytes, 1 or more");
    size_ = size;
    return {};
  }
  Result<void> take_rate(const std::string& value) {
    double rate = 0.0;
    const char* const end = value.data() + value.size();
    const auto read = std::from_chars(value.data(), end, rate);
    if (read.ec != std::errc() || read.ptr != end || !(rate >= 0.1 && rate <= kMaxChannelRate_hz))
      return wrong("rate=" + value + ": messages a second, 0.1 to 240");
    rate_ = rate;
    return {};
  }
  Result<void> take_direction(const std::string& value) {
    if (value != "in" && value != "out" && value != "both")
      return wrong("direction=" + value + ": it is out, in or both");
    rule_.is_out = value != "in";
    rule_.is_in = value != "out";
    return {};
  }
  Result<void> take_layout(const std::string& value) {
    has_layout_ = true;
    auto layout = LayoutCheck::parse(value);
    if (!layout) return wrong(layout.error().what);
    rule_.layout = *layout;
    return {};
  }
  Result<void> take_fingerprint(const std::string& value) {
    std::uint64_t bits = 0;
    const char* const end = value.data() + value.size();
    const auto read = std::from_chars(value.data(), end, bits, 16);
    if (value.size() != 16 || read.ec != std::errc() || read.ptr != end)
      return wrong("fingerprint=" + value +
                   ": 16 hexadecimal digits, the first 8 bytes of a message");
    fingerprint_ = bits;
    return {};
  }
  Result<void> take_unchecked(const std::string& value) {
    if (value != "yes" && value != "no") return wrong("unchecked=" + value + ": it is yes or no");
    is_unchecked_ = value == "yes";
    return {};
  }
  Result<void> take_guest(const std::string& value) {
    const auto guest = GuestId::parse(value);
    if (!guest) return wrong("guest=" + value + ": " + kGuestIdRule);
    rule_.guest = *guest;
    return {};
  }

  std::string_view name_;
  ChannelRule rule_;
  std::vector<std::string> seen_;
  std::optional<std::size_t> size_;
  std::optional<double> rate_;
  std::optional<std::uint64_t> fingerprint_;
  bool has_class_ = false;
  bool has_layout_ = false;
  bool is_unchecked_ = false;
};

}  // namespace

Result<ChannelRule> ChannelRule::of(std::string_view name, const Words& words) {
  RuleReader reader(name);
  for (const auto& word : words)
    if (auto taken = reader.take(word.first, word.second); !taken)
      return tl::make_unexpected(taken.error());
  return reader.finish();
}

Result<ChannelRule> ChannelRule::parse(std::string_view line) {
  std::string name;
  Words words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::string word(line.substr(0, line.find(' ')));
    line.remove_prefix(word.size());
    if (name.empty()) {
      name = word;
      continue;
    }
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      return fail("channel rule " + name.substr(0, 80) + ": \"" + word.substr(0, 40) +
                  "\": behind the name stand words of the form key=value, without spaces");
    words.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    if (words.size() > 16)
      return fail("channel rule " + name.substr(0, 80) + ": too many words; there are " +
                  std::string(kRuleKeys));
  }
  return of(name, words);
}

Result<std::vector<ChannelRule>> parse_channel_rules(const std::vector<std::string>& lines) {
  std::vector<ChannelRule> rules;
  for (const std::string& line : lines) {
    DANCE_TRY(const ChannelRule rule, ChannelRule::parse(line));
    rules.push_back(rule);
  }
  if (rules.size() > kMaxChannelRules)
    return fail("a house has at most " + std::to_string(kMaxChannelRules) +
                " channel rules; join some, as LIGHT/*");
  return rules;
}

const ChannelRule* find_rule_out(std::span<const ChannelRule> rules, std::string_view name) {
  for (const ChannelRule& rule : rules)
    if (rule.is_out && rule.pattern.matches(name)) return &rule;
  return nullptr;
}

const ChannelRule* find_rule_in(std::span<const ChannelRule> rules, std::string_view name) {
  for (const ChannelRule& rule : rules)
    if (rule.is_in && rule.pattern.matches(name)) return &rule;
  return nullptr;
}

bool lets_any_in(std::span<const ChannelRule> rules) {
  return std::ranges::any_of(rules, &ChannelRule::is_in);
}

}  // namespace dance
