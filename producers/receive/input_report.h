// InputReport: tells the user when a receiver has no usable input for three seconds, and when it
// has again: lines for a program's messages, each once.
//
// Units/frames: times of the process's clock; tick() is called about once a second.
// Ownership:    plain value.
#pragma once

#include <string>
#include <vector>

#include "core/base/time.h"
#include "producers/receive/pose_receiver.h"

namespace dance {

// The cure for an address of this machine at which nothing arrives.
std::string nothing_arrives_text(const Address& at);

class InputReport {
 public:
  static constexpr Duration kTimeout = Duration::s(3);

  explicit InputReport(std::string name) : name_(std::move(name)) {}  // of the protocol
  // `arrived_elsewhere` counts datagrams at `elsewhere`: the loopback address of the other family,
  // with the receiver's port.
  std::vector<std::string> tick(const PoseReceiver& receiver, const Address& elsewhere,
                                std::uint64_t arrived_elsewhere, MonoTime now);
  bool is_waiting_for_datagrams() const { return reported_ == Fault::kNothing; }

 private:
  enum class Fault : std::uint8_t { kNone, kNothing, kElsewhere, kUnusable };
  Fault fault_of(const InputState& state, std::uint64_t arrived_elsewhere) const;
  std::string line_of(Fault fault, const PoseReceiver& receiver, const Address& elsewhere) const;

  std::string name_;
  MonoTime since_;  // without a pose
  std::uint64_t poses_ = 0;
  std::uint64_t arrived_ = 0;  // at the last pose
  Fault pending_ = Fault::kNone;
  MonoTime pending_since_;
  Fault reported_ = Fault::kNone;
  bool has_reported_clock_ = false;
};

}  // namespace dance
