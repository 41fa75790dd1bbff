// Edits of single values of a session's text: a key of [house], or of the third [[produce]].
// Comments, order and all that is not edited stay as they were written.
//
// Units/frames: values are written as TOML has them: toml_text("alice") makes "\"alice\"".
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an error names the file and the place; a table that stands within a line or is
//               spread over dotted keys is refused, with the cure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance {

// Which table: [house], or the index-th [[produce]], from 0.
struct TablePlace {
  std::string table;
  std::optional<std::size_t> index;
};

// In quotes, with signs that TOML wants so written out.
std::string toml_text(std::string_view text);
std::string toml_texts(const std::vector<std::string>& texts);

// Gives the key that value, where it stands; else at the end of the table, which is made where
// there is none ([house] alone: a [[table]] is appended by append_table()).
Result<std::string> set_value(std::string_view text, const TablePlace& place, std::string_view key,
                              std::string_view value, const std::string& name);
// Takes the line of the key away, if there is one.
Result<std::string> remove_value(std::string_view text, const TablePlace& place,
                                 std::string_view key, const std::string& name);

// At the end of the file, as [[table]] with these keys and values.
std::string append_table(std::string_view text, std::string_view table,
                         const std::vector<std::pair<std::string, std::string>>& values);
// With all that stands under its heading, but for the comment above the next one.
Result<std::string> remove_table(std::string_view text, const TablePlace& place,
                                 const std::string& name);

// The texts (not numbers, truths or lists) of every [[table]], or of the one [table].
Result<std::vector<std::map<std::string, std::string>>> texts_of_tables(std::string_view text,
                                                                        std::string_view table,
                                                                        const std::string& name);
// The tables that the text has: "house", "produce", …
Result<std::vector<std::string>> table_names(std::string_view text, const std::string& name);

}  // namespace dance
