#pragma once

#include <filesystem>
#include <system_error>

namespace mimetra {

enum class OutputKind { file, folder };

/// Makes an empty file or folder beside `target`, under a hidden name that was free: nothing that
/// an earlier run or anybody else has put there is used or followed. Where it cannot be made,
/// `error` says why.
std::filesystem::path make_temporary_beside(const std::filesystem::path& target, OutputKind kind,
                                            std::error_code& error);

/// What `path` is called once it is committed: without such names, which nobody asked for. Messages
/// use this name.
std::filesystem::path committed_name(const std::filesystem::path& path);

}  // namespace mimetra
