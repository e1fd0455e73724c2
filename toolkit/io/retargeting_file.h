#pragma once

#include <string>
#include <string_view>

#include "toolkit/model/retargeting.h"

namespace mimetra {

/// A map between rigs as JSON, which parse_retargeting() reads: names, bounds, G and H.
std::string retargeting_json(const Retargeting& map);

/// The map that `text`, from a file `path`, holds. Throws IoError that names the member and the
/// element with what was expected and found: for what is no JSON, a member that is missing or
/// unknown, another version, rows of other lengths, what is no finite number, and what
/// Retargeting::check() refuses.
Retargeting parse_retargeting(const std::string& path, std::string_view text);

/// D_t rows of M = plain_matrix() as comma-separated values, named by the target's expressions, in
/// columns named by the source's.
std::string plain_matrix_csv(const Retargeting& map, const Eigen::MatrixXd& matrix);

}  // namespace mimetra
