// Mutations of one field of a structured file: a number of its text (JSON, TOML, BVH, CSV) or an
// integer of its binary part becomes 0, negative, huge, not a number or slightly wrong. Random
// changes of bytes seldom reach such values, as they break the syntax around them first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.h"

namespace dance {

// A copy of `input` with one field changed; the same where it has none. In a GLB the lengths in the
// headers are made to fit the changed JSON.
std::vector<std::uint8_t> with_field_mutated(std::span<const std::uint8_t> input, Random& random);

}  // namespace dance
