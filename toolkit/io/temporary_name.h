#pragma once

#include <filesystem>

namespace mimetra {

/// Where `target` is written before it is whole: a hidden name beside it, unique among the
/// processes and threads that write there.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// What `path` is called once it is committed: without such names, which nobody asked for. Messages
/// use this name.
std::filesystem::path committed_name(const std::filesystem::path& path);

}  // namespace mimetra
