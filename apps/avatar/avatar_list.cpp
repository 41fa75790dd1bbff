#include "apps/avatar/avatar_list.h"

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/bus_program.h"
#include "core/program/program.h"
#include "formats/body/look_names.h"
#include "house/avatar_choice.h"

namespace dance {
namespace {

constexpr const char* kListExamples = R"(Examples:
  dance avatar list                          those that ship, those kept, and who dances here
  dance avatar list --seconds 0              without listening to the bus
)";

struct ListOptions {
  std::string bus_url;
  double seconds = 1.5;
  bool json = false;
};

struct Guests {
  std::map<GuestId, Avatar> avatars;
  std::map<GuestId, AvatarFile> files;
};

Result<Guests> listen_to_guests(const ListOptions& options) {
  Guests guests;
  if (options.seconds <= 0.0) return guests;
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  for (const Where where : {Where::kCapture, Where::kGuest}) {
    program.bus().subscribe<Avatar>({where, GuestId()},
                                    [&](const Channel& channel, const Avatar& avatar, MonoTime) {
                                      guests.avatars.insert_or_assign(channel.guest(), avatar);
                                    });
    program.bus().subscribe<AvatarFile>(
        {where, GuestId()}, [&](const Channel& channel, const AvatarFile& file, MonoTime) {
          guests.files.insert_or_assign(channel.guest(), file);
        });
  }
  program.stop_after(options.seconds);
  program.run();
  return guests;
}

std::vector<std::string> users_of(const Guests& guests, const FileHash& hash) {
  std::vector<std::string> names;
  for (const auto& [guest, file] : guests.files)
    if (file.hash == hash) names.emplace_back(guest.view());
  return names;
}

std::vector<std::string> users_of(const Guests& guests, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [guest, avatar] : guests.avatars) {
    const auto file = guests.files.find(guest);
    const bool has_file = file != guests.files.end() && file->second.hash.is_set();
    if (avatar.name.view() == name && !has_file) names.emplace_back(guest.view());
  }
  return names;
}

std::string called(const Guests& guests, const FileHash& hash) {
  for (const auto& [guest, file] : guests.files)
    if (file.hash == hash) return std::string(file.name.view());
  return "";
}

// One row: kind, what it is called, size, who.
nlohmann::ordered_json avatar_rows(const Guests& guests, const std::string& shipped_folder) {
  auto all = nlohmann::ordered_json::array();
  std::error_code error;
  for (const std::string& name : shipped_avatars(shipped_folder)) {
    const std::string path = shipped_folder + "/" + name + ".vrm";
    all.push_back({{"kind", "shipped"},
                   {"name", name},
                   {"bytes", std::filesystem::file_size(path, error)},
                   {"path", path},
                   {"guests", users_of(guests, name)}});
  }
  for (const StoredAvatar& it : AvatarStore::of_user().list())
    all.push_back({{"kind", it.is_own ? "own" : "fetched"},
                   {"name", called(guests, it.hash)},
                   {"bytes", it.size_bytes},
                   {"sha256", hex_of(it.hash)},
                   {"path", it.path},
                   {"guests", users_of(guests, it.hash)}});
  for (const auto& [guest, avatar] : guests.avatars) {
    const auto file = guests.files.find(guest);
    const bool has_file = file != guests.files.end() && file->second.hash.is_set();
    if (has_file || (avatar.name.is_set() && !is_look_name(avatar.name.view()))) continue;
    all.push_back({{"kind", "mannequin"},
                   {"name", avatar.name.is_set() ? avatar.name.view() : kMannequinName},
                   {"guests", {guest.view()}}});
  }
  return all;
}

void print_rows(const nlohmann::ordered_json& all) {
  std::printf("%-10s %-24s %9s  %-12s  %s\n", "kind", "name", "MB", "sha256", "guests");
  for (const auto& row : all) {
    std::string guests;
    for (const auto& guest : row["guests"])
      guests += (guests.empty() ? "" : " ") + guest.get<std::string>();
    const std::string size =
        row.contains("bytes") ? std::to_string(row["bytes"].get<double>() / 1e6).substr(0, 5) : "";
    std::printf("%-10s %-24s %9s  %-12s  %s\n", row["kind"].get<std::string>().c_str(),
                row["name"].get<std::string>().c_str(), size.c_str(),
                row.value("sha256", "").substr(0, 12).c_str(), guests.c_str());
  }
  std::printf("mannequin, with words of a look joined by '-': %s\n", look_names().c_str());
}

Result<void> list_avatars(const ListOptions& options) {
  DANCE_TRY(const Guests guests, listen_to_guests(options));
  const auto all = avatar_rows(guests, data_folder() + "/avatars");
  if (options.json)
    std::printf("%s\n", all.dump(2).c_str());
  else
    print_rows(all);
  return {};
}

}  // namespace

int avatar_list_main(int argc, char** argv) {
  ListOptions options;
  CommandLine line("Lists the avatars on this machine and who dances with them.",
                   "dance avatar list");
  line.add("--bus", options.bus_url, "LCM URL of the house's bus");
  line.add("--seconds", options.seconds, "how long to listen for guests; 0 = not")
      .range(0.0, 3600.0)
      .shows_default();
  line.add_flag("--json", options.json, "as JSON");
  line.footer(kListExamples);
  return run_program(line, argc, argv, [&] { return list_avatars(options); });
}

}  // namespace dance
