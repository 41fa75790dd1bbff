// The records of the stream of `dance capture --check`: their heads, kinds and bounds.
//
// Units/frames: bytes; little-endian.
// Ownership:    constants.
// Threads:      any.
// Failure:      none.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/camera_view/camera_view.h"

namespace dance {

constexpr std::uint32_t kCameraRecordMagic = 0x56434e44;  // "DNCV"
constexpr std::uint16_t kCameraRecordVersion = 1;
enum class CameraRecordKind : std::uint16_t { kView = 1, kStatus = 2 };

// magic u32, version u16, kind u16, bytes of the body u32
constexpr std::size_t kCameraRecordHead_bytes = 12;
// time i64; seven numbers f32; is_found u8; 33 points of 2 × f32 and u8; width u16, height u16
constexpr std::size_t kCameraViewFacts_bytes = 8 + 7 * 4 + 1 + kSeenPoints * 9 + 4;
constexpr std::size_t kMostCameraBody_bytes = kCameraViewFacts_bytes + kMostPreview_bytes;
constexpr std::size_t kMostCameraRecord_bytes = kCameraRecordHead_bytes + kMostCameraBody_bytes;

}  // namespace dance
