// The state of a GuestBoard as bytes of an index: ReplayStateWriter saves the fields that carry()
// passes to it, StateReader restores them.
//
// Units/frames: little-endian; times in ns.
// Ownership:    the reader borrows its bytes.
// Threads:      none inside.
// Failure:      is_fine() is false after bytes that are too few or too many, numbers that are not
//               finite, times beyond a century, or what a carry() refuses.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/byte_reader.h"
#include "core/base/fixed_string.h"
#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "core/pose/skeleton.h"

namespace dance {

class ReplayStateWriter {
 public:
  void operator()(bool v) { put<1>(v ? 1 : 0); }
  void operator()(int v) { put<4>(static_cast<std::uint32_t>(v)); }
  void operator()(std::uint32_t v) { put<4>(v); }
  void operator()(std::uint64_t v) { put<8>(v); }
  void operator()(float v) { put<4>(std::bit_cast<std::uint32_t>(v)); }
  void operator()(double v) { put<8>(std::bit_cast<std::uint64_t>(v)); }
  void operator()(MonoTime t) { put<8>(static_cast<std::uint64_t>(t.since_zero_ns())); }
  void operator()(Duration d) { put<8>(static_cast<std::uint64_t>(d.count_ns())); }
  void operator()(const std::optional<float>& v) {
    (*this)(v.has_value());
    if (v) (*this)(*v);
  }
  void operator()(const GuestId& id) {
    put<1>(id.view().size());
    out_.insert(out_.end(), id.view().begin(), id.view().end());
  }
  void operator()(const Skeleton& skeleton) {
    (*this)(skeleton.version);
    for (const auto& offset : skeleton.offset_m) vector(offset);
    for (const auto& tip : skeleton.tip_m) vector(tip);
  }
  template <std::size_t kCapacity>
  void operator()(const FixedString<kCapacity>& text) {
    put<2>(text.size());
    out_.insert(out_.end(), text.view().begin(), text.view().end());
  }
  void refuse() {}
  std::vector<std::uint8_t>& bytes() { return out_; }

 private:
  void vector(const Eigen::Vector3f& v) { (*this)(v.x()), (*this)(v.y()), (*this)(v.z()); }
  template <std::size_t kBytes>
  void put(std::uint64_t v) {
    for (std::size_t i = 0; i < kBytes; ++i)
      out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  std::vector<std::uint8_t> out_;
};

class StateReader {
 public:
  explicit StateReader(std::span<const std::uint8_t> bytes) : in_(bytes) {}

  void operator()(bool& v) { v = in_.u8() != 0; }
  void operator()(int& v) { v = in_.i32() & 0xffffff; }  // counts
  void operator()(std::uint32_t& v) { v = in_.u32(); }
  void operator()(std::uint64_t& v) { v = in_.u64(); }
  void operator()(float& v) {
    v = in_.f32();
    if (!std::isfinite(v)) refuse(), v = 0.0f;
  }
  void operator()(double& v) {
    v = in_.f64();
    if (!std::isfinite(v)) refuse(), v = 0.0;
  }
  void operator()(MonoTime& t) { t = MonoTime::from_ns(ns()); }
  void operator()(Duration& d) { d = Duration::ns(ns()); }
  void operator()(std::optional<float>& v) {
    bool has_value = false;
    (*this)(has_value);
    v.reset();
    if (!has_value) return;
    float value = 0.0f;
    (*this)(value);
    v = value;
  }
  void operator()(GuestId& id) {
    const auto text = in_.text(in_.u8());
    id = GuestId();
    if (text.empty()) return;
    if (const auto parsed = GuestId::parse(text))
      id = *parsed;
    else
      refuse();
  }
  void operator()(Skeleton& skeleton) {
    (*this)(skeleton.version);
    for (auto& offset : skeleton.offset_m) vector(offset);
    for (auto& tip : skeleton.tip_m) vector(tip);
    if (!is_valid(skeleton)) refuse();
  }
  template <std::size_t kCapacity>
  void operator()(FixedString<kCapacity>& text) {
    const std::size_t size = in_.u16();
    if (!text.assign(in_.text(size))) refuse();
  }
  void refuse() { is_refused_ = true; }
  bool is_fine() const { return in_.is_exhausted() && !is_refused_; }

 private:
  std::int64_t ns() {
    constexpr std::int64_t kCentury_ns = 100LL * 366 * 24 * 3600 * 1'000'000'000;
    const std::int64_t ns = in_.i64();
    if (ns > -kCentury_ns && ns < kCentury_ns) return ns;
    refuse();
    return 0;
  }
  void vector(Eigen::Vector3f& v) { (*this)(v.x()), (*this)(v.y()), (*this)(v.z()); }

  ByteReader in_;
  bool is_refused_ = false;
};

}  // namespace dance
