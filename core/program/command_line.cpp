#include "core/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/base/plain_number.h"
#include "core/base/text/guest_id_hint.h"

namespace dance {

namespace {

// CLI11 names the option and the text in its messages; the cure is ours.
std::string error_text(const CLI::ParseError& error) {
  const std::string text = error.what();
  const auto behind = [&](std::string_view separator) {
    const std::size_t at = text.find(separator);
    return at == text.npos ? text : text.substr(at + separator.size());
  };
  if (dynamic_cast<const CLI::ExtrasError*>(&error))
    return fmt::format("it takes no '{}'", behind(": "));
  if (dynamic_cast<const CLI::ConversionError*>(&error))
    return fmt::format("{}: this is no number that fits", behind(": "));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && text.ends_with(" missing"))
    return fmt::format("{} needs a value behind it", text.substr(0, text.find(':')));
  return text;
}

CLI::Validator one_of_words(std::vector<std::string> words) {
  const std::string list = fmt::format("{{{}}}", fmt::join(words, ","));
  return CLI::Validator(
      [words = std::move(words)](const std::string& text) -> std::string {
        if (std::ranges::find(words, text) != words.end()) return "";
        std::string known;
        for (std::size_t i = 0; i < words.size(); ++i)
          known += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
        return fmt::format("'{}' is not {}", text, known);
      },
      list);
}

}  // namespace

Option& Option::range(double lowest, double highest) {
  const std::string span = plain_number(lowest) + " to " + plain_number(highest);
  option_->check(CLI::Validator(
      [=](const std::string& text) -> std::string {
        double value = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, value);
        if (is_number && value >= lowest && value <= highest) return "";
        return fmt::format("'{}' is not {}", text, span);
      },
      span));
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  option_->check(one_of_words(std::move(words)));
  return *this;
}

Option& Option::one_each_time() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::check(std::function<std::string(const std::string& text)> wrong) {
  option_->check(std::move(wrong));
  return *this;
}

Option& Option::guest_name() {
  return check(
      [](const std::string& name) { return GuestId::parse(name) ? "" : guest_id_error(name); });
}

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::shows_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::split_at(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::hidden() {
  option_->group("");
  return *this;
}

CommandLine::CommandLine(const std::string& purpose, const std::string& name)
    : app_(std::make_unique<CLI::App>(purpose, name)) {
  app_->set_help_flag("-h,--help", "print this and exit");
}

CommandLine::~CommandLine() = default;

template <class T>
Option CommandLine::add(const std::string& name, T& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
template Option CommandLine::add(const std::string&, std::string&, const std::string&);
template Option CommandLine::add(const std::string&, double&, const std::string&);
template Option CommandLine::add(const std::string&, int&, const std::string&);
template Option CommandLine::add(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::add(const std::string&, std::uint16_t&, const std::string&);
template Option CommandLine::add(const std::string&, std::uint32_t&, const std::string&);
template Option CommandLine::add(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::add(const std::string&, std::vector<double>&, const std::string&);

Option CommandLine::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

Option CommandLine::add_words(const std::string& name, std::vector<std::string> words,
                              std::function<void(std::size_t)> chosen, const std::string& help) {
  const auto choose = [words, chosen = std::move(chosen)](const std::string& word) {
    chosen(static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin()));
  };
  return Option(
      app_->add_option_function<std::string>(name, choose, help)->check(one_of_words(words)));
}

void CommandLine::footer(const std::string& text) { app_->footer(text); }

void CommandLine::finally(std::function<Result<void>()> look) { look_ = std::move(look); }

std::string CommandLine::name() const { return app_->get_name(); }

CommandLine::Parsed CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success&) {  // --help
    text_ = app_->help();
    return Parsed::kHelp;
  } catch (const CLI::ParseError& error) {
    text_ = error_text(error);
    return Parsed::kWrong;
  }
  if (!look_) return Parsed::kRun;
  if (const auto seen = look_(); !seen) {
    text_ = seen.error().what;
    return Parsed::kWrong;
  }
  return Parsed::kRun;
}

}  // namespace dance
