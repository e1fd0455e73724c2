#include "toolkit/operations/listing.h"

#include <nlohmann/json.hpp>

#include "toolkit/operations/json.h"

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

}  // namespace

void add_listing(OperationTable& table) {
  Operation operation;
  operation.name = "operations";
  operation.summary = "Every operation and its parameters";
  operation.examples = {"operations", "operations --json"};
  operation.run = [&table](const Invocation&) {
    return Outcome{{}, Json{{"operations", Json::parse(table.json())}}.dump(), listing(table)};
  };
  table.add(std::move(operation));
}

}  // namespace mimetra
