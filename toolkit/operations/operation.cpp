#include "toolkit/operations/operation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/sequence_parameters.h"

namespace mimetra {

namespace {

bool has_extension(const std::vector<std::string>& extensions, const std::filesystem::path& path) {
  return std::ranges::find(extensions, lower_extension(path)) != extensions.end();
}

/// Those that the writer can write an output with.
std::vector<std::string> extensions_of(const Output& output, const Writer& writer) {
  if (writer.kind != output.kind || (output.fields && !writer.fields)) return {};
  std::vector<std::string> extensions = writer.extensions;
  std::erase_if(extensions, [&output](const std::string& extension) {
    return !output.extensions.empty() &&
           std::ranges::find(output.extensions, extension) == output.extensions.end();
  });
  return extensions;
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

Json json_of(const Input& input) {
  return {{"name", input.name},         {"kind", kind_name(input.kind)},
          {"optional", input.optional}, {"repeated", input.repeated},
          {"named", input.named},       {"help", input.help}};
}

Json json_of(const Output& output) {
  return {{"name", output.name},
          {"kind", kind_name(output.kind)},
          {"optional", output.optional},
          {"repeated", output.repeated},
          {"help", output.help}};
}

}  // namespace

void Invocation::warn(const std::string& message) const {
  if (log) log(LogLevel::warning, message);
}

void Invocation::info(const std::string& message) const {
  if (log) log(LogLevel::info, message);
}

void OperationTable::add(Operation operation) {
  if (find(operation.name)) {
    throw std::invalid_argument("there is an operation '" + operation.name + "' already");
  }
  std::set<std::string> names;
  const auto claim = [&](const std::string& name) {
    if (names.insert(name).second) return;
    throw std::invalid_argument("operation '" + operation.name + "': the name '" + name +
                                "' is there twice");
  };
  for (const Input& input : operation.inputs) claim(input.name);
  for (const Output& output : operation.outputs) claim(output.name);
  for (const Parameter& parameter : parameters_of(operation)) claim(parameter.name);
  operations_.push_back(std::move(operation));
}

void OperationTable::add(Writer writer) {
  writers_.push_back(std::move(writer));
}

std::string note_on_fields(const Writer& writer, const Data& data,
                           const std::filesystem::path& target) {
  const auto* sequence = std::get_if<FieldSequence>(&data);
  if (!sequence || sequence->fields.empty() || writer.fields) return "";
  std::vector<std::string> names;
  for (const Field& field : sequence->fields) names.push_back(field.name);
  return target.string() + ": this format holds no fields; without " + joined(names);
}

void OperationTable::add(RegionReader reader) {
  region_readers_.push_back(std::move(reader));
}

void OperationTable::add(FieldReader reader) {
  field_readers_.push_back(std::move(reader));
}

const Operation* OperationTable::find(const std::string& name) const {
  const auto found = std::ranges::find(operations_, name, &Operation::name);
  return found == operations_.end() ? nullptr : &*found;
}

void OperationTable::add(LandmarkReader reader) {
  landmark_reader_ = std::move(reader);
}

std::vector<Parameter> OperationTable::parameters_of(const Operation& operation) const {
  std::vector<Parameter> parameters = operation.parameters;
  const auto append = [&](const std::vector<Parameter>& more) {
    for (const Parameter& parameter : more) {
      const auto same = std::ranges::find(parameters, parameter.name, &Parameter::name);
      const bool is_own = same - parameters.begin() < std::ssize(operation.parameters);
      if (same == parameters.end()) {
        parameters.push_back(parameter);
      } else if (is_own || same->kind != parameter.kind) {
        throw std::invalid_argument("operation '" + operation.name + "': parameter '" +
                                    parameter.name +
                                    "' means two things: it is one of reading or writing already");
      }
    }
  };
  if (std::ranges::find(operation.inputs, DataKind::sequence, &Input::kind) !=
      operation.inputs.end()) {
    append(sequence_parameters().declared());
  }
  if (std::ranges::find(operation.inputs, DataKind::landmarks, &Input::kind) !=
      operation.inputs.end()) {
    append(frame_parameters().declared());
    if (landmark_reader_) append(landmark_reader_->parameters);
  }
  for (const Output& output : operation.outputs) {
    for (const Writer& writer : writers_) {
      if (!extensions_of(output, writer).empty()) append(writer.parameters);
    }
  }
  return parameters;
}

const Writer& OperationTable::writer(const Output& output,
                                     const std::filesystem::path& target) const {
  const Writer* folder = nullptr;
  std::vector<std::string> known;
  for (const Writer& writer : writers_) {
    for (const std::string& extension : extensions_of(output, writer)) {
      if (extension.empty()) {
        folder = &writer;
      } else if (extension == lower_extension(target)) {
        return writer;
      } else {
        known.push_back(extension);
      }
    }
  }
  if (folder) return *folder;
  const std::string kind =
      std::string(kind_name(output.kind)) + (output.fields ? " with fields" : "");
  if (known.empty()) throw UsageError(target.string() + ": this program writes no " + kind);
  throw UsageError(target.string() + ": " + kind + " can be written as " + joined(known) +
                   ", not as '" + target.extension().string() + "'");
}

bool OperationTable::writes_folder(const Output& output,
                                   const std::filesystem::path& target) const {
  const std::vector<std::string>& extensions = writer(output, target).extensions;
  const bool may = std::ranges::find(extensions, "") != extensions.end();
  return may && (!target.has_extension() || !has_extension(extensions, target));
}

void OperationTable::check_writable(const Output& output, const std::filesystem::path& target,
                                    bool overwrite,
                                    const std::vector<std::filesystem::path>& inputs) const {
  using Kind = PendingOutput::Kind;
  check_inputs_stay(target, inputs);
  PendingOutput(target, writes_folder(output, target) ? Kind::folder : Kind::file, overwrite);
}

std::vector<std::filesystem::path> OperationTable::output_paths(
    const Output& output, const std::filesystem::path& asked,
    const std::vector<std::string>& names) const {
  if (!output.repeated || names.size() <= 1) return {asked};
  const bool is_folder = writes_folder(output, asked);
  std::vector<std::filesystem::path> paths;
  for (const std::string& name : names) {
    const std::string file = asked.stem().string() + '-' + name + asked.extension().string();
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

const RegionReader& OperationTable::region_reader(const std::filesystem::path& path) const {
  std::vector<std::string> known;
  for (const RegionReader& reader : region_readers_) {
    if (has_extension(reader.extensions, path)) return reader;
    known.insert(known.end(), reader.extensions.begin(), reader.extensions.end());
  }
  throw UsageError(path.string() + ": regions can be read from " + joined(known));
}

const FieldReader* OperationTable::field_reader(const std::filesystem::path& path) const {
  const auto found = std::ranges::find_if(field_readers_, [&path](const FieldReader& reader) {
    return has_extension(reader.extensions, path);
  });
  return found == field_readers_.end() ? nullptr : &*found;
}

const LandmarkReader& OperationTable::landmark_reader() const {
  if (!landmark_reader_) throw std::logic_error("no module that reads landmarks was added");
  return *landmark_reader_;
}

std::string OperationTable::json() const {
  Json list = Json::array();
  for (const Operation& operation : operations_) {
    Json json = {{"name", operation.name}, {"summary", operation.summary}};
    for (const Input& input : operation.inputs) json["inputs"].push_back(json_of(input));
    for (const Output& output : operation.outputs) json["outputs"].push_back(json_of(output));
    for (const Parameter& parameter : parameters_of(operation)) {
      json["parameters"].push_back(json_of(parameter));
    }
    json["examples"] = operation.examples;
    list.push_back(json);
  }
  return list.dump(2);
}

}  // namespace mimetra
