// Writes the records of the stream of `dance capture --check`.
//
// Units/frames: as camera_view.h and camera_view_record.h.
// Ownership:    writes into the caller's buffer.
// Threads:      none inside.
// Failure:      facts, statuses and pictures that are not valid are a bug of the caller's.
#pragma once

#include <array>
#include <span>

#include "formats/camera_view/camera_view_record.h"

namespace dance {

using CameraRecordBuffer = std::array<std::uint8_t, kMostCameraRecord_bytes>;

// The record's bytes, in the buffer.
std::span<const std::uint8_t> write_camera_view(const CameraFacts& facts,
                                                const PreviewPicture& picture,
                                                CameraRecordBuffer& buffer);
std::span<const std::uint8_t> write_camera_status(const CameraStatus& status,
                                                  CameraRecordBuffer& buffer);

}  // namespace dance
