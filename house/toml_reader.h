// TomlReader: takes typed values out of one table of a session file and remembers which keys were
// asked for, so that what is left over (a misspelt key) is an error with its place.
//
// Ownership: refers to the parsed document, which must outlive it.
// Threads:   none inside.
// Failure:   the first thing that is wrong is kept in problem(): "file:line:column: what, cure";
//            later reads then give their defaults.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"

namespace dance {

class TomlReader {
 public:
  // `what` names the table in errors, e.g. "[house]".
  TomlReader(const toml::table& table, std::string file, std::string what);

  std::optional<std::string> maybe_string(std::string_view key);
  std::string string_or(std::string_view key, std::string fallback);
  std::string required_string(std::string_view key);
  double number_or(std::string_view key, double fallback, double low, double high);
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, std::int64_t low,
                          std::int64_t high);
  bool bool_or(std::string_view key, bool fallback);
  // `example` is said where there is something else: a list as it is written.
  std::vector<std::string> strings(std::string_view key, const std::string& example);

  // Complains about the value of a key that was read but makes no sense.
  void complain(std::string_view key, const std::string& what);
  bool has(std::string_view key) const { return table_.contains(key); }
  // Complains about keys that have not been read.
  void finish();
  const std::optional<Error>& problem() const { return problem_; }

 private:
  const toml::node* take(std::string_view key);
  std::string place(const toml::source_region& source) const;
  void complain_at(const toml::source_region& source, const std::string& what);

  const toml::table& table_;
  std::string file_;
  std::string what_;
  std::vector<std::string> asked_;
  std::optional<Error> problem_;
};

// A guest's name; not set where the text, which was read for this key, is none.
GuestId read_guest(TomlReader& reader, std::string_view key, const std::string& text);

}  // namespace dance
