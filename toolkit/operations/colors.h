#pragma once

#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/operations/image.h"

namespace mimetra {

/// What a mesh without values looks like.
constexpr Color kClay = {205, 190, 178};
/// What a value that is not a number looks like.
constexpr Color kNoValue = {150, 150, 150};

/// Colour of a share of a range, from light (0) over orange and purple to dark (1). Equal steps
/// look equally far apart, and lightness only falls, so that it reads without colour vision and in
/// print. Shares outside [0, 1] take the nearest end; NaN is kNoValue.
///
/// Even in Oklab: [Ottosson. A perceptual color space for image processing. 2020]
Color even_color(double share);

/// A colour for each vertex's category (N), none where it is negative (kClay). Categories that
/// touch along an edge get different colours unless one touches more than ten earlier ones; the
/// colours are told apart by people with any kind of colour vision.
///
/// [Okabe, Ito. Color universal design. 2008; Tol. Colour schemes. 2021]
std::vector<Color> category_colors(const std::vector<int>& categories, const Triangles& triangles);

/// The colour that each of the categories 0 .. count - 1 has there; kClay of those that no vertex
/// has.
std::vector<Color> colors_by_category(const std::vector<int>& categories,
                                      const Triangles& triangles, std::size_t count);

/// The field `region_color` beside a field `region` (N x 1): red, green and blue, 0 to 255, which
/// ParaView shows as they are where it maps no scalars. A face has the category_colors() of most of
/// its corners' region, of equals that of the lowest.
Field region_color_field(const Field& region, const Connectivity& connectivity);

}  // namespace mimetra
