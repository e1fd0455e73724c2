#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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

/// Looks at markers before anything is fitted to them. Notes, under the target's name, markers that
/// do not lie where the others say (doubtful_markers(), Topic::poor_match); `places` say where each
/// was written, such as "m.txt, line 3", or are none. Throws OptionError (Topic::shifted_markers)
/// where they fit much better as vertices one lower or higher; MismatchError, under the target's
/// name, for what check_markers() refuses.
void check_given_markers(const std::vector<Marker>& markers, const std::vector<std::string>& places,
                         const TriMesh& source, const TriMesh& target, const std::string& name,
                         const Context& context);

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

/// An opening of two faces at rest.
struct OpeningAtRest {
  std::string_view name;
  double source = 0, target = 0;  ///< as in ComparedOpening

  /// One of them is open as no face at rest is when the other's is so: it is not neutral.
  bool differs() const;
};

/// Of the openings that both faces have where their landmarks are known.
std::vector<OpeningAtRest> openings_at_rest(const TriMesh& source, const TriMesh& target,
                                            const AutomaticMarkers& markers);

/// An opening that only one of two faces has, as their landmarks show it.
struct LoneOpening {
  std::string_view name;
  bool is_sources = false;
};

/// Those of two faces at rest. The other's landmarks are likely not on the edges of its opening,
/// such as on an eyeball or inside of the socket, where they mislead whoever pairs the two.
std::vector<LoneOpening> lone_openings(const TriMesh& source, const TriMesh& target,
                                       const AutomaticMarkers& markers);

/// How far an eye or the mouth of a target is open over a sequence, beside the source's: distances
/// of its edges in shares of each face's own opening's width (face_openings.h).
struct ComparedOpening {
  std::string_view name;
  double source_least = 0, source_most = 0;
  double target_least = 0, target_most = 0;
  /// Mean over frames of how much they differ.
  double difference = 0;

  /// The source closes it, the target does not.
  bool stays_open() const;
};

/// Of the openings that both faces have where their landmarks are known. `result` follows `source`
/// frame by frame; the rest poses are neutral. Throws MismatchError for other numbers of frames,
/// what reading throws, Cancelled.
std::vector<ComparedOpening> compared_openings(const FrameSource& source, const FrameSource& result,
                                               const AutomaticMarkers& markers,
                                               const Context& context = {});

}  // namespace mimetra
