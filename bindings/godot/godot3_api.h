// The part of Godot 3's C interface for native libraries (GDNative, core API 1.0) that the plug-in
// calls. Godot hands over a table of functions whose order is fixed since Godot 3.0; the few
// that are needed are named here by their place in it, so that no headers of Godot are needed.
//
// Units/frames: none.
// Ownership:    a value that a function returns or makes is destroyed by its destroy function.
// Threads:      Godot's main thread.
// Failure:      none checks its arguments.
// Source:       Godot 3 documentation, "GDNative C example"; the order is that of
//               gdnative_api.json, the same in 3.1, 3.2.3 and 3.5.3.
#pragma once

#include <stdbool.h>
#include <stdint.h>

// Opaque values, by their sizes on machines of 64 bits.
typedef struct godot_variant {
  int64_t words[3];
} godot_variant;
typedef struct godot_array {
  void* data;
} godot_array;
typedef struct godot_string {
  void* data;
} godot_string;
typedef struct godot_char_string {
  void* data;
} godot_char_string;
typedef struct godot_pool_real_array {
  void* data;
} godot_pool_real_array;
typedef struct godot_pool_access godot_pool_access;

typedef void (*godot_function)(void);

typedef struct godot_api {
  unsigned type;
  unsigned version[2];
  const void* next;
  unsigned extension_count;
  const void* const* extensions;
  godot_function functions[744];
} godot_api;

typedef struct godot_init_options {
  bool in_editor;
  uint64_t hashes[3];
  void (*report_version_mismatch)(void);
  void (*report_loading_error)(void);
  void* library;
  const godot_api* api;
  const godot_string* path;
} godot_init_options;

// Places in functions[].
enum {
  kPoolRealNew = 187,
  kPoolRealResize = 196,
  kPoolRealRead = 197,
  kPoolRealWrite = 198,
  kPoolRealSize = 201,
  kPoolRealDestroy = 202,
  kPoolRealReadPointer = 276,
  kPoolRealReadDestroy = 278,
  kPoolRealWritePointer = 304,
  kPoolRealWriteDestroy = 306,
  kArrayNew = 323,
  kArrayGet = 333,
  kArrayAppend = 336,
  kArraySize = 356,
  kArrayDestroy = 361,
  kVariantNewNil = 509,
  kVariantNewInt = 512,
  kVariantNewReal = 513,
  kVariantNewString = 514,
  kVariantNewArray = 529,
  kVariantNewPoolReal = 532,
  kVariantAsInt = 539,
  kVariantAsString = 541,
  kVariantAsPoolReal = 559,
  kVariantDestroy = 570,
  kCharStringLength = 571,
  kCharStringData = 572,
  kCharStringDestroy = 573,
  kStringUtf8 = 678,
  kStringFromUtf8 = 681,
  kStringDestroy = 721,
};
