// Mouse and keys of a virtual display, as a person uses them: through the XTEST extension, which is
// loaded at run time.
//
// Units/frames: pixels of the screen; keys by their X names: "Return", "q".
// Ownership:    owns its connection to the display server.
// Threads:      one.
// Failure:      is_there() is false where the libraries or the display are missing: skip.
#pragma once

#include <dlfcn.h>

#include <string>

namespace dance {

class TypedInput {
 public:
  explicit TypedInput(const std::string& display) {
    void* x11 = dlopen("libX11.so.6", RTLD_NOW);
    void* xtst = dlopen("libXtst.so.6", RTLD_NOW);
    if (x11 == nullptr || xtst == nullptr) return;
    load(x11, "XOpenDisplay", open_);
    load(x11, "XFlush", flush_);
    load(x11, "XStringToKeysym", keysym_);
    load(x11, "XKeysymToKeycode", keycode_);
    load(x11, "XCloseDisplay", close_);
    load(xtst, "XTestFakeKeyEvent", key_);
    load(xtst, "XTestFakeButtonEvent", button_);
    load(xtst, "XTestFakeMotionEvent", motion_);
    if (key_ != nullptr && button_ != nullptr && motion_ != nullptr) to_ = open_(display.c_str());
  }
  ~TypedInput() {
    if (to_ != nullptr) close_(to_);
  }
  TypedInput(const TypedInput&) = delete;
  TypedInput& operator=(const TypedInput&) = delete;

  bool is_there() const { return to_ != nullptr; }
  void move(int x, int y) {
    motion_(to_, 0, x, y, 0);
    flush_(to_);
  }
  void click(int x, int y) {
    move(x, y);
    button_(to_, 1, 1, 0);
    button_(to_, 1, 0, 0);
    flush_(to_);
  }
  void press(const char* name) {
    const unsigned int code = keycode_(to_, keysym_(name));
    key_(to_, code, 1, 0);
    key_(to_, code, 0, 0);
    flush_(to_);
  }

 private:
  template <class Function>
  static void load(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
  }

  void* to_ = nullptr;
  void* (*open_)(const char*) = nullptr;
  int (*close_)(void*) = nullptr;
  int (*flush_)(void*) = nullptr;
  unsigned long (*keysym_)(const char*) = nullptr;
  unsigned char (*keycode_)(void*, unsigned long) = nullptr;
  int (*key_)(void*, unsigned int, int, unsigned long) = nullptr;
  int (*button_)(void*, unsigned int, int, unsigned long) = nullptr;
  int (*motion_)(void*, int, int, int, unsigned long) = nullptr;
};

}  // namespace dance
