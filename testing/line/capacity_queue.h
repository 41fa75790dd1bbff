// The queue in front of a line of recorded capacity: what comes leaves in order, several in one
// opportunity where they fit, one over several where it does not. An opportunity that nobody waits
// for is lost.
//
// Units/frames: times from the trace's begin; they must not go back. Bytes include all headers.
// Ownership:    shares the trace; never allocates.
// Threads:      none inside; one owner.
// Failure:      none; what would wait too long is refused.
#pragma once

#include <memory>
#include <optional>

#include "testing/line/capacity_trace.h"

namespace dance {

class CapacityQueue {
 public:
  explicit CapacityQueue(std::shared_ptr<const CapacityTrace> trace) : trace_(std::move(trace)) {}

  // When the last of the bytes has left; nothing where that would be more than `longest` from now.
  std::optional<Duration> take(std::size_t bytes, Duration now, Duration longest) {
    if (trace_->at(next_) < now) {
      next_ = trace_->first_from(now);
      left_bytes_ = CapacityTrace::kOpportunity_bytes;
    }
    CapacityTrace::Number next = next_;
    std::size_t left_bytes = left_bytes_;
    while (bytes > left_bytes) {
      bytes -= left_bytes;
      left_bytes = CapacityTrace::kOpportunity_bytes;
      if (trace_->at(++next) - now > longest) return std::nullopt;
    }
    const Duration leaves = trace_->at(next);
    if (leaves - now > longest) return std::nullopt;
    next_ = next;
    left_bytes_ = left_bytes - bytes;
    return leaves;
  }

 private:
  std::shared_ptr<const CapacityTrace> trace_;
  CapacityTrace::Number next_ = 0;  // the opportunity that has left_bytes_ to give
  std::size_t left_bytes_ = CapacityTrace::kOpportunity_bytes;
};

}  // namespace dance
