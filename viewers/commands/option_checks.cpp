#include "viewers/commands/option_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

#include "linespace/nearest_name.h"

namespace sightline::viewers {
namespace {

/// The whole text as a number; nullopt for anything else, a sign alone or blanks too.
template <typename Number>
std::optional<Number> number_of(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Refuses with "'VALUE' is not WHAT".
CLI::Validator check(const std::string& what,
                     std::function<bool(const std::string&)> accepts) {
  CLI::Validator validator;
  validator.description("");
  validator.operation([what, accepts = std::move(accepts)](std::string& value) {
    return accepts(value) ? std::string() : fmt::format("'{}' is not {}", value, what);
  });
  return validator;
}

std::string up_to(double most) {
  return most < std::numeric_limits<double>::max() ? fmt::format(", at most {:g}", most)
                                                   : "";
}

CLI::Validator finite(const std::string& what, std::function<bool(double)> accepts) {
  return check(what, [accepts = std::move(accepts)](const std::string& value) {
    const std::optional<double> x = number_of<double>(value);
    return x && std::isfinite(*x) && accepts(*x);
  });
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back(fmt::format("--{}", name));
    for (const std::string& name : option->get_snames())
      names.push_back(fmt::format("-{}", name));
  }
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
  }
  return names;
}

/// Of arguments that the command does not have.
std::string told_extras(const CLI::App& command, const std::vector<std::string>& extras) {
  const auto option = std::ranges::find_if(extras, [](const std::string& argument) {
    return argument.size() > 1 && argument[0] == '-';
  });
  if (option == extras.end()) {
    return fmt::format("unexpected '{}' (see sightline {} --help)", extras.front(),
                       command.get_name());
  }
  const std::string name = option->substr(0, option->find('='));
  return fmt::format("no option {}{} (see sightline {} --help)", name,
                     did_you_mean(name, names_of(command)), command.get_name());
}

}  // namespace

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::optional<double> x = number_of<double>(text.substr(at, end - at));
    if (!x || !std::isfinite(*x)) return {};
    numbers.push_back(*x);
    at = end + 1;
  }
  return numbers;
}

CLI::Validator number_above_zero(double most) {
  return finite("a number above 0" + up_to(most),
                [most](double x) { return x > 0 && x <= most; });
}

CLI::Validator number_from_zero(double most) {
  return finite("0 or a number above 0" + up_to(most),
                [most](double x) { return x >= 0 && x <= most; });
}

CLI::Validator finite_number() {
  return finite("a finite number", [](double) { return true; });
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const std::string what = fmt::format("a whole number from {} to {}", least, most);
  return check(what, [least, most](const std::string& value) {
    const std::optional<std::uint64_t> n = number_of<std::uint64_t>(value);
    return n && *n >= least && *n <= most;
  });
}

CLI::Validator one_of(std::vector<std::string> words) {
  CLI::Validator validator;
  validator.description("");
  validator.operation([words = std::move(words)](std::string& value) -> std::string {
    if (std::ranges::find(words, value) != words.end()) return {};
    return fmt::format("'{}' is none of {}{}", value, fmt::join(words, ", "),
                       did_you_mean(value, words));
  });
  return validator;
}

std::string told(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::vector<std::string> extras = app.remaining(true);
  const bool no_command = chosen.empty() && !extras.empty() && extras[0][0] != '-';
  if (no_command) {
    const std::vector<std::string> names = commands_of(app);
    const std::optional<std::string> near = nearest_name(extras[0], names);
    return near ? fmt::format("no command '{}'; did you mean '{}'?", extras[0], *near)
                : fmt::format("no command '{}'; there are {}", extras[0],
                              fmt::join(names, ", "));
  }
  if (!extras.empty()) return told_extras(command, extras);
  if (chosen.empty()) {
    return fmt::format("name a command: {} (see sightline --help)",
                       fmt::join(commands_of(app), ", "));
  }
  return fmt::format("{} (see sightline {} --help)", error.what(), command.get_name());
}

}  // namespace sightline::viewers
