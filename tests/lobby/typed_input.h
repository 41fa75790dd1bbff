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
#include <string_view>

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
    load(x11, "XDefaultRootWindow", root_);
    load(x11, "XQueryTree", tree_);
    load(x11, "XGetGeometry", geometry_);
    load(x11, "XMoveWindow", move_window_);
    load(x11, "XFree", free_);
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
  void press(const char* name) { press_code(keycode_(to_, keysym_(name))); }
  // Small letters, digits and dots.
  void type(std::string_view text) {
    for (const char c : text) press(c == '.' ? "period" : std::string(1, c).c_str());
  }
  // The window on top of the others goes there; false where there is none but those that a program
  // keeps to itself.
  bool move_top_window(int x, int y) {
    XWindow root = 0, parent = 0, *all = nullptr;
    unsigned int count = 0;
    tree_(to_, root_(to_), &root, &parent, &all, &count);
    bool is_moved = false;
    for (unsigned int i = count; i-- > 0 && !is_moved;) {
      int left = 0, top = 0;
      unsigned int width = 0, height = 0, border = 0, depth = 0;
      geometry_(to_, all[i], &root, &left, &top, &width, &height, &border, &depth);
      if (width < 100) continue;
      move_window_(to_, all[i], x, y);
      is_moved = true;
    }
    if (all != nullptr) free_(all);
    flush_(to_);
    return is_moved;
  }

 private:
  using XWindow = unsigned long;
  void press_code(unsigned int code) {
    key_(to_, code, 1, 0);
    key_(to_, code, 0, 0);
    flush_(to_);
  }

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
  XWindow (*root_)(void*) = nullptr;
  int (*tree_)(void*, XWindow, XWindow*, XWindow*, XWindow**, unsigned int*) = nullptr;
  int (*geometry_)(void*, XWindow, XWindow*, int*, int*, unsigned int*, unsigned int*,
                   unsigned int*, unsigned int*) = nullptr;
  int (*move_window_)(void*, XWindow, int, int) = nullptr;
  int (*free_)(void*) = nullptr;
};

}  // namespace dance
