#pragma once

#include <filesystem>

namespace mimetra {

/// The program or library that holds this code; empty where the system does not tell.
std::filesystem::path this_binary();

}  // namespace mimetra
