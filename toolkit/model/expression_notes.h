#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Share of a face's diameter() by which no expression moves every vertex of it.
constexpr double kStillShare = 0.01;

/// The least distance between two poses of a vertex that triangles use; 0 without vertices.
double least_move(const Positions& from, const Eigen::Ref<const Positions>& to,
                  const Triangles& triangles);

/// Names of expressions that are shapes of another place, turn or size than the neutral, as where
/// they were exported side by side, with other axes or in another unit: every vertex moves by more
/// than that and all by the same more than by what differs, or whole_motion() turns it by more than
/// 10 degrees or changes its size by more than a fifth. The first components of a statistical
/// model move every vertex, but not so.
std::vector<std::string> displaced_expressions(const Positions& neutral, const Triangles& triangles,
                                               const ShapeBasis& expressions);

/// Names of expressions that are no shapes of the neutral's surface, as where their vertices are in
/// another order: a tenth of the area is turned by more than 90 degrees (those of two faces turn
/// 0.3 % of it at most), or a vertex is_torn_off().
std::vector<std::string> torn_expressions(const Positions& neutral, const Triangles& triangles,
                                          const ShapeBasis& expressions);

/// What names of left and right halves tell about the sides that they move.
struct ExchangedSides {
  /// Left halves whose pair (known_pairs()) moves the sides the other way round.
  std::vector<std::string> left_halves;
  /// Those are most of all: the face is its own mirror image, or "left" is the viewer's.
  bool everywhere = false;
};

/// Left is up x front: front is where the moving surface looks, whichever way its triangles are
/// wound, and up leads from the expressions that are named after the jaw, mouth, lips or chin to
/// those named after brows and eyes. Where names tell no up or no side is the front, left is where
/// most halves have it, and `everywhere` stays false. A half is where its squared motion is; pairs
/// closer together than 2 % of the face tell nothing (halves of two rigs are 9 % and more apart).
ExchangedSides exchanged_sides(const Positions& neutral, const Triangles& triangles,
                               const ShapeBasis& expressions);

/// What to say about a model's expressions under its `name`: displaced_expressions(),
/// torn_expressions(), exchanged_sides() and those that are written in two ways. Nothing where all
/// is as expected.
std::vector<std::string> notes_on_expressions(const std::string& name, const Positions& neutral,
                                              const Triangles& triangles,
                                              const ShapeBasis& expressions);

}  // namespace mimetra
