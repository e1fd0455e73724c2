#include "toolkit/io/mesh_content.h"

#include <algorithm>
#include <cmath>

#include "toolkit/io/single_precision.h"
#include "toolkit/io/text_cursor.h"

namespace mimetra {
bool fits_single_precision(const TextureCoordinates& texture) {
  return std::ranges::all_of(texture.coordinates, [](const Eigen::Vector2d& uv) {
    const double farthest = uv.cwiseAbs().maxCoeff();
    return farthest <= kLargestSingle || !std::isfinite(farthest);
  });
}

std::string position_lines(std::string_view before, const PositionsView& positions,
                           bool double_precision) {
  const std::size_t longest = before.size() + 3 * (kMostDigits + 1);
  std::string text(longest * static_cast<std::size_t>(positions.rows()), ' ');
  char* at = text.data();
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    at = std::copy(before.begin(), before.end(), at);
    for (int axis = 0; axis < 3; ++axis) {
      at = put_number(at, positions(vertex, axis), double_precision);
      *at++ = axis < 2 ? ' ' : '\n';
    }
  }
  text.resize(static_cast<std::size_t>(at - text.data()));
  return text;
}

}  // namespace mimetra
