#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the formats of io but for those of tables (weight_tables.h).
void add_formats(OperationTable& table);

/// Calls `write`, which makes the request's target and returns its files, and lets the request's
/// further files appear beside it right after; where either fails, nothing appears. Returns all
/// files. Throws OutputError.
std::vector<std::filesystem::path> write_with_extra(
    const WriteRequest& request, const std::function<std::vector<std::filesystem::path>()>& write);

/// Writes `text` to the request's target, and its further files beside it. Returns all files.
/// Throws OutputError.
std::vector<std::filesystem::path> write_text(const WriteRequest& request, const std::string& text);

/// The same with the text of a document.
std::vector<std::filesystem::path> write_document(const Data& document, const WriteRequest& request,
                                                  const Context& context = {});

}  // namespace mimetra
