#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

namespace {

std::string listing(const OperationTable& table) {
  std::string text;
  for (const Operation& operation : table.operations()) {
    text += operation.name + ": " + operation.summary + '\n';
    for (const Parameter& parameter : table.parameters_of(operation)) {
      const std::string fallback = to_text(parameter.fallback);
      text += "  " + parameter.option() + (fallback.empty() ? "" : " = " + fallback) + "  " +
              parameter.help + '\n';
    }
  }
  return text;
}

/// Returns the formats sorted by kind.
std::vector<Format> by_kind(const OperationTable& table) {
  std::vector<Format> formats = table.formats();
  std::ranges::stable_sort(formats, {}, &Format::kind);
  return formats;
}

std::vector<std::string> option_words(const std::vector<Parameter>& parameters) {
  std::vector<std::string> words;
  words.reserve(parameters.size());
  for (const Parameter& parameter : parameters) words.push_back(parameter.option());
  return words;
}

/// Describes what the files of a format store by default; "" if that is unknown.
std::string held_by(const Format& format) {
  if (!format.write) return "";
  std::string words = format.holds ? description(format.holds({})) : "";
  if (format.fields) words += words.empty() ? "fields" : ", fields";
  return words;
}

std::string formats_as_markdown(const OperationTable& table) {
  std::string text =
      "# Formats\n\nMade by `mimetra formats --markdown` from the table of formats. The command "
      "names "
      "the parts of a sequence\nthat a format cannot store, and drops them. Files beside a "
      "sequence "
      "(`NAME.rest.ply`, `NAME.topology.ply`) count\nas part of it. A folder stores what its files "
      "store, by default PLY.\n";
  const DataKind* kind = nullptr;
  const std::vector<Format> formats = by_kind(table);
  for (const Format& format : formats) {
    if (!kind || *kind != format.kind) {
      text += "\n## " + std::string(kind_name(format.kind)) +
              "\n\n| name ends in | format | read | written | holds | options |\n"
              "| --- | --- | --- | --- | --- | --- |\n";
    }
    kind = &format.kind;
    const std::string options = joined(option_words(format.options()), "` `");
    text += "| " + listed_extensions(format.extensions) + " | " + format.name +
            (format.built_by.empty() ? "" : " (not built)") + " | " + (format.read ? "yes" : "") +
            " | " + (format.write ? "yes" : "") + " | " + held_by(format) + " | " +
            (options.empty() ? "" : '`' + options + '`') + " |\n";
  }
  return text;
}

/// Lists the formats, one per line, with a column of extensions and a column of names.
std::string formats_as_text(const OperationTable& table) {
  std::string text;
  const DataKind* kind = nullptr;
  const std::vector<Format> formats = by_kind(table);
  for (const Format& format : formats) {
    if (!kind || *kind != format.kind) text += std::string(kind_name(format.kind)) + '\n';
    kind = &format.kind;
    const char* use = !format.built_by.empty() ? " (not built)"
                      : !format.write          ? " (read)"
                      : !format.read           ? " (written)"
                                               : "";
    std::string names = listed_extensions(format.extensions);
    names.resize(std::max<std::size_t>(names.size(), 26), ' ');
    text += "  " + names + "  " + format.name + use + '\n';
  }
  return text;
}

Json formats_as_json(const OperationTable& table) {
  Json list = Json::array();
  for (const Format& format : by_kind(table)) {
    std::vector<std::string> reading, writing;
    for (const Parameter& parameter : format.reading) reading.push_back(parameter.name);
    for (const Parameter& parameter : format.writing) writing.push_back(parameter.name);
    list.push_back({{"name", format.name},
                    {"kind", kind_name(format.kind)},
                    {"extensions", format.extensions},
                    {"read", bool(format.read)},
                    {"written", bool(format.write)},
                    {"built", format.built_by.empty()},
                    {"holds", held_by(format)},
                    {"reading", reading},
                    {"writing", writing}});
  }
  return list;
}

Operation formats_operation(const OperationTable& table) {
  Operation operation;
  operation.name = "formats";
  operation.summary = "Every format that is read or written";
  operation.parameters = {{"markdown", ParameterKind::flag, false, "as a page of Markdown"}};
  operation.examples = {"formats", "formats --markdown > formats.md"};
  operation.run = [&table](const Invocation& invocation) {
    const bool markdown = invocation.parameters.flag("markdown");
    return Outcome{{},
                   json_text(Json{{"formats", formats_as_json(table)}}),
                   markdown ? formats_as_markdown(table) : formats_as_text(table)};
  };
  return operation;
}

}  // namespace

void add_listing(OperationTable& table) {
  Operation operation;
  operation.name = "operations";
  operation.summary = "Every operation and its parameters";
  operation.examples = {"operations", "operations --json"};
  operation.run = [&table](const Invocation&) {
    return Outcome{{}, json_text(Json{{"operations", Json::parse(table.json())}}), listing(table)};
  };
  table.add(std::move(operation));
  table.add(formats_operation(table));
}

}  // namespace mimetra
