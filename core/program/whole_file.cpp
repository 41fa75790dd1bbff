#include "core/program/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <lzma.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCure = "name a file in a folder that is yours, with space left";

tl::unexpected<Error> not_written(const std::string& path, const std::error_code& why,
                                  const std::string& then = kCure) {
  return fail(fmt::format("{} cannot be written: {}; {}", path, why.message(), then));
}

// The system's message for the failed call.
std::error_code put(const fs::path& file, std::string_view content) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return {};
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

constexpr std::string_view kXzMagic(
    "\xFD"
    "7zXZ\0",
    6);
constexpr std::size_t kBlock_bytes = std::size_t{1} << 16;
// What the decoder may take for itself: the strongest preset needs 65 MiB.
constexpr std::uint64_t kDecoderMemory_bytes = std::uint64_t{128} << 20;

std::string megabytes(std::size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

class XzDecoder {
 public:
  XzDecoder()
      : is_ready_(lzma_stream_decoder(&stream_, kDecoderMemory_bytes, LZMA_CONCATENATED) ==
                  LZMA_OK) {}
  ~XzDecoder() { lzma_end(&stream_); }
  XzDecoder(const XzDecoder&) = delete;
  XzDecoder& operator=(const XzDecoder&) = delete;

  Result<Unpacked> decode(std::string_view packed, std::size_t most_bytes) {
    if (!is_ready_) return fail("no memory to unpack it");
    std::string out;
    std::array<std::uint8_t, kBlock_bytes> block;
    stream_.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
    stream_.avail_in = packed.size();
    for (;;) {
      stream_.next_out = block.data();
      stream_.avail_out = block.size();
      const lzma_ret result = lzma_code(&stream_, LZMA_FINISH);
      const std::size_t count = block.size() - stream_.avail_out;
      if (out.size() + count > most_bytes)
        return fail("unpacks to more than " + megabytes(most_bytes));
      out.append(reinterpret_cast<const char*>(block.data()), count);
      if (result == LZMA_STREAM_END) return Unpacked{std::move(out), false};
      if (result == LZMA_BUF_ERROR) return Unpacked{std::move(out), true};
      if (result != LZMA_OK) return fail(reason(result));
    }
  }

 private:
  static const char* reason(lzma_ret result) {
    switch (result) {
      case LZMA_FORMAT_ERROR:
        return "what follows is no xz file; copy it again";
      case LZMA_MEMLIMIT_ERROR:
        return "needs over 128 MiB to unpack; pack it with xz -9 or less";
      case LZMA_OPTIONS_ERROR:
        return "packed in a way this liblzma does not know; pack it with xz";
      default:
        return "the xz file is damaged; copy it again";
    }
  }

  lzma_stream stream_ = LZMA_STREAM_INIT;
  bool is_ready_;
};

struct Place {
  fs::path file, beside;
  fs::file_status was;
  // Pipes and devices are not renamed onto.
  bool is_device() const { return fs::exists(was) && !fs::is_regular_file(was); }
};

Place place_of(const std::string& path) {
  std::error_code error;
  // A symbolic link stays: its target is written.
  Place place{fs::canonical(path, error), {}, {}};
  if (error) {
    place.file = path;
    const fs::path target = fs::read_symlink(path, error);
    if (!error) place.file = place.file.parent_path() / target;
  }
  place.was = fs::status(place.file, error);
  place.beside = fmt::format("{}.{}.part", place.file.native(), getpid());
  return place;
}

}  // namespace

Result<void> try_whole_file(const std::string& path) {
  const Place place = place_of(path);
  std::error_code why, error;
  if (place.is_device()) {
    if (fs::is_directory(place.was))
      why = std::make_error_code(std::errc::is_a_directory);
    else if (access(place.file.c_str(), W_OK) != 0)
      why = {errno, std::generic_category()};
  } else {
    why = put(place.beside, {});
    fs::remove(place.beside, error);
  }
  if (why) return not_written(path, why);
  return {};
}

Result<void> write_whole_file(const std::string& path, std::string_view content) {
  const Place place = place_of(path);
  std::error_code error;
  if (place.is_device()) {
    if (const std::error_code why = put(place.file, content)) return not_written(path, why);
    return {};
  }
  if (const std::error_code why = put(place.beside, content)) {
    fs::remove(place.beside, error);
    return not_written(path, why);
  }
  if (fs::exists(place.was)) fs::permissions(place.beside, place.was.permissions(), error);
  std::error_code why;
  fs::rename(place.beside, place.file, why);
  // The temporary file is kept: it may have taken minutes to make.
  if (why) return not_written(path, why, "what was to be there is in " + place.beside.native());
  return {};
}

Result<void> write_whole_file(const std::string& path, std::span<const std::uint8_t> content) {
  return write_whole_file(
      path, std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

Result<std::string> read_whole_file(const std::string& path, std::size_t most_bytes) {
  // Non-blocking, so that a pipe without a writer is refused instead of waited for.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0)
    return fail(path + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return fail(path + ": " + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) return fail(path + ": a folder; name a file in it");
  if (!S_ISREG(status.st_mode)) return fail(path + ": no regular file");
  std::string bytes;
  std::array<char, kBlock_bytes> block;
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail(path + ": " + std::strerror(errno));
    if (count == 0) return bytes;
    if (bytes.size() + static_cast<std::size_t>(count) > most_bytes)
      return fail(path + ": larger than " + megabytes(most_bytes));
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

bool is_xz(std::string_view bytes) { return bytes.starts_with(kXzMagic); }

Result<Unpacked> unpacked_part(std::string bytes, std::size_t most_bytes) {
  if (!is_xz(bytes)) return Unpacked{std::move(bytes), false};
  return XzDecoder().decode(bytes, most_bytes);
}

Result<std::string> unpacked(std::string bytes, std::size_t most_bytes) {
  DANCE_TRY(Unpacked part, unpacked_part(std::move(bytes), most_bytes));
  if (part.is_cut) return fail(kXzIsCut);
  return std::move(part.bytes);
}

}  // namespace dance
