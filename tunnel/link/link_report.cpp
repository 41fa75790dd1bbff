#include "tunnel/link/link_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace dance {

std::string link_report_json(const Link& link) {
  using nlohmann::ordered_json;
  ordered_json guests = ordered_json::array();
  for (const RemoteGuestStats& guest : link.remote_stats())
    guests.push_back({{"id", std::string(guest.guest.view())},
                      {"here", guest.is_here},
                      {"received", guest.received},
                      {"lost", guest.lost},
                      {"bytes", guest.bytes},
                      {"late", guest.late},
                      {"duplicate", guest.duplicate},
                      {"invalid", guest.invalid},
                      {"reference_missing", guest.reference_missing},
                      {"skeleton_missing", guest.skeleton_missing},
                      {"key_frames_asked", guest.intra_frames_asked},
                      {"voices", guest.voices},
                      {"voice_bytes", guest.voice_bytes}});
  ordered_json own = ordered_json::array();
  for (const LocalGuestStats& guest : link.local_stats())
    own.push_back({{"id", std::string(guest.guest.view())},
                   {"sent", guest.sent},
                   {"acked", guest.acked},
                   {"key_frames_sent", guest.intra_frames_sent},
                   {"references", name_of(guest.references)},
                   {"quality_mm", guest.quality_m * 1e3}});
  const double seconds = std::max(link.uptime().as_seconds(), 1e-3);
  const auto per_second = [&](std::uint64_t n) { return static_cast<double>(n) / seconds; };
  const LinkCounters& c = link.counters();
  const SealClientCounters& seal = link.seal_counters();
  const FileReceiverCounters& taken = link.core().files().received();
  const FileSenderCounters& given = link.core().files().sent();
  const ordered_json files{{"chunks_sent", given.chunks_sent},
                           {"chunks_sent_again", given.chunks_again},
                           {"chunks_taken", taken.chunks_taken},
                           {"chunks_asked_again", taken.chunks_again},
                           {"chunks_foreign", taken.chunks_foreign},
                           {"whole", taken.files_whole},
                           {"wrong", taken.files_wrong},
                           {"refused", taken.files_refused}};
  const ordered_json report{{"offered", c.poses_offered},
                            {"sent", c.poses_sent},
                            {"repeated", c.poses_repeated},
                            {"received", c.poses_received},
                            {"delivered", c.poses_delivered},
                            {"late", c.late},
                            {"invalid", c.invalid},
                            {"reference_missing", c.reference_missing},
                            {"skeleton_missing", c.skeleton_missing},
                            {"key_frames_asked", c.intra_frames_asked},
                            {"key_frames_sent", c.intra_frames_sent},
                            {"unrouted", c.unrouted},
                            {"states_sent", c.states_sent},
                            {"states_delivered", c.states_delivered},
                            {"states_invalid", c.states_invalid},
                            {"states_overruled", c.states_overruled},
                            {"states_refused", c.states_refused},
                            {"channels_sent", c.channels_sent},
                            {"channels_delivered", c.channels_delivered},
                            {"channels_unlisted", c.channels_unlisted},
                            {"channels_invalid", c.channels_invalid},
                            {"channels_limited", c.channels_limited},
                            {"chats_limited", c.chats_limited},
                            {"channels_late", c.channels_late},
                            {"channels_unrouted", c.channels_unrouted},
                            {"channels_overflow", c.channels_overflow},
                            {"voices_sent", c.voices_sent},
                            {"voices_delivered", c.voices_delivered},
                            {"voice_bytes_in", c.voice_bytes_in},
                            {"voice_bytes_out", c.voice_bytes_out},
                            {"voices_limited", c.voices_limited},
                            {"voices_invalid", c.voices_invalid},
                            {"voices_unrouted", c.voices_unrouted},
                            {"overflow", c.overflow},
                            {"foreign_clock", c.foreign_clock},
                            {"stream_restarts", c.stream_restarts},
                            {"datagrams_in", c.datagrams_in},
                            {"datagrams_out", c.datagrams_out},
                            {"datagrams_acked", c.datagrams_acked},
                            {"bytes_in", c.bytes_in},
                            {"bytes_out", c.bytes_out},
                            {"bytes_in_per_s", per_second(c.bytes_in)},
                            {"bytes_out_per_s", per_second(c.bytes_out)},
                            {"path_loss", link.path().loss},
                            {"path_round_trip_us", link.path().round_trip.count_us()},
                            {"rejected_datagrams", c.rejected_datagrams},
                            {"handshakes_begun", seal.tries},
                            {"handshakes_done", seal.sessions},
                            {"forged", seal.forged},
                            {"replayed", seal.replayed},
                            {"hellos", c.hellos},
                            {"lapses", c.lapses},
                            {"reconnects", c.reconnects},
                            {"round_trip_us", link.clock().newest_round_trip().count_us()},
                            {"clock_offset_us", link.clock().offset().count_us()},
                            {"files", files},
                            {"guests", guests},
                            {"own", own}};
  return report.dump();
}

std::string seal_trouble_text(const SealClientCounters& seal) {
  std::string text;
  if (seal.tries != 1 || seal.sessions != 1)
    text += ", " + std::to_string(seal.tries) + " handshakes begun, " +
            std::to_string(seal.sessions) + " done";
  if (seal.forged > 0) text += ", " + std::to_string(seal.forged) + " datagrams forged or damaged";
  if (seal.replayed > 0)
    text += ", " + std::to_string(seal.replayed) + " came twice or far too late";
  return text;
}

}  // namespace dance
