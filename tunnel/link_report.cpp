#include "tunnel/link_report.h"

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
                      {"late", guest.late},
                      {"duplicate", guest.duplicate},
                      {"invalid", guest.invalid}});
  const LinkCounters& c = link.counters();
  const ordered_json report{{"offered", c.poses_offered},
                            {"sent", c.poses_sent},
                            {"received", c.poses_received},
                            {"delivered", c.poses_delivered},
                            {"late", c.late},
                            {"invalid", c.invalid},
                            {"unrouted", c.unrouted},
                            {"overflow", c.overflow},
                            {"foreign_clock", c.foreign_clock},
                            {"stream_restarts", c.stream_restarts},
                            {"datagrams_in", c.datagrams_in},
                            {"datagrams_out", c.datagrams_out},
                            {"rejected_datagrams", c.rejected_datagrams},
                            {"hellos", c.hellos},
                            {"lapses", c.lapses},
                            {"reconnects", c.reconnects},
                            {"round_trip_us", link.clock().newest_round_trip().count_us()},
                            {"clock_offset_us", link.clock().offset().count_us()},
                            {"guests", guests}};
  return report.dump();
}

}  // namespace dance
