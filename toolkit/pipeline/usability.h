#pragma once

#include <string>
#include <vector>

#include "toolkit/pipeline/solution.h"
#include "toolkit/transfer/transfer_error.h"

/// From where on people see that a result is wrong, and what may have made it so. Internal to what
/// notes it.
namespace mimetra {

/// Sound results miss 0.1 to 4 % of the deformation and flip 1 to 5 triangles of 100 000; results
/// that people see to be wrong, 8 % and more, or 40 and more.
constexpr double kUnusableMissedShare = 0.08;
constexpr double kUnusableFlippedShare = 2e-4;

/// What is wrong with a result before head motion is given back: "9 % of the deformation is
/// missing"; empty for nothing.
std::string unusable_by(const TransferError& error);

/// Options that are on and hold a target off what the source does, "option 'smoothness'", as they
/// are named in parameters. \pre a MatchedTarget
std::vector<std::string> holding_options(const Target& target, const SolveOptions& options);

/// The target and the solve without these.
Target without_holds(Target target);
SolveOptions without_holds(SolveOptions options);

}  // namespace mimetra
