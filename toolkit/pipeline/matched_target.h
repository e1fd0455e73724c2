#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "toolkit/correspondence/automatic_markers.h"
#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/weight_rules.h"

namespace mimetra {

/// Looks for markers from the source's undeformed shape to a target. Throws MismatchError that
/// names the mesh on which nothing is found.
using MarkersBetween = std::function<AutomaticMarkers(const TriMesh& source, const Context&)>;

/// How a target of other faces than the source's is paired with it: not at all, by markers that are
/// looked for if it has other faces, by markers, or as is known already.
using GivenMatch =
    std::variant<std::monostate, MarkersBetween, std::vector<Marker>, Correspondence>;

/// The shape of a target. It refers to a model, which outlives it, and keeps a temporary one.
class TargetModel {
 public:
  TargetModel(const BlendshapeModel& model) : model_(std::shared_ptr<const void>(), &model) {}
  TargetModel(BlendshapeModel&& model)
      : model_(std::make_shared<const BlendshapeModel>(std::move(model))) {}
  /// A mesh is a model without expressions.
  TargetModel(const TriMesh& mesh) : TargetModel(BlendshapeModel(mesh, {})) {}

  const BlendshapeModel& get() const { return *model_; }
  operator const BlendshapeModel&() const { return *model_; }

 private:
  std::shared_ptr<const BlendshapeModel> model_;
};

/// Receives the deformation: a model or a mesh.
struct Target {
  /// In notes and errors.
  std::string name;
  TargetModel model;
  GivenMatch match = {};
  /// Of the model's expressions, where they are solved for.
  WeightRules rules = {};
  /// Where each of the markers was written, for notes: "m.txt, line 3". None for their numbers.
  std::vector<std::string> marker_places = {};
  /// With the source; null where both have the same faces. A MatchedTarget has it of `match`.
  std::shared_ptr<const Pairing> pairing = {};
};

/// Whether both have the same polygons, in any order, wound either way and cut in one of them, as
/// quads are into triangles. Where another numbering (renumbering()) fits the faces as well, as
/// that from the other side of a symmetric mesh, the nearer shape decides, carried to the target's
/// neutral.
bool has_faces_of(const TriMesh& source, const BlendshapeModel& target);

/// Whether a MatchedTarget is paired: markers or pairs are given, or markers are looked for and the
/// faces differ.
bool is_to_be_paired(const FrameSource& source, const Target& target);

/// How well a target is paired, and what that took.
struct MatchReport {
  CorrespondenceQuality quality;
  /// By how many markers; 0 for a correspondence that was given.
  int markers = 0;
  /// These, where they were looked for.
  std::optional<AutomaticMarkers> found = {};
  double seconds = 0;
};

/// A target and how its faces are the source's: the same, where polygons that its file begins at
/// another corner are cut along the source's diagonals, or paired.
class MatchedTarget {
 public:
  /// `source_rest` is the source's undeformed shape (N x 3), by default its rest pose.
  ///
  /// Notes, under the target's name, markers that are doubtful and a match whose verdict is
  /// poor (Topic::poor_match), and a target that is inside out. Throws OptionError
  /// (Topic::other_faces) unless the target has the source's vertices and faces or a match is
  /// given, and (Topic::shifted_markers) for markers that fit much better as other vertices;
  /// MismatchError for other wrong markers and those that fit a mirror image, a correspondence of
  /// other numbers of triangles, and one without any pair; Cancelled; what the search for markers
  /// throws.
  MatchedTarget(const FrameSource& source, Target target,
                const std::optional<Positions>& source_rest = {}, const Context& context = {});

  const Target& operator*() const { return target_; }
  /// None where the faces are the same.
  const std::optional<MatchReport>& report() const { return report_; }

 private:
  void pair(const TriMesh& source, const Context& context);

  Target target_;
  std::optional<MatchReport> report_;
};

}  // namespace mimetra
