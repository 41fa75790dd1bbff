// The container of a glTF file: from and to bytes, by tinygltf, which is shown only what was
// checked for size and depth, and which opens no file and decodes no picture.
//
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      unpacked_model() of bytes that are no glTF says what is wrong. Never throws on any
//               bytes; memory is bounded by GlbLimits.
// Source:       glTF 2.0, 4. GLB File Format Specification.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "formats/gltf/glb.h"

namespace dance {

Result<tinygltf::Model> unpacked_model(std::span<const std::uint8_t> bytes,
                                       const GlbLimits& limits);
Result<std::vector<std::uint8_t>> packed_glb(const tinygltf::Model& model);

}  // namespace dance
