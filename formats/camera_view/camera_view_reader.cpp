#include "formats/camera_view/camera_view_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/assert.h"
#include "core/base/byte_reader.h"

namespace dance {
namespace {

bool is_share(float value) { return value >= 0.0f && value <= 1.0f; }

bool is_printable_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

template <std::size_t kCapacity>
bool read_short_text(ByteReader& in, FixedString<kCapacity>& out) {
  return out.assign(in.text(in.u8()));
}

}  // namespace

bool is_valid(const CameraFacts& facts) {
  const PictureLight& light = facts.light;
  const bool is_light = is_share(light.mean) && is_share(light.spread) &&
                        is_share(light.white_share) && is_share(light.body) &&
                        is_share(light.around);
  if (!is_light || !facts.time.is_set() || facts.time < MonoTime()) return false;
  if (!(facts.pictures_hz >= 0.0f && facts.pictures_hz <= 1000.0f)) return false;
  if (!(facts.shake >= 0.0f && facts.shake <= 100.0f)) return false;
  return std::all_of(facts.body.points.begin(), facts.body.points.end(), [](const SeenPoint& p) {
    return std::abs(p.x) <= kFarthestPoint && std::abs(p.y) <= kFarthestPoint &&
           is_share(p.visibility);
  });
}

bool is_valid(const CameraStatus& status) {
  return status.state < CameraState::kCount && status.cause < CameraCause::kCount &&
         status.width_px >= 0 && status.height_px >= 0 && is_printable_text(status.name.view()) &&
         is_printable_text(status.words.view());
}

bool is_valid(const PreviewPicture& picture) {
  return picture.width > 0 && picture.width <= kWidestPreview && picture.height > 0 &&
         picture.height <= kHighestPreview &&
         picture.rgb.size() == 3UL * static_cast<std::size_t>(picture.width * picture.height);
}

CameraViewReader::CameraViewReader()
    : record_(kMostCameraRecord_bytes), picture_(kMostPreview_bytes) {}

void CameraViewReader::add(std::size_t count) {
  DANCE_ASSERT(count <= record_.size() - held_);
  held_ += count;
  std::size_t at = 0;
  while (fault_ == Fault::kNone && held_ - at >= kCameraRecordHead_bytes) {
    ByteReader head{std::span(record_).subspan(at, kCameraRecordHead_bytes)};
    const std::uint32_t magic = head.u32();
    const std::uint16_t version = head.u16();
    const std::uint16_t kind = head.u16();
    const std::uint32_t bytes = head.u32();
    if (magic != kCameraRecordMagic)
      fault_ = Fault::kForeign;
    else if (version != kCameraRecordVersion)
      fault_ = Fault::kOtherVersion;
    else if (bytes > kMostCameraBody_bytes)
      fault_ = Fault::kForeign;
    if (fault_ != Fault::kNone) return;
    const std::size_t whole = kCameraRecordHead_bytes + bytes;
    if (held_ - at < whole) break;
    read_record(static_cast<CameraRecordKind>(kind),
                std::span(record_).subspan(at + kCameraRecordHead_bytes, bytes));
    at += whole;
  }
  if (at == 0) return;
  std::memmove(record_.data(), record_.data() + at, held_ - at);
  held_ -= at;
}

void CameraViewReader::read_record(CameraRecordKind kind, std::span<const std::uint8_t> body) {
  bool is_good = true;
  switch (kind) {
    case CameraRecordKind::kView:
      is_good = read_view(body);
      break;
    case CameraRecordKind::kStatus:
      is_good = read_status(body);
      break;
  }
  if (!is_good) ++invalid_;
}

bool CameraViewReader::read_view(std::span<const std::uint8_t> body) {
  ByteReader in(body);
  CameraFacts facts;
  facts.time = MonoTime::from_us(in.i64() % (std::int64_t{1} << 52));
  facts.pictures_hz = in.f32();
  facts.shake = in.f32();
  for (float* value : {&facts.light.mean, &facts.light.spread, &facts.light.white_share,
                       &facts.light.body, &facts.light.around})
    *value = in.f32();
  facts.body.is_found = in.u8() != 0;
  for (SeenPoint& point : facts.body.points) {
    point.x = in.f32();
    point.y = in.f32();
    point.visibility = static_cast<float>(in.u8()) / 255.0f;
  }
  const int width = in.u16();
  const int height = in.u16();
  const PreviewPicture picture{width, height, in.bytes(in.remaining())};
  if (!in.is_exhausted() || !is_valid(facts) || !is_valid(picture)) return false;
  std::copy(picture.rgb.begin(), picture.rgb.end(), picture_.begin());
  width_ = width;
  height_ = height;
  facts_ = facts;
  has_view_ = true;
  return true;
}

bool CameraViewReader::read_status(std::span<const std::uint8_t> body) {
  ByteReader in(body);
  CameraStatus status;
  status.state = static_cast<CameraState>(in.u8());
  status.cause = static_cast<CameraCause>(in.u8());
  status.has_network = in.u8() != 0;
  status.width_px = in.u16();
  status.height_px = in.u16();
  const bool has_room = read_short_text(in, status.name) && read_short_text(in, status.words);
  if (!has_room || !in.is_exhausted() || !is_valid(status)) return false;
  status_ = status;
  has_status_ = true;
  return true;
}

bool CameraViewReader::take_view() { return std::exchange(has_view_, false); }
bool CameraViewReader::take_status() { return std::exchange(has_status_, false); }

PreviewPicture CameraViewReader::picture() const {
  const std::size_t bytes = 3UL * static_cast<std::size_t>(width_ * height_);
  return {width_, height_, std::span(picture_).first(bytes)};
}

}  // namespace dance
