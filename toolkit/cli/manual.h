#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra::cli {

/// Adds the operation `completion`, which prints scripts that let a shell complete commands,
/// options, their choices and files. The table must outlive the call.
void add_completion(OperationTable& table);

/// Adds the operation `manual`, which prints the manual page mimetra(1) or the reference of all
/// commands. The table must outlive the call.
void add_manual(OperationTable& table);

}  // namespace mimetra::cli
