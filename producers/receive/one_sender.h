// OneSender: whose packets a receiver reads, of all who may send to its port: of one sender at a
// time. The first whose packet made a pose is kept until it has been silent for kKept; before that
// anyone is read.
//
// Units/frames: times of receiving.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      packets of others are counted.
#pragma once

#include <cstdint>

#include "core/base/time.h"
#include "core/net/address.h"

namespace dance {

class OneSender {
 public:
  static constexpr Duration kKept = Duration::s(2);

  enum class Verdict : std::uint8_t {
    kOther,     // not to be read
    kRead,      // of the sender that is kept, or nobody is kept
    kReadAnew,  // the one that was kept is silent: what was learnt of it is to be forgotten first
  };

  // Of each packet, before it is read.
  Verdict admit(const Address& from, MonoTime received) {
    if (!sender_.is_set()) return Verdict::kRead;
    if (from == sender_) {
      heard_ = received;
      return Verdict::kRead;
    }
    if (received - heard_ < kKept) {
      ++others_;
      return Verdict::kOther;
    }
    sender_ = Address();
    return Verdict::kReadAnew;
  }
  // A packet from there made a pose.
  void keep(const Address& from, MonoTime received) {
    sender_ = from;
    heard_ = received;
  }
  void release() { sender_ = Address(); }
  bool is_kept() const { return sender_.is_set(); }
  std::uint64_t others() const { return others_; }

 private:
  Address sender_;
  MonoTime heard_;
  std::uint64_t others_ = 0;
};

}  // namespace dance
