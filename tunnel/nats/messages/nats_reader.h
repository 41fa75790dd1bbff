// The messages in what a NATS server sends, cut out of the stream of bytes in place.
//
// Units/frames: bytes; what is given back is valid until room() is asked for again.
// Ownership:    one buffer of fixed size; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a message that is too long is passed over; a stream that is none of a NATS server's
//               is broken, and stays so.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace dance {

class NatsReader {
 public:
  static constexpr std::size_t kMaxMessage = 16'384;  // without its subject
  enum class Kind : std::uint8_t { kMessage, kTooLong, kPing, kPong, kError, kOther };
  struct Item {
    Kind kind = Kind::kOther;
    std::uint32_t subscription = 0;  // kMessage, kTooLong
    std::string_view text;           // the subject; of kError what is said
    std::span<const std::uint8_t> payload;
  };

  NatsReader() : buffer_(kBuffer) {}

  // Where the next bytes go; how many came; and what is complete, one after the other.
  std::span<std::uint8_t> room();
  void add(std::size_t count) { end_ += count; }
  std::optional<Item> next();
  // Back to the first item since room(), to look at all before any is taken.
  void rewind();
  bool is_broken() const { return is_broken_; }
  // Another connection begins.
  void clear() { *this = NatsReader(std::move(buffer_)); }

 private:
  static constexpr std::size_t kBuffer = 131'072;
  static constexpr std::size_t kMaxLine = 32'768;

  explicit NatsReader(std::vector<std::uint8_t>&& buffer) : buffer_(std::move(buffer)) {}
  std::optional<Item> message(std::string_view line, std::size_t after_line);

  std::vector<std::uint8_t> buffer_;
  std::size_t first_ = 0;  // since room()
  std::size_t at_ = 0;
  std::size_t end_ = 0;
  std::size_t passes_over_ = 0;  // of a message that is too long
  std::size_t first_passes_over_ = 0;
  bool is_broken_ = false;
};

}  // namespace dance
