#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "toolkit/pipeline/region_choice.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// Use of the head motion that was taken out of the source.
enum class RemovedMotion {
  keep,  ///< give it back to the target
  drop
};

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
  /// Known regions, or components from which regions are found; otherwise the source is decomposed.
  /// Regions with a soft border are used unchanged, without completing discs.
  std::variant<std::monostate, GivenRegions, GivenComponents> given = {};
  /// Options of the steps.
  SourceOptions source = {};
  AnalysisOptions analysis = {};
  RegionChoiceOptions regions = {};
  SolveOptions solve = {};

  static constexpr Option kFull{"full", &TransferOptions::full};
  static constexpr Option kHeadMotion{"head_motion", &TransferOptions::head_motion};
  static constexpr auto declared() { return std::tuple(kFull, kHeadMotion); }
};

/// Result for one target.
struct TransferredTarget {
  /// The poses of the target. They have the source's head motion if it was taken out and is kept.
  /// The rest pose is then unknown, and the first frame replaces it.
  Solution solution;
  /// Regions of the source, completed or chosen for this target, with their border on it
  /// (with_border()). Empty for all triangles.
  std::optional<Regions> regions;
  /// From the source's rest pose to the target's.
  Similarity similarity;
  /// Error before head motion was given back.
  TransferError error;
  /// Pairing with the source and its quality; null and empty if the faces are the same.
  std::shared_ptr<const Pairing> pairing = {};
  std::optional<MatchReport> match = {};
  double error_seconds = 0;  ///< time of measuring the error
  /// Eyes and mouth, if markers were searched for.
  std::vector<ComparedOpening> openings = {};
  /// Share of the motion that the target's vertices take, as in Selection; empty for a hard border.
  Eigen::VectorXd weights = {};
};

struct TransferResult {
  std::vector<TransferredTarget> targets;  ///< in the order of the targets
  /// Regions of the source, with the discs that were added for any of the targets. Empty for all
  /// triangles, and if each of several targets has its own regions (has_own_regions()).
  std::optional<Regions> regions;
  std::optional<Components> components;  ///< source of the regions
  HeadMotionTaken head_motion;           ///< of the source
  double region_seconds = 0;             ///< decomposition and choice of regions, for all targets
};

/// Transfers the deformation of a sequence to each of several targets. Takes out the source's head
/// motion, finds its regions, and solves for the targets' poses on the regions' triangles. Work
/// that depends only on the source is done once.
///
/// The source is read in blocks, several times. No more of it is in memory than a decomposition
/// within its memory limit needs. The result does not need the source.
///
/// Notes a result that is probably unusable because it lacks much of the deformation or flips many
/// triangles (Topic::poor_condition if there are regions). If options such as smoothness, ridge,
/// sparsity or rules hold the weights back, the note names them. It then gives the error of another
/// solve without them. Notes a crease at the regions' border (Topic::visible_crease), and eyes and
/// mouths that close only on the source.
///
/// Throws std::invalid_argument for a full transfer with weights of each region or with a falloff.
/// Throws what prepare_source(), MatchedTarget(), analyse(), analysis_of(), check_regions(),
/// check_border(), choose_regions(), RegionSelector, bordered_selection() and solve() throw. Throws
/// MismatchError for a single frame that is the rest pose; Cancelled. A target that does not fit is
/// refused before anything is computed.
TransferResult transfer(const FrameSource& source, const std::vector<Target>& targets,
                        const TransferOptions& options = {}, const Context& context = {});

}  // namespace mimetra
