#pragma once

#include <vector>

#include "toolkit/io/image.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Colour of a mesh without values.
constexpr Color kClay = {205, 190, 178};
/// Colour of NaN.
constexpr Color kNoValue = {150, 150, 150};

/// Colour of a share of a range, from light (0) over orange and purple to dark (1). Equal steps
/// look equally far apart. Lightness only decreases, so the colours read in print and without
/// colour vision. Shares outside [0, 1] are clamped; NaN becomes kNoValue.
///
/// Even in Oklab: [Ottosson. A perceptual color space for image processing. 2020]
Color even_color(double share);

/// Colour of each vertex's category (N); kClay for negative categories. Categories that share an
/// edge get different colours, unless a category touches more than ten earlier ones. People with
/// any kind of colour vision can distinguish the colours.
///
/// [Okabe, Ito. Color universal design. 2008; Tol. Colour schemes. 2021]
std::vector<Color> category_colors(const std::vector<int>& categories, const Triangles& triangles);

/// Colours of the categories 0 .. count - 1 in category_colors(); kClay for categories without a
/// vertex.
std::vector<Color> colors_by_category(const std::vector<int>& categories,
                                      const Triangles& triangles, std::size_t count);

/// Field `region_color` for a field `region` (N x 1): red, green and blue, 0 to 255. ParaView shows
/// it unchanged if it maps no scalars. A face takes the category_colors() of the region that most
/// of its corners have; the lowest number wins ties.
Field region_color_field(const Field& region, const Connectivity& connectivity);

}  // namespace mimetra
