#pragma once

#include <optional>
#include <string>

#include "toolkit/model/retargeting.h"
#include "toolkit/pipeline/transfer.h"

namespace mimetra {

struct RetargetOptions {
  /// Name of the source in notes and errors.
  std::string source_name = "the source";
  /// See SolveOptions.
  Axes axes = Axes::fit;
  double smoothness = 0;
  double ridge = 0;
  double sparsity = 0;
  double symmetry = 0;
  Exclusive exclusive = Exclusive::none;
  /// Also compute the linear map, which later clips can use.
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

/// Weights of another rig.
struct RetargetResult {
  /// The solution's weights are the target's (F x D_t).
  TransferredTarget transferred;
  /// Linear map at the source's neutral, if options.keep_map.
  std::optional<Retargeting> map = {};
};

/// Throws MismatchError if one of the models has no expressions.
void check_rigs(const Animation& source, const Target& target, const std::string& source_name);

/// Converts weights of one rig to weights of another through their meshes. Runs transfer() over all
/// triangles, from the source's poses to the target's expressions. Targets with other faces are
/// paired.
///
/// retargeted() applies the map to the source's weights (F x D_s). Throws what check_rigs() and
/// transfer() throw. Notes what transfer() notes.
RetargetResult retarget(const Animation& source, const Target& target,
                        const RetargetOptions& options = {}, const Context& context = {});

}  // namespace mimetra
