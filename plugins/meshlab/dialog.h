#pragma once

#include <string>
#include <vector>

#include <common/filter_parameter/rich_parameter_list.h>

#include <mimetra/c/mimetra.h>

/// MeshLab's dialogs, made of the descriptions of operations.
namespace mimetra_meshlab {

/// A row for each parameter of the operation itself that has none yet.
void add_parameters(const mimetra_operation& operation, RichParameterList& rows);

/// A row for each parameter of reading sequences from files.
void add_reading_parameters(const mimetra_operation& operation, RichParameterList& rows);

/// A row for the path of an input; `instead` says what is taken without one.
void add_input(const mimetra_operation& operation, const std::string& name,
               const std::string& instead, RichParameterList& rows);

/// A row for the path of each optional output that is a file of its own.
void add_outputs(const mimetra_operation& operation, RichParameterList& rows);

struct Setting {
  std::string name;
  std::string text;
};

/// The operation's parameters that are not at their defaults.
std::vector<Setting> settings_of(const mimetra_operation& operation, const RichParameterList& rows);

/// The parameters of reading that were filled in, as "name=text".
std::vector<std::string> reading_settings_of(const mimetra_operation& operation,
                                             const RichParameterList& rows);

/// The optional outputs that are to be written, and their paths.
std::vector<Setting> outputs_of(const mimetra_operation& operation, const RichParameterList& rows);

/// What was typed in a row of text, without blanks around it.
std::string text_of(const RichParameterList& rows, const std::string& name);

}  // namespace mimetra_meshlab
