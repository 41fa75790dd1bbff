#include "tunnel/wire/wire_removal.h"

namespace dance::wire {
namespace {

constexpr std::uint8_t kMayRemove = 1;

void begin_removal(Type type, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(type));
  out.u8(kRemovalForm);
}

}  // namespace

std::size_t build(const RemovalRequest& request, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_removal(Type::kRemoval, out);
  out.u32(request.number);
  out.short_text(request.guest.view());
  return out.ok() ? out.size() : 0;
}

std::optional<RemovalRequest> parse_removal_request(Bytes body) {
  ByteReader in(body);
  const std::uint8_t form = in.u8();
  RemovalRequest request;
  request.number = in.u32();
  const auto guest = GuestId::parse(in.text(in.u8()));
  if (!in.is_exhausted() || form != kRemovalForm || request.number == 0 || !guest)
    return std::nullopt;
  request.guest = *guest;
  return request;
}

std::size_t build(const RemovalAnswer& answer, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_removal(Type::kRemovalAnswer, out);
  out.u32(answer.number);
  out.u8(static_cast<std::uint8_t>(answer.result));
  return out.ok() ? out.size() : 0;
}

std::optional<RemovalAnswer> parse_removal_answer(Bytes body) {
  ByteReader in(body);
  const std::uint8_t form = in.u8();
  RemovalAnswer answer;
  answer.number = in.u32();
  const std::uint8_t result = in.u8();
  answer.result = static_cast<RemovalResult>(result);
  if (!in.is_exhausted() || form != kRemovalForm || answer.number == 0 ||
      answer.result < RemovalResult::kDone || answer.result > RemovalResult::kTooMany)
    return std::nullopt;
  return answer;
}

std::size_t build(const Rights& rights, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_removal(Type::kRights, out);
  out.u8(rights.may_remove ? kMayRemove : 0);
  return out.ok() ? out.size() : 0;
}

std::optional<Rights> parse_rights(Bytes body) {
  ByteReader in(body);
  const std::uint8_t form = in.u8();
  const std::uint8_t flags = in.u8();
  if (!in.is_exhausted() || form != kRemovalForm || (flags & ~kMayRemove) != 0) return std::nullopt;
  return Rights{(flags & kMayRemove) != 0};
}

}  // namespace dance::wire
