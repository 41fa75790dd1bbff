#include "transformers/settings.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "core/base/plain_number.h"

namespace dance {
namespace {

std::optional<double> whole_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

Result<Duration> parse_duration(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  const double scale = unit == "s" ? 1.0 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 0.0;
  // The comparison also refuses NaN.
  if (error != std::errc() || scale == 0.0 || !(number >= -1e6 && number <= 1e6))
    return fail("'" + std::string(text) + "' is not a length of time like 20ms, 1.5s or 800us");
  return Duration::seconds(number * scale);
}

Settings::Settings(std::string_view station, std::span<const std::string_view> arguments)
    : station_(station) {
  for (const std::string_view argument : arguments) {
    const std::size_t sign = argument.find('=');
    const bool is_named = sign != std::string_view::npos;
    given_.push_back({argument.substr(0, sign),
                      is_named ? argument.substr(sign + 1) : std::string_view(), false});
    if (!is_named && trouble_.empty())
      trouble_ = fmt::format("{} takes settings like name=value, not '{}'", station_, argument);
  }
}

const std::string_view* Settings::find(std::string_view name, std::string_view takes) {
  known_ += fmt::format("{}{}={}", known_.empty() ? "" : ", ", name, takes);
  const std::string_view* value = nullptr;
  for (Given& given : given_) {
    if (given.name != name) continue;
    given.asked = true;
    value = &given.value;  // of two, the last
  }
  return value;
}

void Settings::refuse(std::string_view name, std::string_view value, const std::string& takes) {
  if (trouble_.empty())
    trouble_ = fmt::format("{} {} takes {}, not '{}'", station_, name, takes, value);
}

Settings& Settings::number(std::string_view name, double& value, double least, double most) {
  return number_or(name, "", 0.0, value, least, most);
}

Settings& Settings::number_or(std::string_view name, std::string_view word, double word_value,
                              double& value, double least, double most) {
  const std::string takes = (word.empty() ? "" : std::string(word) + " or ") + plain_number(least) +
                            " to " + plain_number(most);
  const std::string_view* text = find(name, takes);
  if (!text) return *this;
  if (!word.empty() && *text == word) {
    value = word_value;
    return *this;
  }
  const auto number = whole_number(*text);
  if (number && *number >= least && *number <= most)
    value = *number;
  else
    refuse(name, *text, takes);
  return *this;
}

Settings& Settings::duration(std::string_view name, Duration& value, Duration least,
                             Duration most) {
  const std::string takes =
      plain_number(least.as_ms()) + "ms to " + plain_number(most.as_ms()) + "ms";
  const std::string_view* text = find(name, takes);
  if (!text) return *this;
  const auto duration = parse_duration(*text);
  if (duration && *duration >= least && *duration <= most)
    value = *duration;
  else
    refuse(name, *text, takes);
  return *this;
}

Settings& Settings::flag(std::string_view name, bool& value) {
  const std::string_view* text = find(name, "0 or 1");
  if (!text) return *this;
  if (*text != "0" && *text != "1")
    refuse(name, *text, "0 or 1");
  else
    value = *text == "1";
  return *this;
}

Settings& Settings::text(std::string_view name, std::string& value) {
  if (const std::string_view* text = find(name, "TEXT")) value = *text;
  return *this;
}

Result<void> Settings::done() const {
  if (!trouble_.empty()) return fail(trouble_);
  for (const Given& given : given_)
    if (!given.asked)
      return fail(fmt::format("{} has no setting '{}'; it has: {}", station_, given.name, known_));
  return {};
}

}  // namespace dance
