#pragma once

#include <string>
#include <vector>

#include <common/filter_parameter/rich_parameter_list.h>

#include "plugins/c/mimetra.h"

/// Dialogs of MeshLab, made from the descriptions of operations.
namespace mimetra_meshlab {

/// Label of a parameter: "Source rest" for "source-rest".
QString label_of(const std::string& name);

/// True if an input is required or an output is always made.
bool is_needed(const mimetra_port& port);

/// True for a sequence whose fields matter.
bool has_fields(const mimetra_port& port);

/// First required input of a kind; null if there is none.
const mimetra_port* needed_input(const mimetra_operation& operation, mimetra_kind kind);

/// True for outputs that become layers, data on layers, or lines of the log. Others are files.
bool is_shown(const mimetra_port& output);

/// Adds a row for the path of an input. `instead` describes the default for an empty path, if any.
void add_input(const mimetra_operation& operation, const std::string& name,
               const std::string& instead, RichParameterList& rows);

/// Adds a row for each of these parameters.
void add_parameters(const mimetra_operation& operation, const std::vector<std::string>& names,
                    RichParameterList& rows);

/// Adds a row for each parameter of the operation itself that has none yet, up to `most` of them.
void add_own_parameters(const mimetra_operation& operation, int most, RichParameterList& rows);

/// Adds a row for the path of each required output that is a file.
void add_files(const mimetra_operation& operation, RichParameterList& rows);

/// Adds one row for all other options, as on the command line: MeshLab's dialogs do not scroll.
void add_further_options(const mimetra_operation& operation, RichParameterList& rows);

struct Setting {
  std::string name;
  std::string text;
};

/// User input that differs from the defaults.
struct Request {
  std::vector<Setting> parameters;   ///< parameters of the operation itself
  std::vector<std::string> reading;  ///< parameters of reading a sequence: "frames=0:100"
  std::vector<Setting> inputs;       ///< optional inputs and their paths
  std::vector<Setting> outputs;      ///< outputs that are files, and the paths to write
};

/// Collects the input of all rows. Throws Failure if an option is unknown or lacks its value, or an
/// output lacks its path.
Request request_of(const mimetra_operation& operation, const RichParameterList& rows);

/// Text of a row without surrounding blanks.
std::string text_of(const RichParameterList& rows, const std::string& name);

}  // namespace mimetra_meshlab
