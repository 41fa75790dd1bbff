// SettingDesk: what a panel has in hand for one guest: follows what is in force until a person
// changes something, asks for that until it is in force, and gives up after a while.
//
// Units/frames: `now` is the house's clock.
// Ownership:    plain value, no heap.
// Threads:      the drawing thread.
// Failure:      is_unheard() is true where nobody took what was asked for.
#pragma once

#include "core/base/time.h"

namespace dance {

// Of a Setting that is_same(a, b) compares.
template <class Setting, bool (*is_same)(const Setting&, const Setting&)>
class SettingDesk {
 public:
  static constexpr Duration kAgain = Duration::ms(200);
  static constexpr Duration kGivesUp = Duration::s(2);

  const Setting& setting() const { return setting_; }
  bool is_unheard() const { return is_unheard_; }
  bool is_waiting() const { return asked_.is_set(); }

  // Another guest: nothing of before holds.
  void reset() { *this = SettingDesk(); }
  void change(const Setting& setting, MonoTime now) {
    setting_ = setting;
    asked_ = now;
    said_ = MonoTime();
    is_unheard_ = false;
  }
  // Once a picture, with what is in force. True where `setting` is to be asked for now.
  bool follow(const Setting& in_force, MonoTime now) {
    if (!asked_.is_set()) {
      setting_ = in_force;
      return false;
    }
    if (is_same(setting_, in_force)) {
      asked_ = MonoTime();
      setting_ = in_force;
      return false;
    }
    if (now - asked_ > kGivesUp) {
      asked_ = MonoTime();
      is_unheard_ = true;
      setting_ = in_force;
      return false;
    }
    if (said_.is_set() && now - said_ < kAgain) return false;
    said_ = now;
    return true;
  }

 private:
  Setting setting_;
  MonoTime asked_, said_;
  bool is_unheard_ = false;
};

}  // namespace dance
