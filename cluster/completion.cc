// SPDX-License-Identifier: Apache-2.0
#include "cluster/completion.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/settings/choices.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {
namespace {

struct Format {
  const char* name;
  const char* meaning;
  std::string (*text)(const CLI::App& app);
};
constexpr Format kFormats[] = {
    {"bash", "a completion script for bash", bash_completion},
    {"man", "a manual page", man_page},
};
constexpr const char* kFormatArgument = "FORMAT";

// Every way to say it, "--help" and "-h"; a positional argument's name.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  if (option.get_positional()) names.push_back(option.get_name(true));
  return names;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

bool is_path(const CLI::Option& option) { return option.get_type_name().starts_with(kPathType); }

// The words that there are for an option's value, with spaces between; empty where it is free.
std::string words_for(const CLI::Option& option) {
  const std::string name = names_of(option).front();
  if (name == "--planner" || name == "--planners") {
    return listed(kPlannerPairs, " ", &PlannerPair::name);
  }
  if (name == "--world") return listed(kChoices<WorldKind>, " ", &Choice<WorldKind>::name);
  if (name == kFormatArgument) return listed(kFormats, " ", &Format::name);
  return "";
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands(std::function<bool(const CLI::App*)>());
}

// "--help -h --run"
std::string options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional()) std::ranges::copy(names_of(*option), std::back_inserter(names));
  }
  return listed(names, " ");
}

// What a case of the script sets: the options, and what the value of any of `values` can be.
std::string case_of(const std::string& pattern, const std::string& options,
                    const std::vector<const CLI::Option*>& values) {
  std::string sets;
  if (!options.empty()) sets += fmt::format(" options=\"{}\"", options);
  for (const CLI::Option* value : values) {
    if (is_path(*value)) sets += " paths=yes";
    if (value->get_delimiter() != '\0') sets += " list=yes";
    const std::string words = words_for(*value);
    if (!words.empty()) sets += fmt::format(" words=\"{}\"", words);
  }
  return fmt::format("    {}){} ;;\n", pattern, sets);
}

// The cases of a command: for the value of each option, and otherwise.
std::string cases_of(const CLI::App& command) {
  std::string cases;
  std::vector<const CLI::Option*> arguments;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      arguments.push_back(option);
    } else if (takes_value(*option)) {
      for (const std::string& name : names_of(*option)) {
        cases += case_of(fmt::format("\"{} {}\"", command.get_name(), name), "", {option});
      }
    }
  }
  return cases +
         case_of(fmt::format("\"{} \"*", command.get_name()), options_of(command), arguments);
}

// The text, without anything that has a meaning to roff.
std::string roff(std::string_view text) {
  static const std::map<char, const char*> kNames = {
      {'\\', "\\e"},  {'-', "\\-"},   {'`', "\\(ga"}, {'\'', "\\(aq"},
      {'"', "\\(dq"}, {'~', "\\(ti"}, {'^', "\\(ha"}};
  std::string result;
  for (const char c : text) {
    const auto name = kNames.find(c);
    if (name == kNames.end()) {
      result += c;
    } else {
      result += name->second;
    }
  }
  // A dot at a line's start would be a request.
  return result.starts_with('.') ? "\\&" + result : result;
}

// Its lines, each by itself, with `between` them.
std::string roff_lines(const std::string& text, std::string_view between) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(roff(line));
  return listed(lines, between) + "\n";
}

// An entry for an option or argument.
std::string option_entry(const CLI::Option& option) {
  std::string head = listed(names_of(option), ", ");
  head = (option.nonpositional() ? "\\fB" : "\\fI") + roff(head) + "\\fR";
  if (option.nonpositional() && takes_value(option)) {
    head += " \\fI" + roff(option.get_type_name()) + "\\fR";
  }
  if (option.get_items_expected_max() > 1) head += " ...";
  if (!option.get_default_str().empty()) head += roff(" [" + option.get_default_str() + "]");
  if (option.get_required() && option.nonpositional()) head += " (required)";
  return ".TP\n" + head + "\n" + roff_lines(option.get_description(), "\n.br\n");
}

// All arguments and options of `app`, arguments first, but for those options that it has in common
// with its parent: --help, --version.
std::string option_entries(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  std::string arguments;
  std::string options;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      arguments += option_entry(*option);
    } else if (!parent || !parent->get_option_no_throw(option->get_name())) {
      options += option_entry(*option);
    }
  }
  return arguments + options;
}

// "corridor train [OPTIONS] SCENARIO --run PATH"
std::string usage(const CLI::App& app, const CLI::App& command) {
  std::string text = fmt::format("{} {} [OPTIONS]", app.get_name(), command.get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required()) continue;
    text += " " + names_of(*option).front();
    if (!option->get_positional()) text += " " + option->get_type_name();
    if (option->get_items_expected_max() > 1) text += " ...";
  }
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::vector<const CLI::App*> commands = commands_of(app);
  return fmt::format(R"(# Bash completion for {0} {1}: the output of `{0} completion bash`.
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} begin=""
  local options="" words="" paths="" list=""
  COMPREPLY=()
  # bash takes --option=value apart.
  if [ "$word" = "=" ]; then
    word=""
  elif [ "$before" = "=" ]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  # What can stand here.
  case "${{COMP_WORDS[*]:1:$((COMP_CWORD > 1))}} $before" in
    " "*) options="{2}" words="{3}" ;;
{4}  esac
  # Of a list only what stands behind the last comma.
  if [ -n "$list" ] && [ "$word" != "${{word%,*}}" ]; then
    begin="${{word%,*}},"
  fi
  if [[ $word == -* ]]; then
    words=$options paths=""
  fi
  mapfile -t COMPREPLY < <(compgen -P "$begin" -W "$words" -- "${{word#"$begin"}}")
  if [ -n "$paths" ]; then
    compopt -o filenames 2> /dev/null
    mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -F _{0} {0}
)",
                     app.get_name(), kVersion, options_of(app),
                     listed(commands, " ", &CLI::App::get_name),
                     listed(commands, "", [](const auto* command) { return cases_of(*command); }));
}

std::string man_page(const CLI::App& app) {
  const std::string& name = app.get_name();
  std::string title = name;
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string page =
      fmt::format(".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n", title, name, kVersion);
  page += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(app.get_description()));
  page += fmt::format(".SH SYNOPSIS\n\\fB{}\\fR \\fICOMMAND\\fR [OPTIONS] ...\n", roff(name));
  page += ".SH OPTIONS\n" + option_entries(app);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) {
    page += fmt::format(".SS \"{}\"\n{}.\n", roff(usage(app, *command)),
                        roff(command->get_description()));
    page += option_entries(*command);
    page += ".PP\n.nf\n" + roff_lines(command->get_footer(), "\n") + ".fi\n";
  }
  return page;
}

void declare_completion(CLI::App& command, std::string& format) {
  std::string meaning = "what to print:";
  for (const Format& known : kFormats) {
    meaning += fmt::format("\n{} ({})", known.name, known.meaning);
  }
  std::vector<std::string> names;
  std::ranges::transform(kFormats, std::back_inserter(names), &Format::name);
  command.add_option(kFormatArgument, format, meaning)->required()->check(CLI::IsMember(names));
}

int completion(const CLI::App& app, const std::string& format) {
  const auto known = std::ranges::find(kFormats, format, &Format::name);
  CORRIDOR_CHECK(known != std::end(kFormats), "no format {}", format);
  fmt::print("{}", known->text(app));
  return 0;
}

}  // namespace corridor::cluster
