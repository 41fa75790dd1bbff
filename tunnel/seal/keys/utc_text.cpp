#include "tunnel/seal/keys/utc_text.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace dance {
namespace {

constexpr std::int64_t kSecondsOfDay = 86'400;

struct CivilMinute {
  int year;
  unsigned month, day;
  int hour, minute;
};

CivilMinute civil_minute(std::int64_t utc_s) {
  using namespace std::chrono;
  const sys_days first{year{2000} / January / 1}, last{year{9999} / December / 31};
  const auto count = [](const sys_days& day) { return day.time_since_epoch().count(); };
  const std::int64_t begin_s = count(first) * kSecondsOfDay;
  const std::int64_t end_s = (count(last) + 1) * kSecondsOfDay - 1;
  const std::int64_t held_s = std::clamp(utc_s, begin_s, end_s);
  const sys_days day{days{static_cast<int>(held_s / kSecondsOfDay)}};
  const year_month_day date{day};
  const int minute = static_cast<int>(held_s % kSecondsOfDay / 60);
  return {static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
          static_cast<unsigned>(date.day()), minute / 60, minute % 60};
}

std::string printed(const char* format, const CivilMinute& at) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, at.year, at.month, at.day, at.hour, at.minute);
  return text.data();
}

}  // namespace

std::int64_t utc_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string utc_text(std::int64_t utc_s) {
  return printed("%04d%02u%02uT%02d%02dZ", civil_minute(utc_s));
}

std::string utc_shown(std::int64_t utc_s) {
  return printed("%04d-%02u-%02u %02d:%02d UTC", civil_minute(utc_s));
}

std::optional<std::int64_t> parse_utc(std::string_view text) {
  if (text.size() != 14 || text[8] != 'T' || text[13] != 'Z') return std::nullopt;
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = 0;
    for (const char c : text.substr(at, digits))
      value = c < '0' || c > '9' || value < 0 ? -1 : value * 10 + (c - '0');
    return value;
  };
  const int year = number(0, 4), month = number(4, 2), day = number(6, 2), hour = number(9, 2),
            minute = number(11, 2);
  if (year < 2000 || month < 1 || day < 1 || hour < 0 || hour > 23 || minute < 0 || minute > 59)
    return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count() * kSecondsOfDay + hour * 3600 +
         minute * 60;
}

}  // namespace dance
