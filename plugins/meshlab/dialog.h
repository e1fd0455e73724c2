#pragma once

#include <string>
#include <vector>

#include <common/filter_parameter/rich_parameter_list.h>

#include "plugins/c/mimetra.h"

/// MeshLab's dialogs, made of the descriptions of operations.
namespace mimetra_meshlab {

/// "source-rest" is "Source rest".
QString label_of(const std::string& name);

/// True for an input that must be given, and an output that is always made.
bool is_needed(const mimetra_port& port);

/// True for a sequence whose fields matter.
bool has_fields(const mimetra_port& port);

/// The first input of a kind that an operation needs; null for none.
const mimetra_port* needed_input(const mimetra_operation& operation, mimetra_kind kind);

/// True for outputs that become layers, what is on them, or lines of the log; others are files.
bool is_shown(const mimetra_port& output);

/// A row for the path of an input; `instead` says what is taken without one, or nothing.
void add_input(const mimetra_operation& operation, const std::string& name,
               const std::string& instead, RichParameterList& rows);

/// A row for each of these parameters.
void add_parameters(const mimetra_operation& operation, const std::vector<std::string>& names,
                    RichParameterList& rows);

/// A row for each parameter of the operation itself that has none yet, up to `most` of them.
void add_own_parameters(const mimetra_operation& operation, int most, RichParameterList& rows);

/// A row for the path of each output that is always made and that is a file.
void add_files(const mimetra_operation& operation, RichParameterList& rows);

/// One row for everything else, typed as on the command line: MeshLab's dialogs do not scroll.
void add_further_options(const mimetra_operation& operation, RichParameterList& rows);

struct Setting {
  std::string name;
  std::string text;
};

/// What was filled in, without defaults.
struct Request {
  std::vector<Setting> parameters;   ///< of the operation itself
  std::vector<std::string> reading;  ///< of reading a sequence: "frames=0:100"
  std::vector<Setting> inputs;       ///< optional inputs, and their paths
  std::vector<Setting> outputs;      ///< those that are files, and the paths to write them to
};

/// Throws Failure that names an option that there is not, or that lacks its value, and an output
/// that lacks its path.
Request request_of(const mimetra_operation& operation, const RichParameterList& rows);

/// What was typed in a row of text, without blanks around it.
std::string text_of(const RichParameterList& rows, const std::string& name);

}  // namespace mimetra_meshlab
