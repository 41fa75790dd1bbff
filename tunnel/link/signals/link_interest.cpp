#include "tunnel/link/signals/link_interest.h"

#include <array>

namespace dance {

void LinkInterest::update() {
  const wire::InterestList list =
      link_.remotes.interest_list(link_.options.interest, link_.options.hearing);
  if (request_.change(list) && link_.is_connected()) tell();
}

void LinkInterest::repeat() {
  if (!request_.is_acked()) tell();
}

bool LinkInterest::on_ack(wire::Bytes body) {
  const auto version = wire::parse_interest_ack(body);
  if (version) request_.take_ack(*version);
  return version.has_value();
}

void LinkInterest::tell() {
  std::array<std::uint8_t, wire::kMaxPlain> out;
  link_.send({out.data(), wire::build(request_.list(), out)});
}

}  // namespace dance
