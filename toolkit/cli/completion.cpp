#include "toolkit/cli/manual.h"

#include <nlohmann/json.hpp>

#include "toolkit/cli/command.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/text.h"

namespace mimetra::cli {

namespace {

std::string replaced(const std::string& text, char old, const std::string& by) {
  std::string result;
  for (const char c : text) result += c == old ? by : std::string(1, c);
  return result;
}

/// Puts `text` in single quotes. A quote in the text ends them for a moment.
std::string in_quotes(const std::string& text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

/// Puts `text` in quotes for fish, where a backslash escapes inside quotes.
std::string in_fish_quotes(const std::string& text) {
  return "'" + replaced(replaced(text, '\\', "\\\\"), '\'', "\\'") + "'";
}

std::string all_forms(const Command& command) {
  std::vector<std::string> forms;
  for (const CommandOption& option : command.options) {
    forms.insert(forms.end(), option.forms.begin(), option.forms.end());
  }
  forms.push_back("--help");
  return joined(forms, " ");
}

/// Argument of zsh's _arguments: '(-o --out)'{-o,--out}'[help]:value:_files'.
std::string zsh_argument(const CommandOption& option) {
  std::string help;
  for (const char c : option.help) {
    if (c == '[' || c == ']' || c == ':') help += '\\';
    help += c;
  }
  std::string line;
  if (option.forms.size() > 1) {
    line = in_quotes("(" + joined(option.forms, " ") + ")") + "{" + joined(option.forms, ",") + "}";
  } else {
    line = option.forms.front();
  }
  std::string rest = "[" + help + "]";
  if (!option.is_flag()) {
    rest += ":" + option.value + ":";
    if (option.takes_file && !option.choices.empty()) {
      rest +=
          "{_alternative \"word:word:(" + joined(option.choices, " ") + ")\" \"file:file:_files\"}";
    } else if (!option.endings.empty()) {
      rest += "_files -g \"*(" + joined(option.endings, "|") + ")\"";
    } else if (option.takes_file) {
      rest += "_files";
    } else if (!option.choices.empty()) {
      rest += "(" + joined(option.choices, " ") + ")";
    }
  }
  return line + in_quotes(rest);
}

/// Kinds of files that a value may be: "no", "yes", or the endings of their names.
std::string bash_files(const CommandOption& option) {
  if (!option.takes_file) return "no";
  return option.endings.empty() ? "yes" : joined(option.endings, " ");
}

std::string bash_completion(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  std::string options, values;
  for (const Command& command : commands) {
    const std::string& name = command.operation->name;
    names.push_back(name);
    options += "    " + name + ") words='" + all_forms(command) + "' ;;\n";
    for (const CommandOption& option : command.options) {
      if (option.is_flag()) continue;
      for (const std::string& form : option.forms) {
        // The space is escaped because patterns of `case` are words.
        values += "    " + name + "\\ " + form + ") words='" + joined(option.choices, " ") +
                  "'; files='" + bash_files(option) + "' ;;\n";
      }
    }
  }
  return "# Completion of mimetra for bash.\n"
         "_mimetra() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local words='' files=no\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         joined(names, " ") +
         " --help --version' -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case \"${COMP_WORDS[1]} $previous\" in\n" +
         values +
         "    *) files=any ;;\n"
         "  esac\n"
         "  if [ \"$files\" = any ]; then\n"
         "    case \"$current\" in -*)\n"
         "    files=no\n"
         "    case \"${COMP_WORDS[1]}\" in\n" +
         options +
         "    esac ;;\n"
         "    esac\n"
         "  fi\n"
         "  local -a endings=($files)\n"
         "  local ending IFS=$'\\n'\n"
         "  COMPREPLY=($(compgen -W \"${words// /$IFS}\" -- \"$current\"))\n"
         "  case \"$files\" in\n"
         "    no) return ;;\n"
         "    yes | any) COMPREPLY+=($(compgen -f -- \"$current\")) ;;\n"
         "    *)\n"
         "      for ending in \"${endings[@]}\"; do\n"
         "        COMPREPLY+=($(compgen -f -X \"!*$ending\" -- \"$current\"))\n"
         "      done\n"
         "      COMPREPLY+=($(compgen -d -- \"$current\")) ;;\n"
         "  esac\n"
         "  compopt -o filenames 2>/dev/null\n"
         "}\n"
         "complete -F _mimetra mimetra\n";
}

std::string zsh_completion(const std::vector<Command>& commands) {
  std::string list, cases;
  for (const Command& command : commands) {
    const std::string& name = command.operation->name;
    list += "    " + in_quotes(name + ":" + command.operation->summary) + "\n";
    cases += "    " + name + ")\n      _arguments \\\n";
    for (const CommandOption& option : command.options) {
      cases += "        " + zsh_argument(option) + " \\\n";
    }
    cases += "        --help'[show help]'";
    if (!command.positionals.empty()) cases += " \\\n        '*:input:_files'";
    cases += " ;;\n";
  }
  return "#compdef mimetra\n"
         "# Completion of mimetra for zsh.\n"
         "_mimetra() {\n"
         "  local -a commands=(\n" +
         list +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n"
         "    _describe 'command' commands\n"
         "    return\n"
         "  fi\n"
         "  local command=$words[2]\n"
         "  shift words; (( CURRENT-- ))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_mimetra \"$@\"\n";
}

std::string fish_files(const CommandOption& option) {
  if (!option.takes_file) return " -x";
  if (option.endings.empty()) return " -r -F";
  // Passes one ending per call, because further arguments mean different things in versions of
  // fish.
  return " -x -a '(__fish_complete_suffix " + joined(option.endings, "; __fish_complete_suffix ") +
         ")'";
}

std::string fish_completion(const std::vector<Command>& commands) {
  std::string text = "# Completion of mimetra for fish.\n";
  for (const Command& command : commands) {
    text += "complete -c mimetra -f -n __fish_use_subcommand -a " + command.operation->name +
            " -d " + in_fish_quotes(command.operation->summary) + "\n";
  }
  for (const Command& command : commands) {
    const std::string start =
        "complete -c mimetra -n '__fish_seen_subcommand_from " + command.operation->name + "'";
    for (const CommandOption& option : command.options) {
      text += start;
      for (const std::string& form : option.forms) {
        text += form.starts_with("--") ? " -l " + form.substr(2) : " -s " + form.substr(1);
      }
      if (!option.is_flag()) text += fish_files(option);
      if (!option.choices.empty()) text += " -a " + in_fish_quotes(joined(option.choices, " "));
      text += " -d " + in_fish_quotes(option.help) + "\n";
    }
  }
  return text;
}

enum class Shell { bash, zsh, fish };

constexpr std::string_view choice_name(Shell value) {
  switch (value) {
    case Shell::bash:
      return "bash";
    case Shell::zsh:
      return "zsh";
    case Shell::fish:
      return "fish";
  }
  return {};
}

std::string script_for(Shell shell, const std::vector<Command>& commands) {
  switch (shell) {
    case Shell::bash:
      return bash_completion(commands);
    case Shell::zsh:
      return zsh_completion(commands);
    case Shell::fish:
      return fish_completion(commands);
  }
  return {};
}

Operation completion_operation(const OperationTable& table) {
  Operation operation;
  operation.name = "completion";
  operation.summary = "Print a script that completes this command in a shell";
  operation.parameters = {choice_parameter("shell", Shell::bash, "shell")};
  operation.examples = {"completion --shell bash > /etc/bash_completion.d/mimetra",
                        "completion --shell fish > ~/.config/fish/completions/mimetra.fish"};
  operation.run = [&table](const Invocation& invocation) {
    const std::vector<Command> commands = commands_of(table);
    const std::string script = script_for(invocation.parameters.choice<Shell>("shell"), commands);
    return Outcome{{}, json_text(Json{{"script", script}}), script};
  };
  return operation;
}

}  // namespace

void add_completion(OperationTable& table) {
  table.add(completion_operation(table));
}

}  // namespace mimetra::cli
