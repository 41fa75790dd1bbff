// Duration and MonoTime: time inside a process as types, so that a stamp of another clock cannot be
// compared with ours by accident. Nothing here reads a clock; core/net/mono_clock.h does.
//
// Units/frames: nanoseconds inside; MonoTime counts from its clock's unspecified zero
//               (CLOCK_MONOTONIC: boot).
// Threads:      none inside; plain values.
// Failure:      none; 64-bit arithmetic overflows after 292 years.
#pragma once

#include <compare>
#include <cstdint>

namespace dance {

class Duration {
 public:
  constexpr Duration() = default;
  static constexpr Duration ns(std::int64_t n) { return Duration(n); }
  static constexpr Duration us(std::int64_t n) { return Duration(n * 1000); }
  static constexpr Duration ms(std::int64_t n) { return Duration(n * 1000'000); }
  static constexpr Duration s(std::int64_t n) { return Duration(n * 1000'000'000); }
  static constexpr Duration seconds(double n) {
    return Duration(static_cast<std::int64_t>(n * 1e9 + (n < 0 ? -0.5 : 0.5)));
  }
  static constexpr Duration period_of_hz(double hz) { return seconds(1.0 / hz); }

  constexpr std::int64_t count_ns() const { return ns_; }
  constexpr std::int64_t count_us() const { return ns_ / 1000; }
  constexpr std::int64_t count_ms() const { return ns_ / 1000'000; }
  constexpr double as_seconds() const { return static_cast<double>(ns_) * 1e-9; }
  constexpr double as_ms() const { return static_cast<double>(ns_) * 1e-6; }
  constexpr double as_us() const { return static_cast<double>(ns_) * 1e-3; }

  constexpr auto operator<=>(const Duration&) const = default;
  constexpr Duration operator-() const { return Duration(-ns_); }
  constexpr Duration operator+(Duration o) const { return Duration(ns_ + o.ns_); }
  constexpr Duration operator-(Duration o) const { return Duration(ns_ - o.ns_); }
  constexpr Duration operator*(std::int64_t k) const { return Duration(ns_ * k); }
  constexpr Duration operator/(std::int64_t k) const { return Duration(ns_ / k); }
  constexpr Duration& operator+=(Duration o) { return *this = *this + o; }
  constexpr Duration& operator-=(Duration o) { return *this = *this - o; }

 private:
  explicit constexpr Duration(std::int64_t n) : ns_(n) {}
  std::int64_t ns_ = 0;
};

class MonoTime {
 public:
  constexpr MonoTime() = default;  // the clock's zero: "never"
  static constexpr MonoTime from_ns(std::int64_t n) { return MonoTime(n); }
  static constexpr MonoTime from_us(std::int64_t n) { return MonoTime(n * 1000); }
  constexpr std::int64_t since_zero_ns() const { return ns_; }
  constexpr std::int64_t since_zero_us() const { return ns_ / 1000; }
  constexpr bool is_set() const { return ns_ != 0; }

  constexpr auto operator<=>(const MonoTime&) const = default;
  constexpr Duration operator-(MonoTime o) const { return Duration::ns(ns_ - o.ns_); }
  constexpr MonoTime operator+(Duration d) const { return MonoTime(ns_ + d.count_ns()); }
  constexpr MonoTime operator-(Duration d) const { return MonoTime(ns_ - d.count_ns()); }
  constexpr MonoTime& operator+=(Duration d) { return *this = *this + d; }

 private:
  explicit constexpr MonoTime(std::int64_t n) : ns_(n) {}
  std::int64_t ns_ = 0;
};

}  // namespace dance
