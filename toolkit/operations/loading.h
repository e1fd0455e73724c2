#pragma once

#include <map>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// What files were read, for the manifest.
struct LoadedInputs {
  std::map<std::string, std::vector<NamedData>> data;
  std::vector<std::filesystem::path> files;
};

/// Reads the inputs of an operation from what the user named (`names`, by name of the input),
/// beside those that a host has already (`given`). `log` receives the readers' notes as warnings.
/// Sequences are read into memory; with `may_stream`, those of streamed inputs are not. Throws what
/// the readers throw.
LoadedInputs load_inputs(const OperationTable& table, const Operation& operation,
                         const Parameters& parameters,
                         const std::map<std::string, std::vector<std::string>>& names,
                         const Log& log, std::map<std::string, std::vector<NamedData>> given = {},
                         bool may_stream = false, const Context& context = {});

/// What the output for one value of a repeated input is called, where `name` is what was read: a
/// person of a model has a name, all else that of its file or folder. Throws UsageError for none.
std::string name_of_output(const Input& input, const std::string& name);

}  // namespace mimetra
