#pragma once

#include <optional>
#include <string>

#include "toolkit/model/retargeting.h"
#include "toolkit/pipeline/transfer.h"

namespace mimetra {

struct RetargetOptions {
  /// Of the source, in notes and errors.
  std::string source_name = "the source";
  /// As in SolveOptions.
  Axes axes = Axes::fit;
  double smoothness = 0;
  double ridge = 0;
  double sparsity = 0;
  double symmetry = 0;
  Exclusive exclusive = Exclusive::none;
  /// Also find the map that later clips can do with.
  bool keep_map = false;

  static constexpr Option kAxes{"axes", &RetargetOptions::axes};
  static constexpr Option kSmoothness{"smoothness", &RetargetOptions::smoothness,
                                      SolveOptions::kSmoothness.range,
                                      SolveOptions::kSmoothness.unit};
  static constexpr Option kRidge{"ridge", &RetargetOptions::ridge, SolveOptions::kRidge.range};
  static constexpr Option kSparsity{"sparsity", &RetargetOptions::sparsity,
                                    SolveOptions::kSparsity.range};
  static constexpr Option kSymmetry{"symmetry", &RetargetOptions::symmetry,
                                    SolveOptions::kSymmetry.range};
  static constexpr Option kExclusive{"exclusive", &RetargetOptions::exclusive};
  static constexpr Option kKeepMap{"keep_map", &RetargetOptions::keep_map};
  static constexpr auto declared() {
    return std::tuple(kAxes, kSmoothness, kRidge, kSparsity, kSymmetry, kExclusive, kKeepMap);
  }
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
                        const RetargetOptions& options = {}, const Context& context = {});

}  // namespace mimetra
