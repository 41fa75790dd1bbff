#include "formats/camera_view/camera_view_writer.h"

#include <bit>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/byte_writer.h"

namespace dance {
namespace {

void put_f32(ByteWriter& out, float value) { out.u32(std::bit_cast<std::uint32_t>(value)); }

// The length of a body is known when it is written.
std::span<const std::uint8_t> with_head(CameraRecordKind kind, const ByteWriter& body,
                                        CameraRecordBuffer& buffer) {
  DANCE_ASSERT(body.ok());
  ByteWriter head{std::span(buffer).first(kCameraRecordHead_bytes)};
  head.u32(kCameraRecordMagic);
  head.u16(kCameraRecordVersion);
  head.u16(static_cast<std::uint16_t>(kind));
  head.u32(static_cast<std::uint32_t>(body.size()));
  return std::span(buffer).first(kCameraRecordHead_bytes + body.size());
}

}  // namespace

std::span<const std::uint8_t> write_camera_view(const CameraFacts& facts,
                                                const PreviewPicture& picture,
                                                CameraRecordBuffer& buffer) {
  DANCE_ASSERT(is_valid(facts) && is_valid(picture));
  ByteWriter out{std::span(buffer).subspan(kCameraRecordHead_bytes)};
  out.i64(facts.time.since_zero_us());
  put_f32(out, facts.pictures_hz);
  put_f32(out, facts.shake);
  for (const float value : {facts.light.mean, facts.light.spread, facts.light.white_share,
                            facts.light.body, facts.light.around})
    put_f32(out, value);
  out.u8(facts.body.is_found ? 1 : 0);
  for (const SeenPoint& point : facts.body.points) {
    put_f32(out, point.x);
    put_f32(out, point.y);
    out.u8(static_cast<std::uint8_t>(std::lround(point.visibility * 255.0f)));
  }
  out.u16(static_cast<std::uint16_t>(picture.width));
  out.u16(static_cast<std::uint16_t>(picture.height));
  out.bytes(picture.rgb);
  return with_head(CameraRecordKind::kView, out, buffer);
}

std::span<const std::uint8_t> write_camera_status(const CameraStatus& status,
                                                  CameraRecordBuffer& buffer) {
  DANCE_ASSERT(is_valid(status));
  ByteWriter out{std::span(buffer).subspan(kCameraRecordHead_bytes)};
  out.u8(static_cast<std::uint8_t>(status.state));
  out.u8(static_cast<std::uint8_t>(status.cause));
  out.u8(status.has_network ? 1 : 0);
  out.u16(static_cast<std::uint16_t>(status.width_px));
  out.u16(static_cast<std::uint16_t>(status.height_px));
  out.short_text(status.name.view());
  out.short_text(status.words.view());
  return with_head(CameraRecordKind::kStatus, out, buffer);
}

}  // namespace dance
