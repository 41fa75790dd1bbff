// The few OpenGL calls of the test runtime, in the caller's current context: the textures of
// swapchains, and pictures of what was drawn into them.
//
// Units/frames: pixels; rows of a picture from the top.
// Ownership:    the runtime's tables own the textures.
// Threads:      the one in which the application calls, with its context current.
// Failure:      false or nothing where no context is current.
#pragma once

#include <openxr/openxr.h>

#include <cstdint>
#include <string>
#include <vector>

namespace dance::test_xr {

// GLX or EGL; with a context of GLX in the session only that one.
bool is_context_current(void* glx_context);
std::vector<std::uint32_t> make_textures(const XrSwapchainCreateInfo& info, std::uint32_t count);
void delete_textures(const std::vector<std::uint32_t>& textures);
// What stands in a part of a texture as a binary PPM; as stored: no conversion of colours.
bool write_picture(std::uint32_t texture, const XrSwapchainCreateInfo& info,
                   const XrSwapchainSubImage& part, const std::string& path);

}  // namespace dance::test_xr
