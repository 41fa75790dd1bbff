// openxr_platform.h for OpenGL on X, without the macros of X that are words of others.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      none inside.
// Failure:      none.
#pragma once

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#define XR_USE_TIMESPEC
// clang-format off
#include <time.h>
#include <GL/glx.h>
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
// clang-format on

#undef Success
#undef None
#undef Bool
#undef Status
#undef Always
