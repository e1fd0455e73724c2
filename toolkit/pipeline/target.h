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

/// Searches for markers between the source's undeformed shape and a target. Throws MismatchError
/// that names the mesh on which it finds nothing.
using MarkersBetween = std::function<AutomaticMarkers(const TriMesh& source, const Context&)>;

/// How a target with other faces is paired with the source: not at all, by a search for markers, by
/// given markers, or by a known correspondence. The search runs only if the faces differ.
using GivenMatch =
    std::variant<std::monostate, MarkersBetween, std::vector<Marker>, Correspondence>;

/// The model of a target. Refers to an lvalue, which must outlive it; keeps a temporary.
class TargetModel {
 public:
  TargetModel(const BlendshapeModel& model) : model_(std::shared_ptr<const void>(), &model) {}
  TargetModel(BlendshapeModel&& model)
      : model_(std::make_shared<const BlendshapeModel>(std::move(model))) {}
  /// Makes a model without expressions from a mesh.
  TargetModel(const TriMesh& mesh) : TargetModel(BlendshapeModel(mesh, {})) {}

  const BlendshapeModel& get() const { return *model_; }
  operator const BlendshapeModel&() const { return *model_; }

 private:
  std::shared_ptr<const BlendshapeModel> model_;
};

/// Model or mesh that receives the deformation.
struct Target {
  /// Name in notes and errors.
  std::string name;
  TargetModel model;
  GivenMatch match = {};
  /// Rules of the model's expressions, for a solve for weights.
  WeightRules rules = {};
  /// Place where each marker was written, for notes: "m.txt, line 3". If empty, notes give numbers.
  std::vector<std::string> marker_places = {};
  /// Pairing with the source; null if both have the same faces. A MatchedTarget sets it from
  /// `match`.
  std::shared_ptr<const Pairing> pairing = {};
};

/// Whether both meshes have the same polygons. Order and winding may differ, and one mesh may cut
/// the other's polygons, as quads into triangles.
///
/// If another numbering (renumbering()) matches the faces as well, as on a symmetric mesh, the
/// nearer shape decides. The shapes are compared after a similarity fit to the target's neutral.
bool has_faces_of(const TriMesh& source, const BlendshapeModel& target);

/// Whether a MatchedTarget is paired. That is so for given markers or pairs, and for searched
/// markers if the faces differ.
bool is_to_be_paired(const FrameSource& source, const Target& target);

/// Checks markers before anything is fitted to them. Notes, under the target's name, markers that
/// do not fit the others (doubtful_markers(), Topic::poor_match). `places` gives the place of each
/// marker in a file, such as "m.txt, line 3", or is empty.
///
/// Throws OptionError (Topic::shifted_markers) if the markers fit much better as vertices one lower
/// or higher. Throws MismatchError, under the target's name, if check_markers() refuses them or
/// they fit only a mirror image.
void check_given_markers(const std::vector<Marker>& markers, const std::vector<std::string>& places,
                         const TriMesh& source, const TriMesh& target, const std::string& name,
                         const Context& context);

/// How well a target is paired, and the time that the pairing took.
struct MatchReport {
  CorrespondenceQuality quality;
  /// Number of markers; 0 for a given correspondence.
  int markers = 0;
  /// The markers, if they were searched for.
  std::optional<AutomaticMarkers> found = {};
  double seconds = 0;
};

/// A target that fits the source's faces. Either its faces are the same, or the target is paired.
/// Polygons that start at another corner are cut along the source's diagonals.
class MatchedTarget {
 public:
  /// `source_rest` is the source's undeformed shape (N x 3), by default its rest pose.
  ///
  /// Notes, under the target's name, doubtful markers, a match with a poor verdict
  /// (Topic::poor_match), and a target that is inside out. Also notes faces that are the source's
  /// in another order.
  ///
  /// Throws OptionError (Topic::other_faces) unless the target has the source's faces or a match is
  /// given. Throws OptionError (Topic::shifted_markers) for markers that fit much better as
  /// vertices one lower or higher. Throws MismatchError for other wrong markers and for markers
  /// that fit a mirror image. Throws MismatchError for a correspondence with other numbers of
  /// triangles or without any pair, and for a mesh that is only numbered differently. Throws
  /// Cancelled, and what the search for markers throws.
  MatchedTarget(const FrameSource& source, Target target,
                const std::optional<Positions>& source_rest = {}, const Context& context = {});

  const Target& operator*() const { return target_; }
  /// Empty if the faces are the same.
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

  /// True if one of them is open wider than resting faces differ: one face is not neutral.
  bool differs() const;
};

/// Compares the openings that both faces have at rest. Landmarks locate the openings.
std::vector<OpeningAtRest> openings_at_rest(const TriMesh& source, const TriMesh& target,
                                            const AutomaticMarkers& markers);

/// An opening that the landmarks show on only one of two faces.
struct LoneOpening {
  std::string_view name;
  bool is_sources = false;
};

/// Finds the openings that only one of two faces has at rest. On the other face, the landmarks
/// probably miss the edges of its opening. They may be on an eyeball or inside the socket, where
/// they mislead the pairing.
std::vector<LoneOpening> lone_openings(const TriMesh& source, const TriMesh& target,
                                       const AutomaticMarkers& markers);

/// How far an eye or the mouth opens on the source and on a target, over a sequence. Openness is
/// the distance of the edges as a share of the opening's width on the same face (face_openings.h).
struct ComparedOpening {
  std::string_view name;
  double source_least = 0, source_most = 0;
  double target_least = 0, target_most = 0;
  /// Mean absolute difference over the frames.
  double difference = 0;

  /// True if the source closes the opening and the target does not.
  bool stays_open() const;
};

/// Compares the openings that both faces have. Landmarks locate the openings. `result` follows
/// `source` frame by frame, and the rest poses are neutral. Throws MismatchError for different
/// numbers of frames, what reading throws, Cancelled.
std::vector<ComparedOpening> compared_openings(const FrameSource& source, const FrameSource& result,
                                               const AutomaticMarkers& markers,
                                               const Context& context = {});

}  // namespace mimetra
