#include "formats/media/ffmpeg/media_input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

extern "C" {
#include <libavutil/dict.h>
#include <libavutil/error.h>
#include <libavutil/log.h>
#include <libavutil/mem.h>
}

#include "core/base/text/errno_text.h"

namespace dance {
namespace {

constexpr int kIoBuffer_bytes = 64 * 1024;
// Between two packets of sound, pictures of a film among it; and until the first of them.
constexpr std::int64_t kMostBytesBetweenPackets = std::int64_t{256} * 1024 * 1024;
constexpr std::size_t kMostBytesAtOnce = std::size_t{256} * 1024 * 1024;

constexpr const char* kMostStreams = "64";
constexpr const char* kMostPixels = "67108864";  // 8192 × 8192

// A playlist, or an image sequence: what a file names beside itself stays closed.
int refuse_other_files(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) {
  return AVERROR(EPERM);
}

// Looks into the streams, and decodes of them no larger pictures than later.
int find_streams(AVFormatContext& format) {
  std::vector<AVDictionary*> options(format.nb_streams, nullptr);
  for (AVDictionary*& each : options) av_dict_set(&each, "max_pixels", kMostPixels, 0);
  const int code = avformat_find_stream_info(&format, options.data());
  for (AVDictionary*& each : options) av_dict_free(&each);
  return code;
}

// More boxes than that on the top level are in no file of a camera; of fragmented ones, which have
// thousands, the index is among the first.
constexpr int kMostBoxes = 4096;
constexpr std::size_t kHead_bytes = 16;

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

// Whether an MP4 or MOV file lacks its index, the box "moov" (ISO/IEC 14496-12, "Object
// structure"), without which nothing in it can be found. A camera writes it last: it is missing
// after a crash, an empty battery, or a copy that was cut. A file that is no MP4, or cannot be
// read, lacks nothing.
bool lacks_mp4_index(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0 || status.st_size < 0) return false;
  const auto end = static_cast<std::uint64_t>(status.st_size);
  bool is_mp4 = false;
  std::uint64_t at = 0;
  for (int i = 0; i < kMostBoxes && at < end; ++i) {
    std::array<std::uint8_t, kHead_bytes> head{};
    const ssize_t read = ::pread(fd, head.data(), head.size(), static_cast<off_t>(at));
    if (read < 8) break;
    const std::string_view type(reinterpret_cast<const char*>(head.data()) + 4, 4);
    if (type == "moov") return false;
    // The first box of every such file, but for old ones of QuickTime.
    if (i == 0 && type != "ftyp" && type != "wide" && type != "mdat" && type != "free")
      return false;
    is_mp4 = true;
    std::uint64_t size = big_endian(std::span(head).first(4));
    if (size == 1) size = big_endian(std::span(head).subspan(8));
    // 0: up to the end of the file, as a camera leaves it that has not finished.
    if (size == 0) break;
    if (size < 8) return false;
    if (size > end - at) break;
    at += size;
  }
  return is_mp4;
}

}  // namespace

void FfmpegFree::operator()(AVIOContext* io) const {
  if (io) av_freep(&io->buffer);
  avio_context_free(&io);
}

void quieten_ffmpeg() {
  av_log_set_level(AV_LOG_QUIET);
  av_max_alloc(kMostBytesAtOnce);
}

std::string ffmpeg_error(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

int FfmpegInput::read_bytes(void* input, std::uint8_t* bytes, int size) {
  auto& self = *static_cast<FfmpegInput*>(input);
  if (self.may_read_bytes_ <= 0) return AVERROR(EFBIG);
  const ssize_t read = ::read(self.file_, bytes, static_cast<std::size_t>(size));
  if (read < 0) return AVERROR(errno);
  self.may_read_bytes_ -= read;
  return read == 0 ? AVERROR_EOF : static_cast<int>(read);
}

std::int64_t FfmpegInput::seek_bytes(void* input, std::int64_t offset, int whence) {
  const auto& self = *static_cast<FfmpegInput*>(input);
  if (whence == AVSEEK_SIZE) {
    struct stat status {};
    return ::fstat(self.file_, &status) == 0 ? status.st_size : AVERROR(errno);
  }
  const off_t at = ::lseek(self.file_, offset, whence & ~AVSEEK_FORCE);
  return at < 0 ? AVERROR(errno) : at;
}

Result<std::unique_ptr<FfmpegInput>> FfmpegInput::open(const std::string& path,
                                                       const StreamWish& wish,
                                                       const std::string& cure) {
  quieten_ffmpeg();
  std::unique_ptr<FfmpegInput> input(new FfmpegInput(wish, cure));
  input->file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (input->file_ < 0) return fail(errno_text(errno));
  input->may_read_bytes_ = kMostBytesBetweenPackets;
  auto* buffer = static_cast<std::uint8_t*>(av_malloc(kIoBuffer_bytes));
  input->io_.reset(avio_alloc_context(buffer, kIoBuffer_bytes, 0, input.get(), &read_bytes, nullptr,
                                      &seek_bytes));
  AVFormatContext* format = avformat_alloc_context();
  if (!input->io_ || !format) return fail("no memory");
  format->pb = input->io_.get();
  format->io_open = &refuse_other_files;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", wish.containers, 0);
  if (wish.codecs != nullptr) av_dict_set(&options, "codec_whitelist", wish.codecs, 0);
  av_dict_set(&options, "protocol_whitelist", "none", 0);
  av_dict_set(&options, "max_streams", kMostStreams, 0);
  int code = avformat_open_input(&format, "", nullptr, &options);
  av_dict_free(&options);
  // What could not be opened is freed already.
  if (code < 0 && lacks_mp4_index(input->file_))
    return fail("no " + std::string(wish.kind) +
                " that can be read, as its end is missing: the recording was not finished, or the "
                "copy was cut (no 'moov' box); copy it again, or rebuild its index with untrunc");
  if (code < 0)
    return fail("no " + std::string(wish.kind) + " that can be read (" +
                (code == AVERROR(EINVAL) ? "no known format of " + std::string(wish.stream)
                                         : ffmpeg_error(code)) +
                "); copy it again, or convert it to " + cure);
  input->format_.reset(format);
  code = find_streams(*format);
  if (code >= 0) code = av_find_best_stream(format, wish.type, -1, -1, &input->codec_, 0);
  if (code == AVERROR_STREAM_NOT_FOUND)
    return fail("no " + std::string(wish.stream) + " in it; name a file of " + wish.kind);
  if (code < 0)
    return fail("its " + std::string(wish.stream) + " cannot be read (" + ffmpeg_error(code) +
                "); copy it again, or convert it to " + cure);
  input->stream_ = format->streams[code];
  for (unsigned i = 0; i < format->nb_streams; ++i)
    if (static_cast<int>(i) != code) format->streams[i]->discard = AVDISCARD_ALL;
  return input;
}

FfmpegInput::~FfmpegInput() {
  format_.reset();
  if (file_ >= 0) ::close(file_);
}

Result<FfmpegPtr<AVCodecContext>> FfmpegInput::open_decoder() const {
  FfmpegPtr<AVCodecContext> decoder(avcodec_alloc_context3(codec_));
  if (!decoder) return fail("no memory");
  int code = avcodec_parameters_to_context(decoder.get(), stream_->codecpar);
  if (code < 0) return fail(ffmpeg_error(code));
  decoder->pkt_timebase = stream_->time_base;
  decoder->thread_count = wish_.threads;
  AVDictionary* options = nullptr;
  if (wish_.codecs != nullptr) av_dict_set(&options, "codec_whitelist", wish_.codecs, 0);
  av_dict_set(&options, "max_pixels", kMostPixels, 0);
  code = avcodec_open2(decoder.get(), codec_, &options);
  av_dict_free(&options);
  if (code < 0)
    return fail("its " + std::string(wish_.stream) + ", in " + codec_->name +
                ", cannot be decoded (" + ffmpeg_error(code) + "); convert it to " + cure_);
  return decoder;
}

Result<bool> FfmpegInput::read(AVPacket& packet) {
  may_read_bytes_ = kMostBytesBetweenPackets;
  for (;;) {
    av_packet_unref(&packet);
    const int code = av_read_frame(format_.get(), &packet);
    if (code == AVERROR_EOF && may_read_bytes_ > 0) return false;
    if (code < 0) return fail(ffmpeg_error(code));
    if (packet.stream_index == stream_->index) return true;
  }
}

bool FfmpegInput::seek(std::int64_t time) {
  may_read_bytes_ = kMostBytesBetweenPackets;
  return av_seek_frame(format_.get(), stream_->index, time, AVSEEK_FLAG_BACKWARD) >= 0;
}

}  // namespace dance
