#include "formats/bvh/clip_file.h"

#include <fcntl.h>
#include <lzma.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace dance {
namespace {

constexpr std::string_view kXzMagic(
    "\xFD"
    "7zXZ\0",
    6);
constexpr std::size_t kBlock_bytes = std::size_t{1} << 16;
// Memory limit of the decoder: the strongest preset needs 65 MiB.
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

Result<std::string> read_file(const std::string& path, std::size_t most_bytes) {
  // Non-blocking, so that a pipe without a writer is refused instead of waited for.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0)
    return fail(path + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return fail(path + ": " + std::strerror(errno));
  if (S_ISDIR(status.st_mode))
    return fail(path + ": a directory; name a .bvh or .bvh.xz file in it");
  if (!S_ISREG(status.st_mode))
    return fail(path + ": no regular file; name a .bvh or .bvh.xz file");
  std::string bytes;
  std::array<char, kBlock_bytes> block;
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail(path + ": " + std::strerror(errno));
    if (count == 0) return bytes;
    if (bytes.size() + static_cast<std::size_t>(count) > most_bytes)
      return fail(path + ": larger than " + megabytes(most_bytes) + "; cut the take into parts");
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

class XzDecoder {
 public:
  XzDecoder()
      : is_ready_(lzma_stream_decoder(&stream_, kDecoderMemory_bytes, LZMA_CONCATENATED) ==
                  LZMA_OK) {}
  ~XzDecoder() { lzma_end(&stream_); }
  XzDecoder(const XzDecoder&) = delete;
  XzDecoder& operator=(const XzDecoder&) = delete;

  Result<std::string> decode(std::string_view packed, std::size_t most_bytes) {
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
        return fail("unpacks to more than " + megabytes(most_bytes) + "; cut the take into parts");
      out.append(reinterpret_cast<const char*>(block.data()), count);
      if (result == LZMA_STREAM_END) return out;
      if (result != LZMA_OK) return fail(reason(result));
    }
  }

 private:
  static const char* reason(lzma_ret result) {
    switch (result) {
      case LZMA_BUF_ERROR:
        return "the xz file is cut short; copy it again";
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

}  // namespace

Result<std::string> read_clip_text(const std::string& path, std::size_t most_bytes) {
  DANCE_TRY(std::string bytes, read_file(path, most_bytes));
  if (std::string_view(bytes).substr(0, kXzMagic.size()) == kXzMagic) {
    auto unpacked = XzDecoder().decode(bytes, most_bytes);
    if (!unpacked) return fail(path + ": " + unpacked.error().what);
    return std::move(*unpacked);
  }
  if (bytes.empty()) return fail(path + ": empty; copy it again");
  if (path.ends_with(".xz")) return fail(path + ": no xz file inside; rename or pack it with xz");
  return bytes;
}

Result<LoadedClip> load_clip(const std::string& path, const RetargetOptions& options) {
  DANCE_TRY(const std::string text, read_clip_text(path));
  const auto bvh = read_bvh(text);
  if (!bvh) return fail(path + ": " + bvh.error().what);
  auto retargeted = retarget(*bvh, options);
  if (!retargeted) return fail(path + ": " + retargeted.error().what);
  return LoadedClip{std::move(retargeted->clip), std::move(retargeted->notes)};
}

}  // namespace dance
