#include "formats/csv/table_times.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "core/base/text/cut_text.h"
#include "core/base/text/plain_text.h"

namespace dance {
namespace {

constexpr std::size_t kMostTableGuests = 256;
constexpr std::size_t kMostExample_bytes = 24;

// The unit of a number's last digit; 0 of a whole number, which shows no rounding.
double unit_of(std::string_view cell) {
  const std::size_t exponent_at = cell.find_first_of("eE");
  if (exponent_at == cell.npos) return 0.0;
  std::string_view exponent = cell.substr(exponent_at + 1);
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  int power = 0;
  const auto [end, error] =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  if (error != std::errc() || end != exponent.data() + exponent.size()) return 0.0;
  const std::string_view number = cell.substr(0, exponent_at);
  const std::size_t point = number.find('.');
  const std::size_t decimals = point == number.npos ? 0 : number.size() - point - 1;
  return std::pow(10.0, power - static_cast<int>(std::min<std::size_t>(decimals, 400)));
}

}  // namespace

void TableTimes::Column::look(std::string_view guest, std::string_view cell) {
  if (cell.empty()) return;
  bool is_rounded = unit_of(cell) > kCoarsest_us;
  const auto found = last.find(guest);
  if (found == last.end()) {
    if (last.size() < kMostTableGuests) last.emplace(guest, cell);
  } else {
    ++steps;
    if (found->second == cell) {
      ++still;
      is_rounded = true;
    }
    found->second = cell;
  }
  is_coarse = is_coarse || unit_of(cell) > kCoarsest_us;
  if (is_rounded && example.empty()) example = plain_text(cut_text(cell, kMostExample_bytes));
}

void TableTimes::look(std::string_view guest, std::string_view received, std::string_view capture) {
  received_.look(guest, received);
  capture_.look(guest, capture);
}

}  // namespace dance
