#include "tunnel/session/record_bundler.h"

#include "core/base/assert.h"

namespace dance {

bool is_narrow_for(const HeldFrames& frames, const wire::Record& record) {
  return record.kind == wire::RecordKind::kPose && frames.is_of(record.stream) &&
         static_cast<std::uint16_t>(record.sequence - frames.newest()) <= wire::kNarrowReach;
}

void RecordBundler::add(const wire::Record& record, bool is_narrow, std::int64_t near_us,
                        MonoTime due) {
  if (is_empty()) {
    chain_ = {near_us};
    due_ = due;
    poses_ = 0;
  }
  ByteWriter out(std::span<std::uint8_t>(bytes_).subspan(size_));
  wire::add_record(record, is_narrow, chain_, out);
  DANCE_ASSERT(out.ok());
  size_ += out.size();
}

wire::Bytes RecordBundler::write(const wire::RecordsHeader& header,
                                 std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  wire::begin_records(header, out);
  if (header.has_records) {
    out.bytes(std::span<const std::uint8_t>(bytes_).first(size_));
    clear();
  }
  DANCE_ASSERT(out.ok());
  return out.written();
}

}  // namespace dance
