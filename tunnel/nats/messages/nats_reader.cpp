#include "tunnel/nats/messages/nats_reader.h"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace dance {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(word.size());
  return word;
}

template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::span<std::uint8_t> NatsReader::room() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= at_;
  first_ = at_ = 0;
  first_passes_over_ = passes_over_;
  return std::span(buffer_).subspan(end_);
}

void NatsReader::rewind() {
  at_ = first_;
  passes_over_ = first_passes_over_;
}

std::optional<NatsReader::Item> NatsReader::next() {
  const std::size_t passed = std::min(passes_over_, end_ - at_);
  at_ += passed;
  passes_over_ -= passed;
  if (is_broken_ || at_ == end_) return std::nullopt;
  const char* begin = reinterpret_cast<const char*>(buffer_.data()) + at_;
  const auto* found = static_cast<const char*>(std::memchr(begin, '\n', end_ - at_));
  if (found == nullptr || found - begin > static_cast<std::ptrdiff_t>(kMaxLine)) {
    is_broken_ = end_ - at_ > kMaxLine;
    return std::nullopt;
  }
  std::string_view line(begin, static_cast<std::size_t>(found - begin));
  const std::size_t after_line = at_ + line.size() + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::string_view rest = line;
  const std::string_view word = take_word(rest);
  if (word == "MSG") return message(rest, after_line);
  Item item;
  item.kind = word == "PING"   ? Kind::kPing
              : word == "PONG" ? Kind::kPong
              : word == "-ERR" ? Kind::kError
                               : Kind::kOther;
  if (item.kind == Kind::kOther && word != "INFO" && word != "+OK") {
    is_broken_ = true;
    return std::nullopt;
  }
  item.text = rest;
  at_ = after_line;
  return item;
}

// MSG <subject> <subscription> [<reply>] <bytes>
std::optional<NatsReader::Item> NatsReader::message(std::string_view line, std::size_t after_line) {
  Item item;
  item.text = take_word(line);
  const std::string_view subscription = take_word(line);
  std::string_view size_text = take_word(line);
  if (const std::string_view behind_reply = take_word(line); !behind_reply.empty())
    size_text = behind_reply;
  std::size_t size = 0;
  if (item.text.empty() || !read_number(subscription, item.subscription) ||
      !read_number(size_text, size) || size > SIZE_MAX / 2) {
    is_broken_ = true;
    return std::nullopt;
  }
  if (size > kMaxMessage) {
    item.kind = Kind::kTooLong;
    at_ = after_line;
    passes_over_ = size + kLineEnd.size();
    return item;
  }
  if (end_ - after_line < size + kLineEnd.size()) return std::nullopt;
  item.kind = Kind::kMessage;
  item.payload = std::span<const std::uint8_t>(buffer_).subspan(after_line, size);
  at_ = after_line + size + kLineEnd.size();
  return item;
}

}  // namespace dance
