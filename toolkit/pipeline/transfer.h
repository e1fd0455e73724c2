#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "toolkit/pipeline/region_choice.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// What becomes of the head motion that was taken out of the source.
enum class RemovedMotion {
  keep,  ///< it is given back to the target
  drop
};

/// As people choose it.
constexpr std::string_view choice_name(RemovedMotion value) {
  switch (value) {
    case RemovedMotion::keep:
      return "keep";
    case RemovedMotion::drop:
      return "drop";
  }
  return {};
}

struct TransferOptions {
  /// Use all triangles instead of regions.
  bool full = false;
  RemovedMotion head_motion = RemovedMotion::keep;
  /// Regions, or components to find them by, that are known already; otherwise the source is
  /// decomposed. Regions with a soft border of their own are taken as they are: no discs complete
  /// them.
  std::variant<std::monostate, GivenRegions, GivenComponents> given = {};
  /// The steps.
  SourceOptions source = {};
  AnalysisOptions analysis = {};
  RegionChoiceOptions regions = {};
  SolveOptions solve = {};

  static constexpr Option kFull{"full", &TransferOptions::full};
  static constexpr Option kHeadMotion{"head_motion", &TransferOptions::head_motion};
  static constexpr auto declared() { return std::tuple(kFull, kHeadMotion); }
};

/// What came of one target.
struct TransferredTarget {
  /// Its sequence has the source's head motion where that was taken out and is kept; its neutral is
  /// then not its rest pose.
  Solution solution;
  /// Those of the source, completed for this target, or chosen for it, with their border on it
  /// (with_border()); none for all triangles.
  std::optional<Regions> regions;
  /// From the source's rest pose to the target's.
  Similarity similarity;
  /// Before head motion was given back.
  TransferError error;
  /// With the source, null where the faces are the same; and how well they are paired.
  std::shared_ptr<const Pairing> pairing = {};
  std::optional<MatchReport> match = {};
  double error_seconds = 0;  ///< what measuring the error took
  /// Eyes and mouth, where markers were looked for.
  std::vector<ComparedOpening> openings = {};
  /// As in Selection: what share of the motion the target's vertices take; empty for a hard border.
  Eigen::VectorXd weights = {};
};

struct TransferResult {
  std::vector<TransferredTarget> targets;  ///< in the order of the targets
  /// Of the source, and what was added for any of the targets; none for all triangles, and where
  /// Selector::transfer chose others for each of several targets.
  std::optional<Regions> regions;
  std::optional<Components> components;  ///< that the regions come from
  HeadMotionTaken head_motion;           ///< of the source
  double region_seconds = 0;             ///< decomposition and choice of regions, for all targets
};

/// The main job: transfers the deformation of a sequence to each of some targets. The rest pose and
/// the head motion of the source are settled, its regions found, and the target's poses solved for
/// on their triangles, or those that are paired with them. What depends on the source only is done
/// once. The source is read in blocks, several times, and no more of it is held than a
/// decomposition within its options' memory does; the result does not need it.
///
/// Notes a result that is likely not usable, because much of the deformation is missing or many
/// triangles are flipped (Topic::poor_condition where there are regions). Where options hold the
/// weights off the source (smoothness, ridge, sparsity, rules and the like), these are named, and
/// it is solved once more without them to say what that gives. Notes a crease at the regions'
/// border (Topic::visible_crease), and eyes and mouths that close on the source only.
///
/// Throws std::invalid_argument for a full transfer by weights of each region or with a falloff,
/// and what prepare_source(), MatchedTarget(), analyse(), analysis_of(), check_regions(),
/// check_border(), choose_regions(), RegionSelector, bordered_selection() and solve() throw;
/// Cancelled. A target that does not fit is refused before anything is computed.
TransferResult transfer(const FrameSource& source, const std::vector<Target>& targets,
                        const TransferOptions& options = {}, const Context& context = {});

}  // namespace mimetra
