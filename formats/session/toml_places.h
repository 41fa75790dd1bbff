// Finds places in a session's text for its reader and its edits. For formats/session and
// house/session.cpp alone: includes toml++.
//
// Units/frames: offsets in bytes; toml++ counts lines and columns from 1, columns in characters.
// Ownership:    plain values.
// Threads:      any.
// Failure:      with_toml() names file, line and column of what is no TOML.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

std::size_t line_begin(std::string_view text, toml::source_index line);
std::size_t offset_of(std::string_view text, const toml::source_position& place);
// The place-th [[key]], from 0; nullptr where there is none.
const toml::table* table_of(const toml::table& document, std::string_view key, std::size_t place);
Error error_at(const std::string& name, const toml::source_region& source, const std::string& what);

// Replaces toml++'s text, which describes its own grammar, by place and cure.
Error syntax_error(const std::string& name, std::string_view text, const toml::parse_error& error);

template <class Use>
auto with_toml(std::string_view text, const std::string& name, Use use)
    -> decltype(use(std::declval<const toml::table&>())) {
  // toml++ as Debian builds it reports by exception; it ends here.
  try {
    return use(toml::parse(text, std::string_view(name)));
  } catch (const toml::parse_error& error) {
    return tl::make_unexpected(syntax_error(name, text, error));
  }
}

}  // namespace dance
