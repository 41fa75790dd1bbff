// dance key: the identity of this house, and the servers that let it in.

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "apps/key/secret_prompt.h"
#include "core/net/address.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "tunnel/invitation/open_invitation.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance key                            asks for the line that the server's operator gave you:
                                       a key, or an invitation, which it opens
  dance key < line.txt                 takes it from a file
  dance key --list                     which servers let you in, and as whom
  dance key --public                   prints this house's public key, for the operator of a server
  dance key --trust dance.example.org=A7…
                                       trusts a new key of a server, which its operator confirmed
  dance key --remove alice@dance.example.org:7400
)";

struct KeyOptions {
  std::string file;
  std::string server;
  std::string remove;
  std::string trust;  // SERVER=KEY
  bool list = false;
  bool shows_public = false;
};

Result<std::string> asked_line() {
  std::string line;
  {
    const SecretPrompt prompt;  // before the prompt is printed, so that pasting at once works
    if (isatty(STDIN_FILENO)) talk::info("paste the line that you were given (it is not shown):");
    std::getline(std::cin, line);
  }
  if (line.empty()) return fail("nothing was pasted; the keys are as they were");
  return line;
}

// The key is then where this program keeps keys.
Result<void> open_pasted(const std::string& line) {
  DANCE_TRY(const Invitation invitation, parse_invitation(line));
  if (auto opened = open_invitation(invitation); !opened)
    return tl::make_unexpected(opened.error());
  const bool dances = invitation.role != KeyKind::kListener;
  talk::info("the invitation is opened; now: dance join {}{}{}", invitation.server(),
             dances ? " --guest " + std::string(invitation.guest.view()) : "",
             invitation.room.is_set() ? " --room " + std::string(invitation.room.view()) : "");
  return {};
}

Result<void> trust_server(const std::string& given, const std::string& path) {
  const auto mark = given.find('=');
  const auto key =
      mark == std::string::npos ? std::nullopt : PublicKey::parse(given.substr(mark + 1));
  if (!key || !key->is_on_curve())
    return fail(
        "--trust takes SERVER=KEY, with the 44 characters that the server's operator reads in "
        "dance server --list-keys");
  const std::string server = given.substr(0, mark);
  DANCE_TRY(const FileLock lock, FileLock::of_folder(path));
  DANCE_TRY(const auto text, read_secret(path));
  HouseKeys keys;
  if (text) {
    DANCE_TRY(keys, HouseKeys::parse(*text, path));
  }
  const auto changed = keys.trust(server, *key);
  if (changed.empty())
    return fail("no key in " + path + " for the server '" + server +
                "' has another server key; --list prints the servers that there are");
  if (auto written = write_secret(path, keys.text()); !written) return written;
  for (const std::string& title : changed) talk::info("{} trusts the new key of its server", title);
  return {};
}

Result<void> run_key(const KeyOptions& options) {
  if (options.shows_public) {
    DANCE_TRY(const PrivateKey house, house_identity());
    std::printf("%s\n", house.public_key().text().c_str());
    return {};
  }
  std::string path = options.file;
  if (path.empty()) {
    DANCE_TRY(const std::string folder, key_folder());
    path = folder + "/keys";
  }
  if (!options.trust.empty()) return trust_server(options.trust, path);
  DANCE_TRY(const auto text, read_secret(path));
  HouseKeys keys;
  if (text) {
    DANCE_TRY(keys, HouseKeys::parse(*text, path));
  }
  if (options.list) {
    for (const HouseKey& key : keys.keys()) std::printf("%s\n", key.title().c_str());
    if (keys.keys().empty()) talk::info("no keys in {} yet", path);
    return {};
  }
  if (!options.remove.empty()) {
    if (!keys.remove(options.remove))
      return fail("there is no key '" + options.remove + "' in " + path +
                  "; --list says which there are");
    return write_secret(path, keys.text());
  }
  DANCE_TRY(const std::string line, asked_line());
  if (is_invitation(line)) {
    if (!options.file.empty() || !options.server.empty())
      return fail(
          "an invitation says its server, and its key is kept with the others: leave out "
          "--file and --server");
    return open_pasted(line);
  }
  DANCE_TRY(HouseKey key, HouseKey::parse(line));
  if (!options.server.empty()) {
    key.server = server_name_of(options.server, 0);
    if (!HouseKey::parse(key.line()))
      return fail("--server '" + options.server + "' is no HOST or HOST:PORT");
  }
  // What another program of this user has kept meanwhile stays.
  DANCE_TRY(const FileLock lock, FileLock::of_folder(path));
  DANCE_TRY(const auto text_now, read_secret(path));
  if (text_now) {
    DANCE_TRY(keys, HouseKeys::parse(*text_now, path));
  }
  if (const HouseKey* known = keys.find_other(key.server, key.server_key))
    return fail("the line names another key of " + key.server +
                " than the one that this house has saved (" + known->server_key.text() +
                "). If its operator confirms the new one, run: dance key " + "--trust " +
                key.server + "=" + key.server_key.text() + ", and paste the line again");
  keys.put(key);
  if (auto written = write_secret(path, keys.text()); !written) return written;
  const std::string room = key.room.is_set() ? " --room " + std::string(key.room.view()) : "";
  // A room's key is shared: each guest chooses a name.
  const std::string guest = key.room == key.name ? "YOUR-NAME" : std::string(key.name.view());
  talk::info("kept in {}; now: dance join {} --guest {}{}", path,
             key.server.empty() ? "HOST" : key.server, guest, room);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::KeyOptions options;
  dance::CommandLine line("Keeps the keys that servers have given to this house.", "dance key");
  line.add("--server", options.server, "HOST[:PORT] of the server, where the line does not say it");
  line.add_flag("--list", options.list, "whose keys there are, without the keys");
  line.add("--remove", options.remove, "takes one away, named as --list does");
  line.add("--trust", options.trust,
           "SERVER=KEY: trusts another key of a server, after its operator confirmed it");
  line.add_flag("--public", options.shows_public,
                "prints this house's public key, which is no secret");
  line.add("--file", options.file,
           "where keys are kept (else in the folder of the user's settings)");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_key(options); });
}
