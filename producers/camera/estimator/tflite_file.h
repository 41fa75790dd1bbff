// Reads a network from a .tflite file: those operations of TensorFlow Lite that the networks of
// body, hands and face use, with weights in single or half precision, dense or sparse.
//
// Units/frames: as producers/camera/estimator/pose_graph.h says.
// Ownership:    the graph owns its numbers; the bytes are not needed afterwards.
// Threads:      none inside.
// Failure:      an Error says which part of the file is wrong or not known here. Memory is bounded
//               (64 MiB of weights), and so is time, whatever the bytes are.
// Source:       the schema of TensorFlow Lite, version 3.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_graph.h"

namespace dance {

Result<PoseGraph> parse_tflite(std::span<const std::uint8_t> bytes);
// The Error names the file.
Result<PoseGraph> read_tflite_file(const std::string& path);

}  // namespace dance
