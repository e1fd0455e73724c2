#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// Writes the further files of a request beside its output file; returns `written` with them.
std::vector<std::filesystem::path> with_extra(std::vector<std::filesystem::path> written,
                                              const WriteRequest& request);

/// Adds the writers and region readers of io.
void add_formats(OperationTable& table);

}  // namespace mimetra
