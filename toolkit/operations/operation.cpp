#include "toolkit/operations/operation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Extensions of the format if it can write the output, otherwise none.
std::vector<std::string> extensions_of(const Output& output, const Format& format) {
  const bool fits = format.write && format.kind == output.kind &&
                    (format.fields || !output.fields) && (output.weights || !format.weights);
  if (!fits) return {};
  std::vector<std::string> extensions = format.extensions;
  std::erase_if(extensions, [&output](const std::string& extension) {
    return !output.extensions.empty() &&
           std::ranges::find(output.extensions, extension) == output.extensions.end();
  });
  return extensions;
}

/// True for a name that ends in an extension, ".csv" or ".livelink.csv".
bool ends_in(const std::filesystem::path& target, const std::string& extension) {
  if (extension.find('.', 1) == std::string::npos) return lower_extension(target) == extension;
  return lower_case(target.filename().string()).ends_with(extension);
}

/// Double extension of some format at the end of a name, or "". A name in ".livelink.csv" is not a
/// ".csv" file, even if Live Link cannot be written.
std::string written_extension(const std::vector<Format>& formats,
                              const std::filesystem::path& target) {
  for (const Format& format : formats) {
    for (const std::string& extension : format.extensions) {
      const bool is_double = extension.find('.', 1) != std::string::npos;
      if (is_double && format.write && ends_in(target, extension)) return extension;
    }
  }
  return "";
}

/// Appends the formats to a help text: "what it is: .json or .csv".
std::string with_formats(const std::string& help, const std::vector<std::string>& extensions) {
  if (extensions.empty()) return help;
  return (help.empty() ? help : help + ": ") + listed_extensions(extensions);
}

std::string_view kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::flag:
      return "flag";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::integer_list:
      return "integer list";
    case ParameterKind::number:
      return "number";
    case ParameterKind::length:
      return "length";
    case ParameterKind::choice:
      return "choice";
    case ParameterKind::text:
      return "text";
    case ParameterKind::file:
      return "file";
  }
  return "";
}

Json json_of(const ParameterValue& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
          return nullptr;
        else
          return held;
      },
      value);
}

Json json_of(const Parameter& parameter) {
  Json json = {{"name", parameter.name},
               {"kind", kind_name(parameter.kind)},
               {"default", json_of(parameter.fallback)},
               {"help", parameter.help}};
  if (!parameter.unit.empty()) json["unit"] = parameter.unit;
  if (parameter.minimum) json["minimum"] = *parameter.minimum;
  if (parameter.maximum) json["maximum"] = *parameter.maximum;
  if (!parameter.choices.empty()) json["choices"] = parameter.choices;
  return json;
}

Json json_of(const Input& input, const std::string& help) {
  return {{"name", input.name},         {"kind", kind_name(input.kind)},
          {"optional", input.optional}, {"repeated", input.repeated},
          {"named", input.named},       {"help", help}};
}

Json json_of(const Output& output, const std::string& help) {
  return {{"name", output.name},
          {"kind", kind_name(output.kind)},
          {"optional", output.optional},
          {"repeated", output.repeated},
          {"help", help}};
}

}  // namespace

void Invocation::warn(const std::string& message) const {
  if (log) log(LogLevel::warning, message);
}

void Invocation::info(const std::string& message) const {
  if (log) log(LogLevel::info, message);
}

void OperationTable::check_names(const Operation& operation) const {
  std::set<std::string> names;
  const auto claim = [&](const std::string& name) {
    if (names.insert(name).second) return;
    throw std::invalid_argument("operation '" + operation.name + "': the name '" + name +
                                "' is there twice");
  };
  for (const Input& input : operation.inputs) claim(input.name);
  for (const Output& output : operation.outputs) claim(output.name);
  for (const Parameter& parameter : parameters_of(operation)) claim(parameter.name);
}

void OperationTable::add(Operation operation) {
  if (find(operation.name)) {
    throw std::invalid_argument("there is an operation '" + operation.name + "' already");
  }
  check_names(operation);
  operations_.push_back(std::move(operation));
}

void OperationTable::add(Format format) {
  for (const Format& known : formats_) {
    const bool clashes =
        known.kind == format.kind && ((known.read && format.read) || (known.write && format.write));
    for (const std::string& extension : format.extensions) {
      if (!clashes || !known.has(extension)) continue;
      throw std::invalid_argument("format '" + format.name + "': '" + extension + "' is that of '" +
                                  known.name + "' already");
    }
  }
  formats_.push_back(std::move(format));
  try {
    for (const Operation& operation : operations_) check_names(operation);
  } catch (...) {
    formats_.pop_back();
    throw;
  }
}

void OperationTable::add(LandmarkFinder finder) {
  if (landmark_finder_) throw std::invalid_argument("there is a finder of landmarks already");
  landmark_finder_ = std::move(finder);
}

const Operation* OperationTable::find(const std::string& name) const {
  const auto found = std::ranges::find(operations_, name, &Operation::name);
  return found == operations_.end() ? nullptr : &*found;
}

std::vector<Parameter> OperationTable::parameters_of(const Operation& operation) const {
  std::vector<Parameter> parameters = operation.parameters;
  const auto append = [&](const std::vector<Parameter>& more, const std::string& group) {
    for (Parameter parameter : more) {
      const auto same = std::ranges::find(parameters, parameter.name, &Parameter::name);
      const bool is_own = same - parameters.begin() < std::ssize(operation.parameters);
      if (same == parameters.end()) {
        if (parameter.group.empty()) parameter.group = group;
        parameters.push_back(std::move(parameter));
      } else if (is_own || same->kind != parameter.kind) {
        throw std::invalid_argument("operation '" + operation.name + "': parameter '" +
                                    parameter.name +
                                    "' means two things: it is one of reading or writing already");
      }
    }
  };
  for (const Input& input : operation.inputs) {
    for (const Format& format : formats_) {
      if (format.read && format.kind == input.kind) append(format.reading, "Reading");
    }
  }
  for (const Output& output : operation.outputs) {
    for (const Format& format : formats_) {
      if (!extensions_of(output, format).empty()) append(format.writing, "Writing");
    }
  }
  return parameters;
}

namespace {

/// Format of the numbered frames in a folder without mesh files; null for other texts.
const Format* format_of_frames(const std::vector<Format>& formats, DataKind kind,
                               const std::string& text) {
  std::error_code unreadable;
  const bool is_folder = std::filesystem::is_directory(text, unreadable);
  if (!is_folder && !is_frame_pattern(text)) return nullptr;
  const std::set<std::string> named = extensions_named(text);
  if (std::ranges::any_of(named, is_mesh_extension)) return nullptr;
  const auto found = std::ranges::find_if(formats, [&](const Format& format) {
    return format.numbered && format.kind == kind &&
           std::ranges::any_of(named, [&](const auto& each) { return format.has(each); });
  });
  return found == formats.end() ? nullptr : &*found;
}

}  // namespace

const Format& OperationTable::reader(DataKind kind, const std::string& text) const {
  const std::string extension = lower_extension(text);
  std::error_code unreadable;
  const bool is_folder = std::filesystem::is_directory(text, unreadable);
  const Format *folder = nullptr, *any_file = nullptr, *by_extension = nullptr;
  std::vector<std::string> known;
  for (const Format& format : formats_) {
    if (format.kind == kind && format.has(extension)) require_built(format, text);
    if (!format.read || format.kind != kind) continue;
    if (!extension.empty() && format.has(extension)) by_extension = &format;
    if (format.has(Format::kFolder)) folder = &format;
    if (format.has(Format::kAnyFile)) any_file = &format;
    known.insert(known.end(), format.extensions.begin(), format.extensions.end());
  }
  // A folder may have a name like a file's.
  if (by_extension && !(folder && is_folder)) return *by_extension;
  const std::string name(kind_name(kind));
  if (known.empty()) throw UsageError(text + ": no file holds a value of the kind '" + name + "'");
  if (any_file) return *any_file;
  const std::string expected = name + " can be read from " + listed_extensions(known);
  if (!folder) throw UsageError(text + ": " + expected);
  if (!std::filesystem::is_regular_file(text, unreadable)) {
    const Format* numbered = format_of_frames(formats_, kind, text);
    return numbered ? *numbered : *folder;
  }
  const std::string found = foreign_file(text);
  throw IoError(text, (found.empty() ? "" : "is " + found + ". ") + expected + ", not from '" +
                          extension + "'");
}

namespace {

/// Hints that a folder's name with a dot needs a slash.
std::string hint_of_folder(const std::vector<std::string>& known,
                           const std::filesystem::path& target) {
  const bool folder = std::ranges::find(known, Format::kFolder) != known.end();
  if (!folder || lower_extension(target).empty()) return "";
  return "; a folder of this name is '" + target.string() + "/'";
}

}  // namespace

const Format& OperationTable::writer(const Output& output,
                                     const std::filesystem::path& target) const {
  const std::string whole = lower_case(target.filename().string());
  std::vector<std::string> known;
  const Format* found = nullptr;
  std::string of_found;
  for (const Format& format : formats_) {
    for (const std::string& extension : extensions_of(output, format)) {
      if (!extension.empty() && extension == whole) {
        throw UsageError(target.string() + ": is an extension without a name before it");
      }
      if (ends_in(target, extension) && (!found || extension.size() > of_found.size())) {
        found = &format;
        of_found = extension;
      }
      known.push_back(extension);
    }
  }
  for (const Format& format : formats_) {
    if (format.kind == output.kind && format.has(lower_extension(target))) {
      require_built(format, target.string());
    }
  }
  const std::string wanted = written_extension(formats_, target);
  if (found && of_found.size() >= wanted.size()) return *found;
  const std::string kind =
      std::string(kind_name(output.kind)) + (output.fields ? " with fields" : "");
  if (known.empty()) throw UsageError(target.string() + ": this program writes no " + kind);
  const std::string ending = wanted.empty() ? target.extension().string() : wanted;
  throw UsageError(target.string() + ": " + kind + " can be written as " +
                   listed_extensions(known) +
                   (ending.empty() ? "; the name has no extension" : ", not as '" + ending + "'") +
                   hint_of_folder(known, target));
}

std::vector<std::string> OperationTable::extensions(const Input& input) const {
  std::vector<std::string> extensions;
  for (const Format& format : formats_) {
    if (!format.read || format.kind != input.kind || input.run) continue;
    extensions.insert(extensions.end(), format.extensions.begin(), format.extensions.end());
  }
  return extensions;
}

std::vector<std::string> OperationTable::extensions(const Output& output) const {
  std::vector<std::string> extensions;
  for (const Format& format : formats_) {
    const std::vector<std::string> more = extensions_of(output, format);
    extensions.insert(extensions.end(), more.begin(), more.end());
  }
  return extensions;
}

std::string OperationTable::help(const Input& input) const {
  return with_formats(input.help, extensions(input));
}

std::string OperationTable::help(const Output& output) const {
  return with_formats(output.help, extensions(output));
}

bool OperationTable::writes_folder(const Output& output,
                                   const std::filesystem::path& target) const {
  return writer(output, target).has(Format::kFolder);
}

void OperationTable::check_writable(const Output& output, const std::filesystem::path& target,
                                    bool overwrite,
                                    const std::vector<std::filesystem::path>& inputs) const {
  using Kind = PendingOutput::Kind;
  if (target == "-") {
    throw UsageError(
        "output '-': results are files and folders and not written to standard output; "
        "give a name (`./-` is a folder of that name)");
  }
  check_inputs_stay(target, inputs);
  PendingOutput(target, writes_folder(output, target) ? Kind::folder : Kind::file, overwrite);
}

std::vector<std::filesystem::path> OperationTable::output_paths(
    const Output& output, const std::filesystem::path& asked,
    const std::vector<std::string>& names) const {
  if (!output.repeated || names.size() <= 1) return {asked};
  const bool is_folder = writes_folder(output, asked);
  const std::string whole = asked.filename().string();
  std::string stem = asked.stem().string();
  for (const std::string& extension : writer(output, asked).extensions) {
    if (ends_in(asked, extension)) stem = whole.substr(0, whole.size() - extension.size());
  }
  std::vector<std::filesystem::path> paths;
  for (const std::string& name : names) {
    const std::string file = stem + '-' + name + whole.substr(stem.size());
    paths.push_back(is_folder ? asked / name : asked.parent_path() / file);
  }
  return paths;
}

std::filesystem::path OperationTable::companion_path(const Operation& operation,
                                                     const Output& companion,
                                                     const std::filesystem::path& out) const {
  const Output& main = *std::ranges::find(operation.outputs, "out", &Output::name);
  std::filesystem::path name = out.lexically_normal();
  if (!name.has_filename()) name = name.parent_path();
  if (!writes_folder(main, out)) name.replace_extension();
  return name += companion.companion;
}

std::string OperationTable::json() const {
  Json list = Json::array();
  for (const Operation& operation : operations_) {
    Json json = {{"name", operation.name}, {"summary", operation.summary}};
    for (const Input& input : operation.inputs)
      json["inputs"].push_back(json_of(input, help(input)));
    for (const Output& output : operation.outputs)
      json["outputs"].push_back(json_of(output, help(output)));
    for (const Parameter& parameter : parameters_of(operation)) {
      json["parameters"].push_back(json_of(parameter));
    }
    json["examples"] = operation.examples;
    list.push_back(json);
  }
  return json_text(list, 2);
}

}  // namespace mimetra
