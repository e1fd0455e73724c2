#pragma once

#include <string>
#include <vector>

#include "toolkit/io/format.h"

// ReadOptions and WriteOptions as parameters of commands and dialogs.

namespace mimetra {

/// Parameters of ReadOptions; by default those for sequences that weights may drive.
std::vector<Parameter> reading_parameters(const std::vector<std::string>& names = {
                                              "weights", "weight-scale", "topology", "frames",
                                              "fps"});
/// Parameters of WriteOptions: "double" for mesh files, "single" for arrays, "format" for folders
/// and "compress" for VTK's files.
std::vector<Parameter> writing_parameters(const std::vector<std::string>& names);

/// Options with the values of the parameters that are `declared`, such as Format::reading. They
/// refer to `parameters`.
ReadOptions read_options(const std::vector<Parameter>& declared, const Parameters& parameters);
WriteOptions write_options(const std::vector<Parameter>& declared, const Parameters& parameters);

}  // namespace mimetra
