#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Motion up to which a vertex is still, as a share of the face's diameter(). No expression moves
/// every vertex by more.
constexpr double kStillShare = 0.01;

/// Least distance between the two poses over all vertices that triangles use; 0 if there are none.
double least_move(const Positions& from, const Eigen::Ref<const Positions>& to,
                  const Triangles& triangles);

/// Names of expressions that have another place, orientation or size than the neutral. They come
/// from exports side by side, with other axes or in another unit. Every vertex of such an
/// expression moves by more than kStillShare of the diameter, and the common part of the motion
/// exceeds the rest. Or whole_motion() turns it by more than 10 degrees or changes its size by more
/// than a fifth. The first components of a statistical model also move every vertex, but do not
/// meet these conditions.
std::vector<std::string> displaced_expressions(const Positions& neutral, const Triangles& triangles,
                                               const ShapeBasis& expressions);

/// Names of expressions that do not fit the neutral's surface, for example because their vertices
/// have another order. A tenth of the area turns by more than 90 degrees (on two measured faces at
/// most 0.3 %), or a vertex is_torn_off().
std::vector<std::string> torn_expressions(const Positions& neutral, const Triangles& triangles,
                                          const ShapeBasis& expressions);

/// Left and right halves that move the wrong side of the face.
struct ExchangedSides {
  /// Left halves whose pair (known_pairs()) moves the sides the other way round.
  std::vector<std::string> left_halves;
  /// True if most pairs are exchanged: the face is mirrored, or "left" is the viewer's left.
  bool everywhere = false;
};

/// Compares the sides that left and right halves move with the left of the face, up x front.
///
/// Front is the direction that the moving surface faces, whichever way its triangles are wound. Up
/// points from expressions named after the jaw, mouth, lips or chin to expressions named after
/// brows and eyes. If up or front is unknown, left is the side that most left halves move, and
/// `everywhere` stays false. The position of a half is the centroid of its squared motion. Pairs
/// less than 2 % of the diameter apart are ignored (halves of two measured rigs are at least 9 %
/// apart).
ExchangedSides exchanged_sides(const Positions& neutral, const Triangles& triangles,
                               const ShapeBasis& expressions);

/// Notes for the user on a model's expressions, which begin with `name`: displaced_expressions(),
/// torn_expressions(), exchanged_sides() and names that differ in spelling only. Empty if all is as
/// expected.
std::vector<std::string> notes_on_expressions(const std::string& name, const Positions& neutral,
                                              const Triangles& triangles,
                                              const ShapeBasis& expressions);

}  // namespace mimetra
