#include "formats/log/log_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "formats/kind/file_content.h"

namespace dance {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kMaxChannelBytes = 63;
// LCM allows 256 MiB; camera pictures beside poses are the largest events of a house's log.
constexpr std::size_t kMaxDataBytes = 32 << 20;

template <class T>
T get_big_endian(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = (value << 8) | bytes[i];
  return static_cast<T>(value);
}

template <class T>
std::uint8_t* put_big_endian(std::uint8_t* out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    *out++ =
        static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * (sizeof(T) - 1 - i)));
  return out;
}

bool is_header(const std::uint8_t* bytes) {
  const auto channel_bytes = get_big_endian<std::uint32_t>(bytes + 20);
  return get_big_endian<std::uint32_t>(bytes) == kSync && channel_bytes > 0 &&
         channel_bytes <= kMaxChannelBytes &&
         get_big_endian<std::uint32_t>(bytes + 24) <= kMaxDataBytes;
}

std::string reason(int error = errno) {
  std::array<char, 128> text{};
  return strerror_r(error, text.data(), text.size());
}

}  // namespace

Result<LogReader> LogReader::open(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return fail(path + ": is a folder, not an LCM log; name a file in it");
  if (auto checked = check_content(path, {FileContent::kLcmLog}, "an LCM log"); !checked)
    return tl::make_unexpected(checked.error());
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return fail(path + ": " + reason());
  return of(file, path);
}

LogReader LogReader::of(std::FILE* file, std::string name) {
  LogReader reader;
  reader.path_ = std::move(name);
  reader.file_.reset(file);
  return reader;
}

LogReader LogReader::over(std::span<const std::uint8_t> bytes) {
  LogReader reader;
  reader.memory_ = bytes;
  return reader;
}

void LogReader::seek(std::uint64_t at_bytes) {
  buffer_.clear();
  buffer_at_ = at_bytes;
  begin_ = pending_ = 0;
  memory_at_ = std::min<std::uint64_t>(at_bytes, memory_.size());
  at_end_ = false;
  read_error_ = 0;
  if (!file_) return;
  std::clearerr(file_.get());
  if (fseeko(file_.get(), static_cast<off_t>(at_bytes), SEEK_SET) != 0) {
    read_error_ = errno;
    at_end_ = true;
  }
}

Result<void> LogReader::ended() const {
  if (read_error_ == 0) return {};
  return fail(path_ + ": cannot be read to its end: " + reason(read_error_) +
              "; copy what can be had of it to another disk");
}

// Makes `wanted` unused bytes available in buffer_; false at the end.
bool LogReader::fill(std::size_t wanted) {
  if (buffer_.size() - begin_ >= wanted) return true;
  if (at_end_) return false;  // without moving memory: a hostile file may cause this at every byte
  // Compacts rarely, as the kept bytes may be many and reads short.
  if (begin_ > buffer_.size() / 2) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
    buffer_at_ += begin_;
    begin_ = 0;
  }
  constexpr std::size_t kChunk = 64 << 10;
  while (buffer_.size() - begin_ < wanted) {
    const std::size_t old = buffer_.size();
    std::size_t got = 0;
    if (file_) {
      buffer_.resize(old + kChunk);
      errno = 0;
      got = std::fread(buffer_.data() + old, 1, kChunk, file_.get());
      if (got < kChunk && std::ferror(file_.get())) read_error_ = errno != 0 ? errno : EIO;
      buffer_.resize(old + got);
    } else {
      got = std::min(kChunk, memory_.size() - memory_at_);
      const auto from = memory_.begin() + static_cast<std::ptrdiff_t>(memory_at_);
      buffer_.insert(buffer_.end(), from, from + static_cast<std::ptrdiff_t>(got));
      memory_at_ += got;
    }
    if (got == 0 || read_error_ != 0) {
      at_end_ = true;
      return buffer_.size() - begin_ >= wanted;
    }
  }
  return true;
}

// An event begins inside this one: its lengths are wrong, or it was truncated and another recorder
// appended.
bool LogReader::reaches_into_another(std::size_t whole) {
  fill(whole + kLogHeader_bytes - 1);  // including a header that begins in the last byte
  const std::uint8_t* event = buffer_.data() + begin_;
  const std::size_t last = std::min(whole, buffer_.size() - begin_ - (kLogHeader_bytes - 1));
  for (std::size_t at = kLogHeader_bytes; at < last; ++at)
    if (event[at] == kSync >> 24 && is_header(event + at)) return true;
  return false;
}

void LogReader::skip(std::size_t count) {
  begin_ += count;
  skipped_bytes_ += count;
}

std::optional<LogEvent> LogReader::next() {
  begin_ += pending_;
  pending_ = 0;
  for (;;) {
    if (!fill(kLogHeader_bytes)) {
      skip(buffer_.size() - begin_);
      return std::nullopt;
    }
    const std::uint8_t* header = buffer_.data() + begin_;
    if (get_big_endian<std::uint32_t>(header) != kSync) {
      skip(1);
      continue;
    }
    if (!is_header(header)) {
      skip(4);  // a sync word by chance, or a damaged header
      continue;
    }
    const auto channel_bytes = get_big_endian<std::uint32_t>(header + 20);
    const auto data_bytes = get_big_endian<std::uint32_t>(header + 24);
    const std::size_t whole = kLogHeader_bytes + channel_bytes + data_bytes;
    if (!fill(whole)) {
      skip(4);  // truncated, or wrong lengths: search on after the sync word
      continue;
    }
    if (reaches_into_another(whole)) {
      skip(4);  // truncated by a killed recorder, and appended to by another
      continue;
    }
    const std::uint8_t* event = buffer_.data() + begin_;
    pending_ = whole;
    return LogEvent{get_big_endian<std::int64_t>(event + 4),
                    get_big_endian<std::int64_t>(event + 12),
                    {reinterpret_cast<const char*>(event + kLogHeader_bytes), channel_bytes},
                    {event + kLogHeader_bytes + channel_bytes, data_bytes}};
  }
}

Result<LogWriter> LogWriter::create(const std::string& path) {
  LogWriter writer;
  writer.path_ = path;
  writer.file_.reset(std::fopen(path.c_str(), "wbx"));
  if (!writer.file_) {
    if (errno == EEXIST) return fail(path + ": is there already; remove it or choose another name");
    return fail(path + ": " + reason());
  }
  return writer;
}

Result<LogWriter> LogWriter::append_to(const std::string& path) {
  LogWriter writer;
  writer.path_ = path;
  writer.file_.reset(std::fopen(path.c_str(), "ab"));
  if (!writer.file_) return fail(path + ": " + reason());
  return writer;
}

Result<void> LogWriter::append(std::int64_t time_us, std::string_view channel,
                               std::span<const std::uint8_t> data) {
  return append({events_, time_us, channel, data});
}

Result<void> LogWriter::append(const LogEvent& event) {
  const auto& [number, time_us, channel, data] = event;
  if (channel.empty() || channel.size() > kMaxChannelBytes || data.size() > kMaxDataBytes)
    return fail(path_ + ": an event of " + std::to_string(data.size()) + " bytes on '" +
                std::string(channel) + "' does not fit an LCM log");
  std::array<std::uint8_t, kLogHeader_bytes> header;
  std::uint8_t* out = put_big_endian(header.data(), kSync);
  out = put_big_endian(out, number);
  out = put_big_endian(out, time_us);
  out = put_big_endian(out, static_cast<std::uint32_t>(channel.size()));
  put_big_endian(out, static_cast<std::uint32_t>(data.size()));
  std::FILE* file = file_.get();
  if (std::fwrite(header.data(), 1, header.size(), file) != header.size() ||
      std::fwrite(channel.data(), 1, channel.size(), file) != channel.size() ||
      (!data.empty() && std::fwrite(data.data(), 1, data.size(), file) != data.size()))
    return fail(path_ + ": " + reason());
  ++events_;
  bytes_ += event.stored_bytes();
  return {};
}

Result<void> LogWriter::flush() {
  if (std::fflush(file_.get()) != 0) return fail(path_ + ": " + reason());
  return {};
}

}  // namespace dance
