#include "core/program/command_line.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/base/plain_number.h"

namespace dance {

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
  option_->check(CLI::IsMember(std::move(words)));
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
  return check([](const std::string& name) {
    return GuestId::parse(name) ? "" : "'" + name + "': " + kGuestIdRule;
  });
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
      app_->add_option_function<std::string>(name, choose, help)->check(CLI::IsMember(words)));
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
    text_ = error.what();
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
