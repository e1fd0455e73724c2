#include "dialog.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>

#include "toolkit.h"

namespace mimetra_meshlab {

namespace {

/// Those of the parameters of files that say how an input is read.
bool is_of_reading(const mimetra_parameter& parameter) {
  for (const char* name : {"weights", "topology", "frames", "fps"}) {
    if (parameter.of_files && !std::strcmp(parameter.name, name)) return true;
  }
  return false;
}

void for_each_parameter(const mimetra_operation& operation,
                        const std::function<void(const mimetra_parameter&)>& visit) {
  for (auto parameter = operation.parameters; *parameter; ++parameter) visit(**parameter);
}

/// Optional ones, but scripts for other programs, which show files that MeshLab does not write.
std::vector<const mimetra_port*> offered_outputs(const mimetra_operation& operation) {
  std::vector<const mimetra_port*> offered;
  for (auto output = operation.outputs; *output; ++output) {
    const bool is_optional = ((*output)->flags & MIMETRA_OPTIONAL) != 0;
    if (is_optional && (*output)->kind != MIMETRA_VIEW) offered.push_back(*output);
  }
  return offered;
}

/// "admm-iterations" is "Admm iterations".
QString label_of(const std::string& name) {
  QString label = QString::fromStdString(name).replace('-', ' ');
  label[0] = label[0].toUpper();
  return label;
}

QString help_of(const mimetra_parameter& parameter) {
  QString help = QString::fromUtf8(parameter.help);
  if (parameter.unit) help += QString(" (%1)").arg(parameter.unit);
  if (parameter.kind == MIMETRA_LENGTH) {
    help += "; a share of the rest pose's longest side as in 0.1, or a length as in 12abs";
  }
  if (parameter.kind == MIMETRA_FILE && parameter.choices) {
    help += "; a file, or one of";
    for (auto choice = parameter.choices; *choice; ++choice) help += QString(" ") + *choice;
  }
  if (!parameter.fallback) help += "; empty for none";
  return help;
}

QStringList choices_of(const mimetra_parameter& parameter) {
  QStringList choices;
  for (auto choice = parameter.choices; *choice; ++choice) choices << *choice;
  return choices;
}

/// The row's kind: what may be empty, and whatever MeshLab has no field for, is text.
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

/// The shortest text that is this number: 0.1, where a double of it would be 0.100000001.
std::string number_text(float value) {
  std::array<char, 32> text = {};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string choice_text(const mimetra_parameter& parameter, int index) {
  const QStringList choices = choices_of(parameter);
  if (index < 0 || index >= choices.size()) {
    throw Failure(std::string(parameter.name) + ": expected a choice from 0 to " +
                  std::to_string(choices.size() - 1) + ", found " + std::to_string(index));
  }
  return choices[index].toStdString();
}

/// What stands in the parameter's row; empty for its default.
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
      return number_text(value);
    }
    case MIMETRA_CHOICE:
      text = choice_text(parameter, rows.getEnum(name));
      break;
    default:
      text = text_of(rows, parameter.name);
  }
  return text == fallback ? std::string() : text;
}

}  // namespace

void add_parameters(const mimetra_operation& operation, RichParameterList& rows) {
  for_each_parameter(operation, [&rows](const mimetra_parameter& parameter) {
    if (!parameter.of_files && !rows.hasParameter(parameter.name)) add_row(parameter, rows);
  });
}

void add_reading_parameters(const mimetra_operation& operation, RichParameterList& rows) {
  for_each_parameter(operation, [&rows](const mimetra_parameter& parameter) {
    if (is_of_reading(parameter)) add_row(parameter, rows);
  });
}

void add_input(const mimetra_operation& operation, const std::string& name,
               const std::string& instead, RichParameterList& rows) {
  for (auto input = operation.inputs; *input; ++input) {
    if ((*input)->name != name) continue;
    const QString help =
        QString::fromUtf8((*input)->help) + "; empty for " + QString::fromStdString(instead);
    rows.addParam(RichString(QString::fromStdString(name), "", label_of(name), help));
  }
}

void add_outputs(const mimetra_operation& operation, RichParameterList& rows) {
  for (const mimetra_port* output : offered_outputs(operation)) {
    const QString help = QString("File to write: ") + output->help + "; empty for none";
    rows.addParam(RichString(output->name, "", label_of(output->name), help));
  }
}

std::vector<Setting> settings_of(const mimetra_operation& operation,
                                 const RichParameterList& rows) {
  std::vector<Setting> settings;
  for_each_parameter(operation, [&](const mimetra_parameter& parameter) {
    if (parameter.of_files) return;
    const std::string text = value_text(parameter, rows);
    if (!text.empty()) settings.push_back({parameter.name, text});
  });
  return settings;
}

std::vector<std::string> reading_settings_of(const mimetra_operation& operation,
                                             const RichParameterList& rows) {
  std::vector<std::string> settings;
  for_each_parameter(operation, [&](const mimetra_parameter& parameter) {
    if (!is_of_reading(parameter)) return;
    const std::string text = value_text(parameter, rows);
    if (!text.empty()) settings.push_back(std::string(parameter.name) + '=' + text);
  });
  return settings;
}

std::vector<Setting> outputs_of(const mimetra_operation& operation, const RichParameterList& rows) {
  std::vector<Setting> outputs;
  for (const mimetra_port* output : offered_outputs(operation)) {
    const std::string path = text_of(rows, output->name);
    if (!path.empty()) outputs.push_back({output->name, path});
  }
  return outputs;
}

std::string text_of(const RichParameterList& rows, const std::string& name) {
  return rows.getString(QString::fromStdString(name)).trimmed().toStdString();
}

}  // namespace mimetra_meshlab
