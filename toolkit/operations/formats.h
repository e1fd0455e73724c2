#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the writers and region readers of io.
void add_formats(OperationTable& table);

/// Extensions of the files that io reads and writes a sequence as, for dialogs.
std::vector<std::string> sequence_files();
/// What a sequence can be written as, for help: its formats, or a folder.
std::string sequence_outputs();

/// Calls `write`, which makes the request's target and returns its files, and lets the request's
/// further files appear beside it right after; where either fails, nothing appears. Returns all
/// files. Throws OutputError.
std::vector<std::filesystem::path> write_with_extra(
    const WriteRequest& request, const std::function<std::vector<std::filesystem::path>()>& write);

/// Writes `text` to the request's target, and its further files beside it. Returns all files.
/// Throws OutputError.
std::vector<std::filesystem::path> write_text(const WriteRequest& request, const std::string& text);

}  // namespace mimetra
