#pragma once

#include <optional>
#include <string>

#include "toolkit/model/retargeting.h"
#include "toolkit/pipeline/transfer.h"

namespace mimetra {

struct RetargetOptions {
  /// Of the source, in notes and errors.
  std::string source_name = "the source";
  /// In blendshape space.
  SolveOptions solving = {};
  /// Also find the map that later clips can do with.
  bool keep_map = false;
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Progress progress = {};
  Notes notes = {};
};

/// Weights of another rig, and how they came about.
struct RetargetResult {
  /// Its solution's weights are those of the target (F x D_t).
  TransferredTarget transferred;
  /// Linear at the source's neutral, where it is to be kept.
  std::optional<Retargeting> map = {};
};

/// Throws MismatchError where one of the models has no expressions.
void check_rigs(const Animation& source, const Target& target, const std::string& source_name);

/// Weights of one rig become weights of another through their meshes: transfer() over all triangles
/// from the source's poses to the target's expressions, paired where faces differ.
///
/// The map's weights are retargeted() from the source's (F x D_s). Throws what check_rigs() and
/// transfer() throw. Notes what transfer() notes.
RetargetResult retarget(const Animation& source, const Target& target,
                        const RetargetOptions& options = {});

}  // namespace mimetra
