#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "toolkit/model/animation.h"
#include "toolkit/pipeline/region_choice.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {

/// The unknowns.
enum class Space {
  automatic,  ///< weights where the target has expressions, otherwise vertices
  blendshape,
  vertex
};

/// As people choose it.
constexpr std::string_view choice_name(Space value) {
  switch (value) {
    case Space::automatic:
      return "auto";
    case Space::blendshape:
      return "blendshape";
    case Space::vertex:
      return "vertex";
  }
  return {};
}

/// Who receives the deformation: a model, or a mesh, which is a model without expressions. It
/// refers to the model.
struct Target {
  /// In notes and errors.
  std::string name;
  std::reference_wrapper<const BlendshapeModel> model;
};

struct SolveOptions {
  Space space = Space::automatic;
  /// Of each space; their threads and progress, the vertices inside and those that are one are
  /// those of the solve.
  BlendshapeTransferOptions blendshape = {};
  VertexTransferOptions vertex = {};
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Progress progress = {};
  Notes notes = {};

  static constexpr Option kSpace{"space", &SolveOptions::space};
  static constexpr auto declared() { return std::tuple(kSpace); }
};

/// A target's poses that follow a source.
struct Solution {
  /// Of solve(): without head motion, the rest pose is the neutral. Its frames are computed when
  /// they are read, or stored; it does not need the source or the target any more.
  std::shared_ptr<const FrameSource> sequence;
  /// The same where weights drive it; null in vertex space.
  std::shared_ptr<const Animation> animation;
  BlendshapeConditions conditions;
  /// Between vertices that are one, in vertex space: they take no part, and are none of the
  /// degenerate ones.
  int collapsed_triangles = 0;
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
  double seconds = 0;  ///< set-up and the solve of all frames

  /// beta, F x D; empty in vertex space.
  const Eigen::MatrixXd& weights() const;
};

/// True for the vertex space, and where a target has no expressions to solve for.
bool solves_for_vertices(const BlendshapeModel& target, Space space);

/// Throws MismatchError unless the target has the source's vertices and faces.
void check_target(const FrameSource& source, const Target& target);

/// Solves on the selected triangles in blendshape or vertex space; in vertex space closed_seams()
/// stay closed. Notes, under the target's name, expressions that the triangles do not or hardly
/// show (Topic::poor_condition where they do not tell them apart), triangles without area or that a
/// seam collapses, and a source whose rest pose does not look neutral (Topic::unneutral_rest). \pre
/// check_target()
///
/// Throws OptionError (Topic::no_expressions, Topic::anchor_vertex, Topic::held_anchor) and what
/// BlendshapeTransfer, closed_seams(), VertexTransfer, reading the source and FrameStore throw.
Solution solve(const Source& source, const Target& target, const Selection& selection,
               const SolveOptions& options = {});

}  // namespace mimetra
