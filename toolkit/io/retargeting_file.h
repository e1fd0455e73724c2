#pragma once

#include <string>
#include <string_view>

#include "toolkit/model/retargeting.h"

namespace mimetra {

/// Map between rigs as JSON for parse_retargeting(): names, bounds, G and H.
std::string retargeting_json(const Retargeting& map);

/// Parses a map from `text`, the content of the file `path`. Throws IoError with the member and the
/// element, and with what was expected and found. Errors are invalid JSON, missing or unknown
/// members, another version, rows of wrong length, numbers that are not finite, and what
/// Retargeting::check() refuses.
Retargeting parse_retargeting(const std::string& path, std::string_view text);

/// CSV of M = plain_matrix(), with D_t rows named after the target's expressions and columns named
/// after the source's.
std::string plain_matrix_csv(const Retargeting& map, const Eigen::MatrixXd& matrix);

}  // namespace mimetra
