#include "testing/line/lossy_spec.h"

#include <charconv>
#include <cmath>
#include <optional>

namespace dance {
namespace {

struct Quantity {
  double value;
  std::string_view unit;
};

std::optional<Quantity> split_quantity(std::string_view text) {
  Quantity q{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), q.value);
  if (error != std::errc() || !std::isfinite(q.value) || q.value < 0.0) return std::nullopt;
  q.unit = text.substr(static_cast<std::size_t>(stop - text.data()));
  return q;
}

std::optional<Duration> parse_duration(std::string_view text) {
  const auto q = split_quantity(text);
  if (!q) return std::nullopt;
  double seconds = 0.0;
  if (q->unit == "us")
    seconds = q->value * 1e-6;
  else if (q->unit == "ms")
    seconds = q->value * 1e-3;
  else if (q->unit == "s")
    seconds = q->value;
  else if (q->value != 0.0 || !q->unit.empty())
    return std::nullopt;
  if (seconds > 60.0) return std::nullopt;
  return Duration::seconds(seconds);
}

std::optional<double> parse_part(std::string_view text) {
  const auto q = split_quantity(text);
  if (!q || (q->unit != "%" && !(q->unit.empty() && q->value == 0.0)) || q->value > 100.0)
    return std::nullopt;
  return q->value * 0.01;
}

std::optional<double> parse_rate_bps(std::string_view text) {
  const auto q = split_quantity(text);
  if (!q) return std::nullopt;
  double bps = -1.0;
  if (q->unit == "bit") bps = q->value;
  if (q->unit == "kbit") bps = q->value * 1e3;
  if (q->unit == "Mbit" || q->unit == "mbit") bps = q->value * 1e6;
  if (q->unit == "Gbit" || q->unit == "gbit") bps = q->value * 1e9;
  if (bps < 1000.0 || bps > 1e12) return std::nullopt;
  return bps;
}

std::optional<double> parse_burst(std::string_view text) {
  const auto q = split_quantity(text);
  if (!q || !q->unit.empty() || q->value < 1.0 || q->value > 10'000.0) return std::nullopt;
  return q->value;
}

std::optional<std::uint64_t> parse_seed(std::string_view text) {
  std::uint64_t seed = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return seed;
}

template <class T>
Result<void> take(std::string_view word, std::optional<T> parsed, T& into, const char* rule) {
  if (!parsed) return fail("'" + std::string(word) + "' in the link: " + rule);
  into = *parsed;
  return {};
}

Result<void> apply(std::string_view word, LossySpec& spec) {
  constexpr const char* kTime = "write a time of 0 to 60s, as 80ms";
  constexpr const char* kPart = "write a part of 0% to 100%, as 1%";
  const auto equals = word.find('=');
  const std::string_view key = word.substr(0, equals);
  const std::string_view value =
      equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1);
  if (key == "delay") return take(word, parse_duration(value), spec.delay, kTime);
  if (key == "jitter") return take(word, parse_duration(value), spec.jitter, kTime);
  if (key == "tail") return take(word, parse_duration(value), spec.tail, kTime);
  if (key == "queue") return take(word, parse_duration(value), spec.queue, kTime);
  if (key == "loss") return take(word, parse_part(value), spec.loss, kPart);
  if (key == "dup") return take(word, parse_part(value), spec.duplicate, kPart);
  if (key == "reorder") return take(word, parse_part(value), spec.reorder, kPart);
  if (key == "burst")
    return take(word, parse_burst(value), spec.burst,
                "write the mean number of datagrams lost in a row, 1 to 10000");
  if (key == "rate")
    return take(word, parse_rate_bps(value), spec.rate_bps,
                "write a rate of at least 1kbit, as 500kbit or 1Mbit");
  if (key == "seed")
    return take(word, parse_seed(value), spec.seed, "write a whole number, as seed=1");
  return fail("'" + std::string(word) +
              "' is not known in a link: write delay= jitter= tail= loss= burst= dup= reorder= "
              "rate= queue= or seed=");
}

}  // namespace

Result<LossySpec> LossySpec::parse(std::string_view text) {
  constexpr std::string_view kBetween = " ,\t\n";
  LossySpec spec;
  for (;;) {
    const auto begin = text.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const auto end = std::min(text.find_first_of(kBetween), text.size());
    const auto applied = apply(text.substr(0, end), spec);
    if (!applied) return tl::make_unexpected(applied.error());
    text.remove_prefix(end);
  }
  if (spec.loss > 0.99 && spec.loss < 1.0 && spec.burst > 1.0)
    return fail("loss=" + std::to_string(spec.loss * 100) +
                "% cannot come in bursts: lower the loss or leave out burst=");
  return spec;
}

}  // namespace dance
