#include "plugins/meshlab/dialog.h"

#include <algorithm>

#include <QProcess>

#include "plugins/meshlab/toolkit.h"

namespace mimetra_meshlab {

namespace {

constexpr char kFurtherOptions[] = "options";

/// Parameters of the operation itself and of reading files.
std::vector<const mimetra_parameter*> parameters_of(const mimetra_operation& operation) {
  std::vector<const mimetra_parameter*> parameters;
  for (auto parameter = operation.parameters; *parameter; ++parameter) {
    if ((*parameter)->of_files != MIMETRA_WRITING) parameters.push_back(*parameter);
  }
  return parameters;
}

const mimetra_parameter* find_parameter(const mimetra_operation& operation,
                                        const std::string& name) {
  for (const mimetra_parameter* parameter : parameters_of(operation)) {
    if (parameter->name == name) return parameter;
  }
  return nullptr;
}

/// Optional inputs or outputs, except documents, which show files that are not written here.
std::vector<std::string> optional_ports(const mimetra_port* const* ports) {
  std::vector<std::string> names;
  for (; *ports; ++ports) {
    if (is_needed(**ports) || (*ports)->kind == MIMETRA_DOCUMENT) continue;
    names.emplace_back((*ports)->name);
  }
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Names that further options accept: everything without a row.
std::vector<std::string> option_names(const mimetra_operation& operation,
                                      const RichParameterList& rows) {
  std::vector<std::string> names = optional_ports(operation.inputs);
  for (const mimetra_parameter* parameter : parameters_of(operation)) {
    names.emplace_back(parameter->name);
  }
  for (const std::string& output : optional_ports(operation.outputs)) names.push_back(output);
  names.erase(std::remove_if(names.begin(), names.end(),
                             [&rows](const std::string& name) {
                               return rows.hasParameter(QString::fromStdString(name));
                             }),
              names.end());
  return names;
}

QStringList choices_of(const mimetra_parameter& parameter) {
  QStringList choices;
  for (auto choice = parameter.choices; choice && *choice; ++choice) choices << *choice;
  return choices;
}

QString help_of(const mimetra_parameter& parameter) {
  QString help = QString::fromUtf8(parameter.help);
  if (parameter.unit) help += QString(" (%1)").arg(parameter.unit);
  if (parameter.kind == MIMETRA_LENGTH) {
    help += "; a share of the rest pose's diameter as in 0.1, or a length as in 12abs";
  }
  if (parameter.kind == MIMETRA_FILE && parameter.choices) {
    help += "; a file, or one of " + choices_of(parameter).join(' ');
  }
  if (!parameter.fallback) help += "; may be empty";
  return help;
}

/// Kind of a row: text for values that may be empty or for which MeshLab has no field.
mimetra_parameter_kind row_kind(const mimetra_parameter& parameter) {
  return parameter.fallback ? parameter.kind : MIMETRA_TEXT;
}

void add_row(const mimetra_parameter& parameter, RichParameterList& rows) {
  const QString name = parameter.name;
  const QString label = label_of(parameter.name);
  const QString help = help_of(parameter);
  const QString fallback = parameter.fallback ? parameter.fallback : "";
  switch (row_kind(parameter)) {
    case MIMETRA_FLAG:
      rows.addParam(RichBool(name, fallback == "true", label, help));
      break;
    case MIMETRA_INTEGER:
      rows.addParam(RichInt(name, fallback.toInt(), label, help));
      break;
    case MIMETRA_NUMBER:
      rows.addParam(RichFloat(name, fallback.toFloat(), label, help));
      break;
    case MIMETRA_CHOICE: {
      const QStringList choices = choices_of(parameter);
      rows.addParam(RichEnum(name, choices.indexOf(fallback), choices, label, help));
      break;
    }
    default:
      rows.addParam(RichString(name, fallback, label, help));
  }
}

std::string choice_text(const mimetra_parameter& parameter, int index) {
  const QStringList choices = choices_of(parameter);
  if (index < 0 || index >= choices.size()) {
    throw Failure(std::string(parameter.name) + ": expected a choice from 0 to " +
                  std::to_string(choices.size() - 1) + ", found " + std::to_string(index));
  }
  return choices[index].toStdString();
}

/// Value in the parameter's row; empty for the default.
std::string value_text(const mimetra_parameter& parameter, const RichParameterList& rows) {
  const QString name = parameter.name;
  const std::string fallback = parameter.fallback ? parameter.fallback : "";
  std::string text;
  switch (row_kind(parameter)) {
    case MIMETRA_FLAG:
      text = rows.getBool(name) ? "true" : "false";
      break;
    case MIMETRA_INTEGER:
      text = std::to_string(rows.getInt(name));
      break;
    case MIMETRA_NUMBER: {
      const float value = rows.getFloat(name);
      if (value == QString::fromStdString(fallback).toFloat()) return {};
      return shortest_text(value);
    }
    case MIMETRA_CHOICE:
      text = choice_text(parameter, rows.getEnum(name));
      break;
    default:
      text = text_of(rows, parameter.name);
  }
  return text == fallback ? std::string() : text;
}

/// Splits "--rho 5 --signed" and "--rho=5" into names and values.
std::vector<Setting> further_options(const mimetra_operation& operation,
                                     const RichParameterList& rows) {
  if (!rows.hasParameter(kFurtherOptions)) return {};
  const QStringList words =
      QProcess::splitCommand(QString::fromStdString(text_of(rows, kFurtherOptions)));
  const std::vector<std::string> known = option_names(operation, rows);
  std::vector<Setting> options;
  for (int i = 0; i < words.size(); ++i) {
    const std::string word = words[i].toStdString();
    const std::size_t begin = std::min(word.find_first_not_of('-'), word.size());
    const std::size_t end = std::min(word.find('='), word.size());
    const std::string name = word.substr(begin, end - begin);
    if (begin > 0 && rows.hasParameter(QString::fromStdString(name))) {
      throw Failure("further options: " + word + " has a row of its own");
    }
    if (begin == 0 || !contains(known, name)) {
      throw Failure("further options: expected an option such as --" + known.back() + ", found '" +
                    word + "'");
    }
    const mimetra_parameter* parameter = find_parameter(operation, name);
    std::string text = "true";
    if (end < word.size()) {
      text = word.substr(end + 1);
    } else if (!parameter || parameter->kind != MIMETRA_FLAG) {
      if (++i == words.size()) throw Failure("further options: " + word + " needs a value");
      text = words[i].toStdString();
    }
    options.push_back({name, text});
  }
  return options;
}

/// Required outputs that are files.
std::vector<const mimetra_port*> needed_files(const mimetra_operation& operation) {
  std::vector<const mimetra_port*> files;
  for (auto output = operation.outputs; *output; ++output) {
    if (is_needed(**output) && !is_shown(**output)) files.push_back(*output);
  }
  return files;
}

}  // namespace

QString label_of(const std::string& name) {
  QString label = QString::fromStdString(name).replace('-', ' ');
  label[0] = label[0].toUpper();
  return label;
}

bool is_needed(const mimetra_port& port) {
  return (port.flags & MIMETRA_OPTIONAL) == 0;
}

bool has_fields(const mimetra_port& port) {
  return (port.flags & MIMETRA_WITH_FIELDS) != 0;
}

const mimetra_port* needed_input(const mimetra_operation& operation, mimetra_kind kind) {
  for (auto input = operation.inputs; *input; ++input) {
    if ((*input)->kind == kind && is_needed(**input)) return *input;
  }
  return nullptr;
}

bool is_shown(const mimetra_port& output) {
  switch (output.kind) {
    case MIMETRA_SEQUENCE:
    case MIMETRA_REGIONS:
    case MIMETRA_TABLE:
      return true;
    default:
      return false;
  }
}

void add_input(const mimetra_operation& operation, const std::string& name,
               const std::string& instead, RichParameterList& rows) {
  for (auto input = operation.inputs; *input; ++input) {
    if ((*input)->name != name) continue;
    QString help = QString::fromUtf8((*input)->help);
    if (!instead.empty()) help += "; empty for " + QString::fromStdString(instead);
    rows.addParam(RichString(QString::fromStdString(name), "", label_of(name), help));
  }
}

void add_parameters(const mimetra_operation& operation, const std::vector<std::string>& names,
                    RichParameterList& rows) {
  for (const std::string& name : names) {
    if (const mimetra_parameter* parameter = find_parameter(operation, name)) {
      add_row(*parameter, rows);
    }
  }
}

void add_own_parameters(const mimetra_operation& operation, int most, RichParameterList& rows) {
  int added = 0;
  for (const mimetra_parameter* parameter : parameters_of(operation)) {
    if (parameter->of_files || rows.hasParameter(parameter->name)) continue;
    if (added++ == most) return;
    add_row(*parameter, rows);
  }
}

void add_files(const mimetra_operation& operation, RichParameterList& rows) {
  for (const mimetra_port* output : needed_files(operation)) {
    rows.addParam(RichString(output->name, "", label_of(output->name),
                             "file to write: " + QString::fromUtf8(output->help)));
  }
}

void add_further_options(const mimetra_operation& operation, RichParameterList& rows) {
  QStringList further;
  for (const std::string& name : option_names(operation, rows)) {
    further << (name.size() == 1 ? "-" : "--") + QString::fromStdString(name);
  }
  rows.addParam(RichString(
      kFurtherOptions, "", "Further options",
      QString("as for the command mimetra %1: ").arg(operation.name) + further.join(' ')));
}

Request request_of(const mimetra_operation& operation, const RichParameterList& rows) {
  std::vector<Setting> settings;
  for (const mimetra_parameter* parameter : parameters_of(operation)) {
    if (!rows.hasParameter(parameter->name)) continue;
    const std::string text = value_text(*parameter, rows);
    if (!text.empty()) settings.push_back({parameter->name, text});
  }
  for (const Setting& option : further_options(operation, rows)) settings.push_back(option);

  Request request;
  for (const Setting& setting : settings) {
    const mimetra_parameter* parameter = find_parameter(operation, setting.name);
    if (parameter && parameter->of_files) {
      request.reading.push_back(setting.name + '=' + setting.text);
    } else if (parameter) {
      request.parameters.push_back(setting);
    } else if (contains(optional_ports(operation.inputs), setting.name)) {
      request.inputs.push_back(setting);
    } else {
      request.outputs.push_back(setting);
    }
  }
  for (const mimetra_port* output : needed_files(operation)) {
    const std::string path = text_of(rows, output->name);
    if (path.empty()) {
      throw Failure(std::string(output->name) + ": expected a file to write, " + output->help +
                    ", found nothing");
    }
    request.outputs.push_back({output->name, path});
  }
  return request;
}

std::string text_of(const RichParameterList& rows, const std::string& name) {
  return rows.getString(QString::fromStdString(name)).trimmed().toStdString();
}

}  // namespace mimetra_meshlab
