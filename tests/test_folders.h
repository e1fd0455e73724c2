#pragma once

#include <filesystem>

namespace mimetra::test {

/// The project's own folder.
std::filesystem::path source_folder();

/// A file or folder of `data/` or `oracle/` in the folder `shared/` beside the project
/// ($MIMETRA_DATA names another place for `data/`). Real models and independent results are not
/// part of the project.
std::filesystem::path shared_path(const std::filesystem::path& relative);

}  // namespace mimetra::test
