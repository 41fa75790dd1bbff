// How ServerAdmission refuses a link.
#include <algorithm>

#include "tunnel/server/server_admission.h"

namespace dance {

void ServerAdmission::refuse(PeerId to, const GuestId& key, const wire::RoomName& room,
                             std::uint64_t nonce, wire::Refusal cause, const GuestId& guest) {
  audit_refusal(to, key, room, cause);
  server_.reject(cause == wire::Refusal::kVersion ? ServerReject::kVersion
                                                  : ServerReject::kRefused);
  wire::RefusalNotice notice;
  notice.nonce = nonce;
  notice.cause = cause;
  notice.guest = guest;
  std::array<std::uint8_t, 64> out;
  server_.send(to, {out.data(), wire::build(notice, out)});
}

void ServerAdmission::audit_refusal(PeerId to, const GuestId& key, const wire::RoomName& room,
                                    wire::Refusal cause) {
  server_.audit(to, {.kind = AuditKind::kRefused,
                     .key = key.view(),
                     .room = room,
                     .cause = kRefusalNames[static_cast<std::size_t>(cause)]});
}

void ServerAdmission::send_removal_notice(PeerId to, std::uint64_t nonce, Duration for_how_long) {
  if (nonce != 0) server_.reject(ServerReject::kRefused);
  wire::RefusalNotice notice;
  notice.nonce = nonce;
  notice.cause = wire::Refusal::kRemoved;
  notice.seconds = static_cast<std::uint16_t>(
      std::clamp<std::int64_t>((for_how_long.count_ms() + 999) / 1000, 1, wire::kMostRemoved_s));
  std::array<std::uint8_t, 64> out;
  server_.send(to, {out.data(), wire::build(notice, out)});
}

}  // namespace dance
