// OscBundleWriter: puts messages of Open Sound Control into bundles, each of which fits an Ethernet
// frame, and hands each to a sink when the next message no longer fits or at flush().
//
// Units/frames: none; the bundles' time tag is "immediately".
// Ownership:    refers to the sink, which must outlive it; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a message that fits no bundle is left out and counted.
// Source:       Open Sound Control 1.0 specification.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>

namespace dance {

class OscPacketSink {
 public:
  virtual ~OscPacketSink() = default;
  virtual void on_packet(std::span<const std::uint8_t> packet) = 0;
};

struct OscValue {
  enum class Kind : std::uint8_t { kInt, kFloat, kText };
  OscValue(std::int32_t value) : kind(Kind::kInt), number(value) {}  // NOLINT: a list of values
  OscValue(float value) : kind(Kind::kFloat), real(value) {}         // NOLINT
  OscValue(const char* value) : kind(Kind::kText), text(value) {}    // NOLINT
  Kind kind;
  std::int32_t number = 0;
  float real = 0.0f;
  const char* text = "";
};

class OscBundleWriter {
 public:
  // An Ethernet frame of 1500 bytes less the headers of IPv4 and UDP.
  static constexpr std::size_t kMostPacketBytes = 1472;

  explicit OscBundleWriter(OscPacketSink& sink);
  ~OscBundleWriter();
  OscBundleWriter(const OscBundleWriter&) = delete;
  OscBundleWriter& operator=(const OscBundleWriter&) = delete;

  void add(const char* address, std::initializer_list<OscValue> values);
  void flush();
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Buffer;
  OscPacketSink& sink_;
  std::unique_ptr<Buffer> buffer_;
  std::uint64_t left_out_ = 0;
};

}  // namespace dance
