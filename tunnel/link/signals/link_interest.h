// Whose poses and voices this house wants, as the server is told: the list of the guests who are
// here, again whenever it changes, until the server acknowledges it.
//
// Units/frames: dividers as in tunnel/policy/pose_share.h.
// Ownership:    refers to the link's context.
// Threads:      none inside; one owner.
// Failure:      on_ack() of a malformed acknowledgement is false, and changes nothing.
#pragma once

#include "tunnel/link/core/link_context.h"
#include "tunnel/session/interest_filter.h"

namespace dance {

class LinkInterest {
 public:
  explicit LinkInterest(LinkContext& link) : link_(link) {}

  // A new session, whose hello has told what counts for guests who are not named.
  void begin_session() { request_.begin(link_.options.interest.others); }
  // After guests came or left, or the wish changed.
  void update();
  // What the server has not acknowledged.
  void repeat();
  bool is_acked() const { return request_.is_acked(); }

  bool on_ack(wire::Bytes body);

 private:
  void tell();

  LinkContext& link_;
  InterestRequest request_;
};

}  // namespace dance
